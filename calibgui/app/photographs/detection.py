"""Search of photographs for the board.

A failure with one image is recorded in its view and does not stop the search. One camera has one
image size, and its photographs are all turned alike (``sensor_frame.py``). The size is that of most
images that show the board: those of the most frequent size are searched first, then those of any
other size of which there are more than showed it. If the grid size of the board is not given, the
most frequent one among completely seen boards is taken, or that of a part which several photographs
share, and images that show another size, or may cut the board, are searched again. Unknown
properties of a pattern, such as the dictionary of its markers, are inferred in the same way.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from threading import Event
from typing import Protocol

from calibgui.app.photographs.interlacing import INTERLACED, is_interlaced
from calibgui.app.photographs.sensor_frame import list_other_frames, share_frame
from calibgui.app.system.kernel_preparation import choose_preparation
from calibgui.app.system.workers import Crashed, map_in_processes
from calibgui.dataset import DEFAULT_SQUARE, CornerSet, View, ViewStatus
from calibgui.engine import detection
from calibgui.engine.arrays import Array, GridSize, Size
from calibgui.engine.boards import CHECKERBOARD, AprilGrid, Board, Pattern
from calibgui.engine.errors import CalibrationError, MirroredError, NoBoardError
from calibgui.engine.features import METHODS, Corners
from calibgui.engine.images import (
    Field,
    Image,
    find_image_circle,
    mirror_orientation,
    read_image,
)
from calibgui.engine.lattices import LIKE_DOTS

_MIN_PARTS = 3
"""Number of photographs in which the largest part of a board has one size, from which it counts as
the board: something covers some corners in each of them. Parts that the image cuts, or that end
where something begins, are of many sizes."""
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
    unsearched = list(views)
    searches = 0

    def search(which: Sequence[int], grid_size: GridSize | None) -> None:
        nonlocal searches
        total = searches + len(which)
        items = [unsearched[k] for k in which]
        if searches and items and progress is not None:
            progress(searches, total, views[which[0]])  # it takes longer than it seemed
        results = map_in_processes(
            partial(
                search_image or search_view, grid_size=grid_size, method=method, pattern=pattern
            ),
            items,
            stop,
            choose_preparation(pattern),
        )
        for i, view in results:
            searches += 1
            views[which[i]] = _record_crash(items[i]) if isinstance(view, Crashed) else view
            if progress is not None:
                progress(searches, total, views[which[i]])

    def search_instead(others: Mapping[int, View]) -> None:
        """Take other views of some images, turned otherwise or refused, and search them."""
        for k, view in others.items():
            views[k] = unsearched[k] = view
        search([k for k, view in others.items() if view.status is ViewStatus.WAITING], grid_size)

    search([k for k, view in enumerate(views) if view.status is ViewStatus.WAITING], grid_size)
    if size is None and usual_size is not None:
        shown = _count_found(views)
        rivals = [each for each in list_other_frames(waiting, views) if len(each[1]) > shown]
        search_instead({k: view for _, frame in rivals for k, view in frame.items()})
        size = _choose_size(views, usual_size, rivals)
        if rivals and _count_found(views):
            chosen, _ = share_frame(waiting, size, orientation)
            search_instead(
                {
                    k: view
                    for k, view in enumerate(chosen)
                    if view.status is not ViewStatus.WAITING
                    or view.orientation != unsearched[k].orientation
                }
            )
    seen = None if grid_size else infer_grid_size(views)
    shared = None if grid_size or seen else _find_shared_part(views)
    told = (
        grid_size
        if _get_first_tag(infer_pattern(views, pattern)) != _get_first_tag(pattern)
        else None
    )
    if (inferred := seen or shared or told) is not None:
        grid_size, pattern = inferred, infer_pattern(views, pattern)
        again = [
            k for k, view in enumerate(views) if _is_worth_searching_again(view, inferred, pattern)
        ]
        search(again, inferred)
    pattern = infer_pattern(views, pattern)
    if pattern.identifies_points and any(view.corners is not None for view in views):
        read_mirrored = partial(
            search_image or search_view, grid_size=grid_size, method=method, pattern=pattern
        )
        views = _name_mirrored(views, read_mirrored, stop)
    remark = "" if shared is None else _describe_shared_part(shared)
    return Detection(tuple(views), size, grid_size, pattern, remark)


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


def explain_unknown_size(views: Iterable[View], pattern: Pattern) -> CalibrationError | None:
    """Return the error that the images do not tell the size of the board in them: they show parts
    of it only, or end where a grid of circles may go on. None if they do, or no board is seen."""
    views = tuple(views)
    found = [view.corners for view in views if view.corners is not None]
    largest = measure_largest_part(found)
    if largest is None or infer_grid_size(views) or _find_shared_part(views):
        return None
    is_open = any(corners.relative for corners in found)
    rows, cols = largest
    shown = "where the grid ends on all sides" if is_open else "the whole board"
    points = "inner corners" if pattern.has_squares else "circles"
    remedy = (
        f"State the size of the board: {rows} x {cols} if nothing of it lies beyond that part, "
        f"else count its {points}"
    )
    if not pattern.has_squares:
        remedy += " and take pictures that show its whole border"
    return CalibrationError(
        f"No picture shows {shown}, so its size is not known: the largest part seen has {rows} x "
        f"{cols} {points}.",
        f"{remedy}.",
    )


def refuse_unreadable(views: Sequence[View]) -> CalibrationError:
    """Return the error that none of the images can be read."""
    problem = "None of the files can be read as an image."
    return CalibrationError(problem, f"The first: {views[0].reason}")


def infer_grid_size(views: Iterable[View]) -> GridSize | None:
    """Return the most frequent grid size of completely seen boards; of equals, the largest.

    If the corners identify themselves, the largest part seen is taken. A grid of circles counts as
    complete where a few are covered, and as a part where it may go on outside of its image. A size
    is none if more photographs show a part that is larger: a board may look complete where a shadow
    or the image's edge hides its next corners. None if there is no board.
    """
    found = [view.corners for view in views if view.corners is not None]
    if found and all(corners.pattern.identifies_points for corners in found):
        first = _get_first_tag(infer_pattern(views, found[0].pattern))
        return measure_largest_part([c for c in found if _get_first_tag(c.pattern) == first])
    whole = Counter(
        corners.shape
        for corners in found
        if not corners.relative and (corners.complete or not corners.pattern.has_squares)
    )
    for size in sorted(whole, key=lambda size: (whole[size], size[0] * size[1]), reverse=True):
        if sum(_is_larger(corners.shape, size) for corners in found) <= whole[size]:
            return size
    return None


def _is_larger(part: GridSize, size: GridSize) -> bool:
    """Return whether a part has more corners than a board of a size, one way or the other."""
    return any(seen > most for seen, most in zip(sorted(part), sorted(size), strict=True))


def measure_largest_part(found: Sequence[Corners]) -> GridSize | None:
    """Return the most rows and columns seen in parts of a board; None if there are no parts."""
    rows, cols = (max((corners.shape[i] for corners in found), default=0) for i in (0, 1))
    return (rows, cols) if rows and cols else None


def _find_shared_part(views: Iterable[View]) -> GridSize | None:
    """Return the size of the largest part of a board, if many photographs show just that much."""
    parts = [view.corners for view in views if view.corners is not None]
    largest = measure_largest_part(parts)
    shared = sum(corners.shape == largest for corners in parts)
    return largest if shared >= _MIN_PARTS else None


def _describe_shared_part(size: GridSize) -> str:
    counted = f"{size[0]} x {size[1]}"
    return (
        f"No picture shows every corner of the board. It counts as {counted}, the largest part "
        "seen, which several pictures share; state its size if it has more."
    )


def infer_pattern(views: Iterable[View], stated: Pattern) -> Pattern:
    """Return the `stated` pattern, with unknown properties as the images show them."""
    found = [view.corners.pattern for view in views if view.corners is not None]
    return stated.complete_from([pattern for pattern in found if pattern.kind == stated.kind])


def _get_first_tag(pattern: Pattern) -> int:
    """Return the number of the first tag of an AprilGrid; 0 for other boards."""
    return (pattern.first_tag or 0) if isinstance(pattern, AprilGrid) else 0


def _is_worth_searching_again(view: View, grid_size: GridSize, pattern: Pattern) -> bool:
    """Return whether a search for the known board can change the corners of a view."""
    if view.corners is not None:
        is_numbered_alike = _get_first_tag(view.corners.pattern) == _get_first_tag(pattern)
        return view.corners.shape != grid_size or view.corners.relative or not is_numbered_alike
    is_easier = (
        view.roi is not None
        or pattern.identifies_points
        or not pattern.has_squares
        or LIKE_DOTS in view.reason
    )
    return view.status is ViewStatus.NO_BOARD and is_easier


def _record_crash(view: View) -> View:
    reason = "The process that searched it died. Search it again, or leave it out."
    return view.refuse(ViewStatus.UNREADABLE, reason)
