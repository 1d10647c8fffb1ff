"""mrcal's camera model, with the lens LENSMODEL_OPENCV5.

Reader: mrcal 2, its command-line tools and its Python module; what newer ones call rt_cam_ref is
written beside the older `extrinsics`. Pixels are OpenCV's (0-based, integer at pixel centres),
and so are the five coefficients. The camera is its own reference. `valid_intrinsics_region` is
the convex hull of the corners that were seen: the refit has nothing to hold on to beyond.
Cannot hold: the paper's correction (its forward counterpart is refitted), standard deviations,
poses, corners.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy

from calibgui.dataset.result import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.forward_model import write_forward


def write_mrcal(result: Result, path: Path) -> ExportReport:
    """Write a .cameramodel file."""
    corners = np.concatenate([view.uv for view in result.observations()])
    hull = corners[scipy.spatial.ConvexHull(corners).vertices]
    return write_forward(result, path, lambda fitted, note: cameramodel(fitted.camera, hull, note))


def cameramodel(camera: Camera, region: Array, note: str) -> str:
    """The text of the file; `camera` is in OpenCV's model, `region` (n, 2) px an open contour."""
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
    limits="Forward distortion model (OPENCV5) refitted; no standard deviations, no poses.",
    write=write_mrcal,
)
