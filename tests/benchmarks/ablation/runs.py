"""Searching pictures with rules switched off, and what that says of each rule.

A switch is asked only of the pictures in which it matters (`Watch`): in all others the product
would do the same. So a rule that changes nothing costs nothing to ask.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features.corners import Corners
from tests.benchmarks import boards
from tests.benchmarks.ablation.ledger import Entry, digest_image, make_entry
from tests.benchmarks.ablation.patching import Switch, Watch, switched_off
from tests.benchmarks.ablation.sets import REAL, WITHOUT, Picture
from tests.benchmarks.board_readers import Read
from tests.scenes.photograph import Photograph
from tests.scenes.tally import judge

Array = NDArray[np.float64]
Entries = dict[str, Entry]
_MAX_SECONDS = 120
"""Time of the processor after which a search ends: without a rule it may never do."""
_SAME_CORNER = 3.0
"""Distance from a true corner up to which what was found is that one, px."""
_MIN_VIEWS = 4
"""Number of photographs of a real set from which on its camera is calibrated."""
_FIRST, _HARMED_SHARE = 40, 0.1
"""Number of pictures that a switch is asked of first, and the share of these that it harms from
which on it is asked of no more."""
_LESS_EXACT, _MIN_ERROR = 1.5, 0.01
"""Factor of a picture's error that counts, and the least difference, px."""
_LENSES = ("brown-conrady", "kannala-brandt")
"""The lens models of which the better one is taken for a real set."""


@dataclass(frozen=True)
class Score:
    """What was found in a picture, beside its truth."""

    whole: int = 0
    lost: int = 0
    wrong: int = 0
    false: int = 0
    """1 if a board was found and none of it is there."""
    error: float = np.nan
    """Root mean square error per axis, px."""
    ratio: float = np.nan
    """The same over the bound's."""
    chi2: float = np.nan
    """Mean square error in units of the covariances, per axis."""

    def is_more_exact(self, other: Score) -> bool:
        """Return whether the error is clearly less than that of another score."""
        return bool(
            other.error > _LESS_EXACT * self.error and other.error > self.error + _MIN_ERROR
        )

    def is_better(self, other: Score) -> bool:
        """Return whether anything else is worse in another score."""
        counts = (other.lost > self.lost, other.wrong > self.wrong, other.false > self.false)
        return any(counts) or self.is_more_exact(other)


def search(picture: Picture) -> Entry:
    """Search a picture for its board."""
    digest = digest_image(picture.image)
    found: Corners | Exception
    before = signal.signal(signal.SIGPROF, _raise_timeout)
    signal.setitimer(signal.ITIMER_PROF, _MAX_SECONDS)
    start = time.process_time()
    try:
        found = find_corners(picture.image, picture.grid_size, pattern=picture.pattern)
    except Exception as error:  # a switch may break what it switches off
        found = error
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
    return make_entry(found, digest, time.process_time() - start)


def _raise_timeout(*_: object) -> None:
    raise TimeoutError(f"more than {_MAX_SECONDS} s")


def search_all(pictures: Iterable[Picture]) -> Entries:
    """Search pictures."""
    return {picture.name: search(picture) for picture in pictures}


def find_where_switches_matter(
    pictures: Sequence[Picture], switches: Iterable[Switch]
) -> dict[str, set[str]]:
    """Find the names of the pictures in which each switch matters, by the names of the switches;
    of a switch whose functions are never called there is nothing."""
    watch = Watch(switches)
    matters: dict[str, set[str]] = {}
    with watch.watching():
        for picture in pictures:
            watch.start()
            search(picture)
            for name in watch.mattering:
                matters.setdefault(name, set()).add(picture.name)
    return {name: matters.get(name, set()) for name in watch.called}


