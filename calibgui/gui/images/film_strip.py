"""The film strip: every image with what was found in it and how well it fits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import PurePath

from PySide6.QtCore import (
    QItemSelection,
    QItemSelectionModel,
    QModelIndex,
    QPersistentModelIndex,
    QSortFilterProxyModel,
    Qt,
    Signal,
)
from PySide6.QtGui import QAction, QActionGroup, QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from calibgui.app.projects.project import change_views, remove_views
from calibgui.dataset import Result, View
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.images.film_view import FilmView
from calibgui.gui.images.image_model import Criterion, ImageModel, Role
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import enable_action, make_action
from calibgui.gui.widgets.layouts import make_column

Index = QModelIndex | QPersistentModelIndex


class _Order(QSortFilterProxyModel):
    """Shows the images in the order of `criterion`."""

    criterion = Criterion.NAME

    def __init__(self, model: ImageModel) -> None:
        super().__init__(model)
        self._model = model
        self.setSourceModel(model)
        self.sort_by(Criterion.NAME)
        model.modelAboutToBeReset.connect(lambda: self.sort(-1))
        model.modelReset.connect(self._choose_order)

    def sort_by(self, criterion: Criterion) -> None:
        """Sort by another criterion, and anew when an image changes; only names never do."""
        self.criterion = criterion
        self.setDynamicSortFilter(criterion is not Criterion.NAME)
        self._choose_order()
        self.invalidate()

    def _choose_order(self) -> None:
        """Take the images as they come where that is their order: comparing hundreds is felt."""
        as_they_come = self.criterion is Criterion.NAME and self._model.is_sorted
        self.sort(-1 if as_they_come else 0)

    def lessThan(self, left: Index, right: Index) -> bool:  # noqa: N802 - Qt's name
        key = self._model.sort_key
        return key(left.row(), self.criterion) < key(right.row(), self.criterion)


class FilmStrip(QWidget):
    """The project's images, to look at, sort, exclude, search again and remove.

    Under each image stands its error. A threshold across all is dragged, or moved by the keys Up
    and Down: the images above it are selected, and Space or the words beside it exclude them.
    """

    search_wanted = Signal(list)
    """Images to be searched again."""
    excluded = Signal(str)
    """Images were excluded or included by the edit of this name."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._chosen_above: set[str] = set()
        """Images that the threshold has selected."""
        self._model = ImageModel(session)
        self.thumbnails = self._model.thumbnails
        self._order = _Order(self._model)
        self.list = FilmView(self._model)
        self.list.setModel(self._order)
        self.list.entered.connect(lambda index: session.hover(index.data(Role.PATH)))
        for away in (self.list.viewportEntered, self.list.left):
            away.connect(lambda: session.hover(""))
        self.list.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        self.list.setAccessibleName(self.tr("Images"))
        layout = make_column(
            self.list, of=self, margins=(theme.SPACING, theme.SPACING // 2, theme.SPACING, 0)
        )
        self.setFixedHeight(layout.sizeHint().height())
        self.exclude_above = self.list.words
        self.exclude_above.setToolTip(
            self.tr("Leave the images out whose error is above the threshold")
        )
        self.exclude_above.clicked.connect(lambda: self.exclude(self.above))
        self.follows, self.sorting = self._make_choices()
        self.actions_for_menu = self._make_actions()
        self.list.addActions(self.actions_for_menu)
        self.list.selectionModel().currentChanged.connect(self._current_changed)
        self.list.threshold_dragged.connect(self._threshold_dragged)
        self.list.selectionModel().selectionChanged.connect(self._enable_actions)
        session.changed.connect(self._refresh)
        session.selected.connect(self._show_selected)
        session.result_changed.connect(self._result_changed)
        session.hovered.connect(self._show_hovered)
        self._refresh()
        self._result_changed(session.result)

    def _make_choices(self) -> tuple[QAction, list[QAction]]:
        """Return the choice whether a fit follows, and those of the order."""
        follows = make_action(
            self,
            self.tr("Refit at &once"),
            None,
            self.tr(
                "Calibrate again at once when images are excluded or included. The shown result is "
                "replaced; undo brings it back."
            ),
            lambda: None,
        )
        follows.setCheckable(True)
        follows.setChecked(True)
        group, sorting = QActionGroup(self), []
        for criterion, text in (
            (Criterion.NAME, self.tr("Sort by &name")),
            (Criterion.STATUS, self.tr("Sort by &status")),
            (Criterion.ERROR, self.tr("Sort by lar&gest error")),
        ):
            tip = self.tr("Put the images in this order")
            sort = partial(self._sort_by, criterion)
            sorting.append(make_action(self, text, None, tip, sort))
            sorting[-1].setCheckable(True)
            group.addAction(sorting[-1])
        sorting[0].setChecked(True)
        return follows, sorting

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        colours, painter = theme.current(), QPainter(self)
        painter.fillRect(self.rect(), QColor(colours.base))
        painter.fillRect(0, 0, self.width(), 1, QColor(colours.line))

    @property
    def chosen(self) -> list[str]:
        """The images that are selected in the list."""
        return [index.data(Role.PATH) for index in self.list.selectedIndexes()]

    @property
    def above(self) -> list[str]:
        """The images whose error is above the threshold."""
        return self._model.find_above(self.list.threshold)

    def exclude(self, images: list[str], enabled: bool = False) -> None:
        """Leave images out of the calibration, or take them in again."""
        label = self.tr("Include {0}") if enabled else self.tr("Exclude {0}")
        name = label.format(self._named(images))
        change: Callable[[View], View] = lambda view: replace(view, enabled=enabled)  # noqa: E731
        # The fit that follows continues this very edit, so that one undo takes both back.
        self._session.document.end_sliding_edit()
        self._session.edit(name, lambda p: change_views(p, images, change), sliding=True)
        self.excluded.emit(name)

    def remove(self, images: list[str]) -> None:
        """Take images out of the project; the files stay."""
        label = self.tr("Remove {0}").format(self._named(images))
        self._session.edit(label, lambda p: remove_views(p, images))

    def _named(self, images: list[str]) -> str:
        """One image by name, several by number."""
        one = len(images) == 1
        return PurePath(images[0]).name if one else self.tr("{0} images").format(len(images))

    def _make_actions(self) -> list[QAction]:
        table: list[tuple[str, str | None, str, Callable[[], None]]] = [
            (
                self.tr("Ex&clude or include"),
                "Space",
                self.tr("Leave the selected images out of the calibration, or take them in again."),
                self._toggle,
            ),
            (
                self.tr("&Detect again"),
                "F5",
                self.tr("Forget what was found in the selected images and search them anew."),
                lambda: self.search_wanted.emit(self.chosen),
            ),
            (
                self.tr("&Remove from project"),
                "Del",
                self.tr("Take the selected images out of the project. The files stay."),
                lambda: self.remove(self.chosen),
            ),
        ]
        # Space and Del mean something else in other parts of the window.
        scope = Qt.ShortcutContext
        return [
            make_action(
                self, *row, scope=scope.WindowShortcut if row[1] == "F5" else scope.WidgetShortcut
            )
            for row in table
        ]

    def _enable_actions(self) -> None:
        why = self.tr("No image is selected in the list.")
        is_any_chosen = self.list.selectionModel().hasSelection()
        for action in self.actions_for_menu:
            enable_action(action, is_any_chosen, why)

    def _toggle(self) -> None:
        chosen = set(self.chosen)
        views = [view for view in self._session.project.views if view.image in chosen]
        if views:
            self.exclude([v.image for v in views], enabled=not any(v.enabled for v in views))

    def _result_changed(self, _: Result | None) -> None:
        """Put the threshold above all errors again, and select none by it."""
        if self._chosen_above and set(self.chosen) == self._chosen_above:
            flags = QItemSelectionModel.SelectionFlag.ClearAndSelect
            self.list.selectionModel().select(self.list.currentIndex(), flags)
        self._chosen_above = set()
        self.list.set_threshold(None)
        self._offer_exclusion()
        if self._order.criterion is not Criterion.NAME:
            self.list.scrollTo(self.list.currentIndex())  # it may have another place

    def _offer_exclusion(self) -> None:
        """Say how many images are above the threshold; all of them cannot be excluded."""
        count, error = len(self.above), format_two_digits(self.list.threshold)
        usable = sum(view.usable for view in self._session.project.views)
        text = (
            self.tr("{0} px: {1} above · leave out")
            if 0 < count < usable
            else self.tr("{0} px: all are above")
            if count
            else self.tr("{0} px: none above")
        )
        self.exclude_above.setEnabled(0 < count < usable)
        self.exclude_above.setText(text.format(error, count))
        self.list.place_words()

    def _threshold_dragged(self) -> None:
        self._offer_exclusion()
        self._select_above()

    def _select_above(self) -> None:
        """Select the images above the threshold."""
        above = self._chosen_above = set(self.above)
        chosen = QItemSelection()
        for row in range(self._order.rowCount()):
            index = self._order.index(row, 0)
            if index.data(Role.PATH) in above:
                chosen.select(index, index)
        self.list.selectionModel().select(chosen, QItemSelectionModel.SelectionFlag.ClearAndSelect)

    def _sort_by(self, criterion: Criterion) -> None:
        self._order.sort_by(criterion)
        self.list.horizontalScrollBar().setValue(0)  # the first are what was asked for

    def _current_changed(self, current: QModelIndex) -> None:
        if current.isValid() and current.data(Role.PATH) != self._session.image:
            self._session.select(current.data(Role.PATH))

    def _refresh(self) -> None:
        self._show_selected(self._session.image)
        self._enable_actions()

    def _show_hovered(self, image: str) -> None:
        self.list.show_hovered(image)
        if image and not self.list.underMouse():  # nothing moves under the cursor
            row = self._session.project.find(image)
            self.list.scrollTo(self._order.mapFromSource(self._model.index(row)))

    def _show_selected(self, image: str, _: int = -1) -> None:
        row = self._session.project.find(image)
        index = self._order.mapFromSource(self._model.index(row))
        if index.isValid() and index != self.list.currentIndex():
            flags = QItemSelectionModel.SelectionFlag.ClearAndSelect
            self.list.selectionModel().setCurrentIndex(index, flags)
