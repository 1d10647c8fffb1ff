"""What a camera is: its lens model and parameters, and the maps from points to pixels and back.

`Camera` holds the values; `project_points`, `distort_points` and `undistort_points` use them.
`MODELS` lists the lens models by id, `find_model` finds one.
"""

from __future__ import annotations

from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.distortion import (
    Displacement,
    DisplacementPart,
    compute_displacement,
    distort_points,
    project_points,
    undistort_points,
)
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import (
    MODELS,
    PINHOLE,
    find_model,
    parameter_names,
    resolve_model_id,
)
from calibgui.engine.camera.models.lucchese import Lucchese
from calibgui.engine.camera.models.splined_stereographic import SplinedStereographic
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels

__all__ = [
    "MODELS",
    "PINHOLE",
    "Camera",
    "Displacement",
    "DisplacementPart",
    "Lens",
    "Lucchese",
    "SplinedStereographic",
    "check_image_size",
    "compute_displacement",
    "distort_points",
    "find_model",
    "parameter_names",
    "pixels_from_rays",
    "project_points",
    "rays_from_pixels",
    "resolve_model_id",
    "undistort_points",
]
