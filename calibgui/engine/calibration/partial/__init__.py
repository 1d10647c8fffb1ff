"""Partial calibration: what views that do not determine a camera still tell about it."""
