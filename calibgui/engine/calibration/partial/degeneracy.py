"""Sets of views that do not determine a camera, recognised and named.

A view adds two equations on the focal lengths and the centre, through the vanishing line of
its plane only: planes parallel to the sensor add none, parallel planes add the same ones.
What a solution then says of the camera comes from its lens model and from noise, and its
own standard deviations are not to be believed. The test is therefore whether the planes'
directions differ at all: with C_k the covariance of the normal n_k and m their mean, noise
alone makes

    T = sum_k (n_k - m)^T C_k^-1 (n_k - m) / (2 (K - 1))

about 1, whatever the focal length has become, because all parallel planes keep one vanishing
line. Measured over 2 to 40 views at 0.05 to 1 px: at most 5 for parallel planes, 120 for two
planes 1.4 degrees apart, thousands for tilts of 2 to 5 degrees.

What differing planes still leave open, ``uncertainty.precision`` finds; what the views of a
degenerate set do determine, ``assumed.py``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size
from calibgui.engine.calibration.covariances import Precision
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Degeneracy, Diagnosis
from calibgui.engine.camera.models import PINHOLE
from calibgui.engine.errors import CalibrationError

_SIGNIFICANT = 50.0
"""T below which the planes count as parallel."""
_DISTINCT = np.deg2rad(0.1)
"""Largest angle from the mean below which they do however little noise there is."""
_AXIS = np.array([0.0, 0.0, 1.0])
"""The camera's optical axis, the normal of planes parallel to the sensor."""
_CLOSE = np.deg2rad(3.0)
"""Angle below which a diagnosis calls directions the same."""
_MISFIT = 10.0
"""Stage I residual, in those of the median view, beyond which corners are not of the board."""
_LEAST_MISFIT = 1.0
"""Least such residual, reference px, of which a square has 30."""
_SPOT = 1 / 3
"""Of the image's width and height, below which corners lie in one spot."""
_THERE = 0.03
"""Of the distance, by which a board in one place may seem to move."""


def normals(R: Array) -> Array:
    """(K, 3) unit normals of the plates in the camera frame, all pointing away from the camera."""
    n = R[:, :, 2]
    return n * np.where(n[:, 2:] < 0, -1.0, 1.0)


def parallel(R: Array, V: Array, variance: float) -> bool:
    """Whether the planes' normals differ by no more than noise.

    Args:
        R: (K, 3, 3) rotations cam_from_plate.
        V: (K, 6, 6) normal matrices of the poses (w, tau), as in ``arrow``.
        variance: of one residual coordinate.
    """
    n = normals(R)
    mean = _mean(n)
    if _farthest(n, mean) < _DISTINCT:
        return True
    # By the plate's own axes, across n: turns about n itself leave it where it is.
    across = np.swapaxes(R[:, :, :2], 1, 2)
    turn = (across @ np.cross(n, mean)[..., None])[..., 0]
    covariance = across @ np.linalg.inv(V)[:, :3, :3] @ np.swapaxes(across, 1, 2)
    squares = turn * np.linalg.solve(covariance, turn[..., None])[..., 0]
    return bool(squares.sum() / (2 * (len(n) - 1)) < _SIGNIFICANT * variance)


def misfits(rms: Array) -> IntArray:
    """The views whose corners fit no flat board, by their Stage I residuals (K,), reference px.

    One such view makes all the noise that hides what the others determine.
    """
    return np.flatnonzero(rms > np.maximum(_MISFIT * np.median(rms), _LEAST_MISFIT))


def undetermined(
    solution: Solution, names: tuple[str, ...], precision: Precision, suspects: Sequence[str]
) -> tuple[str, ...]:
    """The focal lengths and coordinates of the centre that the views do not determine.

    Args:
        solution: of Stage II.
        names: (P,) of the free parameters.
        precision: of the solution.
        suspects: names of the views that are `misfits`.

    Raises:
        CalibrationError: if suspects are the cause.
    """
    pinhole = tuple(name for name in names if name in PINHOLE)
    if not np.isfinite(precision.variance):
        return pinhole
    # One orientation gives two equations: enough if the other two parameters are held.
    same = len(pinhole) > 2 and parallel(solution.state.R, solution.normal.V, precision.variance)
    found = pinhole if same else tuple(u.name for u in precision.undetermined if u.name in PINHOLE)
    if found and suspects:
        raise CalibrationError(
            f"No camera sees a flat board as in {', '.join(suspects)}, which leaves "
            f"{', '.join(found)} undetermined.",
            "Number their corners as in the other views, or leave them out.",
        )
    return found


