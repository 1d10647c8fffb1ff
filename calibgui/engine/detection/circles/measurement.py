"""The circles of a grid measured, once it is known where they are and which is which.

An ellipse is fitted to the pixels of every circle's edge (`ellipse_fit`), and the image of the
circle's centre follows from the ellipse's (`circle_map`), for the diameter that the ellipses show.
Circles that the edge of a shadow, a glare or a scratch crosses follow from the rest of their edge
(`arc_fit`). What is no circle of the board's, or not where the others predict it, is left out, and
with many such the whole grid.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage, IntArray, compute_median
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.listed_circles import ListedCircles
from calibgui.engine.detection.circles import ellipse_fit
from calibgui.engine.detection.circles.arc_fit import fit_arcs
from calibgui.engine.detection.circles.circle_map import fit_circle_map
from calibgui.engine.detection.circles.defocus import find_apart, is_size_told
from calibgui.engine.detection.circles.ellipse_fit import EllipseFit
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import find_usable_covariances

CirclePattern = Circles | ListedCircles
_SAMPLE = 40
"""Number of circles, spread over the grid, that are fitted before all of a grid of more than twice
as many."""
_MAX_SAMPLE_EXCESS = 2.0
"""Greatest misfit of these, over that of all that is allowed, at which the rest is fitted. Bricks
have 3.5 to 4, drawn circles less than 1."""
_MAX_SCATTER_SIGMAS = 3.0
"""Greatest excess of the variance about the map over the stated one that counts as chance, standard
deviations of the former."""
_SIGMA_OF_MEDIAN = 1.2
"""Standard deviation of a variance from the median of squares of distances, over that from their
mean."""
_MAX_SCATTER = 4.5
"""Distance of a centre from the map of the others, standard deviations along one axis, up to which
it counts as usual: of 20 000 circles one lies farther by chance."""
_SCATTER_ROUNDS = 4
"""Number of times that the map and those near it are told from each other."""
_MAX_DISAGREEMENT = 6.0
"""Greatest distance of a centre from where the others predict it, standard deviations ..."""
_MIN_DISAGREEMENT = 0.02
"""... or pitches, whichever is more."""
_MIN_FREEDOM = 6.0
"""Number of circles beyond those that the map takes from which on such centres are told."""
_MIN_LEFT = 0.05
"""Least part of its own deviation that the map is taken to leave a circle."""
_NO_ELLIPSES = "ellipses do not describe the edges of its circles"
_TOO_MANY_FAIL = "too many of its circles fail or are covered"
_CENTRE_ITERATIONS = 3
"""Number of times that the map and the centres are computed from each other."""


def measure_circles(
    grey: GreyImage,
    estimate: Array,
    xy: Array,
    pattern: CirclePattern,
    count: int,
    *,
    is_part: bool,
) -> tuple[EllipseFit, VerifiedCircles]:
    """Measure the circles that are seen of a grid.

    Args:
        grey: (h, w) grey levels.
        estimate: (n, 2) px, where they are about.
        xy: (n, 2) pitches, where they are on the board.
        pattern: what they are circles of.
        count: number of the pattern's circles that the image shows.
        is_part: whether it shows a part of the grid only.

    Raises:
        NoBoardError: if too many are not such circles, or they are of another size than stated.
    """
    fit = _fit_circles(grey, estimate, xy, pattern)
    verified = _verify_circles(fit, xy, grey, count)
    verified = _add_arcs(verified, fit, xy, grey, pattern)
    if fit.is_out_of_focus:
        verified = _check_defocus(verified, fit, xy, count, pattern)
    if is_part and np.count_nonzero(verified.good) < CIRCLE_THRESHOLDS.min_grid_circles:
        raise distrust(_TOO_MANY_FAIL)
    _check_diameter(pattern, 2 * verified.radius)
    return fit, verified


def _fit_circles(grey: GreyImage, centres: Array, xy: Array, pattern: CirclePattern) -> EllipseFit:
    """Fit ellipses at the `centres` (n, 2) px of circles at `xy` (n, 2) pitches.

    Raises:
        NoBoardError: if ellipses do not describe some of many, and none need be fitted to the rest.
    """
    steps = fit_circle_map(xy, centres).differentiate(xy)

    def fit(chosen: IntArray) -> EllipseFit:
        return ellipse_fit.fit_ellipses(
            grey,
            centres[chosen],
            steps[chosen],
            pattern.half_distance,
            pattern.list_paper(),
            pattern.list_neighbours(),
        )

    if len(centres) > 2 * _SAMPLE:
        tried = fit(np.linspace(0, len(centres) - 1, _SAMPLE).astype(np.int64))
        if np.median(tried.misfit) > _MAX_SAMPLE_EXCESS * CIRCLE_THRESHOLDS.max_misfit:
            raise distrust(_NO_ELLIPSES)
    return fit(np.arange(len(centres)))


def _check_diameter(pattern: CirclePattern, diameter: float) -> None:
    """Raise NoBoardError if the circles measure another `diameter`, pitches, than is stated."""
    stated = pattern.diameter
    if stated is None or abs(diameter - stated) <= CIRCLE_THRESHOLDS.max_diameter_difference:
        return
    raise NoBoardError(
        f"The circles measure {diameter:.2f} of their distance, not {stated:.2f}.",
        "State diameter and distance as measured, or leave the diameter out.",
    )


@dataclass(frozen=True, eq=False, slots=True)
class VerifiedCircles:
    """The circles that are seen of a grid, n of its places."""

    good: BoolArray
    """(n,) True for those that pass."""
    uv: Array
    """(n, 2) px, the images of their centres."""
    radius: float
    """Radius of all but the marks, pitches."""
    are_marks: BoolArray
    """(n,) True for those that pass and are of another size."""
    covariance: Array
    """(n, 2, 2) px^2, of `uv`."""


def _verify_circles(fit: EllipseFit, xy: Array, image: GreyImage, count: int) -> VerifiedCircles:
    """Verify the circles that are seen of a grid of which the image shows `count`, and compute
    their centres' images.

    Those that its border cuts are left out. Every ellipse must lie inside the image, be larger than
    its blur, be what a circle of the common radius or a mark looks like there, where the others
    predict it, with a contrast like theirs, or like theirs over the light, and no more unexplained.

    Raises:
        NoBoardError: if too many fail or are not seen.
    """
    limits = CIRCLE_THRESHOLDS
    if not (np.isfinite(fit.unknowns).all() and find_usable_covariances(fit.covariance).all()):
        raise distrust(_NO_ELLIPSES)
    good = _find_inside(fit.uv, fit.spread, fit.blur, image)
    fewest = (1 - limits.max_rejected_share) * (count - np.count_nonzero(~good))
    shorter = np.sqrt(np.maximum(np.linalg.eigvalsh(fit.spread)[:, 0], 0.0))
    is_sharp = fit.blur < limits.max_blur_over_axis * shorter
    if np.count_nonzero(~is_sharp) > limits.max_rejected_share * len(good):
        raise distrust("its circles are too small for how blurred they are")
    good &= is_sharp
    contrast, misfit = fit.contrast, fit.misfit
    good &= (fit.unknowns[:, 7] > 0) == fit.are_bright
    by_light = contrast / np.maximum(fit.light, 1.0)
    relative = np.maximum(contrast / np.median(contrast), by_light / np.median(by_light))
    good &= relative > limits.min_relative_contrast
    good &= misfit < max(limits.max_misfit_over_median * np.median(misfit), limits.max_misfit)
    uv, are_marks = fit.uv, np.zeros_like(good)
    variance = np.einsum("nii->n", fit.covariance) / 2
    for _ in range(_CENTRE_ITERATIONS):
        # A circle that fails must not bend the map for the others.
        if np.count_nonzero(good) < fewest:
            raise distrust(_TOO_MANY_FAIL)
        circle_map = fit_circle_map(xy[good], uv[good], are_exact=True)
        J = circle_map.differentiate(xy)
        spread = np.linalg.solve(J, np.linalg.solve(J, fit.spread).transpose(0, 2, 1))
        own_radii = np.sqrt(np.sqrt(np.maximum(np.linalg.det(spread), 0.0)))
        radius = float(np.median(own_radii[good]))
        are_marks = abs(own_radii / radius - 1) > limits.min_mark_radius_difference
        radii = np.where(are_marks, own_radii, radius)
        uv = fit.uv - circle_map.compute_centre_bias(xy, radii)
        off = np.linalg.solve(J, (uv - circle_map.locate(xy))[..., None])[..., 0]
        shape = np.abs(spread / radii[:, None, None] ** 2 - np.eye(2)).max(axis=(1, 2))
        good = good & (np.linalg.norm(off, axis=1) < limits.max_misplacement)
        good = good & (shape < limits.max_shape_difference)
        good[good] = _find_agreeing(xy[good], uv[good], variance[good])
    if np.count_nonzero(good) < fewest:
        raise distrust(_TOO_MANY_FAIL)
    if np.median(misfit) > limits.max_misfit:
        raise distrust(_NO_ELLIPSES)
    if np.count_nonzero(are_marks & good) > limits.max_marked_share * len(good):
        raise distrust("too many of its circles are of another size")
    covariance = fit.covariance.copy()
    covariance[good] = _widen_covariances(xy[good], uv[good], covariance[good])
    return VerifiedCircles(good, uv, radius, are_marks & good, covariance)


def _add_arcs(
    circles: VerifiedCircles, fit: EllipseFit, xy: Array, image: GreyImage, pattern: CirclePattern
) -> VerifiedCircles:
    """Add the circles of which only parts of the edge are seen undisturbed, where the others
    predict them."""
    good = circles.good
    if good.all():
        return circles
    circle_map = fit_circle_map(xy[good], circles.uv[good], are_exact=True)
    J = circle_map.differentiate(xy)
    spread = circles.radius**2 * J @ J.transpose(0, 2, 1)
    bias = circle_map.compute_centre_bias(xy, np.full(len(xy), circles.radius))
    expected = circle_map.locate(xy) + bias
    blur = float(np.median(fit.blur[good]))
    tried = np.flatnonzero(~good & _find_inside(expected, spread, blur, image))
    shortest = np.sqrt(np.linalg.eigvalsh(spread[tried])[:, 0])
    gap = 2 * (pattern.half_distance / circles.radius - 1) * shortest
    arcs = fit_arcs(image, expected[tried], spread[tried], gap, blur, are_bright=fit.are_bright)
    aside = arcs.uv - expected[tried]
    off = np.linalg.norm(np.linalg.solve(J[tried], aside[..., None])[..., 0], axis=1)
    is_added = arcs.is_told & (off < _MIN_DISAGREEMENT)
    added = tried[is_added]
    uv, covariance, good = circles.uv.copy(), circles.covariance.copy(), good.copy()
    uv[added], good[added] = (arcs.uv - bias[tried])[is_added], True
    # What is left of a disturbance draws many ways alike, as the distance from the map tells.
    widened = np.sum(aside**2, axis=1)[:, None, None] / 2 * np.eye(2) + arcs.covariance
    covariance[added] = widened[is_added]
    return replace(circles, good=good, uv=uv, covariance=covariance)


def _check_defocus(
    circles: VerifiedCircles, fit: EllipseFit, xy: Array, count: int, pattern: CirclePattern
) -> VerifiedCircles:
    """Leave out circles whose light flows into that of others, of a grid much out of focus of which
    the image shows `count`.

    Raises:
        NoBoardError: if too many do, or the circles' size is not told.
    """
    good = circles.good & find_apart(fit.blur, fit.spread, circles.radius, pattern.half_distance)
    if np.count_nonzero(good) < (1 - CIRCLE_THRESHOLDS.max_rejected_share) * count:
        raise distrust("it is so much out of focus that its circles flow into one another")
    circle_map = fit_circle_map(xy[good], circles.uv[good], are_exact=True)
    if not is_size_told(fit.spread[good], circle_map.differentiate(xy[good])):
        raise distrust("it is so much out of focus that the size of its circles is not told")
    return replace(circles, good=good)


def _find_inside(uv: Array, spread: Array, blur: Array | float, image: GreyImage) -> BoolArray:
    """Find the ellipses (n,) True, `uv` (n, 2) px and their spread (n, 2, 2) px^2, that the image
    shows whole with their `blur`, (n,) or one for all, px."""
    half = np.sqrt(np.einsum("nii->ni", spread)) + np.reshape(blur, (-1, 1))
    return np.asarray(((uv > half) & (uv + half < np.array(image.shape[::-1]) - 1)).all(axis=1))


def _find_agreeing(xy: Array, uv: Array, variance: Array) -> BoolArray:
    """Find the centres that lie where the others predict them, about as closely as these do: (n,)
    True.

    What covers a circle, as a dot of paint, may have an edge as good as the circle's and lie beside
    it. Shadows' edges draw circles aside by less, all along a line: these stay, for they tell how
    far centres scatter. A centre's deviation from the map of all is less than that from the others'
    by 1 - h, h its leverage, and has a variance less by as much. The usual variance is that whose
    median is seen, as no outlier makes it larger.

    Args:
        xy: (n, 2) the circles' centres, pitches.
        uv: (n, 2) their images, px.
        variance: (n,) stated, along u and v, px^2.
    """
    agreeing = np.ones(len(xy), dtype=bool)
    while np.count_nonzero(agreeing) > _MIN_FREEDOM:
        circle_map = fit_circle_map(xy[agreeing], uv[agreeing], are_exact=True)
        freedom = 1 - circle_map.compute_leverages(xy[agreeing])
        if freedom.sum() < _MIN_FREEDOM:
            return agreeing
        freedom = np.maximum(freedom, _MIN_LEFT)
        off = np.sum((uv[agreeing] - circle_map.locate(xy[agreeing])) ** 2, axis=1) / freedom
        usual = np.median(off) / (2 * np.log(2))
        pitch2 = abs(np.linalg.det(circle_map.differentiate(xy[agreeing])))
        most = _MAX_DISAGREEMENT**2 * np.maximum(usual, variance[agreeing])
        excess = off / np.maximum(most, _MIN_DISAGREEMENT**2 * pitch2)
        worst = np.argmax(excess)
        if excess[worst] < 1:
            return agreeing
        agreeing[np.flatnonzero(agreeing)[worst]] = False
    return agreeing


def _widen_covariances(xy: Array, uv: Array, covariance: Array) -> Array:
    """Return covariances (n, 2, 2) px^2 that say how far centres scatter about the smooth map.

    The covariances of the ellipses take what these leave unexplained for noise of single pixels.
    Beats of a screen's pixels with the camera's, shadows and stains draw whole edges aside, by
    several times as much. What is usual of that, if it is more than noise would, holds for all
    circles; those that lie farther from where the others predict them have the distance besides.

    Args:
        xy: (n, 2) the circles' centres, pitches.
        uv: (n, 2) their images, px.
        covariance: (n, 2, 2) px^2, of the ellipses.
    """
    stated = np.einsum("nii->n", covariance) / 2
    scatter, aside2 = 0.0, np.zeros(len(xy))
    is_near = np.ones(len(xy), dtype=np.bool_)
    for _ in range(_SCATTER_ROUNDS):
        circle_map = fit_circle_map(xy[is_near], uv[is_near], are_exact=True)
        own_freedom = np.ones(len(xy))
        own_freedom[is_near] = 1 - circle_map.compute_leverages(xy[is_near])
        freedom = 2 * own_freedom[is_near].sum()
        if freedom < _MIN_FREEDOM:
            break
        own_freedom = np.maximum(own_freedom, _MIN_LEFT)
        off2 = np.sum((uv - circle_map.locate(xy)) ** 2, axis=1) / own_freedom
        usual = compute_median(off2[is_near] / stated[is_near]) / (2 * np.log(2))
        most = 1 + _MAX_SCATTER_SIGMAS * _SIGMA_OF_MEDIAN * np.sqrt(2 / freedom)
        scatter = float((usual - 1) * np.mean(stated[is_near])) if usual > most else 0.0
        was_near, is_near = is_near, off2 < _MAX_SCATTER**2 * (stated + scatter)
        aside2 = np.where(is_near, 0.0, off2 / own_freedom)
        if (is_near == was_near).all():
            break
    return covariance + (scatter + aside2 / 2)[:, None, None] * np.eye(2)


def distrust(reason: str) -> NoBoardError:
    """Return the error for a grid that fails a test, `reason` being the end of a sentence."""
    return NoBoardError(
        f"What looks like a grid of circles is not trusted: {reason}.",
        "Take the picture again, sharp and evenly lit, or leave it out.",
    )
