"""Geometric camera calibration through multi-view rectification."""

__version__ = "0.1.0"
