"""The project's images as a list for Qt."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import Any, assert_never

from PySide6.QtCore import (
    QAbstractListModel,
    QCoreApplication,
    QModelIndex,
    QPersistentModelIndex,
    Qt,
)
from PySide6.QtGui import QColor

from calibgui.app.photographs.paths import make_natural_key
from calibgui.app.projects.project import Project
from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.boards import Symmetry
from calibgui.gui.images.thumbnails import Thumbnails
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.sizes import set_times_signs

Index = QModelIndex | QPersistentModelIndex


class Role(IntEnum):
    """Roles of the data that the list has of an image beside its name."""

    STATUS = Qt.ItemDataRole.UserRole
    COLOUR = Qt.ItemDataRole.UserRole + 1
    RMS = Qt.ItemDataRole.UserRole + 2
    """Px, of the shown result; None if the view has no part in it."""
    PATH = Qt.ItemDataRole.UserRole + 3
    ENABLED = Qt.ItemDataRole.UserRole + 4
    """True unless the user excluded the image."""
    VIEW_COLOUR = Qt.ItemDataRole.UserRole + 5
    """The colour that the view has in every plot."""


class Criterion(IntEnum):
    """Criteria to sort images by."""

    NAME = 0
    STATUS = 1
    ERROR = 2


def status_text(view: View) -> str:
    """The state of an image in a few words."""
    translate = QCoreApplication.translate
    words = {
        ViewStatus.WAITING: translate("status_text", "not searched"),
        ViewStatus.NO_BOARD: translate("status_text", "no board"),
        ViewStatus.UNREADABLE: translate("status_text", "unreadable"),
        ViewStatus.WRONG_SIZE: translate("status_text", "wrong size"),
        ViewStatus.FOUND: translate("status_text", "found"),
    }
    text = words[view.status]
    if view.corners is not None:
        rows, cols = view.corners.shape
        ambiguous = view.corners.ambiguity is not Symmetry.NONE or view.corners.relative
        text = (
            translate("status_text", "{0} of {1}, ambiguous")
            if ambiguous
            else translate("status_text", "{0} of {1} corners")
        ).format(len(view.corners), rows * cols)
    elif view.points is not None:
        text = translate("status_text", "{0} corners").format(len(view.points.uv))
    return text if view.enabled else translate("status_text", "excluded")


def status_tip(view: View) -> str:
    """The state of an image in sentences."""
    tip = view.why_unused or status_text(view)
    if view.note:
        tip += "\n" + view.note
    if view.corners is not None and view.corners.relative:
        tip += "\n" + QCoreApplication.translate(
            "status_tip", "Which part of the board is seen cannot be decided from it."
        )
    if view.corners is not None and view.corners.ambiguity is not Symmetry.NONE:
        turn = "180°" if view.corners.ambiguity is Symmetry.HALF_TURN else "90°"
        tip += "\n" + QCoreApplication.translate(
            "status_tip", "A turn of the board by {0} cannot be seen in its pattern."
        ).format(turn)
    for rows, cols in [] if view.corners is None else [o.shape for o in view.corners.others]:
        tip += "\n" + QCoreApplication.translate(
            "status_tip", "Another board is seen here, of {0} × {1} inner corners."
        ).format(rows, cols)
    return f"{view.image}\n{set_times_signs(tip)}"


class ImageModel(QAbstractListModel):
    """Follows the session; thumbnails are read in the background."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._session = session
        self._views = session.project.views
        self._places = _rank_by_name(self._views)
        self._rms: dict[str, float] = {}
        self.thumbnails = Thumbnails(session)
        self.thumbnails.read.connect(self._show_picture)
        session.changed.connect(self._project_changed)
        session.result_changed.connect(self._result_changed)

    @property
    def worst(self) -> float:
        """The largest RMS of any view, px; 0 without a result."""
        return max(self._rms.values(), default=0.0)

    def find_above(self, error: float) -> list[str]:
        """Return the images whose RMS is larger than `error` px, in the project's order."""
        images = (view.image for view in self._views)
        return [image for image in images if self._rms.get(image, 0.0) > error]

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: N802, B008 - Qt's signature
        return 0 if parent.isValid() else len(self._views)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        view = self._views[index.row()]
        match role:
            case Qt.ItemDataRole.DisplayRole:
                return view.name
            case Qt.ItemDataRole.DecorationRole:
                return self.thumbnails.picture(view.image)
            case Qt.ItemDataRole.ToolTipRole:
                return self._tip(view)
            case Qt.ItemDataRole.AccessibleTextRole:
                return self._spoken(view)
            case Role.STATUS:
                return self._status(view)
            case Role.COLOUR:
                return self._colour(view)
            case Role.RMS:
                return self._rms.get(view.image)
            case Role.PATH:
                return view.image
            case Role.ENABLED:
                return view.enabled
            case Role.VIEW_COLOUR:
                return theme.view_colour(index.row())
        return None

    def _status(self, view: View) -> str:
        text = status_text(view)
        return self.tr("changed · {0}").format(text) if self._altered(view) else text

    def _spoken(self, view: View) -> str:
        """Return what a screen reader says of an image."""
        text = f"{view.name}, {self._status(view)}"
        rms = self._rms.get(view.image)
        return text if rms is None else self.tr("{0}, error {1:.3f} px").format(text, rms)

    def _tip(self, view: View) -> str:
        tip = status_tip(view)
        if self._altered(view):
            tip += "\n" + self.tr(
                "The file has changed since its corners were found: detect again."
            )
        return tip

    def _altered(self, view: View) -> bool:
        return view.status is not ViewStatus.WAITING and self.thumbnails.altered(view.image)

    def _colour(self, view: View) -> QColor:
        colours = theme.current()
        if not view.enabled or view.status is ViewStatus.WAITING:
            return QColor(colours.muted)
        if self._altered(view):
            return QColor(colours.warning)
        return QColor(colours.good if view.status is ViewStatus.FOUND else colours.bad)

    @property
    def is_sorted(self) -> bool:
        """True if the images stand in the order of their names, as those of one folder do."""
        return all(place == row for row, place in enumerate(self._places))

    def sort_key(self, row: int, criterion: Criterion) -> tuple[object, ...]:
        """Key of an image among the others; equal ones stand in the order of their names."""
        view, place = self._views[row], self._places[row]
        match criterion:
            case Criterion.STATUS:
                return (self._status(view), place)
            case Criterion.ERROR:
                return (-self._rms.get(view.image, -1.0), place)
            case Criterion.NAME:
                return (place,)
            case _:
                assert_never(criterion)

    def _project_changed(self, _: Project, after: Project) -> None:
        before, self._views = self._views, after.views
        same = len(before) == len(after.views) and all(
            a.image == b.image for a, b in zip(before, after.views, strict=True)
        )
        if not same:
            self.beginResetModel()
            self._places = _rank_by_name(self._views)
            self.endResetModel()
            self.thumbnails.read_new()
            return
        for row, (a, b) in enumerate(zip(before, after.views, strict=True)):
            if a is not b:
                self.dataChanged.emit(self.index(row), self.index(row))

    def _result_changed(self, result: Result | None) -> None:
        self._rms = {}
        if result is not None:
            pairs = zip(result.used, result.calibration.residuals, strict=True)
            self._rms = {view.image: residuals.rms for view, residuals in pairs}
        if self._views:
            self.dataChanged.emit(self.index(0), self.index(len(self._views) - 1))

    def _show_picture(self, image: str) -> None:
        if (row := self._session.project.find(image)) >= 0:
            self.dataChanged.emit(self.index(row), self.index(row))


def _rank_by_name(views: Sequence[View]) -> list[int]:
    """Return the place of each image in the order of their names."""
    order = sorted(range(len(views)), key=lambda row: make_natural_key(views[row].image))
    places = [0] * len(views)
    for place, row in enumerate(order):
        places[row] = place
    return places
