"""What the user works on: images, board, settings and named results, as one frozen record.

Everything else that the window shows (which board, how many views are usable, whether a result
is out of date) follows from it and is computed, not stored.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from types import MappingProxyType

from calibgui.app.detection import largest_part, usual_board, usual_pattern
from calibgui.app.settings import Settings
from calibgui.dataset.result import Result
from calibgui.dataset.view import View, ViewStatus
from calibgui.engine.arrays import GridSize, Size
from calibgui.engine.boards import CHECKERBOARD, KINDS, Board, Charuco, Circles, Pattern
from calibgui.engine.detection import METHODS
from calibgui.engine.errors import CalibrationError

DEFAULT_SQUARE = 30.0
"""Side of a square until the user states it, mm. Only the poses' lengths depend on it."""


class Unit(StrEnum):
    """In which the user states the side of a square; kept in mm."""

    MM = "mm"
    CM = "cm"
    INCH = "inch"

    @property
    def mm(self) -> float:
        """Its length, mm."""
        return {"mm": 1.0, "cm": 10.0, "inch": 25.4}[self]


@dataclass(frozen=True, eq=False, slots=True)
class Project:
    """Images of a board, what was found in them and what was made of it."""

    views: tuple[View, ...] = ()
    """One per image, under its absolute path."""
    size: Size | None = None
    """Width and height of the images, px; None until one has been read."""
    pattern: Pattern = CHECKERBOARD
    """What is printed on the target, as stated by the user."""
    grid_size: GridSize | None = None
    """Rows and columns of inner corners or circles as stated by the user; inferred if None."""
    method: str = METHODS[0]
    """Of locating corners, one of ``corners.METHODS``."""
    square: float = DEFAULT_SQUARE
    """Side of a square, mm."""
    unit: Unit = Unit.MM
    settings: Settings = field(default_factory=Settings)
    results: Mapping[str, Result] = field(default_factory=lambda: MappingProxyType({}))
    """By name, oldest first."""
    digests: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    """SHA-256 of the image files, by path, as far as they have been read."""

    @property
    def board(self) -> Board | None:
        """The board as stated or as seen; None while nothing is known of it."""
        found = [view.corners for view in self.views if view.corners is not None]
        grid_size = self.grid_size or usual_board(self.views) or largest_part(found)
        pattern = usual_pattern(self.views, self.pattern)
        return None if grid_size is None else Board(*grid_size, self.square, pattern)

    @property
    def usable(self) -> tuple[View, ...]:
        """The views that a calibration would use."""
        return tuple(view for view in self.views if view.usable)

    def is_current(self, result: Result) -> bool:
        """Whether `result` answers the views as they are now."""
        used, now = result.used, self.usable
        same = len(used) == len(now) and all(a is b for a, b in zip(used, now, strict=True))
        return same and result.board == self.board

    def find(self, image: str) -> int:
        """Place of the view of `image`; -1 if there is none."""
        return next((k for k, view in enumerate(self.views) if view.image == image), -1)


def with_square(project: Project, square: float) -> Project:
    """The project with squares (or distances of circles) of `square` mm; what else is printed
    keeps its size, or is to be found out if it does not fit."""
    ratio = project.square / square
    try:
        pattern = _scaled(project.pattern, ratio)
    except CalibrationError:
        pattern = KINDS[project.pattern.kind]
    return replace(project, square=square, pattern=pattern)


def _scaled(pattern: Pattern, ratio: float) -> Pattern:
    """The pattern with its own lengths times `ratio`. Raises CalibrationError for none."""
    if isinstance(pattern, Charuco) and pattern.marker is not None:
        return replace(pattern, marker=pattern.marker * ratio)
    if isinstance(pattern, Circles) and pattern.diameter is not None:
        return replace(pattern, diameter=pattern.diameter * ratio)
    return pattern


def with_pattern(project: Project, pattern: Pattern) -> Project:
    """The project with another pattern: what was found of the one before is searched anew.

    The size of a board of another kind does not stay.
    """
    grid_size = project.grid_size if pattern.kind == project.pattern.kind else None
    return replace(project, pattern=pattern, grid_size=grid_size, views=_waiting(project.views))


