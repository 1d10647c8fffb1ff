"""Photographs of a rig to instants, by the times at which they were taken.

The times are those of a table, or what the files themselves tell: names as ROS and its users write
them, seconds or nanoseconds since 1970 (1403636579763555584, 1403636579.763555), or EXIF with its
fractions of a second. Photographs of two cameras are joined if each is the other camera's nearest
to the other, the nearest first, as long as no two of an instant were taken further apart than a
tolerance.

Where no tolerance is stated it is half the time from one photograph to the next: what lies beyond
is nearer to another one.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from calibgui.dataset import CameraPhotographs, RigPairing
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import read_image_header

Times = Mapping[str, Mapping[Path, float]]
"""Time of each photograph by its camera's clock, s, by the name of the camera."""
_SECONDS = re.compile(r"(?<!\d)(\d{10})(?:[._](\d{3,9}))?(?!\d)")
"""Seconds since 1970 and a fraction of them in a name."""
_WHOLE = re.compile(r"(?<!\d)(\d{19}|\d{16}|\d{13})(?!\d)")
"""Nano-, micro- or milliseconds since 1970 in a name."""


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
        told = {file: time for file in files if (time := _read_name_time(file.stem)) is not None}
        if len(told) == len(files):
            times[camera] = told
    return times


def _read_name_time(stem: str) -> float | None:
    """Return the time that a name tells, s since 1970."""
    if found := _WHOLE.search(stem):
        return float(int(found[1]) / 10 ** (len(found[1]) - 10))
    if found := _SECONDS.search(stem):
        return float(f"{found[1]}.{found[2] or 0}")
    return None


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


def _find_tolerance(times: Times) -> float:
    """Return half the usual time from one photograph to the next, of the quickest camera, s."""
    intervals = [np.diff(np.sort(list(own.values()))) for own in times.values() if len(own) > 1]
    return min((float(np.median(each)) / 2 for each in intervals), default=0.0)


def _join_nearest(times: Times, tolerance: float) -> list[dict[str, Path]]:
    """Return the photographs of each instant by camera, in the order of their times."""
    pairs: list[tuple[float, tuple[str, Path], tuple[str, Path]]] = []
    for a, b in itertools.combinations(times, 2):
        apart = np.abs(np.subtract.outer(list(times[a].values()), list(times[b].values())))
        files, others = list(times[a]), list(times[b])
        for k, nearest in enumerate(apart.argmin(axis=1)):
            if apart[:, nearest].argmin() == k and apart[k, nearest] <= tolerance:
                pairs.append((apart[k, nearest], (a, files[k]), (b, others[nearest])))
    instants = {(c, file): {c: file} for c, own in times.items() for file in own}
    for _, first, second in sorted(pairs):
        joined = instants[first] | instants[second]
        is_one_of_each = len(joined) == len(instants[first]) + len(instants[second])
        if is_one_of_each and _measure_spread(joined, times) <= tolerance:
            instants |= dict.fromkeys(joined.items(), joined)
    unique = {id(instant): instant for instant in instants.values()}.values()
    return sorted(unique, key=lambda instant: min(times[c][f] for c, f in instant.items()))


def _measure_spread(instant: Mapping[str, Path], times: Times) -> float:
    """Return the time from the first to the last photograph of an instant, s."""
    own = [times[camera][file] for camera, file in instant.items()]
    return max(own) - min(own)


def _find_nearest(times: Times) -> float:
    """Return the least time between photographs of two cameras, s."""
    return min(
        float(np.abs(np.subtract.outer(list(a.values()), list(b.values()))).min())
        for a, b in itertools.combinations(times.values(), 2)
    )
