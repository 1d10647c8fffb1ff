"""Recognition of the board that photographs show, where it is not the one that was looked for.

Nothing may have been said of the board: a plain checkerboard was looked for, and its squares may
bear marks, or nothing was found. Or something wrong was said: the board has another size or is of
another kind. Or the pictures are mirrored, so that no marks can be read.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from threading import Event
from typing import Protocol

from calibgui.app.photographs.detection import Detection, refuse_unreadable, search_view
from calibgui.app.photographs.shared_board import infer_grid_size
from calibgui.app.system.kernel_preparation import prepare_every_finder
from calibgui.app.system.workers import map_in_processes
from calibgui.dataset import View, ViewStatus
from calibgui.engine import detection as detectors
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import CHECKERBOARD, KINDS, Pattern
from calibgui.engine.errors import CalibrationError, UnknownPartError
from calibgui.engine.features import Corners
from calibgui.engine.images import Pixels, read_image
from calibgui.report.boards import name_kind

_KINDS_MARKED_IN_SQUARES = ("charuco", "tagged-checkerboard")
"""Kinds of boards with marks in their squares that a search for plain checkerboards may find."""
_KINDS_MARKED_ON_EDGES = ("puzzleboard",)
"""Kinds of boards with marks on the squares' edges that it may find."""
_FIRST_SAMPLES, _MAX_SAMPLES = 2, 8
"""Numbers of images in which other boards are looked for, which takes a second in each: at first,
and in all if these show none. A hand on a board or a blurred picture may hide what others show."""


class FindBoard(Protocol):
    """A function that searches photographs for a board of a pattern and a size."""

    def __call__(self, pattern: Pattern, grid_size: GridSize | None, /) -> Detection: ...


def explain_missing_board(
    detection: Detection, grid_size: GridSize | None, is_any_looked_for: bool = False
) -> tuple[CalibrationError | None, tuple[View, ...]]:
    """Explain why none of the photographs shows the board, and what they show instead.

    Args:
        detection: what was found of the pattern that was looked for.
        grid_size: of the board, if stated.
        is_any_looked_for: True if boards of all other patterns were looked for as well.

    Returns:
        The error, None if the board was found or no image could be read, and the views with other
        faults than that.
    """
    views, pattern = detection.views, detection.pattern
    if any(view.usable for view in views) or detection.size is None:
        return None, ()
    samples = choose_samples(views)
    if not samples:
        return refuse_unreadable(views), ()
    size = None if grid_size is None else find_grid_size(samples, pattern)
    mirrored = None if size else find_mirrored_pattern(samples)
    is_other_looked_for = not (size or mirrored or is_any_looked_for)
    other = find_other_pattern(samples, pattern) if is_other_looked_for else None
    if grid_size is not None and size is not None:
        problem = (
            f"The images show a board of {_format_size(size)}, not of {_format_size(grid_size)}."
        )
        hint = f"State --board {_format_size(size)}, or leave --board out."
    elif mirrored is not None:
        problem, hint = _describe_mirroring(mirrored)
    elif other is not None:
        problem = f"The images show {name_kind(other)}, not {name_kind(pattern)}."
        hint = f"State --target {other.kind}; if another board is meant, --roi says where it is."
    else:
        problem = "The board was found in none of the images."
        hint = (
            "Photograph the whole board, sharp and evenly lit; state what is printed on it with "
            "--target, or mark its corners with --roi."
        )
    is_explained = any(seen is not None for seen in (size, mirrored, other))
    faults = [v for v in views if not (is_explained and v.status is ViewStatus.NO_BOARD)]
    return CalibrationError(problem, hint), tuple(faults)


def _describe_mirroring(pattern: Pattern) -> tuple[str, str]:
    """Return the problem that the images show a board mirrored, and what to do about it."""
    return (
        f"The images show {name_kind(pattern)} mirrored: left is right.",
        "Turn mirroring off in the camera or in the program that takes the pictures, and take "
        "them again.",
    )


def _format_size(size: GridSize) -> str:
    return f"{size[0]}x{size[1]}"


