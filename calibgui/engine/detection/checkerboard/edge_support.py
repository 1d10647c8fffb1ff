"""The pixels near two crossing edges, each read once.

An edge that runs more along u than v crosses each pixel column once: the pixels of its band are,
column by column, those around the row where it passes. (Else with u and v exchanged.) This gives
rectangular arrays, the same for all corners, of little more than the band itself; what lies
outside the band or the image, or in the band of the other edge before, is masked. So is the
outermost line of pixels on each side of the image, which cameras and programs that resample
often leave dark or half filled.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.arrays import FloatImage as Array32


@dataclass(frozen=True, eq=False, slots=True)
class Bands:
    """Where to read around n corners."""

    uv: Array
    """(n, 2) the corners, px."""
    tangent: Array
    """(n, 2, 2) unit tangents of edges 1 and 2."""
    normal: Array
    """(n, 2, 2) their unit normals."""
    curvature: Array
    """(n, 2) 1/px."""
    arm: Array
    """(n, 2) reach along the edges to both sides, px."""
    width: Array
    """(n, 2) reach across the edges to both sides, px."""

    def pixels(self, edge: int) -> int:
        """Pixels read per corner along an edge, masked ones included."""
        length, breadth = self._extent(edge)
        return length * breadth

    def read(self, image: GreyImage) -> tuple[IntArray, Array32, Array32]:
        """Pixels (n, P, 2) as (u, v), their grey levels (n, P), and 1 for those that count (n, P),
        0 for the others."""
        uv = np.concatenate([self._along(0), self._along(1)], axis=1)
        q = (uv - self.uv[:, None]).astype(np.float32)
        first = self.pixels(0)
        counts = self._holds(0, q)
        counts[:, first:] = ~counts[:, first:] & self._holds(1, q[:, first:])
        last = np.array(image.shape[::-1]) - 1
        inside = np.clip(uv, 1, last - 1)
        counts &= (inside == uv).all(axis=2)
        grey = image[inside[..., 1], inside[..., 0]].astype(np.float32)
        return uv, grey, counts.astype(np.float32)

    def _holds(self, edge: int, q: Array32) -> BoolArray:
        """Which offsets `q` (n, k, 2) from the corner lie in the band of an edge."""
        frame = np.stack([self.tangent[:, edge], self.normal[:, edge]], axis=2)
        along = q @ frame.astype(np.float32)
        s, d = along[..., 0], along[..., 1]
        half = (self.curvature[:, edge, None] / 2).astype(np.float32)
        near = abs(d - half * s * s) <= self.width[:, edge, None].astype(np.float32)
        return np.asarray(near & (abs(s) <= self.arm[:, edge, None].astype(np.float32)))

    def _along(self, edge: int) -> IntArray:
        """(n, k, 2) pixels in and around the band of an edge, line by line across it."""
        length, breadth = self._extent(edge)
        tangent = self.tangent[:, edge]
        flat = abs(tangent[:, 0]) >= abs(tangent[:, 1])
        main = np.where(flat, 0, 1)
        row = np.arange(len(main))
        start = np.rint(self.uv[row, main])
        x = start[:, None] + np.arange(length) - length // 2
        dx = x - self.uv[row, main][:, None]
        slope = tangent[row, 1 - main] / tangent[row, main]
        bend = (
            self.curvature[:, edge] * self.normal[:, edge][row, 1 - main] / tangent[row, main] ** 2
        )
        y = self.uv[row, 1 - main][:, None] + slope[:, None] * dx + bend[:, None] / 2 * dx * dx
        lines = np.rint(y)[:, :, None] + np.arange(breadth) - breadth // 2
        columns = np.broadcast_to(x[:, :, None], lines.shape)
        turned = flat[:, None, None]
        uv = np.stack([np.where(turned, columns, lines), np.where(turned, lines, columns)], axis=-1)
        return uv.reshape(len(main), -1, 2).astype(np.int64)

    def _extent(self, edge: int) -> tuple[int, int]:
        """Number of lines along, and of pixels across, an edge's band of the greediest corner."""
        slant = np.max(abs(self.tangent[:, edge]), axis=1)
        along = np.max(self.arm[:, edge] * slant + self.width[:, edge])
        across = np.max(self.width[:, edge] / slant)
        return 2 * int(np.ceil(along)) + 1, 2 * int(np.ceil(across + 0.5)) + 1
