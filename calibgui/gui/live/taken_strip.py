"""The pictures of a capture, the newest first, each of which can be taken back."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize, QSizeF, Qt, Signal
from PySide6.QtGui import QColor, QIcon, QPainter, QPixmap
from PySide6.QtWidgets import QListView, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from calibgui.engine.capture import Picture
from calibgui.gui.live.frame_image import make_frame_image
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.scrolling import make_thin

_THUMBNAIL = QSize(98, 74)
_WIDTH = 136
"""Width of the strip, device-independent px."""
_FINEST = 2
"""Pixels of a thumbnail for a device-independent one."""


class TakenStrip(QWidget):
    """Shows what was taken; one that was taken back stays, pale, and can be taken again."""

    toggle_wanted = Signal(Path)
    """The picture in this file is to be taken back, or again."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(_WIDTH)
        self.list = QListWidget()
        self.list.setFrameShape(QListWidget.Shape.NoFrame)
        make_thin(self.list)
        self.list.setViewMode(QListView.ViewMode.IconMode)
        self.list.setFlow(QListView.Flow.LeftToRight)
        self.list.setMovement(QListView.Movement.Static)
        self.list.setResizeMode(QListView.ResizeMode.Adjust)
        self.list.setIconSize(_THUMBNAIL)
        self.list.setSpacing(4)
        self.list.setAccessibleName(self.tr("Pictures taken"))
        self.toggle = Button(self.tr("&Take back"))
        self.toggle.setEnabled(False)
        self._taken_back: set[Path] = set()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, theme.SPACING)
        column.addWidget(self.list, 1)
        column.addWidget(self.toggle, 0, Qt.AlignmentFlag.AlignHCenter)
        self.list.itemSelectionChanged.connect(self._show_button)
        self.toggle.clicked.connect(self._toggle)

    def add(self, file: Path, picture: Picture) -> None:
        """Show a picture that was taken."""
        words = str(self.list.count() + 1)
        if picture.for_validation:
            words = self.tr("{0} · put aside").format(words)
        item = QListWidgetItem(_draw_thumbnail(picture), words)
        item.setData(Qt.ItemDataRole.UserRole, file)
        item.setToolTip(
            self.tr("{0}: a camera calibrated without it is checked with it as well").format(
                file.name
            )
            if picture.for_validation
            else file.name
        )
        self.list.insertItem(0, item)
        self.list.scrollToTop()

    def list_files(self) -> list[str]:
        """List the files of the pictures that count, the oldest first."""
        items = [self.list.item(k) for k in reversed(range(self.list.count()))]
        files = [item.data(Qt.ItemDataRole.UserRole) for item in items]
        return [str(file) for file in files if file not in self._taken_back]

    def list_taken_back(self) -> list[str]:
        """List the names of the files of the pictures that do not count."""
        return sorted(file.name for file in self._taken_back)

    def clear(self) -> None:
        """Show nothing."""
        self._taken_back.clear()
        self.list.clear()

    def _toggle(self) -> None:
        for item in self.list.selectedItems():
            file = item.data(Qt.ItemDataRole.UserRole)
            self._taken_back ^= {file}
            gone = file in self._taken_back
            item.setForeground(QColor(theme.current().muted if gone else theme.current().text))
            font = item.font()
            font.setStrikeOut(gone)
            item.setFont(font)
            self.toggle_wanted.emit(file)
        self._show_button()

    def _show_button(self) -> None:
        chosen = [item.data(Qt.ItemDataRole.UserRole) for item in self.list.selectedItems()]
        self.toggle.setEnabled(bool(chosen))
        is_gone = bool(chosen) and chosen[0] in self._taken_back
        self.toggle.setText(self.tr("&Take again") if is_gone else self.tr("&Take back"))


def _draw_thumbnail(picture: Picture) -> QIcon:
    """Draw a picture small."""
    found = make_frame_image(picture.frame.image, QSizeF(_THUMBNAIL * _FINEST))
    whole = QPixmap(_THUMBNAIL * _FINEST)
    whole.fill(Qt.GlobalColor.transparent)
    fitted = QPixmap.fromImage(found).scaled(
        whole.size(),
        Qt.AspectRatioMode.KeepAspectRatio,
        Qt.TransformationMode.SmoothTransformation,
    )
    painter = QPainter(whole)
    painter.drawPixmap(
        (whole.width() - fitted.width()) // 2, whole.height() - fitted.height(), fitted
    )
    painter.end()
    whole.setDevicePixelRatio(_FINEST)
    return QIcon(whole)
