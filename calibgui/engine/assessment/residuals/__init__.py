"""Tests and measures of a calibration's residuals, told in reading order.

``residual_statistics`` states their size, ``residual_checks`` whether they are noise; if they are
not, ``residual_causes`` lists what may have caused them, ``systematic_errors`` are what views may
have of their own, and ``cause_fits`` fits such causes and compares what they explain.
``error_sources`` splits the residuals among lens, board, views and noise; ``outliers`` leaves
corners out that spoil a calibration, and ``view_weights`` weighs views.
"""
