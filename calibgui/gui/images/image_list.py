"""The list of images: what was found in each, and how well it fits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import PurePath

from PySide6.QtCore import (
    QItemSelectionModel,
    QModelIndex,
    QPersistentModelIndex,
    QPoint,
    QRect,
    QSize,
    QSortFilterProxyModel,
    Qt,
    Signal,
)
from PySide6.QtGui import QAction, QColor, QFont, QPainter, QPixmap
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QListView,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.project import change_views, remove_views
from calibgui.dataset import View
from calibgui.gui.images.image_model import Criterion, ImageModel, Role
from calibgui.gui.images.thumbnails import THUMBNAIL
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_action

_PAD = 4
_RMS, _BAR = 56, 36
"""Width of the residuals' RMS, and of its bar, px."""
Index = QModelIndex | QPersistentModelIndex


class _Delegate(QStyledItemDelegate):
    """Thumbnail, name over status, and the RMS as a bar with its number."""

    def __init__(self, model: ImageModel) -> None:
        super().__init__(model)
        self._model = model

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:  # noqa: N802, ARG002
        return QSize(180, THUMBNAIL.height() + 2 * _PAD)

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        selected = bool(option.state & QStyle.StateFlag.State_Selected)
        palette, rect = option.palette, option.rect.adjusted(_PAD, _PAD, -_PAD, -_PAD)
        if selected:
            painter.fillRect(option.rect, palette.highlight())
        frame = QRect(rect.topLeft(), THUMBNAIL)
        self._thumbnail(painter, frame, index.data(Qt.ItemDataRole.DecorationRole))

        text = palette.highlightedText().color() if selected else palette.text().color()
        dim = text if selected else QColor(theme.current().muted)
        rms = index.data(Role.RMS)
        words = rect.adjusted(THUMBNAIL.width() + 2 * _PAD, 0, 0, 0)
        if rms is not None:
            self._bar(
                painter,
                QRect(words.right() - _RMS, rect.top(), _RMS, rect.height()),
                rms,
                text,
                selected,
            )
        bold = QFont(option.font)
        bold.setBold(True)
        upper, lower = QRect(words), QRect(words)
        upper.setBottom(words.center().y())
        lower.setTop(words.center().y() + 1)
        if rms is not None:
            upper.setRight(words.right() - _RMS - _PAD)
            lower.setRight(words.right() - _BAR - _PAD)
        painter.setFont(bold)
        painter.setPen(text)
        self._text(painter, upper, index.data(), Qt.TextElideMode.ElideLeft)
        painter.setFont(option.font)
        dot = QRect(lower.left(), lower.center().y() - 4, 8, 8)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(text if selected else index.data(Role.COLOUR))
        painter.drawEllipse(dot)
        painter.setPen(dim)
        self._text(
            painter,
            lower.adjusted(13, 0, 0, 0),
            index.data(Role.STATUS),
            Qt.TextElideMode.ElideRight,
        )
        painter.restore()

    def _thumbnail(self, painter: QPainter, frame: QRect, pixmap: QPixmap | None) -> None:
        painter.fillRect(frame, QColor(theme.current().line))
        if pixmap is not None:
            size = pixmap.size().scaled(frame.size(), Qt.AspectRatioMode.KeepAspectRatio)
            board = QRect(QPoint(), size)
            board.moveCenter(frame.center())
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.drawPixmap(board, pixmap)

    def _bar(
        self, painter: QPainter, rect: QRect, rms: float, text: QColor, selected: bool
    ) -> None:
        colours = theme.current()
        painter.setPen(text)
        upper, lower = QRect(rect), QRect(rect)
        upper.setBottom(rect.center().y())
        top = rect.center().y() + rect.height() // 4 - 3
        lower.setRect(rect.right() - _BAR, top, _BAR, 6)
        painter.drawText(upper, _RIGHT, f"{rms:.3f} px")
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(colours.line))
        painter.drawRoundedRect(lower, 3, 3)
        lower.setWidth(max(6, round(lower.width() * rms / self._model.worst)))
        painter.setBrush(text if selected else QColor(colours.accent))
        painter.drawRoundedRect(lower, 3, 3)

    @staticmethod
    def _text(painter: QPainter, rect: QRect, text: str, elide: Qt.TextElideMode) -> None:
        painter.drawText(rect, _LEFT, painter.fontMetrics().elidedText(text, elide, rect.width()))


