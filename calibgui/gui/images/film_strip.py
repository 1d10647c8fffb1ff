"""The film strip: every image with what was found in it and how well it fits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import PurePath

import numpy as np
from PySide6.QtCore import (
    QItemSelection,
    QItemSelectionModel,
    QModelIndex,
    QPersistentModelIndex,
    QSortFilterProxyModel,
    Qt,
    Signal,
)
from PySide6.QtGui import QAction, QResizeEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QWidget,
)

from calibgui.app.projects.project import change_views, remove_views
from calibgui.dataset import Result, View
from calibgui.gui.images.film_view import Cell, FilmView
from calibgui.gui.images.image_model import Criterion, ImageModel, Role
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import enable_action, make_action
from calibgui.gui.widgets.number_box import fit_width

_LEAST_IMAGES = 3
"""Number of images below which a strip has no room for its controls."""
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

    Under each image stands its error. A threshold across all is dragged or typed: the images above
    it are selected, and Space or a button excludes them.
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
        layout = QHBoxLayout(self)
        layout.setContentsMargins(theme.SPACING, 0, 0, 0)
        self.controls = QWidget()
        self.controls.setLayout(self._make_controls())
        layout.addWidget(self.controls)
        layout.addWidget(self.list, 1)
        self.setFixedHeight(layout.sizeHint().height())
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

    def _make_controls(self) -> QGridLayout:
        self.count = QLabel()
        self.follows = QCheckBox(self.tr("Refit at once"))
        self.follows.setChecked(True)
        self.follows.setToolTip(
            self.tr(
                "Calibrate again at once when images are excluded or included. The shown result is "
                "replaced; undo brings it back."
            )
        )
        self.sorting = QComboBox()
        self.sorting.addItems([self.tr("name"), self.tr("status"), self.tr("largest error")])
        self.sorting.currentIndexChanged.connect(self._sort_by)
        self.threshold = QDoubleSpinBox(
            decimals=4, prefix=self.tr("Threshold "), suffix=self.tr(" px")
        )
        self.threshold.setAccessibleName(self.tr("Threshold"))
        self.threshold.setStepType(QDoubleSpinBox.StepType.AdaptiveDecimalStepType)
        self.threshold.setMaximum(1e6)
        fit_width(self.threshold, self.tr("Threshold 100.000 px"))
        self.threshold.setToolTip(
            self.tr(
                "Images whose RMS residual is larger are selected. Drag the line across the bars "
                "to change it."
            )
        )
        self.threshold.valueChanged.connect(self._threshold_typed)
        self.exclude_above = QPushButton(self._describe_exclusion(100))
        self.exclude_above.setMinimumWidth(self.exclude_above.sizeHint().width())
        self.exclude_above.setToolTip(
            self.tr("Leave the images out whose error is above the threshold")
        )
        self.exclude_above.clicked.connect(lambda: self.exclude(self.above))
        sort_by = QLabel(self.tr("Sort b&y"))
        sort_by.setBuddy(self.sorting)
        grid = QGridLayout()
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(2)
        grid.addWidget(self.count, 0, 0)
        grid.addWidget(self.follows, 0, 1)
        grid.addWidget(sort_by, 1, 0)
        grid.addWidget(self.sorting, 1, 1)
        grid.addWidget(self.threshold, 2, 0)
        grid.addWidget(self.exclude_above, 2, 1)
        return grid

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        """Leave a strip that is too narrow for both to the images."""
        super().resizeEvent(event)
        room = event.size().width() - self.controls.sizeHint().width()
        self.controls.setVisible(room >= _LEAST_IMAGES * Cell.SIZE.width())

    def list_stops(self) -> list[QWidget]:
        """Return what the Tab key stops at, in this order."""
        return [self.follows, self.sorting, self.threshold, self.exclude_above, self.list]

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
        top = self.list.top
        self.list.set_threshold(None)
        if top > 0:  # three digits of the largest error are as fine as it can be dragged
            self.threshold.blockSignals(True)  # the last threshold, rounded, is nobody's choice
            self.threshold.setDecimals(int(np.clip(2 - np.floor(np.log10(top)), 1, 4)))
            self.threshold.blockSignals(False)
        self._show_threshold(top)
        self.threshold.setEnabled(top > 0)
        if self._order.criterion is not Criterion.NAME:
            self.list.scrollTo(self.list.currentIndex())  # it may have another place

    def _show_threshold(self, error: float) -> None:
        """Show the threshold as a number, and what excluding by it would do."""
        self.threshold.blockSignals(True)
        self.threshold.setValue(error)
        self.threshold.blockSignals(False)
        self._offer_exclusion()

    def _offer_exclusion(self) -> None:
        """Say how many images are above the threshold; all of them cannot be excluded."""
        count = len(self.above)
        usable = sum(view.usable for view in self._session.project.views)
        self.exclude_above.setEnabled(0 < count < usable)
        self.exclude_above.setText(self._describe_exclusion(count))

    def _describe_exclusion(self, count: int) -> str:
        return self.tr("E&xclude above: {0}").format(count) if count else self.tr("None above")

    def _threshold_typed(self, error: float) -> None:
        self.list.set_threshold(error)
        self._offer_exclusion()  # the box is left alone: more digits may be about to come
        self._select_above()

    def _threshold_dragged(self, error: float) -> None:
        self._show_threshold(error)
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

    def _sort_by(self, criterion: int) -> None:
        self._order.sort_by(Criterion(criterion))
        self.list.horizontalScrollBar().setValue(0)  # the first are what was asked for

    def _current_changed(self, current: QModelIndex) -> None:
        if current.isValid() and current.data(Role.PATH) != self._session.image:
            self._session.select(current.data(Role.PATH))

    def _refresh(self) -> None:
        views = self._session.project.views
        self.count.setText(
            self.tr("{0} of {1} usable").format(sum(v.usable for v in views), len(views))
        )
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