def choose_samples(views: Iterable[View]) -> list[View]:
    """Return the views in which other boards are looked for where the stated one is in none.

    They are spread over all that were searched: the first one, that in the middle, those between.
    """
    searched = (ViewStatus.FOUND, ViewStatus.NO_BOARD)
    images = [
        View(view.image, orientation=view.orientation, field=view.field)
        for view in views
        if view.status in searched
    ]
    count = min(len(images), _MAX_SAMPLES)
    spread = [k * len(images) // count for k in range(count)]
    first = spread[:: max(1, -(-count // _FIRST_SAMPLES))]
    return [images[k] for k in dict.fromkeys([*first, *spread])]


def find_grid_size(
    images: Sequence[View], pattern: Pattern, stop: Event | None = None
) -> GridSize | None:
    """Return the size of the board that some of the `images` show, None if that is none.

    Raises:
        Cancelled: if `stop` was set.
    """
    found = map_in_processes(partial(search_view, pattern=pattern), images, stop)
    return infer_grid_size(view for _, view in found if isinstance(view, View))


def find_any_board(find: FindBoard, grid_size: GridSize | None) -> Detection:
    """Search photographs for a board of which no kind is stated.

    A plain checkerboard is looked for, and then what else they show. A size may have been stated as
    the board was held; the marks on a board tell its rows from its columns.

    Args:
        find: searches the photographs for a board of a pattern and a size, None for any size.
        grid_size: of the board, if stated.

    Raises:
        CalibrationError: as `recognise_pattern`.
    """
    plain = find(CHECKERBOARD, grid_size)
    other = recognise_pattern(plain.views, grid_size)
    if other is None:
        return plain
    for size in dict.fromkeys((grid_size, grid_size and grid_size[::-1])):
        detection = find(other, size)
        if any(view.usable for view in detection.views):
            return detection
    is_seen_whole = any(view.corners is not None and view.corners.complete for view in plain.views)
    return plain if is_seen_whole else detection


def recognise_pattern(
    views: Sequence[View],
    grid_size: GridSize | None = None,
    stop: Event | None = None,
) -> Pattern | None:
    """Return the pattern that photographs show in which a plain checkerboard was looked for.

    Where one was found it may bear marks, which are read if a look at it shows any; where none was
    found, all other kinds are tried.

    Args:
        views: what was found.
        grid_size: of the board that was looked for, if stated.
        stop: abandons the search for other kinds when set.

    Returns:
        None if it is a plain checkerboard, maybe of another size, or nothing that can be found.

    Raises:
        CalibrationError: one was found whose marks can be read in a mirror only.
        Cancelled: if `stop` was set.
    """
    found = [(view, view.corners) for view in views if view.corners is not None]
    if not found:
        samples = choose_samples(views)
        if grid_size is not None and find_grid_size(samples, CHECKERBOARD, stop) is not None:
            return None
        return find_other_pattern(samples, CHECKERBOARD, stop)
    view, corners = max(found, key=lambda pair: len(pair[1]))
    try:
        marks = detectors.look_for_marks(_read_pixels(view), corners)
    except CalibrationError:  # the file has changed since it was searched
        return None
    kinds = (
        *(_KINDS_MARKED_IN_SQUARES if marks.in_squares else ()),
        *(_KINDS_MARKED_ON_EDGES if marks.on_edges else ()),
    )
    tries = [(view, KINDS[kind]) for kind in kinds]
    for attempt in tries:
        if isinstance(_search_image(attempt), Corners):
            return attempt[1]
    if (mirrored := next(filter(None, map(_search_mirror_image, tries)), None)) is not None:
        raise CalibrationError(*_describe_mirroring(mirrored.pattern))
    return None


def find_other_pattern(
    images: Iterable[View],
    stated: Pattern,
    stop: Event | None = None,
) -> Pattern | None:
    """Return another pattern than `stated` that is found in some of the `images`, else None.

    Of several, the one found in most images is returned, then the one with most corners. If none is
    found, it is the one whose marks were read in most.

    Raises:
        Cancelled: if `stop` was set.
    """
    others = [pattern for pattern in KINDS.values() if pattern.kind != stated.kind]
    return _find_best_pattern(images, others, _search_image, stop)


def find_mirrored_pattern(images: Iterable[View], stop: Event | None = None) -> Pattern | None:
    """Return the pattern whose marks can be read in mirror images of some `images`, else None.

    Programs for video calls mirror pictures, which no mark on a board survives. Patterns without
    marks look alike in a mirror: they are found as they are, and none is returned.

    Raises:
        Cancelled: if `stop` was set.
    """
    marked = [pattern for pattern in KINDS.values() if pattern.identifies_points]
    return _find_best_pattern(images, marked, _search_mirror_image, stop)


def _find_best_pattern(
    images: Iterable[View],
    patterns: Sequence[Pattern],
    search: Callable[[tuple[View, Pattern]], Corners | UnknownPartError | None],
    stop: Event | None,
) -> Pattern | None:
    """Return the pattern that `search` finds in most images, of several that with most corners.

    Only where the first images show none the others are searched. Where all show none, it is the
    one of which `search` reads marks in most images.
    """
    images = list(images)
    found: Counter[str] = Counter()
    corners: Counter[str] = Counter()
    read: Counter[str] = Counter()
    for some in images[:_FIRST_SAMPLES], images[_FIRST_SAMPLES:]:
        tries = [(image, pattern) for image in some for pattern in patterns]
        for i, seen in map_in_processes(search, tries, stop, prepare_every_finder):
            kind = tries[i][1].kind
            if isinstance(seen, Corners):
                found[kind] += 1
                corners[kind] += len(seen)
            read[kind] += isinstance(seen, UnknownPartError)
        if found:
            break
    best = max(+read | found, key=lambda kind: (found[kind], corners[kind], read[kind]), default="")
    return KINDS[best] if best else None


def _read_pixels(view: View) -> Pixels:
    """Read the image of a view as it is searched. Raises CalibrationError as `read_image`."""
    return read_image(view.image, view.orientation, view.field).pixels


def _search_image(attempt: tuple[View, Pattern]) -> Corners | UnknownPartError | None:
    """Search an image; an error says that marks were read which do not tell its corners."""
    view, pattern = attempt
    try:
        return detectors.find_corners(_read_pixels(view), pattern=pattern)
    except UnknownPartError as error:
        return error
    except CalibrationError:
        return None


def _search_mirror_image(attempt: tuple[View, Pattern]) -> Corners | None:
    """Search an image with left and right exchanged; the corners are in that one's frame."""
    view, pattern = attempt
    try:
        return detectors.find_corners(_read_pixels(view)[:, ::-1], pattern=pattern)
    except CalibrationError:
        return None
