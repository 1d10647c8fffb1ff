"""Faults of the corners: numbered wrongly, misplaced, blurred, or in another frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calibgui.engine.arrays import BoolArray, Size
from calibgui.engine.calibration.observations import Observation
from tests.faults.sets import FaultySet, Rng, draw_set, photograph, state_fault


def shift_row(rng: Rng) -> FaultySet:
    """Number one row of one view from its second corner on."""
    return _shift_line(rng, axis=0, name="row")


def shift_column(rng: Rng) -> FaultySet:
    """Number one column of one view from its second corner on."""
    return _shift_line(rng, axis=1, name="column")


def _shift_line(rng: Rng, axis: int, name: str) -> FaultySet:
    """Give the corners of a line (a row lies along x, axis 0) the numbers of their neighbours."""
    photographed = draw_set(rng)
    views = photograph(photographed)
    k = int(rng.integers(len(views)))
    uv, xy, _ = views[k]
    line = np.round(xy[:, 1 - axis], 6)
    values, counts = np.unique(line, return_counts=True)
    chosen = np.flatnonzero(line == rng.choice(values[counts >= 3]))
    order = chosen[np.argsort(xy[chosen, axis])]
    keep = np.ones(len(uv), bool)
    keep[order[-1]] = False
    moved = uv.copy()
    moved[order[:-1]] = uv[order[1:]]
    views[k] = Observation(moved[keep], xy[keep])
    return state_fault(photographed, views, f"{name} of {len(order)} in view {k}")


def misnumber_view(rng: Rng) -> FaultySet:
    """List the corners of one view column by column instead of row by row."""
    photographed = draw_set(rng)
    views = photograph(photographed)
    k = int(rng.integers(len(views)))
    uv, xy, _ = views[k]
    order = np.lexsort((xy[:, 1], xy[:, 0]))
    uv = uv[np.lexsort((xy[:, 0], xy[:, 1]))]
    views[k] = Observation(uv, xy[order])
    return state_fault(photographed, views, f"rows read as columns in view {k}")


def turn_view(rng: Rng) -> FaultySet:
    """Number the corners of one view from the other end, which a true flat board does not show."""
    photographed = draw_set(rng)
    views = photograph(photographed)
    k = int(rng.integers(len(views)))
    uv, xy, _ = views[k]
    views[k] = Observation(uv, xy.min(axis=0) + xy.max(axis=0) - xy)
    return state_fault(photographed, views, f"view {k} turned by 180 degrees")


def exchange_views(rng: Rng) -> FaultySet:
    """Exchange the corners of two views, in part: all of them would exchange the poses only."""
    photographed = draw_set(rng)
    views = photograph(photographed)
    a, b = sorted(rng.choice(len(views), 2, replace=False).tolist())
    share = rng.uniform(0.05, 0.5)
    common = [
        (i, int(j[0]))
        for i, p in enumerate(views[a].xy)
        if len(j := np.flatnonzero((views[b].xy == p).all(axis=1)))
    ]
    some = common[: max(2, int(share * len(common)))]
    first, second = (list(side) for side in zip(*some, strict=True))
    uv_a, uv_b = views[a].uv.copy(), views[b].uv.copy()
    uv_a[first], uv_b[second] = views[b].uv[second], views[a].uv[first]
    views[a], views[b] = Observation(uv_a, views[a].xy), Observation(uv_b, views[b].xy)
    return state_fault(photographed, views, f"{len(some)} corners of views {a} and {b} exchanged")


def misplace_few(rng: Rng) -> FaultySet:
    """Misplace 5 % of the corners of a view by 50 px."""
    return _misplace_in_view(rng, 0.05)


def misplace_many(rng: Rng) -> FaultySet:
    """Misplace 20 % of the corners of a view by 50 px."""
    return _misplace_in_view(rng, 0.2)


def _misplace_in_view(rng: Rng, share: float) -> FaultySet:
    photographed = draw_set(rng)
    views = photograph(photographed)
    k = int(rng.integers(len(views)))
    n = len(views[k].uv)
    chosen = np.isin(np.arange(n), rng.choice(n, max(1, round(share * n)), replace=False))
    views[k] = _misplace(views[k], chosen, 50.0, photographed.camera.size, rng)
    story = f"{int(chosen.sum())} corners of view {k} off by 50 px"
    return state_fault(photographed, views, story)


def misplace_everywhere(rng: Rng) -> FaultySet:
    """Misplace 1 % of all corners by 5 px."""
    photographed = draw_set(rng)
    views = [
        _misplace(view, rng.random(len(view.uv)) < 0.01, 5.0, photographed.camera.size, rng)
        for view in photograph(photographed)
    ]
    return state_fault(photographed, views, "1 % of the corners off by 5 px")


def _misplace(
    view: Observation, chosen: BoolArray, distance: float, size: Size, rng: Rng
) -> Observation:
    """Misplace the chosen corners (n,) in any direction that stays in the image."""
    uv = view.uv.copy()
    for i in np.flatnonzero(chosen).tolist():
        angles = rng.uniform(0, 2 * np.pi, 100)
        places = uv[i] + distance * np.column_stack([np.cos(angles), np.sin(angles)])
        uv[i] = places[int(np.argmax(((places >= 0) & (places <= np.array(size) - 1)).all(axis=1)))]
    return Observation(uv, view.xy)


def blur_views(rng: Rng) -> FaultySet:
    """Triple the noise of some views."""
    photographed = draw_set(rng)
    views = photograph(photographed)
    count = int(rng.integers(1, max(2, len(views) // 3) + 1))
    level = photographed.level * np.sqrt(8.0)
    for k in rng.choice(len(views), count, replace=False).tolist():
        uv, xy, _ = views[k]
        views[k] = Observation(uv + rng.normal(0, level, uv.shape), xy)
    return state_fault(photographed, views, f"noise tripled in {count} views")


def move_frame(rng: Rng) -> FaultySet:
    """Count pixels from the middle of the image, in half of the draws with y up."""
    photographed = draw_set(rng)
    size = photographed.camera.size
    up = -1.0 if rng.random() < 0.5 else 1.0
    middle, sign = (np.array(size) - 1) / 2, np.array([1.0, up])
    views = [Observation((uv - middle) * sign, xy) for uv, xy, _ in photograph(photographed)]
    return state_fault(photographed, views, f"origin in the middle, y {'down' if up > 0 else 'up'}")


def misstate_size(rng: Rng) -> FaultySet:
    """State another image size: half or twice as large, or width for height."""
    photographed = draw_set(rng)
    w, h = photographed.camera.size
    sizes = [(w // 2, h // 2), (2 * w, 2 * h), (h, w)]
    size = sizes[int(rng.integers(len(sizes)))]
    views = photograph(photographed)
    made = state_fault(photographed, views, f"stated size {size} for {(w, h)}")
    return replace(made, size=size)
