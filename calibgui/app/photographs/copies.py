"""Copies of photographs, which count once: two tell no more than one.

A copy that is not changed has exactly the same corners. One that is stored again, as JPEG beside
the PNG, has others, by what the compression does to them; so have two photographs from a tripod,
by their noise. What tells them apart is the name: of one photograph a program makes several files
that differ in the suffix alone, and those of a burst have numbers.

A copy that was drawn on and stored again under another name has the noise of its original. Corners
of two photographs from a tripod differ by sqrt(2) standard deviations in each coordinate, so that
the median length is 1.7; those of a copy differ by a small part of that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import PurePath

import numpy as np
import scipy

from calibgui.dataset import CornerSet, View
from calibgui.engine.arrays import IntArray
from calibgui.engine.calibration import Observation, find_copies
from calibgui.engine.images import FORMATS

_LOSSY = (".jpg", ".jpeg", ".webp")
"""Suffixes of files in which a photograph is stored less exactly than in others."""
_MAX_DISTANCE_PX = 0.1
"""Root mean square distance of the corners up to which files whose names differ in the suffix alone
show one photograph. Rendered boards stored as JPEG of quality 50 have 0.01 px."""
_MAX_SIGMAS_OF_EDITED = 0.5
"""Median distance of the corners, in their standard deviations, up to which files of any names show
one photograph: their errors then have more than 90 % of their squares in common. Of rendered boards
that were drawn on and stored as JPEG of quality 95 it was 0.08 to 0.8, below this in 31 of 36; of
two photographs from a tripod 0.65 to 2.4, least where one coarse JPEG compresses both alike."""
_MIN_COMMON_CORNERS = 8
"""Number of corners that two such files have in common."""
_MIN_SHARE_OF_NEAREST = 0.25
"""Share of a view's corners that are nearest to those of another one, from which they are compared:
of many photographs from a tripod any is."""
_GRID_STEP_PX = 1e7
"""Distance that parts corners of different places on the board, px, when neighbours are sought."""


def disable_copies(corner_set: CornerSet) -> CornerSet:
    """Return the set with copies of views disabled, unless all views are exact copies of one."""
    views = list(corner_set.views)
    usable = [k for k, view in enumerate(views) if view.usable]
    seen = [views[k].observation(corner_set.board) for k in usable]
    originals = find_copies(each[:2] for each in seen)
    if not originals.any():
        return corner_set
    for k, (copy, first) in enumerate(zip(usable, originals.tolist(), strict=True)):
        if first != k:
            name = _name_beside(views[usable[first]], views[copy])
            reason = f"A copy of {name}, which counts once."
            views[copy] = replace(views[copy], enabled=False, reason=reason)
    for copy, original in _find_resaved(views, usable, seen):
        # The original is not named in full, so that lists gather all views of one reason.
        suffix = PurePath(views[original].image).suffix
        reason = f"Looks like a copy of the {suffix} file of the same name, which counts once."
        views[copy] = replace(views[copy], enabled=False, reason=reason)
    for copy, original in _find_edited(views, usable, seen):
        reason = (
            f"Looks like a copy of {views[original].name}, drawn on or stored again: it has the "
            "same noise, and counts once."
        )
        views[copy] = replace(views[copy], enabled=False, reason=reason)
    return replace(corner_set, views=tuple(views))


def _name_beside(view: View, other: View) -> str:
    """Return a view's name, with its folder if that of another view is not the same."""
    is_beside = PurePath(view.image).parent == PurePath(other.image).parent
    return view.name if is_beside else view.image


def _find_resaved(
    views: Sequence[View], usable: Sequence[int], seen: Sequence[Observation]
) -> list[tuple[int, int]]:
    """Find the enabled views whose photograph another file holds, too.

    Args:
        views: all views.
        usable: indices of some of them.
        seen: what each of these shows.

    Returns:
        The index of each, and that of the one which is as exact or more so.
    """
    files: dict[str, list[tuple[int, Observation]]] = {}
    for k, observation in zip(usable, seen, strict=True):
        image, suffix = views[k].image, PurePath(views[k].image).suffix
        if views[k].enabled and suffix.lower() in FORMATS:
            files.setdefault(image.removesuffix(suffix), []).append((k, observation))
    found = []
    for alike in files.values():
        alike.sort(key=lambda one: _is_lossy(views[one[0]]))
        (original, best), *others = alike
        found += [(k, original) for k, other in others if _is_one_photograph(best, other)]
    return found