def with_method(project: Project, method: str) -> Project:
    """The project with corners located in another way: all are searched anew."""
    return replace(project, method=method, views=_waiting(project.views))


def _waiting(views: Iterable[View]) -> tuple[View, ...]:
    """The views without what a search made of them."""

    def again(view: View) -> View:
        searched = view.status in (ViewStatus.FOUND, ViewStatus.NO_BOARD)
        if view.points is not None or not searched:
            return view
        return replace(view, status=ViewStatus.WAITING, reason="", corners=None)

    return tuple(map(again, views))


def with_images(project: Project, images: Iterable[str]) -> Project:
    """The project with views of those `images` that it does not have, in the order given."""
    known = {view.image for view in project.views}
    new = [image for image in dict.fromkeys(images) if image not in known]
    return replace(project, views=(*project.views, *map(View, new)))


def without_views(project: Project, images: Iterable[str]) -> Project:
    """The project without the views of `images`."""
    gone = set(images)
    views = tuple(view for view in project.views if view.image not in gone)
    return replace(project, views=views, size=project.size if views else None)


def with_each(project: Project, images: Iterable[str], change: Callable[[View], View]) -> Project:
    """The project with the views of `images` changed."""
    chosen = set(images)
    views = tuple(change(view) if view.image in chosen else view for view in project.views)
    return replace(project, views=views)


def with_result(project: Project, name: str, result: Result) -> Project:
    """The project with `result` under `name`, as the newest."""
    others = {key: value for key, value in project.results.items() if key != name}
    return replace(project, results=MappingProxyType({**others, name: result}))


def answered(project: Project, name: str, asked: Sequence[View], result: Result) -> Project:
    """The project with the `result` of a calibration from the views `asked`.

    What the calibration left out as outliers is left out of the project's views as well: there
    it is seen, and undo brings it back.
    """
    pairs = zip(asked, result.views, strict=True)
    screened = {id(before): after for before, after in pairs if before is not after}
    if screened:
        views = tuple(screened.get(id(view), view) for view in project.views)
        project = replace(project, views=views)
    return with_result(project, name, result)


def without_result(project: Project, name: str) -> Project:
    """The project without the result of that name."""
    others = {key: value for key, value in project.results.items() if key != name}
    return replace(project, results=MappingProxyType(others))


def renamed_result(project: Project, old: str, new: str) -> Project:
    """The project with the result `old` called `new`, at its place."""
    results = {new if key == old else key: value for key, value in project.results.items()}
    return replace(project, results=MappingProxyType(results))


def with_digests(project: Project, digests: Mapping[str, str]) -> Project:
    """The project with the SHA-256 of more images."""
    return replace(project, digests=MappingProxyType({**project.digests, **digests}))


def without_digests(project: Project, images: Iterable[str]) -> Project:
    """The project that does not say what the files of `images` held."""
    gone = set(images)
    digests = {image: digest for image, digest in project.digests.items() if image not in gone}
    return replace(project, digests=MappingProxyType(digests))


def relocated(project: Project, moved: Mapping[str, str]) -> Project:
    """The project with images under new paths; results follow."""

    def view_at(view: View) -> View:
        return replace(view, image=moved[view.image]) if view.image in moved else view

    # A view that a result shares with the project must go on being the same object.
    renewed: dict[int, View] = {}

    def views_at(views: Sequence[View]) -> tuple[View, ...]:
        return tuple(renewed.setdefault(id(view), view_at(view)) for view in views)

    return replace(
        project,
        views=views_at(project.views),
        results=MappingProxyType(
            {
                name: replace(result, views=views_at(result.views))
                for name, result in project.results.items()
            }
        ),
        digests=MappingProxyType({moved.get(k, k): v for k, v in project.digests.items()}),
    )


def free_name(project: Project, stem: str) -> str:
    """`stem` with the lowest number that no result has."""
    count = 1
    while f"{stem} {count}" in project.results:
        count += 1
    return f"{stem} {count}"