def copies(views: Iterable[tuple[Array, Array]]) -> IntArray:
    """(K,) of each view (uv, xy) the first with the same corners: itself, or what it copies."""
    first: dict[bytes, int] = {}
    keys = [uv.tobytes() + xy.tobytes() for uv, xy in views]
    return np.array([first.setdefault(key, k) for k, key in enumerate(keys)], dtype=np.int64)


def in_one_spot(uv: Array, size: Size) -> bool:
    """Whether all corners (..., 2) lie in a small part of the image."""
    return bool((_extent(uv, size) < _SPOT).all())


def diagnosed(
    observations: Observations, size: Size, like: IntArray, state: State, lost: Sequence[str]
) -> Diagnosis:
    """The kind of a degenerate set, why it leaves the camera open, and what to photograph.

    Args:
        observations: the views.
        size: of the images, px.
        like: (K,) as from `copies`.
        state: camera and poses, as far as they are known.
        lost: names of what is undetermined.
    """
    K, n = len(like), normals(state.R)
    tilt = "the board tilted by 20 to 45 degrees"
    so = f", which leaves {', '.join(lost)} undetermined." if lost else "."
    if not like.any():
        kind = Degeneracy.ONE_VIEW if K == 1 else Degeneracy.COPIES
        said = (
            f"All {K} views are copies of one" if K > 1 else "One view does not determine a camera"
        )
        hint = f"Add at least two more views with {tilt} in different directions."
        return Diagnosis(kind, said + so, hint)
    if 2 * observations.count <= len(lost) + 6 * K:
        return Diagnosis(
            Degeneracy.TOO_LITTLE,
            "There are no more corner coordinates than unknowns.",
            "Add views, or views that show more corners.",
        )
    if _farthest(n, _mean(n)) < _CLOSE:
        hint = f"Add views with {tilt} in other directions."
        if _in_one_place(observations, state):
            kind = Degeneracy.ONE_PLACE
            said = "All views show the board in one orientation and place, or turned in its plane"
        elif _farthest(n, _AXIS) < _CLOSE:
            kind = Degeneracy.PARALLEL_TO_SENSOR
            said = "All views are parallel to the sensor"
            hint = f"Add views with {tilt}, to the left, right, top and bottom."
        else:
            kind = Degeneracy.ONE_ORIENTATION
            said = "All views show the board in one orientation"
        return Diagnosis(kind, said + so, hint)
    if in_one_spot(observations.uv, size):
        w, h = (100 * _extent(observations.uv, size)).tolist()
        return Diagnosis(
            Degeneracy.ONE_SPOT,
            f"All corners lie in one spot, {w:.0f} x {h:.0f} % of the image{so}",
            "Fill the image with the board, or bring it into every part of the image.",
        )
    return Diagnosis(
        Degeneracy.TOO_LITTLE,
        f"These {K} views leave {', '.join(lost)} undetermined.",
        f"Add views with {tilt} in different directions, some of them near the image's corners.",
    )


def _extent(uv: Array, size: Size) -> Array:
    """(2,) width and height over which corners (..., 2) lie, of the image's."""
    return np.asarray(np.ptp(uv.reshape(-1, 2), axis=0) / np.array(size))


def _in_one_place(observations: Observations, state: State) -> bool:
    """Whether the plate's middle stays where it is, seen from the camera."""
    xy = observations.xy.reshape(-1, observations.xy.shape[-1])[:, :2]
    middle = (xy.min(axis=0) + xy.max(axis=0)) / 2
    place = state.R[:, :, :2] @ middle + state.T
    distance = np.linalg.norm(place, axis=1)
    away = np.linalg.norm(place - place.mean(axis=0), axis=1)
    return bool(away.max() < _THERE * distance.mean())


def _mean(n: Array) -> Array:
    """(3,) unit mean of normals (K, 3)."""
    total = n.sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


def _farthest(n: Array, direction: Array) -> float:
    """Largest angle between one of the normals (K, 3) and a direction, rad."""
    return float(np.arccos(np.clip(n @ direction, -1, 1)).max())
