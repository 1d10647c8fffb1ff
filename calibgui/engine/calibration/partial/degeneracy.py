"""Degeneracy: views that do not determine a camera are recognised and named.

A view adds two equations on the focal lengths and the centre, through the vanishing line of
its plane only: planes parallel to the sensor add none, parallel planes add the same ones.
What a solution then tells of the camera comes from its lens model and from noise, and its
standard deviations are not to be believed. The test is therefore whether the planes'
directions differ at all: with C_k the covariance of the normal n_k and m their mean, noise
alone makes

    T = sum_k (n_k - m)^T C_k^-1 (n_k - m) / (2 (K - 1))

about 1, whatever the focal length has become, because all parallel planes keep one vanishing
line. Measured over 2 to 40 views at 0.05 to 1 px: at most 5 for parallel planes, 120 for two
planes 1.4 degrees apart, thousands for tilts of 2 to 5 degrees.

Parameters that planes of different directions still leave open are found by
``covariances.measure_precision``; what degenerate views do determine is estimated by
``partial_calibration.py``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.covariances import Precision
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Degeneracy, Diagnosis
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import PINHOLE, find_model
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import make_cross_matrix

_MIN_T = 50.0
"""T below which the planes count as parallel."""
_MIN_ANGLE = np.deg2rad(0.1)
"""Largest angle from the mean normal, rad, below which planes count as parallel without noise."""
_OPTICAL_AXIS = np.array([0.0, 0.0, 1.0])
"""The camera's optical axis, the normal of planes parallel to the sensor."""
_MAX_SAME_ANGLE = np.deg2rad(3.0)
"""Angle between directions below which a diagnosis calls them the same, rad."""
_MAX_RESIDUAL_RATIO = 10.0
"""Ratio of a Stage I residual to the median view's beyond which no flat board explains the view."""
_MIN_MISFIT = 1.0
"""Stage I residual below which a view is never a misfit, reference px (a square has 30)."""
_NEAR_AXIS = 1e-6
"""Distance of a ray from the axis, at a depth of 1, at which the image's scale is measured."""
_MAX_SCALE_DEVIATION = 0.1
"""Standard deviation of the image's scale on the axis, relative to it, above which it is open."""
_MAX_SPOT = 1 / 3
"""Share of the image's width and height below which corners lie in one spot."""
_MAX_MOTION = 0.03
"""Share of its distance by which a board in one place may seem to move."""


def compute_normals(R: Array) -> Array:
    """Return unit normals (K, 3) of the boards in the camera frame, all away from the camera."""
    n = R[:, :, 2]
    return n * np.where(n[:, 2:] < 0, -1.0, 1.0)


def are_planes_parallel(R: Array, roots: Array, variance: float) -> bool:
    """Return whether the planes' normals differ by no more than noise.

    Args:
        R: (K, 3, 3) rotations cam_from_board.
        roots: (K, 6, 6) L^-1 of the poses (w, tau), as in ``refinement/schur.py``.
        variance: variance of one residual coordinate.
    """
    n = compute_normals(R)
    mean = _average_normals(n)
    if _measure_max_angle(n, mean) < _MIN_ANGLE:
        return True
    # The turn about the board's two axes across n; turns about n itself leave n where it is.
    across = R[:, :, :2]
    turn = ((n @ make_cross_matrix(mean))[:, None] @ across)[:, 0]
    root = roots[..., :3] @ across
    covariance = np.swapaxes(root, 1, 2) @ root
    squares = turn * np.linalg.solve(covariance, turn[..., None])[..., 0]
    return bool(squares.sum() / (2 * (len(n) - 1)) < _MIN_T * variance)


def find_misfits(rms: Array) -> IntArray:
    """Find the views whose corners fit no flat board.

    One such view makes enough noise to hide what the others determine.

    Args:
        rms: (K,) Stage I residuals, reference px.
    """
    return np.flatnonzero(rms > np.maximum(_MAX_RESIDUAL_RATIO * np.median(rms), _MIN_MISFIT))


def find_undetermined(
    solution: Solution,
    names: tuple[str, ...],
    precision: Precision,
    name_misfits: Callable[[], Sequence[str]],
    camera: Camera,
) -> tuple[str, ...]:
    """Find the focal lengths and coordinates of the centre that the views do not determine.

    Args:
        solution: the minimum.
        names: (P,) names of the free parameters.
        precision: the precision of the solution.
        name_misfits: a function that returns the names of the views that `find_misfits` finds.
        camera: the camera of the solution.

    Raises:
        CalibrationError: if there are misfits, which are then the cause.
    """
    pinhole = tuple(name for name in names if name in PINHOLE)
    if not np.isfinite(precision.variance):
        return pinhole
    # One orientation gives two equations: enough if the other two parameters are held.
    if len(pinhole) > 2 and are_planes_parallel(
        solution.state.R, precision.reduced.roots, precision.variance
    ):
        found = pinhole
    elif found := tuple(u.name for u in precision.undetermined if u.name in PINHOLE):
        traded = find_traded_focal_lengths(camera, names, precision.shared)
        found = tuple(name for name in found if name not in traded)
    if found and (misfits := name_misfits()):
        raise CalibrationError(
            f"No camera sees a flat board as in {', '.join(misfits)}, which leaves "
            f"{', '.join(found)} undetermined.",
            "Number their corners as in the other views, or leave them out.",
        )
    return found


