"""Calibrations beside each other: of two cameras, of one at two times, or of a whole fleet.

``comparison`` maps how far two cameras differ, ``drift`` asks whether their uncertainties explain
it; ``calibration_check`` tests a stored camera on new views, by the ``camera_change`` that explains
them.
``series`` describes a camera that varies with a scalar, ``fleet_spread`` many cameras of one kind.
"""
