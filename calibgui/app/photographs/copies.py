"""Copies of photographs, which count once: two tell no more than one.

A copy that is not changed has exactly the same corners. One that is stored again, as JPEG beside
the PNG, has others, by what the compression does to them; so have two photographs from a tripod,
by their noise. What tells them apart is the name: of one photograph a program makes several files
that differ in the suffix alone, and those of a burst have numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import PurePath

import numpy as np

from calibgui.dataset import CornerSet, View
from calibgui.engine.calibration import Observation, find_copies
from calibgui.engine.images import FORMATS

_LOSSY = (".jpg", ".jpeg", ".webp")
"""Suffixes of files in which a photograph is stored less exactly than in others."""
_MAX_DISTANCE_PX = 0.1
"""Root mean square distance of the corners up to which files whose names differ in the suffix alone
show one photograph. Rendered boards stored as JPEG of quality 50 have 0.01 px."""


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
            reason = f"A copy of {views[usable[first]].image}, which counts once."
            views[copy] = replace(views[copy], enabled=False, reason=reason)
    for copy, original in _find_resaved(views, usable, seen):
        # The original is not named in full, so that lists gather all views of one reason.
        suffix = PurePath(views[original].image).suffix
        reason = f"Looks like a copy of the {suffix} file of the same name, which counts once."
        views[copy] = replace(views[copy], enabled=False, reason=reason)
    return replace(corner_set, views=tuple(views))


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
        alike.sort(key=lambda one: views[one[0]].image.lower().endswith(_LOSSY))
        (original, best), *others = alike
        found += [(k, original) for k, other in others if _is_one_photograph(best, other)]
    return found


def _is_one_photograph(a: Observation, b: Observation) -> bool:
    """Return whether the corners that two views share lie at the same places in the image."""
    places = {tuple(xy): k for k, xy in enumerate(a.xy.tolist())}
    pairs = [(places[xy], k) for k, xy in enumerate(map(tuple, b.xy.tolist())) if xy in places]
    if not pairs:
        return False
    i, k = np.array(pairs).T
    return bool(np.sqrt(np.mean(np.sum((a.uv[i] - b.uv[k]) ** 2, axis=1))) <= _MAX_DISTANCE_PX)
