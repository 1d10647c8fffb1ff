"""Refitting a calibration in the lens model of another program.

The paper's model corrects measured points, most programs distort ideal ones, and the coefficients
of neither express the other. The other model is therefore calibrated on the same corners and
compared with the original: a pixel's ray under the first camera is imaged by the second, and the
distance between the two pixels is the refit's error there. Where corners were seen both models
agree to a fraction of the corners' noise; beyond them both extrapolate, and the error says how far
they disagree, not which of them is right.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.plane import PlaneLens
from calibgui.engine.camera.projection import pixels_from_rays, rays_from_pixels
from calibgui.engine.images.sampling import make_mesh

_GRID_SAMPLES = 64
"""Number of pixels along either side of the image at which the models are compared."""


@dataclass(frozen=True, eq=False, slots=True)
class Refit:
    """A calibration in another lens model, and its distance from the original."""

    calibration: Calibration
    largest_error: float
    """Largest error over the whole image, px; NaN if a pixel has no ray or its ray no image."""
    covered_error: float
    """Largest error at the places where corners were seen, px."""


def refit(
    views: Sequence[Observation | tuple[Array, Array]],
    original: Calibration,
    model: str = "brown-conrady",
    zeros: Collection[str] = (),
) -> Refit:
    """Calibrate another lens model on the same corners.

    Args:
        views: the observations that `original` was calibrated from.
        original: the calibration to express.
        model: the lens model, a key of ``camera.models.MODELS``.
        zeros: names of its coefficients that are to be 0.

    Raises:
        CalibrationError, DegenerateError: as `calibrate`.

    Examples:
        A lens of the paper's model is expressed in OpenCV's. Two polynomials of finite degree are
        not quite inverse to each other, so that a small error remains.

        >>> import numpy as np
        >>> from calibgui.engine import Board, Camera, Pose, calibrate, project_points, refit
        >>> board = Board(rows=6, cols=7, square=30.0)
        >>> camera = Camera((640, 480), [650, 650, 320, 240, 0.2, 0, 0, 0, 0, 0])
        >>> xy = board.points()
        >>> tilts = [(0.5, 0, 0), (-0.5, 0, 0), (0, 0.5, 0), (0, -0.5, 0), (0.3, 0.4, 0)]
        >>> views = [(project_points(xy, camera, Pose(r, (-90, -75, 500))), xy) for r in tilts]
        >>> found = refit(views, calibrate(views, camera.size), model="brown-conrady")
        >>> found.calibration.camera.names
        ('fx', 'fy', 'cx', 'cy', 'k1', 'k2', 'p1', 'p2', 'k3', 'skew')
        >>> found.covered_error < 0.02
        True
    """
    held = _select_common_held(original, model) | dict.fromkeys(zeros, 0.0)
    board_shape = original.board_shape or BoardShapeModel.NOMINAL
    calibration = calibrate(
        views, original.camera.size, model=model, fix=held, board_shape=board_shape
    )
    w, h = original.camera.size
    whole = make_mesh(np.linspace(0, w - 1, _GRID_SAMPLES), np.linspace(0, h - 1, _GRID_SAMPLES))
    seen = np.concatenate([Observation(*view).uv for view in views])
    return Refit(
        calibration,
        float(measure_displacement(original.camera, calibration.camera, whole).max()),
        float(measure_displacement(original.camera, calibration.camera, seen).max()),
    )


def _select_common_held(original: Calibration, model: str) -> dict[str, float]:
    """Select the original's held parameters that the refit holds as well.

    The centre means the same in every model, and the focal lengths in every model whose plainest
    lens images the axis at the scale of a pinhole. Lens coefficients do not, but the inverse of a
    symmetric map is symmetric, and that of a map of the plane without distortion has none either.
    """
    fixed, own, other = (
        original.settings.fixed,
        find_model(original.camera.model),
        find_model(model),
    )
    held = {name: fixed[name] for name in ("cx", "cy") if name in fixed}
    if all(_has_pinhole_scale(lens) for lens in (own, other)):
        held |= {name: fixed[name] for name in ("fx", "fy") if name in fixed}
    without = {name for name, value in fixed.items() if value == 0}
    if without >= set(own.asymmetric):
        held |= dict.fromkeys(other.asymmetric, 0.0)
        is_plane = isinstance(own, PlaneLens) and isinstance(other, PlaneLens)
        if is_plane and without >= set(own.names):
            held |= dict.fromkeys(other.names, 0.0)
    return held


def _has_pinhole_scale(lens: Lens) -> bool:
    """Return whether the plainest lens images directions near the axis as a pinhole does."""
    seen = lens.project(np.array([0.0, 0.0, 1.0]), np.array(lens.defaults))
    return bool(seen.by_ray[0, 0] == 1)


def measure_displacement(a: Camera, b: Camera, uv: Array) -> Array:
    """Measure how far two cameras disagree.

    Args:
        a, b: the cameras.
        uv: (..., 2) pixels of camera `a`.

    Returns:
        (...) distances, px, between the pixels and the images of their rays in camera `b`; NaN
        where there is none.
    """
    return np.linalg.norm(pixels_from_rays(rays_from_pixels(uv, a), b) - uv, axis=-1)