def _is_lossy(view: View) -> bool:
    """Return whether a view's file stores a photograph less exactly than others do."""
    return view.image.lower().endswith(_LOSSY)


def _find_edited(
    views: Sequence[View], usable: Sequence[int], seen: Sequence[Observation]
) -> list[tuple[int, int]]:
    """Find the enabled views that have the noise of another one. Takes and returns as
    `_find_resaved`; the original is the one with more corners, or the more exact."""
    known = [
        (k, one)
        for k, one in zip(usable, seen, strict=True)
        if views[k].enabled and one.cov is not None and np.isfinite(one.uv).all()
    ]
    known.sort(key=lambda one: (-len(one[1].uv), _is_lossy(views[one[0]])))
    observations = [one for _, one in known]
    found: dict[int, int] = {}
    for a, b in sorted(_find_nearest_views(observations)):
        if b not in found and _has_same_noise(observations[a], observations[b]):
            found[b] = found.get(a, a)
    return [(known[b][0], known[a][0]) for b, a in found.items()]


def _find_nearest_views(seen: Sequence[Observation]) -> set[tuple[int, int]]:
    """Return pairs (a, b), a < b, of views that are nearest to each other in many corners, those at
    the same place on the board being compared."""
    if not seen:
        return set()
    of_view = np.concatenate([np.full(len(one.uv), k) for k, one in enumerate(seen)])
    xy, uv = (np.concatenate([one[i] for one in seen]) for i in (1, 0))
    place = np.unique(xy, axis=0, return_inverse=True)[1].reshape(-1, 1)
    points = np.concatenate([uv, _GRID_STEP_PX * place], axis=1)
    distance, nearest = map(np.asarray, scipy.spatial.cKDTree(points).query(points, k=2))
    near = distance[:, 1] <= _MAX_DISTANCE_PX
    a, b = of_view[near], of_view[nearest[near]].T
    pairs = np.concatenate([np.column_stack([a, other]) for other in b])
    pairs = np.sort(pairs[pairs[:, 0] != pairs[:, 1]], axis=1)
    pairs, counts = np.unique(pairs, axis=0, return_counts=True)
    few = [_MIN_SHARE_OF_NEAREST * len(seen[j].uv) for j in pairs[:, 1].tolist()]
    return {(int(i), int(j)) for i, j in pairs[counts > few]}


def _has_same_noise(a: Observation, b: Observation) -> bool:
    """Return whether the corners that two views share are off alike, for more than chance."""
    i, k = _match_corners(a, b)
    if a.cov is None or b.cov is None or len(i) < max(_MIN_COMMON_CORNERS, len(b.uv) // 2):
        return False
    apart = a.uv[i] - b.uv[k]
    covariance = (a.cov[i] + b.cov[k]) / 2
    sigmas = np.sqrt(np.sum(apart * np.linalg.solve(covariance, apart[..., None])[..., 0], axis=1))
    return bool(np.median(sigmas) <= _MAX_SIGMAS_OF_EDITED)


def _match_corners(a: Observation, b: Observation) -> IntArray:
    """Return the indices (2, n) in both views of the corners that they share."""
    places = {tuple(xy): k for k, xy in enumerate(a.xy.tolist())}
    pairs = [(places[xy], k) for k, xy in enumerate(map(tuple, b.xy.tolist())) if xy in places]
    return np.array(pairs, dtype=np.int64).reshape(-1, 2).T


def _is_one_photograph(a: Observation, b: Observation) -> bool:
    """Return whether the corners that two views share lie at the same places in the image."""
    i, k = _match_corners(a, b)
    return bool(len(i)) and bool(
        np.sqrt(np.mean(np.sum((a.uv[i] - b.uv[k]) ** 2, axis=1))) <= _MAX_DISTANCE_PX
    )
