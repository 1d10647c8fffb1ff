"""Corners whose light is their own.

The light's gradients gm and ga pull at a corner, and are taken from the whole board, since one that
has them as unknowns is located 40 % worse (`board_priors`). Where the light falls through blinds,
flickers or ends at the edge of a shadow, no polynomial over the board follows it, and corners would
lie as much as 2 px aside, each as sure of its place as any other.

Such corners leave less unexplained with gradients of their own, by more than noise would:

    F = (RSS - RSS') / 4 / (RSS' / degrees of freedom)

of the four more unknowns is 1 on average for any other. What a camera does to all corners alike, as
one that sharpens to one side, gradients explain a little of, too, and those that have them would be
moved against the others. So a corner has its own only if it leaves more unexplained than most, or
if on most of a board of plain squares gradients explain much of it. Where something is printed in
the squares less of an edge is read, and it is enough that its F stands out from the board's.

Those corners are fitted with them, and once more to the nearer half of their edges. An edge of the
light may cross the farther one, and bend the edges as no gradient does: where the two places differ
by more than noise, the nearer one counts, with the square of the difference in its covariance. So
has all that is left unexplained by more than noise.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, compute_median
from calibgui.engine.detection.checkerboard.fit_thresholds import FIT_THRESHOLDS
from calibgui.engine.detection.checkerboard.x_corner_model import (
    BLUR,
    UNKNOWNS,
    A,
    C,
    XCornerModel,
    accumulate_normal_equations,
)
from calibgui.engine.detection.checkerboard.x_corner_step import take_lit_step

_THRESHOLDS = FIT_THRESHOLDS.light
_GRADIENTS = 4
"""Number of unknowns that gm and ga are."""
_STEPS = 3
"""Number of Gauss-Newton steps; a fourth moves no corner by a tenth of its standard deviation."""


def find_uneven_light(
    products: Array,
    square: Array,
    lit_square: Array,
    least_noise: float,
    is_plain: bool,
    is_bare: bool,
) -> BoolArray:
    """Find the corners (n,) that gradients of the light of their own describe clearly better.

    Args:
        products: (n, 14, 14) that the last step was taken from.
        square: (n,) mean square that it leaves unexplained.
        lit_square: (n,) what a step leaves that changes the gradients of every corner as well.
        least_noise: least square of the noise that is believed, grey levels^2.
        is_plain: whether nothing is printed in the squares: blurred, that looks like light at all
            corners.
        is_bare: whether that was taken out of the image: some corners are left more of it than
            others, and none stands out.
    """
    free = products[:, 6, 6] - UNKNOWNS
    gain = free * square - (free - _GRADIENTS) * lit_square
    is_clear = gain > _THRESHOLDS.min_gain * _GRADIENTS * np.maximum(lit_square, least_noise)
    # A model of as many unknowns as pixels describes anything.
    is_clear &= free - _GRADIENTS >= FIT_THRESHOLDS.noise.min_freedom
    if not is_clear.any():
        return np.asarray(is_clear)
    share = compute_median(gain / np.maximum(free * square, least_noise))
    if is_plain and share > _THRESHOLDS.min_median_share:
        return np.asarray(is_clear)
    F = gain / (_GRADIENTS * np.maximum(lit_square, least_noise))
    stands_out = F > _THRESHOLDS.min_gain * max(float(compute_median(F)), 1.0)
    usual = float(compute_median(np.sqrt(square)))
    is_poor = np.sqrt(square) > _THRESHOLDS.min_relative_residual * usual
    is_marked = not is_plain and not is_bare
    return np.asarray(is_clear & (is_poor | (stands_out & is_marked)))


def fit_local_light(
    image: GreyImage, model: XCornerModel, noise: float
) -> tuple[XCornerModel, Array, Array]:
    """Fit corners with gradients of the light of their own.

    Args:
        image: (h, w) grey levels.
        model: at n corners, near the solution.
        noise: square of what noise alone leaves unexplained, grey levels^2.

    Returns:
        The model, the covariance (n, 2, 2) px^2 of the corners, and the mean square (n,) of what is
        left unexplained.
    """
    whole, covariance, square = _fit_arms(image, model, model.arm)
    half = np.maximum(model.arm / 2, np.minimum(model.arm, _THRESHOLDS.min_arm))
    near, near_covariance, near_square = _fit_arms(image, model, half)
    apart = np.sum((near.unknowns[C] - whole.unknowns[C]) ** 2, axis=1)
    differ = apart > _THRESHOLDS.max_distance * np.trace(near_covariance, axis1=1, axis2=2)

    def choose(one: Array, other: Array) -> Array:
        return np.where(differ.reshape(-1, *[1] * (one.ndim - 1)), one, other)

    chosen = replace(
        whole,
        unknowns=choose(near.unknowns, whole.unknowns),
        level_gradient=choose(near.level_gradient, whole.level_gradient),
        contrast_gradient=choose(near.contrast_gradient, whole.contrast_gradient),
    )
    square = choose(near_square, square)
    added = choose(apart / 2, np.zeros_like(apart)) + _estimate_pull(chosen, square - noise)
    covariance = choose(near_covariance, covariance) + added[:, None, None] * np.eye(2)
    return chosen, covariance, square


def _estimate_pull(model: XCornerModel, square: Array) -> Array:
    """Estimate the variance (n,) px^2 of corners near which the light leaves the mean `square` (n,)
    unexplained.

    Noise pulls at the pixels of an edge one by one, light at all of an arm: an error e of the grey
    level moves it by e over the slope, sqrt(2 pi) s e / 2 a, and the two arms of an edge halve the
    variance.
    """
    share = np.maximum(square, 0.0) / (2 * model.unknowns[A]) ** 2
    return np.asarray(np.pi * share * np.mean(model.unknowns[BLUR] ** 2, axis=1))


def _fit_arms(
    image: GreyImage, model: XCornerModel, arm: Array
) -> tuple[XCornerModel, Array, Array]:
    """Fit corners, as `fit_local_light`, to arms `arm` (n, 2) px of their edges.

    What is left unexplained is that before the last step: a fit that did not settle is not sure.
    """
    model = replace(model, arm=arm)
    for _ in range(_STEPS):
        products, _ = accumulate_normal_equations(image, model, odd=True)
        model, inverse, _ = take_lit_step(model, products)
    free = np.maximum(products[:, 6, 6] - UNKNOWNS - _GRADIENTS, 1)
    square = products[:, UNKNOWNS, UNKNOWNS] / free
    return model, square[:, None, None] * inverse, square
