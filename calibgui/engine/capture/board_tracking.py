"""Tracking: the corners of a board followed from one frame of a live image to the next.

The finder is exact, but takes tens of milliseconds. From frame to frame a board moves by little, so
its corners are followed by optical flow in a pyramid of images (Lucas and Kanade 1981; Bouguet
2000). A corner counts if the flow leads it back to where it came from (forward-backward error,
Kalal, Mikolajczyk and Matas 2010), and if it lies where the others say: two frames of one flat
board are related by a homography, but for what the lens bends otherwise in the next frame. The
followed corners serve guidance and stillness; what a camera is calibrated from is always found by
the finder.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import GreyImage
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.homography import apply_homography, fit_homography
from calibgui.engine.uncertainty.next_view import measure_spacing

_MAX_RETURN_PX = 0.5
"""Distance from where it came to which the flow must lead a corner back, px: a plausibility
limit."""
MAX_OFF_PX = 2.0
"""Distance from where the homography of all corners puts it at which a corner was lost, px: lenses
bend boards by less between two frames."""
_MIN_SHARE = 0.7
"""Share of the corners that must be followed: with fewer the board counts as lost."""


def track_corners(before: GreyImage, after: GreyImage, corners: Corners) -> Corners | None:
    """Follow the corners of a board to the next frame.

    Args:
        before, after: the frames, of one size, grey (h, w) or RGB (h, w, 3).
        corners: the corners in the frame before.

    Returns:
        Those that could be followed, without covariances; None if the board was lost.
    """
    uv, back = opencv.follow_points(before, after, corners.uv, measure_spacing(corners.uv))
    h, w = after.shape[:2]
    good = np.linalg.norm(back - corners.uv, axis=1) <= _MAX_RETURN_PX
    good &= ((uv >= 0) & (uv <= [w - 1, h - 1])).all(axis=1)
    least = max(4, round(_MIN_SHARE * len(uv)))
    if good.sum() < least:
        return None
    H = fit_homography(corners.uv[good], uv[good], np.ones(int(good.sum())))
    good &= np.linalg.norm(apply_homography(H, corners.uv) - uv, axis=1) <= MAX_OFF_PX
    if good.sum() < least:
        return None
    return replace(
        corners,
        grid=corners.grid[good],
        uv=uv[good],
        estimate=uv[good],
        cov=None,
        blur=None,
        contrast=None,
        residual=None,
        rejected=(),
        others=(),
        remark="",
    )


def measure_motion(before: Corners, after: Corners) -> float:
    """Measure the rms distance, px, between the corners that both have; NaN if there are none."""
    places = {tuple(cell): uv for cell, uv in zip(before.grid.tolist(), before.uv, strict=True)}
    moved = [
        uv - places[tuple(cell)]
        for cell, uv in zip(after.grid.tolist(), after.uv, strict=True)
        if tuple(cell) in places
    ]
    return float(np.sqrt(np.mean(np.sum(np.array(moved) ** 2, axis=1)))) if moved else np.nan
