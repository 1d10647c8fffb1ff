"""From photographs to views: read each image and search it for the target.

What goes wrong with one image is recorded in its view and stops nothing. One camera has one
image size: the most frequent one counts, images of another are left out unread. If the
board's size is not given, the most frequent one among the boards seen whole is taken to be
it, and images in which something else was counted are searched again for that size. What a
pattern leaves open, as the dictionary of its markers, is settled in the same way.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from threading import Event

from calibgui.app.workers import Crashed, spread
from calibgui.dataset.corner_set import CornerSet
from calibgui.dataset.view import View, ViewStatus
from calibgui.engine.arrays import Array, GridSize, Size
from calibgui.engine.boards import CHECKERBOARD, KINDS, Board, Pattern
from calibgui.engine.detection import METHODS, Corners, find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.images import image_size, read_image

Progress = Callable[[int, int, View], None]
"""Told of each image done: how many are, of how many, and its view."""


@dataclass(frozen=True, eq=False, slots=True)
class Detection:
    """The views of a set of images, with what they have in common."""

    views: tuple[View, ...]
    """One per image, in the images' order."""
    size: Size | None
    """Of the images, px; None if none could be read."""
    grid_size: GridSize | None
    """As given, or as most frequently seen; None if no board was seen whole."""
    pattern: Pattern = CHECKERBOARD
    """As given, with what the images tell of it."""

    def corner_set(self, square: float) -> CornerSet:
        """The views as a calibration takes them, on a board of squares of side `square` mm.

        Raises:
            CalibrationError: if no image could be read.
        """
        if self.size is None:
            raise CalibrationError(
                "None of the files can be read as an image.",
                f"The first: {self.views[0].reason}",
            )
        board = None if self.grid_size is None else Board(*self.grid_size, square, self.pattern)
        return CornerSet(self.size, self.views, board)


def find_views(
    images: Sequence[Path],
    grid_size: GridSize | None = None,
    rois: Mapping[Path, Array] | None = None,
    progress: Progress | None = None,
    stop: Event | None = None,
    size: Size | None = None,
    method: str = METHODS[0],
    pattern: Pattern = CHECKERBOARD,
    preparing: Callable[[], None] | None = None,
) -> Detection:
    """Search all images for the board, on all processors.

    Args:
        images: files; their order is the views'.
        board: rows and columns of inner corners; inferred over the whole set if None.
        rois: (4, 2) px, the region to search in some of the images.
        progress: told of each image searched; those searched again add to the total.
        stop: abandons the search within 0.2 s when set.
        size: width and height of the camera's images; the most frequent ones if None.
        method: of locating corners, one of ``corners.METHODS``.
        pattern: of the target; what it leaves open is inferred over the whole set.
        preparing: called if the corner finder has to be prepared for its first use, which takes
            some `kernels.FINDER_SECONDS`.

    Raises:
        Cancelled: if `stop` was set.
    """
    rois = rois or {}
    waiting = [View(str(path), roi=rois.get(path)) for path in images]
    views, size = _sized(waiting, size)

    def search(which: Sequence[int], grid_size: GridSize | None, before: int = 0) -> None:
        items = [views[k] for k in which]
        results = spread(
            partial(search_view, grid_size=grid_size, method=method, pattern=pattern),
            items,
            stop,
            preparing,
        )
        for done, (i, view) in enumerate(results, start=before + 1):
            views[which[i]] = _crashed(items[i]) if isinstance(view, Crashed) else view
            if progress is not None:
                progress(done, before + len(which), views[which[i]])

    readable = [k for k, view in enumerate(views) if view.status is ViewStatus.WAITING]
    search(readable, grid_size)
    if grid_size is None and (grid_size := usual_board(views)) is not None:
        pattern = usual_pattern(views, pattern)
        again = [k for k, view in enumerate(views) if _worth_another_look(view, grid_size, pattern)]
        search(again, grid_size, before=len(readable))
    return Detection(tuple(views), size, grid_size, usual_pattern(views, pattern))


