"""Sets of views that do not determine a camera, recognised and named.

A view adds two equations on the focal lengths and the centre, through the direction of its
plane in the camera's frame only: planes parallel to the sensor add none, parallel planes add
the same ones. ``uncertainty.undetermined`` finds the loss by the rank of the normal
equations; the directions of the planes then tell its cause.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.errors import DegenerateError
from calibgui.engine.levenberg_marquardt import Solution
from calibgui.engine.types import Array
from calibgui.engine.uncertainty import undetermined

_PARALLEL = np.deg2rad(3.0)
_PINHOLE = ("fx", "fy", "cx", "cy")


def normals(R: Array) -> Array:
    """(K, 3) unit normals of the plates in the camera frame, all pointing away from the camera."""
    n = R[:, :, 2]
    return n * np.where(n[:, 2:] < 0, -1.0, 1.0)


def diagnose(solution: Solution, names: tuple[str, ...]) -> None:
    """Refuse a solution whose focal lengths or centre the views do not determine.

    Args:
        solution: of Stage II.
        names: (P,) of the free parameters.

    Raises:
        DegenerateError: with the cause, and what to photograph instead.
    """
    lost = [u.name for u in undetermined(solution.normal, names) if u.name in _PINHOLE]
    if not lost:
        return
    n = normals(solution.state.R)
    tilt = np.arccos(np.clip(n[:, 2], -1, 1))
    mean = n.mean(axis=0) / np.linalg.norm(n.mean(axis=0))
    spread = np.arccos(np.clip(n @ mean, -1, 1))
    what = ", ".join(lost)
    if (tilt < _PARALLEL).all():
        raise DegenerateError(
            f"All views are parallel to the sensor, which leaves {what} undetermined.",
            "Tilt the board by 20 to 45 degrees, to the left, right, top and bottom.",
        )
    if (spread < _PARALLEL).all():
        raise DegenerateError(
            f"All views show the board in one orientation, which leaves {what} undetermined.",
            "Add views with the board tilted by 20 to 45 degrees in other directions.",
        )
    raise DegenerateError(
        f"These {len(n)} views leave {what} undetermined.",
        "Add views with the board tilted by 20 to 45 degrees in different directions, "
        "some of them near the image's corners.",
    )
