"""Photographs of a rig to cameras and instants, by the names of folders and files.

Each of several folders, patterns or videos that a user names is a camera. One folder may hold a
folder for each, or the photographs of all (``camera_names.py``).

Photographs of one instant have the same name but for the camera, or the same last number in it, or
were taken at the same time if their names tell it (``time_pairing.py``); whichever pairs more.
Where none of these pairs any it is EXIF that tells.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from calibgui.app.photographs.paths import count_images_below, find_images, make_natural_key
from calibgui.app.rig.camera_names import list_varying_places, split_by_cameras, split_name
from calibgui.app.rig.time_pairing import Times, pair_by_times, read_file_times, read_name_times
from calibgui.dataset import CameraPhotographs, RigPairing, RigResult
from calibgui.engine.errors import CalibrationError

_HINT = (
    "Name a folder for each camera (cam0 cam1), a pattern for each in quotes ('left*.jpg' "
    "'right*.jpg'), or call the photographs as left01, right01."
)


def pair_photographs(names: Sequence[str], tolerance: float | None = None) -> RigPairing:
    """Find the cameras and instants of photographs.

    Args:
        names: folders, files and patterns.
        tolerance: largest time between photographs of one instant, s, which are paired by their
            times alone; None to pair by what pairs most.

    Raises:
        CalibrationError: if a name means no photographs, the names tell no cameras, or no two
            cameras have a photograph of one instant.
    """
    groups = find_cameras(names)
    if tolerance is not None:
        return pair_by_times(groups, read_file_times(groups), tolerance)
    return pair_files(groups)


def find_cameras(names: Sequence[str]) -> dict[str, Sequence[Path]]:
    """Find the photographs of each camera by its name. Raises as `pair_photographs`."""
    groups = _group_by_camera(names)
    if len(groups) < 2:
        raise CalibrationError("The names of the photographs tell no two cameras.", _HINT)
    return groups


def pair_files(groups: Mapping[str, Sequence[Path]]) -> RigPairing:
    """Pair the photographs of cameras, by what pairs most.

    Args:
        groups: the photographs of each camera, by its name.

    Raises:
        CalibrationError: if no two cameras have a photograph of one instant.
    """
    by_number = {
        camera: _key_files(map(_read_last_number, files), files) for camera, files in groups.items()
    }
    candidates = (("numbers", by_number), ("names", _key_by_names(groups)))
    how, keyed = max(candidates, key=lambda candidate: _count_shared(candidate[1]))
    by_times = _pair_by_file_times(groups, _count_shared(keyed))
    if by_times is not None:
        return by_times
    if not _count_shared(keyed):
        raise CalibrationError(
            "No two cameras have photographs of the same name or number.",
            "Photographs of one instant are paired by their names: give them the same number, or "
            "say how far apart in time they may be (--within).",
        )
    keys = sorted(
        {key for files in keyed.values() for key in files},
        key=lambda key: make_natural_key(str(key)),
    )
    number = {key: k + 1 for k, key in enumerate(keys)}
    if all(isinstance(key, int) for key in keys):
        number = {key: int(str(key)) for key in keys}
    cameras = tuple(
        CameraPhotographs(camera, {number[key]: file for key, file in _sort_items(files)})
        for camera, files in keyed.items()
    )
    return RigPairing(cameras, {number[key]: str(key) for key in keys}, how)


def _pair_by_file_times(groups: Mapping[str, Sequence[Path]], shared: int) -> RigPairing | None:
    """Pair photographs by times if that pairs no fewer than are `shared` by names; else return
    None.

    EXIF is read only if none is shared.
    """
    times = read_name_times(groups) if shared else read_file_times(groups)
    if len(times) < len(groups):
        return None
    try:
        pairing = pair_by_times(groups, times)
    except CalibrationError:
        return None
    pairs = sum(len(camera.files) for camera in pairing.cameras) - len(pairing.instants)
    return pairing if pairs >= shared else None


def move_photographs(
    pairing: RigPairing, camera: int, instants: Collection[int], step: int
) -> RigPairing:
    """Move photographs of a camera to the instants before or after theirs.

    A photograph that stands there and is not moved takes the place that becomes free. Beyond the
    first and the last instant a new one is made.

    Args:
        pairing: the cameras and instants.
        camera: number of the camera.
        instants: numbers of the instants whose photographs are moved.
        step: 1 to later instants, -1 to earlier ones.
    """
    photographs = pairing.cameras[camera]
    order, files = list(pairing.instants), dict(photographs.files)
    names = dict(pairing.instants)
    moved = [instant for instant in order if instant in files and instant in instants]
    for instant in reversed(moved) if step > 0 else moved:
        place = order.index(instant) + step
        if not 0 <= place < len(order):
            new = max(order) + 1 if step > 0 else min(order) - 1
            order.insert(len(order) if step > 0 else 0, new)
            names[new] = files[instant].stem
            place = order.index(new)
        there = files.pop(order[place], None)
        files[order[place]] = files.pop(instant)
        if there is not None:
            files[instant] = there
    return _replace_files(pairing, camera, files, {instant: names[instant] for instant in order})


def leave_photographs_out(
    pairing: RigPairing, camera: int, instants: Collection[int]
) -> RigPairing:
    """Return a pairing without photographs of a camera at these instants."""
    files = pairing.cameras[camera].files
    kept = {instant: file for instant, file in files.items() if instant not in instants}
    return _replace_files(pairing, camera, kept, pairing.instants)


def _replace_files(
    pairing: RigPairing, camera: int, files: Mapping[int, Path], instants: Mapping[int, str]
) -> RigPairing:
    """Return a pairing with other photographs of a camera, in the order of the instants.

    Instants of which there is no photograph any more are dropped.
    """
    cameras = list(pairing.cameras)
    in_order = {instant: files[instant] for instant in instants if instant in files}
    cameras[camera] = replace(cameras[camera], files=in_order)
    seen = {instant for each in cameras for instant in each.files}
    kept = {instant: name for instant, name in instants.items() if instant in seen}
    return RigPairing(tuple(cameras), kept, pairing.how)


def state_times(pairing: RigPairing, times: Times) -> RigPairing:
    """Return a pairing whose photographs were taken at these times."""
    cameras = tuple(replace(each, times=times.get(each.name, {})) for each in pairing.cameras)
    return replace(pairing, cameras=cameras)


def recall_pairing(result: RigResult) -> RigPairing:
    """Return the pairing that a rig was made from, as far as its file tells."""
    cameras = []
    for c, name in enumerate(result.rig.names):
        files = {i: Path(image) for (of, i), image in result.images.items() if of == c}
        cameras.append(CameraPhotographs(name, dict(sorted(files.items()))))
    return RigPairing(tuple(cameras), result.instants, "names")


def _sort_items(files: Mapping[Hashable, Path]) -> list[tuple[Hashable, Path]]:
    """Return keys and files in the natural order of the keys."""
    return sorted(files.items(), key=lambda item: make_natural_key(str(item[0])))


def _count_shared(keyed: Mapping[str, Mapping[Hashable, Path]]) -> int:
    """Count the pairs of photographs with one key in two cameras."""
    counts = Counter(key for files in keyed.values() for key in files)
    return sum(count - 1 for count in counts.values())


def _read_last_number(file: Path) -> int | None:
    """Return the last number in a file's name; None if there is none."""
    numbers = re.findall(r"\d+", file.stem)
    return int(numbers[-1]) if numbers else None


