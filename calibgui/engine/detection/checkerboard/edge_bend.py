"""The bend of edges over what was read of them, by which corners are moved aside.

An edge is read over an arm to both sides of its corner, but no farther than the image: at its
border one side is short. With the middle m and the half length h of what was read, from the corner
along the edge, an edge of curvature kappa passes the corner and is yet met there by the straight
line that lies nearest to what was read,

    kappa / 2 (h^2 / 3 - m^2),        that is kappa L^2 / 6 for both arms of length L,

off, on the side to which it bends: a fit that takes the edge for straight moves the corner so far.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, Size


class ReadEdges(NamedTuple):
    """The edges at n corners as they were fitted, given how their curvatures run."""

    uv: Array
    """(n, 2) the corners, px."""
    normals: Array
    """(n, 2, 2) unit normals of the row's edge towards the next row, and of the column's edge
    towards the next column."""
    curvature: Array
    """(n, 2) that they were taken to have at the corner, 1/px ..."""
    curvature_change: Array
    """(n, 2) ... and by how much it was taken to change along them, 1/px^2."""
    middle: Array
    """(n, 2) m, px."""
    half: Array
    """(n, 2) h, px."""

    def measure_bend(self, curvature: Array) -> Array:
        """Measure how far edges of `curvature` (n, 2) 1/px would be bent aside, (n, 2) px."""
        return curvature / 2 * (self.half**2 / 3 - self.middle**2)

    def compute_tangents(self) -> Array:
        """Compute the unit tangents (n, 2, 2), towards the next column and the next row."""
        n = self.normals
        return np.stack([n[..., 1], -n[..., 0]], axis=-1) * np.array([[1.0], [-1.0]])


def clip_arms(uv: Array, tangents: Array, arm: Array, size: Size) -> tuple[Array, Array]:
    """Clip arms to the image, whose outermost line of pixels is not read.

    Args:
        uv: (n, 2) the corners, px.
        tangents: (n, 2, 2) unit tangents of their edges.
        arm: (n, 2) how far the edges are read to both sides, px.
        size: width and height of the image, px.

    Returns:
        (n, 2) middles and (n, 2) half lengths, px, of what is left.
    """
    last = np.array(size) - 2.0
    to_border = np.minimum(uv - 1.0, last - uv)
    if (abs(tangents) * arm[..., None] <= to_border[:, None]).all():
        return np.zeros_like(arm), arm  # most boards lie in the image with all of their squares
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.stack([(1.0 - uv)[:, None] / tangents, (last - uv)[:, None] / tangents])
    ends = np.where(np.isfinite(ends), ends, np.array([-np.inf, np.inf]).reshape(2, 1, 1, 1))
    begin = np.maximum(np.minimum(ends.min(axis=0).max(axis=2), 0.0), -arm)
    end = np.minimum(np.maximum(ends.max(axis=0).min(axis=2), 0.0), arm)
    return (begin + end) / 2, (end - begin) / 2
