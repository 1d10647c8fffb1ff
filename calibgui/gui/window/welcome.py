"""The page of an empty window: how to begin."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QSize, Qt, Signal, SignalInstance
from PySide6.QtWidgets import (
    QCommandLinkButton,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QStyle,
    QVBoxLayout,
    QWidget,
)

from calibgui.gui.widgets import theme

_SHOWN = 5
_WIDTH = 520


class Welcome(QWidget):
    """Drop images, open a folder, open the sample, or a recent project."""

    folder_wanted = Signal()
    images_wanted = Signal()
    sample_wanted = Signal()
    board_wanted = Signal()
    project_wanted = Signal(Path)

    def __init__(self) -> None:
        super().__init__()
        title = QLabel(self.tr("Calibrate a camera"))
        font = title.font()
        font.setPointSizeF(1.8 * font.pointSizeF())
        font.setBold(True)
        title.setFont(font)
        words = QLabel(
            self.tr(
                "Drop photographs of a flat checkerboard here: 10 to 30 of them, all of the "
                "board in view, tilted in different directions, and reaching into the "
                "image's corners. A saved project can be dropped as well."
            )
        )
        words.setWordWrap(True)
        words.setAlignment(Qt.AlignmentFlag.AlignCenter)
        words.setMargin(3 * theme.SPACING)
        words.setStyleSheet("border: 2px dashed palette(mid); border-radius: 8px;")
        icon = QStyle.StandardPixmap
        self.buttons = [
            self._link(
                self.tr("Open a f&older of images"),
                self.tr("Corners are found and the camera is calibrated at once."),
                self.folder_wanted,
                icon.SP_DirOpenIcon,
            ),
            self._link(
                self.tr("&Add images"),
                self.tr("Choose single files."),
                self.images_wanted,
                icon.SP_FileIcon,
            ),
            self._link(
                self.tr("Open the &sample"),
                self.tr("Fourteen rendered photographs, to look around."),
                self.sample_wanted,
                icon.SP_FileDialogContentsView,
            ),
            self._link(
                self.tr("&Print a board"),
                self.tr("A checkerboard, ChArUco board or grid of circles in true size."),
                self.board_wanted,
                icon.SP_FileDialogDetailedView,
            ),
        ]
        column = QWidget()
        column.setMaximumWidth(_WIDTH)
        self._column = QVBoxLayout(column)
        self._column.setSpacing(theme.SPACING)
        for widget in (title, words, *self.buttons):
            self._column.addWidget(widget)
        self._heading = QLabel(self.tr("Recent projects"))
        self._heading.setContentsMargins(0, 2 * theme.SPACING, 0, 0)
        self._column.addWidget(self._heading)
        self._recent: list[QPushButton] = []
        layout = QVBoxLayout(self)
        layout.addStretch(1)
        middle = QHBoxLayout()
        middle.addStretch(1)
        middle.addWidget(column, 1000)
        middle.addStretch(1)
        layout.addLayout(middle)
        layout.addStretch(2)
        self.show_recent([])

    def show_recent(self, projects: Sequence[Path]) -> None:
        """Offer these projects."""
        for button in self._recent:
            button.deleteLater()
        self._recent = []
        self._heading.setVisible(bool(projects))
        for path in projects[:_SHOWN]:
            button = QPushButton(f"{path.parent.name}/{path.name}")
            button.setFlat(True)
            button.setToolTip(str(path))
            button.setCursor(Qt.CursorShape.PointingHandCursor)
            button.setStyleSheet("text-align: left; padding: 4px;")
            button.clicked.connect(lambda _=False, path=path: self.project_wanted.emit(path))
            self._column.addWidget(button)
            self._recent.append(button)

    def _link(
        self, text: str, tip: str, wanted: SignalInstance, icon: QStyle.StandardPixmap
    ) -> QCommandLinkButton:
        button = QCommandLinkButton(text, tip)
        button.setMinimumHeight(button.heightForWidth(_WIDTH))
        button.setIcon(self.style().standardIcon(icon))
        button.setIconSize(QSize(24, 24))
        button.clicked.connect(lambda: wanted.emit())
        return button
