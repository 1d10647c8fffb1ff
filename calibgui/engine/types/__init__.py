"""The records that the engine takes and returns.

All are frozen; their arrays are read-only, C-contiguous float64 (or int64 where said).
Unless a field says otherwise lengths on the plate are millimetres, angles radians and
image coordinates pixels in the array frame (``frames.py``).
"""

from __future__ import annotations

from calibgui.engine.types.arrays import (
    Array,
    Board,
    BoolArray,
    Int32Array,
    IntArray,
    Size,
    freeze,
    frozen,
    frozen_int,
    image_size,
)
from calibgui.engine.types.calibration import (
    Assumed,
    Calibration,
    Cost,
    Degeneracy,
    Diagnosis,
    Iteration,
    Progress,
    Report,
    StageOne,
    Status,
    Undetermined,
    ViewResiduals,
)
from calibgui.engine.types.camera import Camera, Pose
from calibgui.engine.types.plate import Plate, PlateModel, Prior
from calibgui.engine.types.views import (
    Ambiguity,
    Corners,
    Observation,
    OtherBoard,
    Rejection,
    Target,
    View,
    ViewStatus,
)

__all__ = [
    "Ambiguity",
    "Array",
    "Assumed",
    "Board",
    "BoolArray",
    "Calibration",
    "Camera",
    "Corners",
    "Cost",
    "Degeneracy",
    "Diagnosis",
    "Int32Array",
    "IntArray",
    "Iteration",
    "Observation",
    "OtherBoard",
    "Plate",
    "PlateModel",
    "Pose",
    "Prior",
    "Progress",
    "Rejection",
    "Report",
    "Size",
    "StageOne",
    "Status",
    "Target",
    "Undetermined",
    "View",
    "ViewResiduals",
    "ViewStatus",
    "freeze",
    "frozen",
    "frozen_int",
    "image_size",
]
