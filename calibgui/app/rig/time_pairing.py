"""Photographs of a rig to instants, by the times at which they were taken.

The times are those of a table, or what the files themselves tell: names as ROS and its users write
them, seconds or nanoseconds since 1970 (1403636579763555584, 1403636579.763555), seconds since a
robot was switched on (1623.456789) and dates (20230612_101502), or EXIF with its fractions of a
second. Photographs of two cameras are joined if each is the other camera's nearest
to the other, the nearest first, as long as no two of an instant were taken further apart than a
tolerance.

Where no tolerance is stated it is half the time from one photograph to the next: what lies beyond
is nearer to another one.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from calibgui.dataset import CameraPhotographs, RigPairing
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import read_image_header

Times = Mapping[str, Mapping[Path, float]]
"""Time of each photograph by its camera's clock, s, by the name of the camera."""
TIME = re.compile(
    r"""(?<!\d)(?:
    (?P<date>(?:19|20)\d\d[-_.]?[01]\d[-_.]?[0-3]\d[-_.T\ ]?[0-2]\d[-_.]?[0-5]\d[-_.]?[0-5]\d
        (?:[-_.]?\d{3,9})?)
    | (?P<whole>\d{19}|\d{16}|\d{13})
    | (?P<seconds>\d{10}(?:[._]\d{3,9})? | (?<![^\W_])\d+\.\d{6,9})
    )(?!\d)""",
    re.VERBOSE,
)
"""A time in a name: a date with its fraction of a second, nano-, micro- or milliseconds since 1970,
or seconds with their fraction."""


def read_file_times(groups: Mapping[str, Sequence[Path]]) -> Times:
    """Read the times of photographs from their names or, where not all tell it, from EXIF.

    Returns:
        The times of the cameras whose files all tell them.
    """
    named = read_name_times(groups)
    if len(named) == len(groups):
        return named
    times: dict[str, dict[Path, float]] = {}
    for camera, files in groups.items():
        dates = {file: _read_exif_time(file) for file in files}
        known = {file: time for file, time in dates.items() if time is not None}
        if len(known) == len(files):
            times[camera] = known
    return times


def read_name_times(groups: Mapping[str, Sequence[Path]]) -> Times:
    """Read the times of photographs from their names, of the cameras where all tell them."""
    times: dict[str, dict[Path, float]] = {}
    for camera, files in groups.items():
        told = {file: time for file in files if (time := read_name_time(file.stem)) is not None}
        if len(told) == len(files):
            times[camera] = told
    return times


def read_name_time(stem: str) -> float | None:
    """Return the time that a name tells, s since 1970 or any other moment; None if it tells none.

    The times of the photographs of one folder count from the same moment.
    """
    if (found := TIME.search(stem)) is None:
        return None
    if whole := found["whole"]:
        return float(int(whole) / 10 ** (len(whole) - 10))
    if seconds := found["seconds"]:
        return float(seconds.replace("_", "."))
    digits = re.sub(r"\D", "", found["date"])
    try:
        date = datetime.strptime(digits[:14], "%Y%m%d%H%M%S").replace(tzinfo=UTC)
    except ValueError:  # a number that looks like a date, as 20231399
        return None
    return date.timestamp() + float(f"0.{digits[14:] or 0}")


def _read_exif_time(file: Path) -> float | None:
    try:
        date = read_image_header(file).exif.date
    except CalibrationError:
        return None  # the search of the photograph says what is wrong with it
    return None if date is None else date.timestamp()


