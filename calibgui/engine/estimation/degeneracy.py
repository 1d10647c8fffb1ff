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

What differing planes still leave open, ``uncertainty.precision`` finds.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calibgui.engine.errors import CalibrationError, DegenerateError
from calibgui.engine.estimation.levenberg_marquardt import Solution
from calibgui.engine.estimation.uncertainty import Precision
from calibgui.engine.types import Array, IntArray

PINHOLE = ("fx", "fy", "cx", "cy")
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


def diagnose(
    solution: Solution, names: tuple[str, ...], precision: Precision, suspects: Sequence[str]
) -> None:
    """Refuse a solution whose focal lengths or centre the views do not determine.

    Args:
        solution: of Stage II.
        names: (P,) of the free parameters.
        precision: of the solution.
        suspects: names of the views that are `misfits`.

    Raises:
        DegenerateError: with the cause, and what to photograph instead.
        CalibrationError: if suspects are the cause.
    """
    if not np.isfinite(precision.variance):
        raise DegenerateError(
            "There are no more corner coordinates than unknowns.",
            "Add views, or views that show more corners.",
        )
    pinhole = [name for name in names if name in PINHOLE]
    R, n = solution.state.R, normals(solution.state.R)
    # One orientation gives two equations: enough if the other two parameters are held.
    same = len(pinhole) > 2 and parallel(R, solution.normal.V, precision.variance)
    lost = pinhole if same else [u.name for u in precision.undetermined if u.name in PINHOLE]
    if not lost:
        return
    what = ", ".join(lost)
    if suspects:
        raise CalibrationError(
            f"No camera sees a flat board as in {', '.join(suspects)}, which leaves {what} "
            "undetermined.",
            "Number their corners as in the other views, or leave them out.",
        )
    if _farthest(n, _AXIS) < _CLOSE:
        raise DegenerateError(
            f"All views are parallel to the sensor, which leaves {what} undetermined.",
            "Tilt the board by 20 to 45 degrees, to the left, right, top and bottom.",
        )
    if same or _farthest(n, _mean(n)) < _CLOSE:
        raise DegenerateError(
            f"All views show the board in one orientation, which leaves {what} undetermined.",
            "Add views with the board tilted by 20 to 45 degrees in other directions.",
        )
    raise DegenerateError(
        f"These {len(n)} views leave {what} undetermined.",
        "Add views with the board tilted by 20 to 45 degrees in different directions, "
        "some of them near the image's corners.",
    )


def _mean(n: Array) -> Array:
    """(3,) unit mean of normals (K, 3)."""
    total = n.sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


def _farthest(n: Array, direction: Array) -> float:
    """Largest angle between one of the normals (K, 3) and a direction, rad."""
    return float(np.arccos(np.clip(n @ direction, -1, 1)).max())
