"""Light that strays from bright parts of the image, at corners of printed squares.

A lens scatters a part of the light over tens of pixels, more of it where the image is overexposed.
Around corners of plain squares that is even under point reflection, and moves none. Tags, markers
and dots in the squares are not: every corner beside them has a gradient of light of its own, which
no polynomial over the board follows (`board_priors`) and which is hard to tell at a single one.

All corners together do tell. With its own gradients a corner lies aside, by v, of where those of
the board have it. If these are right the covariance of v is D, what more unknowns cost (Hausman
1978), and

    h = v^T D^-1 v / 2

is distributed exponentially with mean 1. Where its median over the board is H times as large, the
board's gradients err and draw corners aside with the covariance (H - 1) D. The best place is then
the share 1 - 1 / H of v away from the board's, with a covariance that is so much of D larger. What
neighbouring pixels have in common makes v larger, too: D grows by it.

Of paper that is clipped the stray light is not seen, but it moves the place along an edge where the
level leaves the clipped one. So a part of (H - 1) D is added there. D itself is too large there:
edges bend so abruptly that opposite pixels differ by more than their noise (`corner_noise`).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_median, invert_2x2
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS
from calibgui.engine.detection.checkerboard.x_corner_model import LIGHT, XCornerModel

_THRESHOLDS = FIT_THRESHOLDS.stray_light


def find_clipped_corners(image: GreyImage, model: XCornerModel) -> BoolArray:
    """Find the corners (n,) whose bright squares have the greatest level of the image (h, w)."""
    bright = model.unknowns[LIGHT].sum(axis=1)
    return np.asarray(bright >= (1 - _THRESHOLDS.max_below_clipping) * float(image.max()))


def estimate_stray_light(
    shift: Array, lost: Array, usable: BoolArray, clipped: BoolArray
) -> tuple[float, Array]:
    """Estimate how far corners go towards their places with gradients of their own.

    Args:
        shift: (n, 2) v, px.
        lost: (n, 2, 2) D, px^2.
        usable: (n,) the corners that are looked at.
        clipped: (n,) those of `find_clipped_corners`.

    Returns:
        The share of v, 0 where it is not clear, and (n,) how often D is to be added to the
        covariances.
    """
    number = int(np.count_nonzero(usable))
    if number < _THRESHOLDS.min_corners:
        return 0.0, np.zeros(len(shift))
    of_noise = np.where(clipped, _THRESHOLDS.clipped_share, 1.0)
    v, D = shift[usable], of_noise[usable, None, None] * lost[usable]
    least = _THRESHOLDS.least_loss * np.einsum("nii->n", D) + np.finfo(np.float64).tiny
    told = invert_2x2(D + least[:, None, None] * np.eye(2))
    h = np.einsum("ni,nij,nj->n", v, told, v) / 2
    H = float(compute_median(h)) / np.log(2)
    # The median of n such numbers deviates from log 2 by n^-1/2.
    is_clear = H >= 1 + _THRESHOLDS.min_sigmas / (np.log(2) * np.sqrt(number))
    if not is_clear or compute_median(np.hypot(*v.T)) > _THRESHOLDS.max_shift:
        return 0.0, np.zeros(len(shift))
    share = 1 - 1 / H
    unseen = np.where(clipped, _THRESHOLDS.unseen_share * (H - 1), 0.0)
    return share, share + of_noise * unseen


def go_to_own_light(
    model: XCornerModel, boards: XCornerModel, own: XCornerModel, share: float
) -> XCornerModel:
    """Move a model towards the light of its own corners.

    Args:
        model: at n corners, with the board's light.
        boards: the same before its edges were bent.
        own: as a step with the light's gradients among the unknowns left it.
        share: of the way from the board's light to their own.
    """
    level, contrast = (
        at_board + share * (at_own - at_board)
        for at_board, at_own in (
            (model.level_gradient, own.level_gradient),
            (model.contrast_gradient, own.contrast_gradient),
        )
    )
    unknowns = model.unknowns + share * (own.unknowns - boards.unknowns)
    return replace(model, unknowns=unknowns, level_gradient=level, contrast_gradient=contrast)