def search_without(
    switch: Switch,
    pictures: Sequence[Picture],
    where: set[str],
    baseline: Mapping[str, Entry],
    *,
    is_thorough: bool = False,
) -> Entries:
    """Search pictures with a rule switched off, where it matters.

    Forty of them are searched first, evenly spread; if a tenth of these suffer, that is enough,
    unless all are asked for. None is searched after one that takes too long.

    Returns:
        What was found in the pictures that were searched.
    """
    asked = [picture for picture in pictures if picture.name in where]
    order = dict.fromkeys(i * len(asked) // _FIRST for i in range(_FIRST))
    first = [asked[k] for k in order] if asked else []
    with switched_off(switch):
        entries: Entries = {}
        for picture in first:
            entries[picture.name] = search(picture)
            if entries[picture.name].error.startswith(TimeoutError.__name__):
                return entries  # others would take as long
        harmed = sum(
            score(each, baseline[each.name]).is_better(score(each, entries[each.name]))
            or bool(entries[each.name].error)
            for each in first
        )
        if is_thorough or harmed < _HARMED_SHARE * _FIRST:
            entries |= search_all(each for each in asked if each.name not in entries)
    return entries


def score(picture: Picture, entry: Entry) -> Score:
    """Compare what was found in a picture with its truth."""
    found = len(entry.uv)
    if picture.group == WITHOUT or not picture.boards:
        return Score(wrong=found, false=int(found > 0)) if picture.group == WITHOUT else Score()
    truth = picture.boards[0]
    seen = np.ones(truth.shape[:2], np.bool_) if picture.seen is None else picture.seen
    if not found:
        return Score(lost=int(np.count_nonzero(seen)))
    if picture.pattern.kind == "checkerboard":
        shot = Photograph(picture.image, picture.boards, ~seen)
        tally = judge(shot, (entry.grid, entry.uv))
        counts = Score(tally.whole, tally.lost, tally.wrong, tally.false)
    else:
        bound = np.full((*seen.shape, 2, 2), np.nan)
        known = boards.Photograph(picture.image, truth, seen, bound)
        read = Read(entry.grid, entry.uv)
        board = Board(*seen.shape, 1.0, picture.pattern)
        told = boards.score(lambda *_: read, board, [known])
        lost = round((1 - told.found) * np.count_nonzero(seen))
        counts = Score(int(lost == told.wrong == 0), lost, told.wrong, int(told.wrong == found))
    return _measure_errors(picture, entry, counts)


def _measure_errors(picture: Picture, entry: Entry, counts: Score) -> Score:
    """Measure how far the corners are from the nearest true ones of the board that they are of."""
    best = np.zeros(len(entry.uv), np.bool_), entry.uv, entry.uv[:, 0].astype(np.int64)
    which = 0
    for k, board in enumerate(picture.boards):
        flat = board.reshape(-1, 2)
        distance = np.linalg.norm(entry.uv[:, None] - flat, axis=2)
        nearest = np.argmin(distance, axis=1)
        own = distance.min(axis=1) < _SAME_CORNER
        if own.sum() > best[0].sum():
            best, which = (own, entry.uv - flat[nearest], nearest), k
    own, off, nearest = best
    if not own.any():
        return counts
    e, cov = off[own], entry.cov[own]
    chi2 = np.nan
    if np.isfinite(cov).all() and (np.linalg.det(cov) > 0).all():
        chi2 = float(np.mean(np.einsum("ni,nij,nj->n", e, np.linalg.inv(cov), e)) / 2)
    error = float(np.sqrt(np.mean(e**2)))
    ratio = np.nan
    if picture.bound is not None and not which:
        bound = picture.bound.reshape(-1, 2, 2)[nearest[own]]
        ratio = error / float(np.sqrt(np.mean(np.trace(bound, axis1=1, axis2=2)) / 2))
    return replace(counts, error=error, ratio=ratio, chi2=chi2)


def add_truth(pictures: Sequence[Picture], baseline: Mapping[str, Entry]) -> list[Picture]:
    """Add to the photographs of real sets where a camera that is calibrated from the corners of the
    baseline sees their boards: of these the corners that were found are to be found again."""
    sets: dict[tuple[str, tuple[int, ...]], list[Picture]] = {}
    for picture in pictures:
        if picture.group == REAL and len(baseline[picture.name].uv):
            key = picture.name.split("/")[0], picture.image.shape
            sets.setdefault(key, []).append(picture)
    known: dict[str, Picture] = {}
    for shots in sets.values():
        if len(shots) >= _MIN_VIEWS:
            known |= _predict_boards(shots, baseline)
    return [known.get(picture.name, picture) for picture in pictures]


def _predict_boards(shots: list[Picture], baseline: Mapping[str, Entry]) -> dict[str, Picture]:
    """Predict the boards of a set's photographs; of none if no camera can be calibrated."""
    entries = [baseline[shot.name] for shot in shots]
    views = [Observation(e.uv, e.grid[:, ::-1].astype(np.float64), e.cov) for e in entries]
    size = (shots[0].image.shape[1], shots[0].image.shape[0])
    fits = []
    for model in _LENSES:
        try:
            fits.append(calibrate(views, size, model=model))
        except CalibrationError:
            continue
    if not fits:
        return {}
    best = min(fits, key=lambda fit: np.mean(np.concatenate([v.image for v in fit.residuals]) ** 2))
    known = {}
    for shot, entry, pose in zip(shots, entries, best.poses, strict=True):
        shape = tuple(entry.grid.max(axis=0) + 1)
        grid = np.argwhere(np.ones(shape, np.bool_))
        uv = project_points(grid[:, ::-1].astype(np.float64), best.camera, pose)
        seen = np.zeros(shape, np.bool_)
        seen[tuple(entry.grid.T)] = True
        known[shot.name] = replace(shot, boards=(uv.reshape(*shape, 2),), seen=seen)
    return known
