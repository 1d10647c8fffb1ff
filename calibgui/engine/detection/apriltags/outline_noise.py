"""Growth of the covariances of tags by errors that neighbouring pixels share along outlines.

JPEG, enlarging and denoising make one pixel's error its neighbours', and greater at edges than
beside them: the outlines are then worse known than pixels by themselves say. As at corners of
checkerboards (``corner_noise``) that shows in the scores along edges. Lines of pixels across an
edge, 1 px apart, differ from their mean by r_k, and tell that the edge lies aside by

    F_k = sum of r_k g',

g' being the edge's gradient less what levels of paper and ink explain of it, which are unknown.
"""

from __future__ import annotations

import numpy as np
import scipy

from calibgui.engine.arrays import Array, GreyImage, compute_median
from calibgui.engine.corner_fit.corner_noise import (
    CORRELATION_REACH,
    MIN_CORRELATION_REACH,
    compute_growth,
)
from calibgui.engine.detection.apriltags.outline_model import OutlineModel
from calibgui.engine.images.sampling import sample_image

_MARGIN = 0.15
"""Part of an edge at both ends that is left out, lengths: its corners are blurred."""
_SAMPLES = 9
"""Number of samples across an edge."""
_REACH_BLURS, _MIN_REACH_BLURS = 2.5, 1.5
"""Reach of these to either side, blurs, and the least with which a tag is looked at: nearer to its
edge hardly anything tells the edge's place from the levels of paper and ink."""
_MIN_BLUR = 0.75
"""Least blur of tags that are looked at, px: where edges are sharper what is interpolated between
pixels is wrong in step with them. Without JPEG a growth of 1.7 showed with a blur of 0.6 px, up to
58 with none but the pixel's."""
MAX_TAGS = 8
"""Number of tags that are looked at, spread over the board."""


def estimate_outline_growth(image: GreyImage, model: OutlineModel, noise: Array) -> float:
    """Estimate the growth of the covariances of a board's corners by what neighbouring pixels have
    in common.

    Args:
        image: (h, w) grey levels.
        model: at the n tags of a board.
        noise: (n,) square of the noise pixel by pixel, grey levels^2.

    Returns:
        The growth; 1 where it is not clearly more.
    """
    blur = model.blurs.mean(axis=1)
    reach = np.minimum(_REACH_BLURS * blur, np.minimum(model.inwards, model.outwards))
    at = np.flatnonzero((reach >= _MIN_REACH_BLURS * blur) & (blur > _MIN_BLUR))
    if not len(at):
        return 1.0
    at = at[np.unique(np.linspace(0, len(at) - 1, MAX_TAGS).astype(np.int64))]
    model, reach, noise = model.select(at), reach[at], noise[at]
    length = model.measure_edges()[0]
    usual = float(compute_median(length.ravel()))
    lines = max(round((1 - 2 * _MARGIN) * usual), 3)
    shares = np.linspace(_MARGIN, 1 - _MARGIN, lines)
    seen = sample_image(image, model.locate_profiles(reach, shares, _SAMPLES))
    witness = _weigh_samples(model, reach)
    scores = (seen @ witness[..., None])[..., 0]
    scores -= scores.mean(axis=2, keepdims=True)
    known = np.sum(witness**2, axis=2)[..., None]
    both = np.stack([scores, np.broadcast_to(known, scores.shape)], axis=2)
    area = (1 - 2 * _MARGIN) * length / (lines - 1) * (2 * reach / (_SAMPLES - 1))[:, None]
    both *= area[..., None, None]
    farthest = max(MIN_CORRELATION_REACH, CORRELATION_REACH * usual / 2)
    # The fit leaves nothing of what all lines of an edge have in common.
    farthest = min(farthest, lines / 3)
    return compute_growth(both.reshape(-1, 2, 2, lines), np.repeat(noise, 2), farthest)


def _weigh_samples(model: OutlineModel, reach: Array) -> Array:
    """Weigh samples across edges, (n, 4, samples), by what each says of where they lie."""
    blur = model.blurs[:, [0, 1, 0, 1], None]
    at = reach[:, None, None] * np.linspace(-1, 1, _SAMPLES) / blur
    ink = scipy.special.ndtr(at)
    contrast = (model.levels[:, 0, 0] - model.levels[:, 1, 0])[:, None, None]
    gradient = contrast * np.exp(-(at**2) / 2) / (np.sqrt(2 * np.pi) * blur)
    levels = np.stack([1 - ink, ink], axis=-1)
    products = levels.swapaxes(2, 3) @ levels
    share = np.linalg.solve(products, levels.swapaxes(2, 3) @ gradient[..., None])
    return np.asarray(gradient - (levels @ share)[..., 0])