_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class _Order(QSortFilterProxyModel):
    """Shows the images in the order of `criterion`."""

    criterion = Criterion.NAME

    def __init__(self, model: ImageModel) -> None:
        super().__init__(model)
        self._model = model
        self.setSourceModel(model)
        self.setDynamicSortFilter(True)
        self.sort(0)

    def lessThan(self, left: Index, right: Index) -> bool:  # noqa: N802 - Qt's name
        key = self._model.sort_key
        return key(left.row(), self.criterion) < key(right.row(), self.criterion)


class ImageList(QWidget):
    """The project's images, to look at, sort, exclude, search again and remove."""

    search_wanted = Signal(list)
    """Images to be searched again."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._model = ImageModel(session)
        self.thumbnails = self._model.thumbnails
        self._order = _Order(self._model)
        self.list = QListView()
        self.list.setModel(self._order)
        self.list.setItemDelegate(_Delegate(self._model))
        self.list.setSelectionMode(QListView.SelectionMode.ExtendedSelection)
        self.list.setUniformItemSizes(True)
        self.list.setVerticalScrollMode(QListView.ScrollMode.ScrollPerPixel)
        self.list.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        self.list.setAccessibleName(self.tr("Images"))
        self.sorting = QComboBox()
        self.sorting.addItems([self.tr("name"), self.tr("status"), self.tr("largest error")])
        self.sorting.currentIndexChanged.connect(self._sort_by)
        label = QLabel(self.tr("Sort b&y"))
        label.setBuddy(self.sorting)
        self.count = QLabel()
        head = QHBoxLayout()
        head.addWidget(self.count, 1)
        head.addWidget(label)
        head.addWidget(self.sorting)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addLayout(head)
        layout.addWidget(self.list, 1)
        self.actions_for_menu = self._make_actions()
        self.list.addActions(self.actions_for_menu)
        self.list.selectionModel().currentChanged.connect(self._current_changed)
        session.changed.connect(self._refresh)
        session.selected.connect(self._show_selected)
        self._refresh()

    @property
    def chosen(self) -> list[str]:
        """The images that are selected in the list."""
        return [index.data(Role.PATH) for index in self.list.selectedIndexes()]

    def exclude(self, images: list[str], enabled: bool = False) -> None:
        """Leave images out of the calibration, or take them in again."""
        label = self.tr("Include {0}") if enabled else self.tr("Exclude {0}")
        change: Callable[[View], View] = lambda view: replace(view, enabled=enabled)  # noqa: E731
        self._session.edit(
            label.format(self._named(images)), lambda p: change_views(p, images, change)
        )

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
        scope = Qt.ShortcutContext.WidgetShortcut
        return [make_action(self, *row, scope=scope) for row in table]

    def _toggle(self) -> None:
        chosen = set(self.chosen)
        views = [view for view in self._session.project.views if view.image in chosen]
        if views:
            self.exclude([v.image for v in views], enabled=not any(v.enabled for v in views))

    def _sort_by(self, criterion: int) -> None:
        self._order.criterion = Criterion(criterion)
        self._order.invalidate()

    def _current_changed(self, current: QModelIndex) -> None:
        if current.isValid() and current.data(Role.PATH) != self._session.image:
            self._session.select(current.data(Role.PATH))

    def _refresh(self) -> None:
        views = self._session.project.views
        self.count.setText(
            self.tr("{0} of {1} usable").format(sum(v.usable for v in views), len(views))
        )
        self._show_selected(self._session.image)

    def _show_selected(self, image: str, _: int = -1) -> None:
        row = self._session.project.find(image)
        index = self._order.mapFromSource(self._model.index(row))
        if index.isValid() and index != self.list.currentIndex():
            flags = QItemSelectionModel.SelectionFlag.ClearAndSelect
            self.list.selectionModel().setCurrentIndex(index, flags)
