"""Points in an image are matched with the circles of a listed layout.

A circle and those around it are nearly an affine image of the layout there. From a point in the
middle every pair of its neighbours is tried for the first two neighbours of every kind of circle,
kinds being circles whose neighbours lie alike: in rows by turns there are few, in a layout that is
strewn as many as circles. Where the other neighbours hold points, too, the match grows: a
homography with a radial lens is fitted to what is matched, and circles next to it are looked for
where that predicts them, until there are no more.

A regular layout looks the same from circle to circle, and only its border tells them apart. So the
layout is then shifted by every way from one circle to another, under the map that was found: where
most circles meet points, the match grows anew. Of all matches the one with most circles counts. If
there is another with as many, which is no turn of the layout, the picture does not tell which.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, IntArray, Size
from calibgui.engine.boards.listed_circles import ListedCircles
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.features.lattice import MIN_CORNERS
from calibgui.engine.lattices.grid_map import RadialHomography, fit_radial_homography


class LayoutMatch(NamedTuple):
    """Points that are circles of a layout."""

    points: IntArray
    """(n,) index of each circle's point, -1 where none is seen."""
    in_view: int
    """Number of the circles that the image shows, or would if nothing covered them."""
    is_certain: bool
    """False if the points may as well be other circles."""


class _Seed(NamedTuple):
    """A circle, with those around it, taken for a point."""

    circle: int
    point: int
    A: Array
    """(2, 2) from pitches to px."""


def match_layout(points: Array, pattern: ListedCircles, size: Size) -> LayoutMatch | None:
    """Match points to the circles of a layout.

    Args:
        points: (m, 2) px, some of them images of circles' centres.
        pattern: the layout.
        size: width and height of the image, px.

    Returns:
        The best match, None if too few of the circles in view are matched.
    """
    places = np.array(pattern.places)
    fewest = CIRCLE_THRESHOLDS.min_grid_circles
    if min(len(points), len(places)) < max(fewest, MIN_CORNERS):
        return None
    tree = scipy.spatial.cKDTree(points)
    middle = np.linalg.norm(points - np.median(points, axis=0), axis=1)
    matches: list[LayoutMatch] = []
    for point in np.argsort(middle)[:fewest].tolist():
        tried: list[Array] = []
        for seed in _list_seeds(point, points, tree, places):
            if any(_are_alike_maps(seed.A, A) for A in tried):
                continue  # the layout is shifted to every circle
            tried.append(seed.A)
            matches += _grow_shifted(seed, points, tree, places, size)
            if any((each.points >= 0).all() for each in matches):
                break
        if matches:
            break
    if not matches:
        return None
    counts = [int(np.count_nonzero(each.points >= 0)) for each in matches]
    best = matches[int(np.argmax(counts))]
    turned = [best.points[order] for _, order in pattern.list_turns()]
    rivals = [each.points for each, n in zip(matches, counts, strict=True) if n == max(counts)]
    is_certain = all(any(_are_alike(each, other) for other in turned) for each in rivals)
    return best._replace(is_certain=is_certain)


def _is_enough(found: IntArray, in_view: IntArray) -> BoolArray:
    """Return whether numbers of circles found are a layout's, of those in view."""
    share = 1 - CIRCLE_THRESHOLDS.max_rejected_share
    return np.asarray(found >= np.maximum(CIRCLE_THRESHOLDS.min_grid_circles, share * in_view))


def _are_alike_maps(A: Array, B: Array) -> bool:
    """Return whether two maps (2, 2) take a step to nearly the same place."""
    least = np.linalg.svd(B, compute_uv=False)[-1]
    return bool(np.linalg.norm(A - B, 2) < CIRCLE_THRESHOLDS.max_prediction_error * least)


def _are_alike(a: IntArray, b: IntArray) -> bool:
    """Return whether two matches (n,) take most points for the same circles."""
    return bool(2 * np.count_nonzero((a == b) & (a >= 0)) > np.count_nonzero(a >= 0))


def _list_seeds(
    point: int, points: Array, tree: scipy.spatial.cKDTree, places: Array
) -> Iterator[_Seed]:
    """List the ways in which a point and those around it look like a circle and those around it,
    the most compact first, as the nearest points are a circle's neighbours unless it is tilted."""
    count = MIN_CORNERS  # with itself: as many as make the smallest lattice
    around = np.asarray(scipy.spatial.cKDTree(places).query(places, k=count)[1])[:, 1:]
    offsets = places[around] - places[:, None]
    _, kinds = np.unique(_sort_rows(np.round(offsets, 1)), axis=0, return_index=True)
    ways = points[np.asarray(tree.query(points[point], k=count)[1])[1:]] - points[point]
    least = CIRCLE_THRESHOLDS.min_seed_sine
    first, second = (each.ravel() for each in np.indices((len(ways), len(ways))))
    sines = _cross(ways[first], ways[second]) / _norms(ways[first]) / _norms(ways[second])
    own = offsets[kinds]
    turns = _cross(own[:, :1], own) / _norms(own[:, :1]) / _norms(own)
    others = np.argmax(abs(turns) > least, axis=1)
    turn = turns[np.arange(len(own)), others][:, None]
    kind, pair = np.nonzero((abs(turn) > least) & (sines * np.sign(turn) > least))
    sides = np.stack([own[kind, 0], own[kind, others[kind]]], axis=2)
    A = np.stack([ways[first[pair]], ways[second[pair]]], axis=2) @ np.linalg.inv(sides)
    expected = points[point] + own[kind] @ A.transpose(0, 2, 1)
    limit = CIRCLE_THRESHOLDS.max_prediction_error * np.linalg.svd(A, compute_uv=False)[:, -1:]
    reach = float(limit.max(initial=0.0))
    off = np.asarray(tree.query(expected, distance_upper_bound=reach)[0])
    are_met = np.flatnonzero((off < limit).all(axis=1))
    order = np.argsort(np.linalg.norm(A[are_met], axis=(1, 2)), kind="stable")
    for k in are_met[order].tolist():
        yield _Seed(int(kinds[kind[k]]), point, A[k])


