"""The corners that were found in many images, in one file, and what moved from one to another.

A ledger holds rows and columns, places and covariances of every corner of every image, and a digest
of the image. Two ledgers of the same images tell what a change of the code has moved.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners

Array = NDArray[np.float64]
_SAME_CORNER = 3.0
"""Greatest distance of corners that are the same one, moved, px."""
_MOVED, _MOVED_SIGMAS = 0.01, 0.1
"""Least distance by which a corner counts as moved: px, and its standard deviations."""
_WIDENED = 1.1
"""Least factor of a standard deviation that counts as another."""


@dataclass(frozen=True, eq=False)
class Entry:
    """What was found in an image."""

    grid: NDArray[np.int64]
    """(n, 2) rows and columns; n is 0 where no board was found."""
    uv: Array
    """(n, 2) px."""
    cov: Array
    """(n, 2, 2) px^2, NaN where there is none."""
    digest: int
    """Of the image."""
    seconds: float
    """Time of the processor."""
    error: str = ""
    """What was raised that is no `NoBoardError`."""


class Change(NamedTuple):
    """What differs between two entries of an image."""

    appeared: int = 0
    vanished: int = 0
    moved: int = 0
    """Corners that are elsewhere by more than 0.01 px or 0.1 of their standard deviation."""
    widened: int = 0
    """Corners whose standard deviation differs by more than a tenth."""
    renumbered: int = 0
    farthest: float = 0.0
    """The longest way of a corner, px."""

    def __bool__(self) -> bool:
        return any(self[:5])


def digest_image(image: NDArray[Any]) -> int:
    """Compute a digest of an image."""
    return zlib.crc32(np.ascontiguousarray(image).tobytes())


def make_entry(found: Corners | Exception, digest: int, seconds: float) -> Entry:
    """Make the entry of what a search returned or raised."""
    if isinstance(found, Corners):
        cov = np.full((len(found), 2, 2), np.nan) if found.cov is None else found.cov
        return Entry(found.grid, found.uv, cov, digest, seconds)
    error = "" if isinstance(found, NoBoardError) else f"{type(found).__name__}: {found}"
    nothing = np.empty((0, 2))
    return Entry(nothing.astype(np.int64), nothing, np.empty((0, 2, 2)), digest, seconds, error)


def write_ledger(file: Path, entries: Mapping[str, Entry]) -> None:
    """Write a ledger."""
    values = list(entries.values())
    empty = make_entry(NoBoardError("", ""), 0, 0.0)
    np.savez_compressed(
        file,
        names=np.array(list(entries)),
        counts=np.array([len(each.uv) for each in values], np.int64),
        **{
            name: np.concatenate([getattr(each, name) for each in [*values, empty]])
            for name in ("grid", "uv", "cov")
        },
        **{
            field.name: np.array([getattr(each, field.name) for each in values])
            for field in fields(Entry)[3:]
        },
    )


def read_ledger(file: Path) -> dict[str, Entry]:
    """Read a ledger."""
    with np.load(file) as kept:
        ends = np.cumsum(kept["counts"])[:-1]
        parts = [np.split(kept[name], ends) for name in ("grid", "uv", "cov")]
        rest = [kept[field.name].tolist() for field in fields(Entry)[3:]]
        names = kept["names"].tolist()
        return {name: Entry(*values) for name, *values in zip(names, *parts, *rest, strict=True)}


def compare(before: Entry, after: Entry) -> Change:
    """Compare what was found in an image before and after a change."""
    if not len(before.uv) or not len(after.uv):
        return Change(len(after.uv), len(before.uv))
    distance, place = scipy.spatial.cKDTree(before.uv).query(after.uv)
    own = np.flatnonzero(distance < _SAME_CORNER)
    # Of two corners that are nearest to the same one only one can be it.
    _, once = np.unique(place[own[np.argsort(distance[own])]], return_index=True)
    own = own[np.argsort(distance[own])][once]
    old, way = place[own], distance[own]
    sigma, sigma_before = (
        np.sqrt(np.trace(cov, axis1=1, axis2=2) / 2) for cov in (after.cov[own], before.cov[old])
    )
    is_moved = (way > _MOVED) | (way > _MOVED_SIGMAS * sigma_before)
    ratio = np.maximum(sigma / sigma_before, sigma_before / sigma)
    return Change(
        appeared=len(after.uv) - len(own),
        vanished=len(before.uv) - len(own),
        moved=int(np.count_nonzero(is_moved)),
        widened=int(np.count_nonzero(ratio > _WIDENED)),
        renumbered=int(np.count_nonzero((after.grid[own] != before.grid[old]).any(axis=1))),
        farthest=float(way.max(initial=0.0)),
    )


def describe_changes(before: Mapping[str, Entry], after: Mapping[str, Entry]) -> str:
    """Describe in lines what differs between two ledgers, image by image, and in all."""
    lines, total = [], Change()
    common = [name for name in after if name in before]
    others = [name for name in common if before[name].digest != after[name].digest]
    for name in common:
        change = compare(before[name], after[name])
        if change and name not in others:
            lines.append(f"{name:44} {_describe(change)}")
            total = Change(*map(sum, zip(total[:5], change[:5], strict=True)))._replace(
                farthest=max(total.farthest, change.farthest)
            )
    corners = sum(len(after[name].uv) for name in common)
    lines.append(
        f"{len(lines)} of {len(common)} images differ; of {corners} corners {_describe(total)}"
    )
    lines += [f"{name}: the image itself is another, and was left out" for name in others]
    if missing := set(before) ^ set(after):
        lines.append(f"{len(missing)} images are in one ledger only")
    return "\n".join(lines)


def _describe(change: Change) -> str:
    """Describe a change in a line."""
    names = ("appeared", "vanished", "moved", "have another sigma", "are numbered otherwise")
    told = [f"{count} {name}" for count, name in zip(change[:5], names, strict=True) if count]
    way = f"up to {change.farthest:.3f} px" if change.moved else ""
    return ", ".join([*told, *filter(None, [way])]) or "none changed"