def _key_by_names(groups: Mapping[str, Sequence[Path]]) -> dict[str, dict[Hashable, Path]]:
    """Return files by the parts of their names that vary within a camera."""
    names = {camera: [split_name(file) for file in files] for camera, files in groups.items()}
    varying = list_varying_places(names)
    return {
        camera: _key_files(
            ("_".join(parts[p] for p in varying if p < len(parts)) for parts in own), groups[camera]
        )
        for camera, own in names.items()
    }


def _key_files(keys: Iterable[Hashable], files: Sequence[Path]) -> dict[Hashable, Path]:
    """Return files by their keys; those that share one have none."""
    listed = list(keys)
    counts = Counter(listed)
    return {
        key: file
        for key, file in zip(listed, files, strict=True)
        if key not in (None, "") and counts[key] == 1
    }


def _group_by_camera(names: Sequence[str]) -> dict[str, Sequence[Path]]:
    """Return the photographs of each camera by its name."""
    if len(names) == 1 and Path(names[0]).is_dir():
        below = [
            path for path in count_images_below(Path(names[0])) if path.parent == Path(names[0])
        ]
        if len(below) > 1:
            return {folder.name: find_images([str(folder)]) for folder in below}
    if len(names) > 1 and not all(Path(name).is_file() for name in names):
        files = [find_images([name]) for name in names]
        return dict(zip(_name_cameras(names, files), files, strict=True))
    return split_by_cameras(find_images(names))


def _name_cameras(names: Sequence[str], files: Sequence[Sequence[Path]]) -> list[str]:
    """Name the cameras after their folders or, in one folder, what begins their files' names."""
    named = [Path(name).name for name in names]
    if not all(Path(name).is_dir() for name in names):
        named = [re.sub(r"[^\w-]+|_+$", "", Path(name).stem) for name in names]
        folders = [each[0].parent.name for each in files]
        if len(set(named)) < len(named):
            named = folders
    if len(set(named)) < len(named) or not all(named):
        named = [f"cam{c}" for c in range(len(names))]
    return named