def find_traded_focal_lengths(
    camera: Camera, names: tuple[str, ...], covariance: Array
) -> tuple[str, ...]:
    """Find the focal lengths that the lens's coefficients make up for.

    The image of a lens is (dd/dr on the axis) f times as large as the object near the axis. Where
    that derivative depends on a coefficient, as on Mei's xi, a focal length can be open that the
    image's scale is not.

    Args:
        camera: the camera.
        names: names of the free parameters.
        covariance: covariance of the free parameters.
    """
    params, lens = camera.params, find_model(camera.model)
    near_axis = lens.project(np.array([_NEAR_AXIS, 0.0, 1.0]), params[4:])
    by_k = near_axis.by_coefficients[0] / near_axis.points[0]
    found = []
    for i, name in enumerate(PINHOLE[:2]):
        relative = dict(zip(lens.names, by_k.tolist(), strict=True)) | {name: 1 / float(params[i])}
        by_free = np.array([relative.get(free, 0.0) for free in names])
        if by_k.any() and np.sqrt(by_free @ covariance @ by_free) < _MAX_SCALE_DEVIATION:
            found.append(name)
    return tuple(found)


def find_copies(views: Iterable[tuple[Array, Array]]) -> IntArray:
    """Return (K,) for each view (uv, xy) the index of the first with the same corners."""
    views = list(views)
    if len({float(uv[0, 0]) for uv, _ in views}) == len(views):  # mostly one coordinate tells
        return np.arange(len(views))
    alike: dict[bytes, list[tuple[int, Array, Array]]] = {}
    originals = []
    for k, (uv, xy) in enumerate(views):
        before = alike.setdefault(uv[:1].tobytes(), [])  # mostly the first corner tells
        same = (j for j, *corners in before if all(map(np.array_equal, corners, (uv, xy))))
        originals.append(next(same, k))
        before.append((k, uv, xy))
    return np.array(originals, dtype=np.int64)


def is_in_one_spot(uv: Array, size: Size) -> bool:
    """Return whether all corners (..., 2) lie in a small part of the image."""
    return bool((_measure_extent(uv, size) < _MAX_SPOT).all())


def diagnose_degeneracy(
    observations: Observations, size: Size, originals: IntArray, state: State, lost: Sequence[str]
) -> Diagnosis:
    """Diagnose degenerate views: their kind, why they leave the camera open, what to photograph.

    Args:
        observations: the views.
        size: width and height of the images, px.
        originals: (K,) the view that each one copies, from `find_copies`.
        state: camera and poses, as far as they are known.
        lost: names of the quantities that are undetermined.
    """
    K, n = len(originals), compute_normals(state.R)
    tilt = "the board tilted by 20 to 45 degrees"
    consequence = f", which leaves {', '.join(lost)} unknown." if lost else "."
    if not originals.any():
        kind = Degeneracy.ONE_VIEW if K == 1 else Degeneracy.COPIES
        cause = (
            f"All {K} views are copies of one" if K > 1 else "One view does not determine a camera"
        )
        hint = f"Add at least two more views with {tilt} in different directions."
        return Diagnosis(kind, cause + consequence, hint)
    if 2 * observations.count <= len(lost) + 6 * K:
        return Diagnosis(
            Degeneracy.TOO_LITTLE,
            "There are no more corner coordinates than unknowns.",
            "Add views, or views that show more corners.",
        )
    if _measure_max_angle(n, _average_normals(n)) < _MAX_SAME_ANGLE:
        hint = f"Add views with {tilt} in other directions."
        if _is_in_one_place(observations, state):
            kind = Degeneracy.ONE_PLACE
            cause = "All views show the board in one orientation and place, or turned in its plane"
        elif _measure_max_angle(n, _OPTICAL_AXIS) < _MAX_SAME_ANGLE:
            kind = Degeneracy.PARALLEL_TO_SENSOR
            cause = "All views are parallel to the sensor"
            hint = f"Add views with {tilt}, to the left, right, top and bottom."
        else:
            kind = Degeneracy.ONE_ORIENTATION
            cause = "All views show the board in one orientation"
        return Diagnosis(kind, cause + consequence, hint)
    if is_in_one_spot(observations.uv, size):
        w, h = (100 * _measure_extent(observations.uv, size)).tolist()
        return Diagnosis(
            Degeneracy.ONE_SPOT,
            f"All corners lie in one spot, {w:.0f} x {h:.0f} % of the image{consequence}",
            "Fill the image with the board, or bring it into every part of the image.",
        )
    return Diagnosis(
        Degeneracy.TOO_LITTLE,
        f"These {K} views leave {', '.join(lost)} undetermined.",
        f"Add views with {tilt} in different directions, some of them near the image's corners.",
    )


def _measure_extent(uv: Array, size: Size) -> Array:
    """Return (2,) width and height over which corners (..., 2) lie, as shares of the image's."""
    return np.array([np.ptp(uv[..., i]) / size[i] for i in range(2)])


def _is_in_one_place(observations: Observations, state: State) -> bool:
    """Return whether the board's middle stays where it is, seen from the camera."""
    xy = observations.xy.reshape(-1, observations.xy.shape[-1])[:, :2]
    middle = (xy.min(axis=0) + xy.max(axis=0)) / 2
    place = state.R[:, :, :2] @ middle + state.T
    distance = np.linalg.norm(place, axis=1)
    away = np.linalg.norm(place - place.mean(axis=0), axis=1)
    return bool(away.max() < _MAX_MOTION * distance.mean())


def _average_normals(n: Array) -> Array:
    """Return the unit mean (3,) of normals (K, 3)."""
    total = n.sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


def _measure_max_angle(n: Array, direction: Array) -> float:
    """Return the largest angle between one of the normals (K, 3) and a direction, rad."""
    return float(np.arccos(np.clip(n @ direction, -1, 1)).max())
