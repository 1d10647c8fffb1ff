"""A project: images, board, settings and named results, as one frozen record.

All else that the window shows (the inferred board, the number of usable views, which results are
out of date) follows from the project and is computed, not stored.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property
from types import MappingProxyType

from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.shared_board import (
    explain_unknown_size,
    infer_grid_size,
    infer_pattern,
    measure_largest_part,
)
from calibgui.dataset import DEFAULT_SQUARE, CornerSet, KnownCamera, Result, View, ViewStatus
from calibgui.dataset.details import NO_DETAILS, Details
from calibgui.dataset.limits import Limits
from calibgui.engine.arrays import GridSize, Size
from calibgui.engine.boards import CHECKERBOARD, Board, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import METHODS
from calibgui.engine.images import Field

GRID_LINES = range(2, 201)
"""Numbers of rows, and of columns, that a board can be stated to have."""


class Unit(StrEnum):
    """Unit in which the user states the side of a square; it is kept in mm."""

    MM = "mm"
    CM = "cm"
    INCH = "inch"

    @property
    def mm(self) -> float:
        """Length of the unit, mm."""
        return {"mm": 1.0, "cm": 10.0, "inch": 25.4}[self]


@dataclass(frozen=True, eq=False)
class Project:
    """Images of a board, the corners found in them, and the calibrations from these."""

    views: tuple[View, ...] = ()
    """One view per image, with its absolute path."""
    size: Size | None = None
    """Width and height of the images, px; None until one has been read."""
    pattern: Pattern = CHECKERBOARD
    """Pattern of the board, as stated by the user."""
    grid_size: GridSize | None = None
    """Rows and columns of inner corners or circles as stated by the user; inferred if None."""
    method: str = METHODS[0]
    """Method of locating corners, one of ``features.METHODS``."""
    square: float = DEFAULT_SQUARE
    """Side of a square, mm."""
    square_sigma: float = 0.0
    """Standard deviation of the side, mm, common to all squares; 0 if it counts as exact."""
    unit: Unit = Unit.MM
    by_hand: bool = False
    """True if the user marks every board: images are searched only where that is asked for."""
    details: Details = NO_DETAILS
    """What a person states of the calibration, for its report."""
    lengths_confirmed: bool = False
    """True once the user has stated the side of a square, or confirmed it."""
    limits: Limits | None = None
    """Limits that the camera has to keep; None if nothing is demanded."""
    settings: Settings = field(default_factory=Settings)
    results: Mapping[str, Result] = field(default_factory=lambda: MappingProxyType({}))
    """Results by name, the oldest first."""
    settings_of_results: Mapping[str, Settings] = field(
        default_factory=lambda: MappingProxyType({})
    )
    """Settings by which results were made, by name, as far as they are known."""
    digests: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    """SHA-256 of the image files that have been read, by path."""
    field: Field | None = None
    """The field of interlaced frames that is searched; None for all rows."""

    @cached_property
    def board(self) -> Board | None:
        """The board as stated or as seen, inferred from all views once; None while nothing is known
        of it."""
        found = [view.corners for view in self.views if view.corners is not None]
        grid_size = self.grid_size or infer_grid_size(self.views) or measure_largest_part(found)
        pattern = infer_pattern(self.views, self.pattern)
        if grid_size is None:
            return None
        return Board(*grid_size, self.square, pattern, self.square_sigma)

    @property
    def corner_set(self) -> CornerSet | None:
        """The views and the board that a calibration is made from; None while no image's size is
        known."""
        if self.size is None:
            return None
        return CornerSet(self.size, self.views, self.board, self.lengths_confirmed)

    @cached_property
    def grid_size_doubt(self) -> CalibrationError | None:
        """The doubt about how many rows and columns a board has of which parts are seen;
        None if it is stated or seen, or no board is found. The board counts as its largest part
        for what is shown, and nothing is calibrated."""
        if self.grid_size is not None:
            return None
        return explain_unknown_size(self.views, self.pattern)

    @property
    def confirmed_image_size(self) -> Size | None:
        """Width and height of the images, px, once one of them shows the board; None before, as
        images of another size may turn out to be those that are meant."""
        is_seen = any(view.status is ViewStatus.FOUND for view in self.views)
        return self.size if is_seen else None

    @cached_property
    def usable(self) -> tuple[View, ...]:
        """Views that a calibration would use."""
        return tuple(view for view in self.views if view.usable)

    def is_current(self, result: Result) -> bool:
        """Return whether `result` is from views, board and settings as they are now."""
        return self.has_views_of(result) and self.has_settings_of(result)

    def has_views_of(self, result: Result) -> bool:
        """Return whether `result` is from the views and the board as they are now."""
        used, now = result.used, self.usable
        same = len(used) == len(now) and all(a is b for a, b in zip(used, now, strict=True))
        return same and result.board == self.board

    def has_settings_of(self, result: Result) -> bool:
        """Return whether `result` was made by the settings as they are now, or by unknown ones."""
        names = (name for name, other in self.results.items() if other is result)
        return self.settings_of_results.get(next(names, ""), self.settings) == self.settings

    def find(self, image: str) -> int:
        """Return the index of the view of `image`; -1 if there is none."""
        return next((k for k, view in enumerate(self.views) if view.image == image), -1)


def set_pattern(project: Project, pattern: Pattern) -> Project:
    """Return the project with another pattern, for which all images are to be searched again.

    The grid size is dropped if the kind of pattern is another one.
    """
    grid_size = project.grid_size if pattern.kind == project.pattern.kind else None
    return replace(
        project, pattern=pattern, grid_size=grid_size, views=_reset_searches(project.views)
    )


def take_pattern(project: Project, pattern: Pattern) -> Project:
    """Return the project with another pattern, without results from corners that were taken for
    the one before."""
    for name, result in project.results.items():
        if project.has_views_of(result):
            project = remove_result(project, name)
    return set_pattern(project, pattern)


def set_grid_size(project: Project, grid_size: GridSize | None) -> Project:
    """Return the project with a stated number of rows and columns, None to count them.

    Images whose corners are of another board, or of a part that may be the whole of this one, and
    those that showed none are to be searched again.
    """

    def fits(view: View) -> bool:
        corners = view.corners
        is_alike = corners is not None and corners.shape == grid_size and not corners.relative
        return corners is not None and (grid_size is None or is_alike)

    views = (view if fits(view) else _reset_search(view) for view in project.views)
    return replace(project, grid_size=grid_size, views=tuple(views))


def hold_known(project: Project, known: KnownCamera | None) -> Project:
    """Return the project with a camera that is held; None for one that is to be calibrated."""
    return replace(project, settings=replace(project.settings, known=known))


def set_method(project: Project, method: str) -> Project:
    """Return the project with another method of locating corners: images are searched again."""
    return replace(project, method=method, views=_reset_searches(project.views))


def set_field(project: Project, field: Field | None) -> Project:
    """Return the project with another field of interlaced frames: images are searched again."""
    views = tuple(replace(view, field=field) for view in _reset_searches(project.views))
    return replace(project, field=field, views=views)


def _reset_searches(views: Iterable[View]) -> tuple[View, ...]:
    """Return the views without the outcome of a search."""
    return tuple(map(_reset_search, views))


def _reset_search(view: View) -> View:
    """Return a view that is to be searched again, unless another program located its corners."""
    searched = view.status in (ViewStatus.FOUND, ViewStatus.NO_BOARD)
    if view.points is not None or not searched:
        return view
    return replace(view, status=ViewStatus.WAITING, reason="", corners=None)


def set_limits(project: Project, limits: Limits | None) -> Project:
    """Return the project with other demands on its camera, in its results too."""
    results = {name: replace(result, limits=limits) for name, result in project.results.items()}
    return replace(project, limits=limits, results=MappingProxyType(results))


def add_images(project: Project, images: Iterable[str]) -> Project:
    """Return the project with views of those `images` that it lacks, in the order given."""
    known = {view.image for view in project.views}
    new = [image for image in dict.fromkeys(images) if image not in known]
    added = (View(image, field=project.field) for image in new)
    return replace(project, views=(*project.views, *added))


def remove_views(project: Project, images: Iterable[str]) -> Project:
    """Return the project without the views of `images`."""
    gone = set(images)
    views = tuple(view for view in project.views if view.image not in gone)
    return replace(project, views=views, size=project.size if views else None)


def change_views(
    project: Project, images: Iterable[str], change: Callable[[View], View]
) -> Project:
    """The project with the views of `images` changed."""
    chosen = set(images)
    views = tuple(change(view) if view.image in chosen else view for view in project.views)
    return replace(project, views=views)


def add_result(project: Project, name: str, result: Result) -> Project:
    """Return the project with `result` under `name`, as the newest, from unknown settings."""
    project = remove_result(project, name)
    return replace(project, results=MappingProxyType({**project.results, name: result}))


def record_result(project: Project, name: str, inputs: Sequence[View], result: Result) -> Project:
    """Return the project with the `result` of a calibration by its settings from views `inputs`.

    Outliers that the calibration left out are left out of the project's views as well: there the
    user sees it, and undo restores them.
    """
    pairs = zip(inputs, result.views, strict=True)
    screened = {id(before): after for before, after in pairs if before is not after}
    if screened:
        views = tuple(screened.get(id(view), view) for view in project.views)
        project = replace(project, views=views)
    result = replace(result, lengths_confirmed=project.lengths_confirmed, limits=project.limits)
    project = add_result(project, name, result)
    settings = {**project.settings_of_results, name: project.settings}
    return replace(project, settings_of_results=MappingProxyType(settings))


def remove_result(project: Project, name: str) -> Project:
    """Return the project without the result of that name."""
    return _name_results(project, {key: key for key in project.results if key != name})


def rename_result(project: Project, old: str, new: str) -> Project:
    """Return the project with the result `old` under the name `new`, at its place."""
    return _name_results(project, {key: new if key == old else key for key in project.results})


def _name_results(project: Project, names: Mapping[str, str]) -> Project:
    """Return the project with those of its results that have new names, under these."""
    results = {new: project.results[old] for old, new in names.items()}
    known = project.settings_of_results
    settings = {new: known[old] for old, new in names.items() if old in known}
    return replace(
        project,
        results=MappingProxyType(results),
        settings_of_results=MappingProxyType(settings),
    )


def add_digests(project: Project, digests: Mapping[str, str]) -> Project:
    """Return the project with the SHA-256 of more images."""
    return replace(project, digests=MappingProxyType({**project.digests, **digests}))


def remove_digests(project: Project, images: Iterable[str]) -> Project:
    """Return the project without the SHA-256 of `images`."""
    gone = set(images)
    digests = {image: digest for image, digest in project.digests.items() if image not in gone}
    return replace(project, digests=MappingProxyType(digests))


def relocate_images(project: Project, moved: Mapping[str, str]) -> Project:
    """Return the project with images under new paths, in the results too."""

    def view_at(view: View) -> View:
        return replace(view, image=moved[view.image]) if view.image in moved else view

    # A view that a result shares with the project must remain the same object.
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


def find_free_name(project: Project, stem: str) -> str:
    """Return `stem` with the lowest number that no result has."""
    count = 1
    while f"{stem} {count}" in project.results:
        count += 1
    return f"{stem} {count}"
