"""Choices among models and methods, by how well they predict views that they have not seen.

``cross_validation`` measures that, ``lens_choice`` chooses a lens model among those of
``lens_trial``, and ``method_comparison`` sets the methods of calibration side by side.
"""
