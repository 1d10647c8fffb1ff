"""The record of the corners of a board with markers or tags."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.detection import region_of_interest as region
from calibgui.engine.detection.checkerboard import harris
from calibgui.engine.detection.checkerboard.x_corner_fit import XCornerFit
from calibgui.engine.detection.corners import Corners, RejectedCorner
from calibgui.engine.detection.lattice import Lattice


def assemble_corners(
    image: GreyImage,
    lattice: Lattice,
    fit: XCornerFit | None,
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
