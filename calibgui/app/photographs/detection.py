"""Search of photographs for the board.

A failure with one image is recorded in its view and does not stop the search. One camera has one
image size, and its photographs are all turned alike (``sensor_frame.py``). The size is that of most
images that show the board: those of the most frequent size are searched first, then those of any
other size of which there are more than showed it. What is not known of the board is taken from what
the photographs agree on (``shared_board.py``), and images that show another size, or may cut the
board, are searched again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from threading import Event
from typing import Protocol

from calibgui.app.photographs.interlacing import INTERLACED, is_interlaced
from calibgui.app.photographs.sensor_frame import list_other_frames, share_frame
from calibgui.app.photographs.shared_board import (
    agree_on_board,
    explain_unknown_size,
    infer_pattern,
    list_worth_searching_again,
)
from calibgui.app.system.kernel_preparation import choose_preparation
from calibgui.app.system.workers import Crashed, map_in_processes
from calibgui.dataset import DEFAULT_SQUARE, CornerSet, View, ViewStatus
from calibgui.engine import detection
from calibgui.engine.arrays import Array, GridSize, Size
from calibgui.engine.boards import CHECKERBOARD, Board, Pattern
from calibgui.engine.errors import CalibrationError, MirroredError, NoBoardError
from calibgui.engine.features import METHODS
from calibgui.engine.images import (
    Field,
    Image,
    find_image_circle,
    mirror_orientation,
    read_image,
)

_MIRRORED = str(MirroredError())
"""Reason why a board with marks is not found in a mirrored photograph."""
Progress = Callable[[int, int, View], None]
"""Function that is called with the number of finished images, of all images, and the last view."""


class SearchImage(Protocol):
    """A function that searches the image of a view, as `search_view`."""

    def __call__(
        self, view: View, grid_size: GridSize | None, method: str, pattern: Pattern
    ) -> View: ...


@dataclass(frozen=True, eq=False, slots=True)
class Detection:
    """The views of a set of images, with the size and the board that they share."""

    views: tuple[View, ...]
    """One view per image, in the order of the images."""
    size: Size | None
    """Width and height of the images, px; None if none could be read."""
    grid_size: GridSize | None
    """Rows and columns, given or inferred; None if the photographs do not tell them."""
    pattern: Pattern = CHECKERBOARD
    """The given pattern, completed from the images."""
    remark: str = ""
    """A sentence on how the size was inferred, where the user should check it; mostly empty."""

    def corner_set(self, square: float | None, square_sigma: float = 0.0) -> CornerSet:
        """Return the views for a calibration, on a board of squares of side `square` mm.

        If it is None they are `DEFAULT_SQUARE`, and lengths not confirmed. `square_sigma` is its
        standard deviation, mm, common to all squares.

        Raises:
            CalibrationError: if no image could be read, or the size of the board that was found is
                neither given nor seen.
        """
        if self.size is None:
            raise refuse_unreadable(self.views)
        if self.grid_size is None and (error := explain_unknown_size(self.views, self.pattern)):
            raise error
        side = DEFAULT_SQUARE if square is None else square
        board = None
        if self.grid_size is not None:
            board = Board(*self.grid_size, side, self.pattern, square_sigma)
        return CornerSet(self.size, self.views, board, lengths_confirmed=square is not None)


def find_views(
    images: Sequence[Path],
    grid_size: GridSize | None = None,
    rois: Mapping[Path, Array] | None = None,
    progress: Progress | None = None,
    stop: Event | None = None,
    size: Size | None = None,
    orientation: int | None = None,
    method: str = METHODS[0],
    pattern: Pattern = CHECKERBOARD,
    search_image: SearchImage | None = None,
    field: Field | None = None,
) -> Detection:
    """Search all images for the board, on all processors.

    Args:
        images: files, in the order of the views.
        grid_size: rows and columns of inner corners; inferred from the whole set if None.
        rois: (4, 2) px, regions to search in some of the images.
        progress: called after each image; images of other sizes and those searched again add to
            the total, of which it is told before the first of them.
        stop: abandons the search within 0.2 s when set.
        size: width and height of the camera's images; if None, those of most images that show the
            board, or of most images if none does.
        orientation: EXIF orientation by which the images are turned; the most frequent one if None.
        method: of locating corners, one of ``features.METHODS``.
        pattern: of the board; its unknown properties are inferred from the whole set.
        search_image: does what `search_view` does, as one that remembers; `search_view` if None.
        field: the field of interlaced frames to search; all rows if None.

    Raises:
        Cancelled: if `stop` was set.
    """
    rois = rois or {}
    waiting = [View(str(path), roi=rois.get(path), field=field) for path in images]
    views, usual_size = share_frame(waiting, size, orientation)
    search = _Search(views, progress, stop, choose_preparation(pattern))

    def look_for(grid_size: GridSize | None, pattern: Pattern) -> Callable[[View], View]:
        how = search_image or search_view
        return partial(how, grid_size=grid_size, method=method, pattern=pattern)

    look = look_for(grid_size, pattern)
    search.run([k for k, view in enumerate(views) if view.status is ViewStatus.WAITING], look)
    if size is None and usual_size is not None:
        size = _settle_size(search, waiting, usual_size, orientation, look)
    board = agree_on_board(search.views, grid_size, pattern)
    again = list_worth_searching_again(search.views, board, grid_size, pattern)
    search.run(again, look_for(board.grid_size, board.pattern))
    pattern = infer_pattern(search.views, board.pattern)
    found = search.views
    if pattern.identifies_points and any(view.corners is not None for view in found):
        found = _name_mirrored(found, look_for(board.grid_size, pattern), stop)
    return Detection(tuple(found), size, board.grid_size, pattern, board.remark)


class _Search:
    """A search of images, which goes on as more is known of their size and of the board."""

    def __init__(
        self,
        views: Iterable[View],
        progress: Progress | None,
        stop: Event | None,
        prepare: Callable[[], None],
    ) -> None:
        """Begin with views that wait, and others that were refused; the rest as `find_views`."""
        self.views = list(views)
        self._unsearched = list(self.views)
        self._progress, self._stop, self._prepare = progress, stop, prepare
        self._finished = 0

    def run(self, which: Sequence[int], look: Callable[[View], View]) -> None:
        """Search some of the images, also again, as they were before any search."""
        total = self._finished + len(which)
        items = [self._unsearched[k] for k in which]
        if self._finished and items:
            self._report(total, which[0])  # it takes longer than it seemed
        for i, view in map_in_processes(look, items, self._stop, self._prepare):
            self._finished += 1
            self.views[which[i]] = _record_crash(items[i]) if isinstance(view, Crashed) else view
            self._report(total, which[i])

    def run_instead(self, others: Mapping[int, View], look: Callable[[View], View]) -> None:
        """Take other views of some images, turned otherwise or refused, and search them."""
        for k, view in others.items():
            self.views[k] = self._unsearched[k] = view
        self.run([k for k, view in others.items() if view.status is ViewStatus.WAITING], look)

    def was_turned_as(self, k: int, view: View) -> bool:
        """Return whether an image was searched turned as a view of it is."""
        return self._unsearched[k].orientation == view.orientation

    def _report(self, total: int, k: int) -> None:
        if self._progress is not None:
            self._progress(self._finished, total, self.views[k])


def _settle_size(
    search: _Search,
    waiting: Sequence[View],
    usual: Size,
    orientation: int | None,
    look: Callable[[View], View],
) -> Size:
    """Search images of other sizes than the `usual` one too, where they may show more boards, and
    return the size of those that do; all images are left in the frame of that size."""
    shown = _count_found(search.views)
    rivals = [each for each in list_other_frames(waiting, search.views) if len(each[1]) > shown]
    search.run_instead({k: view for _, frame in rivals for k, view in frame.items()}, look)
    size = _choose_size(search.views, usual, rivals)
    if rivals and _count_found(search.views):
        chosen, _ = share_frame(waiting, size, orientation)
        others = {
            k: view
            for k, view in enumerate(chosen)
            if view.status is not ViewStatus.WAITING or not search.was_turned_as(k, view)
        }
        search.run_instead(others, look)
    return size


def search_view(
    view: View,
    grid_size: GridSize | None = None,
    method: str = METHODS[0],
    pattern: Pattern = CHECKERBOARD,
) -> View:
    """Return the view with the corners found in its image, or the reason why there are none."""
    try:
        image = read_image(view.image, view.orientation, view.field)
    except CalibrationError as error:
        return view.refuse(ViewStatus.UNREADABLE, str(error))
    view = replace(view, circle=find_image_circle(image.pixels))
    is_combed = view.field is None and is_interlaced(image.pixels)
    interlaced = INTERLACED if is_combed else ""
    doubt = " ".join(filter(None, (_describe_zero_tail(image), interlaced)))
    try:
        corners = detection.find_corners(image.pixels, grid_size, view.roi, method, pattern=pattern)
    except NoBoardError as error:
        return view.refuse(ViewStatus.NO_BOARD, f"{error} {doubt}".rstrip())
    said = [view.note, *(each for each in (doubt, corners.remark) if each not in view.note)]
    note = " ".join(filter(None, said))
    return replace(view, status=ViewStatus.FOUND, reason="", note=note, corners=corners)


def _choose_size(
    views: Sequence[View], usual: Size, rivals: Sequence[tuple[Size, Mapping[int, View]]]
) -> Size:
    """Return the size of most images that show the board; of equals, that of most images.

    Args:
        views: what was found.
        usual: the most frequent size of the images.
        rivals: other sizes, with the views of each by their indices.
    """
    shown = {size: _count_found(views[k] for k in frame) for size, frame in rivals}
    shown = {usual: _count_found(views) - sum(shown.values()), **shown}
    return max(shown, key=shown.__getitem__)


def _count_found(views: Iterable[View]) -> int:
    return sum(view.status is ViewStatus.FOUND for view in views)


def _name_mirrored(
    views: Sequence[View], search: Callable[[View], View], stop: Event | None
) -> list[View]:
    """Return the views, with the reason of those in whose mirror image the board is found.

    No mark on a board survives that its picture is mirrored, as programs for video calls do.
    """
    named = list(views)
    lost = [
        k
        for k, view in enumerate(named)
        if view.status is ViewStatus.NO_BOARD
        and view.roi is None
        and not view.reason.startswith(_MIRRORED)
    ]
    mirror_images = [
        replace(named[k], orientation=mirror_orientation(named[k].orientation or 1)) for k in lost
    ]
    for i, seen in map_in_processes(search, mirror_images, stop):
        if isinstance(seen, View) and seen.corners is not None:
            named[lost[i]] = named[lost[i]].refuse(ViewStatus.NO_BOARD, _MIRRORED)
    return named


def _describe_zero_tail(image: Image) -> str:
    """Say that an image may have been copied in part; an empty text if it does not look so."""
    if not image.zero_tail:
        return ""
    return (
        f"The last {100 * image.zero_tail:.2g} % of the file are zeros: if the photograph is not "
        "black there, copy it from the camera again."
    )


def refuse_unreadable(views: Sequence[View]) -> CalibrationError:
    """Return the error that none of the images can be read."""
    problem = "None of the files can be read as an image."
    return CalibrationError(problem, f"The first: {views[0].reason}")


def _record_crash(view: View) -> View:
    reason = "The process that searched it died. Search it again, or leave it out."
    return view.refuse(ViewStatus.UNREADABLE, reason)
