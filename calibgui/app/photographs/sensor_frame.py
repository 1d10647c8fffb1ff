"""One frame for all photographs of a camera: that of its sensor.

A camera that is held upright or upside down stores the same rows and columns of its sensor, and
states in EXIF how to turn them for people to look at. Each photograph turned by itself would be of
another camera: its principal point and distortion are turned, too. So all photographs of a set are
turned alike, as most of them state. Only where a file names no camera in EXIF, its pixels may have
been turned by the program that wrote it, and are left as they are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from calibgui.dataset import View, ViewStatus
from calibgui.engine.arrays import Size
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import Header, read_image_header

_MIN_OF_A_SIZE = 3
"""Number of images of the most frequent size from which it counts as the camera's, where there are
as many other sizes: fewer do not determine a camera."""
_NOTE = "Turned like the other photographs: the camera was held otherwise when it was taken."


def share_frame(
    views: Iterable[View], size: Size | None = None, orientation: int | None = None
) -> tuple[list[View], Size | None]:
    """Turn all photographs alike, and record those that cannot be read or have another size.

    Args:
        views: views to be searched.
        size: width and height of the camera's images; the most frequent ones if None.
        orientation: EXIF orientation by which the camera's other photographs are turned; the most
            frequent one if None.

    Returns:
        The views, and the size, None if no image is readable.
    """
    headers: dict[int, Header] = {}
    result = list(views)
    for k, view in enumerate(result):
        try:
            headers[k] = read_image_header(view.image)
        except CalibrationError as error:
            result[k] = view.refuse(ViewStatus.UNREADABLE, str(error))
    count = Counter(header.size for header in headers.values())
    if size is None:
        size = max(count, key=lambda size: (count[size], size[0] * size[1]), default=None)
    if orientation is None:
        stated = Counter(h.exif.orientation for h in headers.values() if h.size == size)
        orientation = max(stated, key=stated.__getitem__, default=None)
    for k, header in headers.items():
        turned = choose_orientation(header, size, orientation)
        if turned is None:
            reason = _describe_wrong_size(header.size, size or header.size, count)
            result[k] = result[k].refuse(ViewStatus.WRONG_SIZE, reason)
        else:
            note = "" if turned == header.exif.orientation else _NOTE
            result[k] = replace(result[k], orientation=turned, note=note)
    return result, size


def find_common_size(
    images: Iterable[Path], usual: Size, orientation: int | None = None
) -> Size | None:
    """Find the size of photographs, turned alike: the `usual` one if any has it, else that of most.

    Args:
        images: the files.
        usual: width and height of the camera's images.
        orientation: EXIF orientation by which the camera's photographs are turned, where known.

    Returns:
        None if no image can be read.
    """
    views = [View(str(path)) for path in images]
    alike, _ = share_frame(views, usual, orientation)
    if any(view.status is ViewStatus.WAITING for view in alike):
        return usual
    return share_frame(views, None, orientation)[1]


def list_other_frames(
    views: Sequence[View], shared: Sequence[View]
) -> Iterator[tuple[Size, dict[int, View]]]:
    """Yield the other sizes that photographs have, with those of that size, all turned alike.

    Args:
        views: views to be searched.
        shared: the same as `share_frame` returned them.

    Yields:
        The size, and the views of it by their indices; the most frequent size first.
    """
    rest = [k for k, view in enumerate(shared) if view.status is ViewStatus.WRONG_SIZE]
    while rest:
        turned, size = share_frame([views[k] for k in rest])
        if size is None:  # the files are gone since their headers were read
            return
        pairs = list(zip(rest, turned, strict=True))
        yield size, {k: view for k, view in pairs if view.status is ViewStatus.WAITING}
        rest = [k for k, view in pairs if view.status is ViewStatus.WRONG_SIZE]


def choose_orientation(header: Header, size: Size | None, usual: int | None) -> int | None:
    """Return the orientation by which an image is turned to its size; None if there is none.

    Args:
        header: the image's header.
        size: width and height of the camera's images.
        usual: EXIF orientation by which the camera's photographs are turned, where it is known.
    """
    stated = header.exif.orientation
    is_original = header.exif.is_of_camera or stated != 1
    for orientation in (usual if is_original else None, stated):
        if orientation is not None and header.turned_size(orientation) == size:
            return orientation
    return None


def _describe_wrong_size(size: Size, usual: Size, count: Counter[Size]) -> str:
    """Say why an image of another size than `usual` is not used, and what to do.

    Args:
        size: the image's width and height, px.
        usual: those of the camera's images.
        count: number of the images of each size.
    """
    if count[usual] and max(count.values()) < _MIN_OF_A_SIZE <= len(count):
        return (
            f"The images have {len(count)} different sizes, as if they were cropped or resized one "
            "by one: take the files as the camera wrote them."
        )
    width, height = usual
    remedy = "Not used: calibrate images of each size by themselves."
    if usual == size[::-1]:
        remedy = "Take the file as the camera wrote it, or leave it out."
    compared = "most" if 2 * count[usual] > sum(count.values()) else "others"
    return f"{size[0]} x {size[1]} pixels, {compared} have {width} x {height}. {remedy}"
