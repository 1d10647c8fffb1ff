"""The record of the corners of a board with markers or tags."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit
from calibgui.engine.features import harris
from calibgui.engine.features.corners import Corners, RejectedCorner
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices import region_of_interest as region


class FittedCorners(NamedTuple):
    """The places of n corners, with their covariances and what a fit says of the image there."""

    uv: Array
    """(n, 2) px."""
    covariance: Array
    """(n, 2, 2) px^2."""
    blur: Array
    """(n,) px."""
    contrast: Array
    """(n,) bright minus dark, grey levels."""
    residual: Array
    """(n,) standard deviation of what the fit leaves unexplained, grey levels."""

    def select(self, index: BoolArray | IntArray) -> FittedCorners:
        """Select corners by a mask (n,) or by their indices (m,)."""
        return FittedCorners(*(values[index] for values in self))

    def join(self, other: FittedCorners) -> FittedCorners:
        """Return these corners and then the others."""
        return FittedCorners(*map(np.concatenate, zip(self, other, strict=True)))

    def widen(self, displacement: Array) -> FittedCorners:
        """Return the fit with the covariances of corners that are drawn aside, by `displacement`
        (n,) px, so much larger that they expect it: its square, shared by both axes."""
        added = displacement[:, None, None] ** 2 / 2 * np.eye(2)
        return self._replace(covariance=self.covariance + added)


def assemble_corners(
    image: GreyImage,
    lattice: Lattice,
    fit: XCornerFit | FittedCorners | None,
    outline: Array | None,
    rejected: list[RejectedCorner],
    pattern: Pattern,
) -> Corners:
    """Assemble a detector's result: saddle points, or the fitted model where there is one."""
    found = lattice.found
    uv = lattice.uv[found]
    corners = Corners(
        shape=lattice.shape,
        grid=np.argwhere(found),
        uv=uv,
        estimate=harris.estimate_corners(image, uv, lattice.spacing()[found]),
        roi=region.find_outline(lattice) if outline is None else outline,
        method="saddle",
        rejected=tuple(rejected),
        pattern=pattern,
    )
    if fit is None:
        return corners
    return replace(
        corners,
        method="edges",
        uv=fit.uv,
        cov=fit.covariance,
        blur=fit.blur,
        contrast=fit.contrast,
        residual=fit.residual,
    )