def pair_by_times(
    groups: Mapping[str, Sequence[Path]], times: Times, tolerance: float | None = None
) -> RigPairing:
    """Pair photographs by times.

    Args:
        groups: the photographs of each camera, by its name.
        times: when they were taken; one without a time has no partner.
        tolerance: largest time between photographs of one instant, s; None for half the time from
            one photograph to the next.

    Raises:
        CalibrationError: if a camera has no times, or no two cameras have photographs so near to
            each other.
    """
    if missing := [camera for camera in groups if not times.get(camera)]:
        raise CalibrationError(
            f"It is not known when the photographs of {' and '.join(missing)} were taken.",
            "Neither their names nor EXIF tell it: write a table of times (--times).",
        )
    limit = _find_tolerance(times) if tolerance is None else tolerance
    instants = _join_nearest(times, limit)
    shared = [instant for instant in instants if len(instant) > 1]
    if not shared:
        raise CalibrationError(
            f"No two cameras have photographs at most {limit:.3g} s apart; the nearest are "
            f"{_find_nearest(times):.3g} s apart.",
            "Allow more if the boards were held still, or set the cameras' clocks alike.",
        )
    spread = max(_measure_spread(instant, times) for instant in shared)
    beginning = min(min(own.values()) for own in times.values())
    names = {
        number: f"{min(times[c][file] for c, file in instant.items()) - beginning:.3f} s"
        for number, instant in enumerate(instants, 1)
    }
    cameras = tuple(
        CameraPhotographs(
            camera,
            {k: instant[camera] for k, instant in enumerate(instants, 1) if camera in instant},
            {file: time - beginning for file, time in times[camera].items()},
        )
        for camera in groups
    )
    return RigPairing(cameras, names, f"times, which are at most {spread * 1e3:.3g} ms apart")


def count_instants(times: Times) -> int:
    """Count the moments at which several cameras, and each of them once, took a photograph."""
    labels = np.repeat(np.arange(len(times)), [len(own) for own in times.values()])
    taken = np.concatenate([list(own.values()) for own in times.values()])
    order = np.argsort(taken, kind="stable")
    apart = np.diff(taken[order]) > _find_tolerance(times)
    moment = np.concatenate([[0], np.cumsum(apart)])
    photographs = np.bincount(moment)
    cameras = np.bincount(np.unique(np.stack([moment, labels[order]]), axis=1)[0])
    return int(np.sum((photographs > 1) & (cameras == photographs)))


def _find_tolerance(times: Times) -> float:
    """Return half the usual time from one photograph to the next, of the quickest camera, s."""
    intervals = [np.diff(np.sort(list(own.values()))) for own in times.values() if len(own) > 1]
    return min((float(np.median(each)) / 2 for each in intervals), default=0.0)


def _join_nearest(times: Times, tolerance: float) -> list[dict[str, Path]]:
    """Return the photographs of each instant by camera, in the order of their times."""
    pairs: list[tuple[float, tuple[str, Path], tuple[str, Path]]] = []
    in_order = {camera: sorted(own, key=own.__getitem__) for camera, own in times.items()}
    for a, b in itertools.combinations(times, 2):
        files, others = in_order[a], in_order[b]
        taken = np.array([times[a][file] for file in files])
        there = np.array([times[b][file] for file in others])
        nearest, back = _find_nearest_values(taken, there), _find_nearest_values(there, taken)
        apart = np.abs(taken - there[nearest])
        mutual = (back[nearest] == np.arange(len(files))) & (apart <= tolerance)
        pairs += [
            (float(apart[k]), (a, files[k]), (b, others[nearest[k]]))
            for k in np.flatnonzero(mutual).tolist()
        ]
    instants = {(c, file): {c: file} for c, own in times.items() for file in own}
    for _, first, second in sorted(pairs):
        joined = instants[first] | instants[second]
        is_one_of_each = len(joined) == len(instants[first]) + len(instants[second])
        if is_one_of_each and _measure_spread(joined, times) <= tolerance:
            instants |= dict.fromkeys(joined.items(), joined)
    unique = {id(instant): instant for instant in instants.values()}.values()
    return sorted(unique, key=lambda instant: min(times[c][f] for c, f in instant.items()))


def _find_nearest_values(values: Array, others: Array) -> IntArray:
    """Return the place of the nearest one of others for each of some values; both ascend."""
    after = np.clip(np.searchsorted(others, values), 1, max(len(others) - 1, 1))
    before = after - 1
    after = np.minimum(after, len(others) - 1)
    is_before = values - others[before] <= others[after] - values
    return np.where(is_before, before, after)


def _measure_spread(instant: Mapping[str, Path], times: Times) -> float:
    """Return the time from the first to the last photograph of an instant, s."""
    own = [times[camera][file] for camera, file in instant.items()]
    return max(own) - min(own)


def _find_nearest(times: Times) -> float:
    """Return the least time between photographs of two cameras, s."""
    taken = [np.sort(list(own.values())) for own in times.values()]
    return min(
        float(np.abs(a - b[_find_nearest_values(a, b)]).min())
        for a, b in itertools.combinations(taken, 2)
    )
