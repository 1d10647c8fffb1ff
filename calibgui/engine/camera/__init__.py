"""A camera is a lens model with its parameters, which maps points to pixels and back.

`Camera` holds the values; `project_points`, `distort_points` and `undistort_points` use them.
`MODELS` lists the lens models by id, `find_model` finds one. `SensorMode` leads from the images
that a camera was calibrated with to those of another of its streams.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.camera.camera import Camera as Camera, check_image_size as check_image_size
    from calibgui.engine.camera.distortion import (
        Displacement as Displacement,
        DisplacementPart as DisplacementPart,
        compute_displacement as compute_displacement,
        distort_points as distort_points,
        project_points as project_points,
        undistort_points as undistort_points,
    )
    from calibgui.engine.camera.image_circle import (
        ImageCircle as ImageCircle,
        find_common_circle as find_common_circle,
    )
    from calibgui.engine.camera.model import Lens as Lens
    from calibgui.engine.camera.models import (
        MODELS as MODELS,
        PINHOLE as PINHOLE,
        find_model as find_model,
        list_parameter_names as list_parameter_names,
        resolve_model_id as resolve_model_id,
        suggest_model as suggest_model,
    )
    from calibgui.engine.camera.models.lucchese import Lucchese as Lucchese
    from calibgui.engine.camera.models.splined_stereographic import (
        SplinedStereographic as SplinedStereographic,
    )
    from calibgui.engine.camera.sensor_mode import (
        SensorMode as SensorMode,
        describe_mode as describe_mode,
    )
    from calibgui.engine.camera.projection import (
        pixels_from_rays as pixels_from_rays,
        rays_from_pixels as rays_from_pixels,
    )

load_on_demand(
    __name__,
    {
        "camera": ["Camera", "check_image_size"],
        "distortion": [
            "Displacement",
            "DisplacementPart",
            "compute_displacement",
            "distort_points",
            "project_points",
            "undistort_points",
        ],
        "image_circle": ["ImageCircle", "find_common_circle"],
        "model": ["Lens"],
        "models": [
            "MODELS",
            "PINHOLE",
            "find_model",
            "list_parameter_names",
            "resolve_model_id",
            "suggest_model",
        ],
        "models.lucchese": ["Lucchese"],
        "models.splined_stereographic": ["SplinedStereographic"],
        "projection": ["pixels_from_rays", "rays_from_pixels"],
        "sensor_mode": ["SensorMode", "describe_mode"],
    },
)