def _grow_shifted(
    seed: _Seed, points: Array, tree: scipy.spatial.cKDTree, places: Array, size: Size
) -> list[LayoutMatch]:
    """Grow a match from a seed, and again from the circles that its point may as well be: those of
    the matches that hold most circles, if these are enough."""
    grown = _grow(seed, points, tree, places)
    if grown is None:
        return []
    grid_map, middle = grown[0], places[seed.circle]
    shifted = places[None] - places[:, None] + middle
    at = _locate_in_image(grid_map, shifted.reshape(-1, 2), size).reshape(shifted.shape)
    is_in_view = np.isfinite(at[..., 0])
    off = np.full(is_in_view.shape, np.inf)
    off[is_in_view] = tree.query(at[is_in_view])[0]
    A = grid_map.differentiate(middle[None])[0][0].T
    limit = CIRCLE_THRESHOLDS.max_prediction_error * np.linalg.svd(A, compute_uv=False)[-1]
    hits = np.asarray(np.count_nonzero(off < limit, axis=1))
    is_best = _is_enough(hits, np.asarray(is_in_view.sum(axis=1))) & (hits == hits.max())
    matches = []
    for circle in np.flatnonzero(is_best).tolist():
        again = _grow(_Seed(circle, seed.point, A), points, tree, places)
        if again is not None:
            expected = _locate_in_image(again[0], places, size)
            in_view = np.isfinite(expected[:, 0]).sum()
            if _is_enough((again[1] >= 0).sum(), in_view):
                matches.append(LayoutMatch(again[1], int(in_view), is_certain=True))
    return matches


def _locate_in_image(grid_map: RadialHomography, xy: Array, size: Size) -> Array:
    """Compute positions (n, 2) px of places (n, 2), NaN where the image does not show them."""
    at = grid_map.locate(xy)
    is_inside = np.asarray(((at >= 0) & (at <= np.array(size) - 1)).all(axis=1))
    return np.where(is_inside[:, None], at, np.nan)


def _grow(
    seed: _Seed, points: Array, tree: scipy.spatial.cKDTree, places: Array
) -> tuple[RadialHomography, IntArray] | None:
    """Grow a match from a seed: the map, and the point of each circle (n,), -1 where there is none;
    None if too few hang together for a map."""
    beside = scipy.spatial.cKDTree(places)
    near = np.asarray(beside.query(places[seed.circle], k=MIN_CORNERS)[1])
    at = points[seed.point] + (places - places[seed.circle]) @ seed.A.T
    J = np.broadcast_to(seed.A, (len(places), 2, 2))
    found = _take_nearest(near, at, J, tree)
    grid_map: RadialHomography | None = None
    while True:
        known = np.flatnonzero(found >= 0)
        if 2 * len(known) < MIN_CORNERS:
            return None
        grid_map = fit_radial_homography(places[known], points[found[known]])
        at = grid_map.locate(places)
        J = grid_map.differentiate(places)[0].transpose(0, 2, 1)
        reach = np.asarray(beside.query(places, k=MIN_CORNERS)[1])
        tried = np.unique(reach[known])
        tried = tried[np.isfinite(at[tried]).all(axis=1) & np.isfinite(J[tried]).all(axis=(1, 2))]
        before, found = found, _take_nearest(tried, at, J, tree)
        if np.count_nonzero(found >= 0) <= len(known):
            return grid_map, before


def _take_nearest(tried: IntArray, at: Array, J: Array, tree: scipy.spatial.cKDTree) -> IntArray:
    """Take the point nearest to where each of the circles `tried` is predicted, `at` (n, 2) px, if
    it is near enough in steps of `J` (n, 2, 2) and no other circle is nearer: (n,), -1 for none."""
    found = np.full(len(at), -1)
    off, index = (np.asarray(each) for each in tree.query(at[tried]))
    step = np.linalg.svd(J[tried], compute_uv=False)[:, -1]
    order = np.argsort(off)
    order = order[(off < CIRCLE_THRESHOLDS.max_prediction_error * step)[order]]
    _, nearest = np.unique(index[order], return_index=True)
    chosen = order[nearest]
    found[tried[chosen]] = index[chosen]
    return found


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _norms(a: Array) -> Array:
    return np.asarray(np.linalg.norm(a, axis=-1))


def _sort_rows(offsets: Array) -> Array:
    """Return displacements (n, k, 2) as rows (n, 2 k), each in an order of its own that does not
    depend on which of equal distances came first."""
    order = np.lexsort((offsets[..., 1], offsets[..., 0]), axis=1)
    return np.take_along_axis(offsets, order[..., None], axis=1).reshape(len(offsets), -1)
