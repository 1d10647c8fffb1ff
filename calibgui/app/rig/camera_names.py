"""The cameras of the photographs in one folder, by their names.

One part of the names, a word or a number, tells the camera, as in left01 and right01, cam0_0007 and
cam1_0007 or image_0_1623.456789 and image_1_1623.459012. It is the part without which most names
are of an instant of several cameras: they are alike but for what is the same in all names of a
camera, or they tell times next to each other (``time_pairing.py``). Words come before numbers, and
those that cameras are called by before all others. A time is one part, and tells no camera.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path

from calibgui.app.photographs.paths import find_images, make_natural_key
from calibgui.app.rig.time_pairing import TIME, count_instants, read_name_times

_PART = re.compile(rf"{TIME.pattern}|\d+|[^\W\d_]+", re.VERBOSE)
"""A time, number or word in a name."""
_CAMERA = re.compile(r"left|right|[lr]|(cam|camera)\d*", re.IGNORECASE)
"""A word that cameras are called by."""


def split_name(file: Path) -> list[str]:
    """Return the times, numbers and words in a file's name."""
    return [found[0] for found in _PART.finditer(file.stem)]


def list_varying_places(names: Mapping[str, Sequence[Sequence[str]]]) -> list[int]:
    """List the places of the parts that are not the same in all names of a camera.

    Args:
        names: the parts of the names of each camera's photographs.
    """
    several = [own for own in names.values() if len(own) > 1]
    places = range(max((len(parts) for own in names.values() for parts in own), default=0))
    return [
        place
        for place in places
        if any(len({tuple(parts[place : place + 1]) for parts in own}) > 1 for own in several)
    ]


def split_by_cameras(files: Sequence[Path]) -> dict[str, Sequence[Path]]:
    """Split photographs of one folder by the part of their names that tells the camera.

    Returns:
        The photographs of each camera by its name; empty if no part tells two cameras.
    """
    return _find_best_split(files)[1]


def find_named_cameras(names: Sequence[str]) -> dict[str, Sequence[Path]]:
    """Find the cameras that names of photographs tell beyond doubt.

    They do if the part that tells the camera is a word that cameras are called by, or most of the
    times in the names are of several cameras. A word such as near and far may tell anything.

    Args:
        names: folders, files and patterns.

    Returns:
        The photographs of each camera by its name; empty if there is doubt.

    Raises:
        CalibrationError: as `find_images`.
    """
    is_certain, groups = _find_best_split(find_images(names))
    return groups if is_certain else {}


def list_cameras(groups: Mapping[str, Sequence[Path]]) -> str:
    """List cameras with the numbers of their photographs, as "left (12), right (11)"."""
    return ", ".join(f"{name} ({len(files)})" for name, files in groups.items())


def _find_best_split(files: Sequence[Path]) -> tuple[bool, dict[str, Sequence[Path]]]:
    """Return the split by the part that tells the camera, and whether it does so beyond doubt."""
    names = [split_name(file) for file in files]
    best: tuple[tuple[bool, bool, int], dict[str, Sequence[Path]]] = ((False, False, 1), {})
    is_certain = False
    for place in range(max(map(len, names), default=0)):
        groups: dict[str, list[Path]] = defaultdict(list)
        parts_of: dict[str, list[list[str]]] = defaultdict(list)
        for file, parts in zip(files, names, strict=True):
            if place < len(parts) and not TIME.fullmatch(parts[place]):
                groups[_name_part(parts, place)].append(file)
                parts_of[_name_part(parts, place)].append(parts)
        if len(groups) < 2 or len(groups) == len(files):
            continue
        alike, near = _count_alike(parts_of), _count_near(groups)
        is_camera = all(map(_CAMERA.fullmatch, groups))
        is_word = not any(name[-1].isdigit() for name in groups)
        rank = is_camera, is_word, max(alike, near)
        if rank[2] > 1 and rank > best[0]:
            best = rank, {name: groups[name] for name in sorted(groups, key=make_natural_key)}
            is_certain = is_camera or 2 * near > max(map(len, groups.values()))
    return is_certain, best[1]


def _count_alike(names: Mapping[str, Sequence[Sequence[str]]]) -> int:
    """Count the names of several cameras that are alike in what varies within a camera."""
    varying = list_varying_places(names)
    rests = Counter(
        tuple(parts[place] for place in varying if place < len(parts))
        for own in names.values()
        for parts in own
    )
    return sum(count > 1 for rest, count in rests.items() if rest)


def _count_near(groups: Mapping[str, Sequence[Path]]) -> int:
    """Count the instants of several cameras by the times in the names of their photographs."""
    times = read_name_times(groups)
    return count_instants(times) if len(times) == len(groups) else 0


def _name_part(parts: Sequence[str], place: int) -> str:
    """Return the part that tells the camera: of a number with the word before it, as cam0."""
    is_numbered_word = parts[place].isdigit() and place > 0 and parts[place - 1].isalpha()
    return (parts[place - 1] if is_numbered_word else "") + parts[place]
