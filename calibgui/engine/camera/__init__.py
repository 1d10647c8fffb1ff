"""What a camera is: its lens model and parameters, and the ways from points to pixels and back."""

from __future__ import annotations

from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import (
    Displacement,
    Part,
    displacement,
    distort_points,
    project_points,
    undistort_points,
)
from calibgui.engine.camera.models import MODELS, parameter_names
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.camera.projection import pixels

__all__ = [
    "MODELS",
    "Camera",
    "Displacement",
    "Lucchese",
    "Part",
    "displacement",
    "distort_points",
    "parameter_names",
    "pixels",
    "project_points",
    "undistort_points",
]
