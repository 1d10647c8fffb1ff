"""The limits that a calibration has to keep.

They are the same for one camera (``calibgui calibrate --limits``) and for those of a fleet;
``acceptance.py`` judges by them. A preset is a file with a name (``formats/limits_toml.py``).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LengthLimit:
    """The certainty of a length that is measured by its two ends, wherever it is seen."""

    sigma_mm: float
    """Largest standard deviation, mm."""
    length_mm: float
    distance_mm: float
    """Depth of the plane across the axis in which it lies."""


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits that every camera has to keep; None where there is none."""

    largest_edge_error_px: float | None = None
    """Largest error of pixels along the image's edge, px, one standard deviation
    (``assessment/verdict.py``)."""
    fewest_views: float | None = None
    """Least number of photographs that are used."""
    least_coverage: float | None = None
    """Least share of the sensor that has corners, 0 to 1 (``sensor_coverage.py``)."""
    largest_change_px: float | None = None
    """Largest displacement of a pixel, px, since the last calibration of the same serial number, if
    it is more than the uncertainties explain."""
    length: LengthLimit | None = None
    """How certain a length has to be."""
    name: str = ""
    """What the limits are called."""


NO_LIMITS = Limits()