def search_view(
    view: View,
    grid_size: GridSize | None = None,
    method: str = METHODS[0],
    pattern: Pattern = CHECKERBOARD,
) -> View:
    """The view with the corners found in its image, or with the reason why there are none."""
    try:
        pixels = read_image(view.image).pixels
    except CalibrationError as error:
        return _without_corners(view, ViewStatus.UNREADABLE, str(error))
    try:
        corners = find_corners(pixels, grid_size, view.roi, method, pattern=pattern)
    except NoBoardError as error:
        return _without_corners(view, ViewStatus.NO_BOARD, str(error))
    return replace(view, status=ViewStatus.FOUND, reason="", corners=corners)


def other_pattern(
    images: Iterable[str], stated: Pattern, stop: Event | None = None
) -> Pattern | None:
    """Another pattern than the one `stated`, if it is found in any of the `images`.

    Of several that which is found in most, with most corners.

    Raises:
        Cancelled: if `stop` was set.
    """
    others = [pattern for pattern in KINDS.values() if pattern.kind != stated.kind]
    tries = [(image, pattern) for image in images for pattern in others]
    found: Counter[str] = Counter()
    corners: Counter[str] = Counter()
    for i, view in spread(_tried, tries, stop):
        if isinstance(view, View) and view.corners is not None:
            kind = tries[i][1].kind
            found[kind] += 1
            corners[kind] += len(view.corners)
    best = max(found, key=lambda kind: (found[kind], corners[kind]), default=None)
    return None if best is None else KINDS[best]


def _tried(one: tuple[str, Pattern]) -> View:
    image, pattern = one
    return search_view(View(image), pattern=pattern)


def usual_board(views: Iterable[View]) -> GridSize | None:
    """The most frequent size of boards seen whole, of equally frequent ones the largest.

    Where corners say which they are the largest part seen is the board, or as much as is known.
    """
    found = [view.corners for view in views if view.corners is not None]
    if found and all(corners.pattern.identified for corners in found):
        return largest_part(found)
    seen = Counter(corners.shape for corners in found if corners.complete)
    return max(seen, key=lambda shape: (seen[shape], shape[0] * shape[1]), default=None)


def largest_part(found: Sequence[Corners]) -> GridSize | None:
    """Rows and columns that parts of a board, perhaps never seen whole, amount to at least."""
    rows, cols = (max((corners.shape[i] for corners in found), default=0) for i in (0, 1))
    return (rows, cols) if rows and cols else None


def usual_pattern(views: Iterable[View], stated: Pattern) -> Pattern:
    """The `stated` pattern with what it leaves open as the images show it."""
    found = [view.corners.pattern for view in views if view.corners is not None]
    return stated.completed([pattern for pattern in found if pattern.kind == stated.kind])


def _worth_another_look(view: View, grid_size: GridSize, pattern: Pattern) -> bool:
    """Whether knowing the board can give a view other corners: fewer, more or renumbered."""
    if view.corners is not None:
        return view.corners.shape != grid_size
    known = view.roi is not None or pattern.identified
    return view.status is ViewStatus.NO_BOARD and known


def _sized(views: Iterable[View], size: Size | None) -> tuple[list[View], Size | None]:
    """The views, without those whose image is unreadable or not of `size`, by default the usual."""
    sizes: dict[int, Size] = {}
    result = list(views)
    for k, view in enumerate(result):
        try:
            sizes[k] = image_size(view.image)
        except CalibrationError as error:
            result[k] = _without_corners(view, ViewStatus.UNREADABLE, str(error))
    count = Counter(sizes.values())
    most = max(count, key=lambda size: (count[size], size[0] * size[1]), default=None)
    usual = size or most
    for k, own in sizes.items():
        if own != usual:
            result[k] = _without_corners(result[k], ViewStatus.WRONG_SIZE, _wrong(own, usual))
    return result, usual


def _wrong(size: Size, usual: Size | None) -> str:
    remedy = "Leave it out, or calibrate images of each size by themselves."
    if usual == size[::-1]:
        remedy = "Turn it like the others (without EXIF rotation), or leave it out."
    width, height = usual or (0, 0)
    return f"It has {size[0]} x {size[1]} pixels, most have {width} x {height}. {remedy}"


def _crashed(view: View) -> View:
    reason = "Searching it ended the process that did. Leave it out."
    return _without_corners(view, ViewStatus.UNREADABLE, reason)


def _without_corners(view: View, status: ViewStatus, reason: str) -> View:
    return replace(view, status=status, reason=reason, corners=None)
