"""The pinhole camera: a lens without distortion.

A measured point is the ideal point itself, d = n = (X/Z, Y/Z), and the derivative is I. Images that
were undistorted or rendered have such a camera, and long focal lengths nearly do.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.plane import PlaneLens, PlanePoints


class Pinhole(PlaneLens):
    """The model without coefficients."""

    title = "Pinhole (no distortion)"
    names = ()
    powers = ()
    closed_form_factor = 0.0

    def correct(self, d: Array, k: Array) -> PlanePoints:  # noqa: ARG002 - there are no coefficients
        """Map measured to ideal points."""
        return _map_to_itself(d)

    def distort(self, n: Array, k: Array) -> PlanePoints:  # noqa: ARG002 - there are no coefficients
        """Map ideal to measured points."""
        return _map_to_itself(n)


def _map_to_itself(points: Array) -> PlanePoints:
    by_point = np.broadcast_to(np.eye(2), (*points.shape, 2))
    return PlanePoints(points.copy(), by_point.copy(), np.empty((*points.shape, 0)))
