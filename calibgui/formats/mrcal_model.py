"""mrcal's camera model, with the lens LENSMODEL_OPENCV5.

Reader: mrcal 2, its command-line tools and its Python module; the newer key `rt_cam_ref` is
written beside the older `extrinsics`. Pixels are OpenCV's (0-based, integer at pixel centres),
and so are the five coefficients. The camera is its own reference. `valid_intrinsics_region` is
the convex hull of the corners that were seen, beyond which a refit extrapolates.
Cannot hold: other lens models (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.formats.camera_refit import FORWARD_MODELS, write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport


def write_mrcal(result: Result, path: Path) -> ExportReport:
    """Write a .cameramodel file."""
    corners = np.concatenate([view.uv for view in result.observations()])
    hull = corners[scipy.spatial.ConvexHull(corners).vertices]
    return write_in_models(
        result,
        path,
        EXPORTER.models,
        lambda fitted, note: format_camera_model(fitted.camera, hull, note),
    )


def format_camera_model(camera: Camera, region: Array, note: str) -> str:
    """Return the text of the file.

    Args:
        camera: in one of `FORWARD_MODELS`.
        region: (n, 2) px, an open contour.
        note: on the refit.
    """
    contour = [*region.tolist(), region[0].tolist()]
    return f"""\
# {note}
# {FRAME}
{{
    'lensmodel': 'LENSMODEL_OPENCV5',
    # fx, fy, cx, cy, k1, k2, p1, p2, k3
    'intrinsics': {camera.params.tolist()},
    'valid_intrinsics_region': {contour},
    'extrinsics': {[0.0] * 6},
    'rt_cam_ref': {[0.0] * 6},
    'imagersize': {list(camera.size)},
}}
"""


EXPORTER = Exporter(
    name="mrcal",
    title="mrcal camera model",
    suffixes=(".cameramodel",),
    models=FORWARD_MODELS,
    limits="Forward distortion model (OPENCV5) refitted; no standard deviations, no poses.",
    write=write_mrcal,
)
