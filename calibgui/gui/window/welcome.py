"""The page of an empty window: how to begin."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QEvent, QPointF, QSize, Qt, Signal, SignalInstance
from PySide6.QtGui import QIcon, QImage, QPainter, QPixmap
from PySide6.QtWidgets import (
    QCommandLinkButton,
    QFrame,
    QHBoxLayout,
    QLabel,
    QScrollArea,
    QStyle,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.photographs.image_store import read_thumbnail
from calibgui.app.projects.recent import Recent
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.focus_ring import FocusRing
from calibgui.gui.widgets.icons import Icon, draw_icon
from calibgui.gui.widgets.picture import make_qimage
from calibgui.gui.widgets.wrapped_label import WrappedLabel

_SHOWN = 6
_WIDTH, _RECENT_WIDTH = 520, 340
_PICTURE = QSize(64, 48)
"""A recent project's first image, device-independent px."""


class Welcome(QScrollArea):
    """Drop images, open a folder, open the sample, or a recent project or folder.

    Args:
        jobs: that read the pictures of recent projects.
    """

    folder_wanted = Signal()
    images_wanted = Signal()
    sample_wanted = Signal()
    camera_wanted = Signal()
    board_wanted = Signal()
    recent_wanted = Signal(Path)
    """A recent project's file or folder of images is to be opened."""

    def __init__(self, jobs: Jobs) -> None:
        super().__init__()
        self._jobs = jobs
        title = QLabel(self.tr("Calibrate a camera"))
        font = title.font()
        font.setPixelSize(24)
        font.setBold(True)
        title.setFont(font)
        words = WrappedLabel(
            self.tr(
                "Drop photographs of a flat board here: 10 to 20 of them, the board tilted in "
                "different directions and reaching into the image's corners. Its kind and size are "
                "found. A saved project can be dropped as well."
            )
        )
        words.setAlignment(Qt.AlignmentFlag.AlignCenter)
        words.setMargin(3 * theme.SPACING)
        words.setStyleSheet("border: 2px dashed palette(mid); border-radius: 8px;")
        self.buttons = [
            self._link(
                self.tr("Open a f&older of images"),
                self.tr("Corners are found and the camera is calibrated at once."),
                self.folder_wanted,
            ),
            self._link(
                self.tr("&Photograph live"),
                self.tr("With a camera: it says where to hold the board, and when it is enough."),
                self.camera_wanted,
            ),
            self._link(self.tr("&Add images"), self.tr("Choose single files."), self.images_wanted),
            self._link(
                self.tr("Open the &sample"),
                self.tr("Fourteen rendered photographs, to look around."),
                self.sample_wanted,
            ),
            self._link(
                self.tr("Prin&t a board"),
                self.tr("A checkerboard, or one of the other kinds, in true size."),
                self.board_wanted,
            ),
        ]
        self._restyle()
        column = QWidget()
        column.setMaximumWidth(_WIDTH)
        begin = QVBoxLayout(column)
        begin.setSpacing(theme.SPACING)
        for widget in (title, words, *self.buttons):
            begin.addWidget(widget)
        begin.addStretch(1)
        self._recent_part = QWidget()
        self._recent_part.setFixedWidth(_RECENT_WIDTH)
        self._list = QVBoxLayout(self._recent_part)
        heading = QLabel(self.tr("Recent projects and folders"))
        self._list.addWidget(heading)
        self._list.addStretch(1)
        self.recent: list[QCommandLinkButton] = []
        """Buttons that open what was opened lately, the newest first."""
        body = QWidget()
        layout = QVBoxLayout(body)
        layout.addStretch(1)
        middle = QHBoxLayout()
        middle.addStretch(1)
        middle.addWidget(column, 1000)
        middle.addWidget(self._recent_part)
        middle.addStretch(1)
        layout.addLayout(middle)
        layout.addStretch(2)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidgetResizable(True)
        self.setWidget(body)
        self.show_recent([])

    def show_recent(self, recent: Sequence[Recent]) -> None:
        """Offer these projects and folders, each with its first image."""
        for button in self.recent:
            button.deleteLater()
        self.recent = [self._make_recent(entry) for entry in recent[:_SHOWN]]
        self._recent_part.setVisible(bool(recent))
        for place, button in enumerate(self.recent, start=1):
            self._list.insertWidget(place, button)
        pictured = [
            (button, entry.image)
            for button, entry in zip(self.recent, recent, strict=False)
            if entry.image
        ]
        if pictured:
            self._jobs.each(
                "", pictured, _read_picture, self._show_picture, failed=_leave_icon, owner=self
            )

    def _make_recent(self, entry: Recent) -> QCommandLinkButton:
        path, room = entry.path, _RECENT_WIDTH - _PICTURE.width() - 8 * theme.SPACING
        button = QCommandLinkButton()
        metrics, dots = button.fontMetrics(), Qt.TextElideMode.ElideMiddle
        # The title is in larger letters than the text below it.
        name = metrics.elidedText(path.name, dots, round(0.75 * room))
        button.setText(name.replace("&", "&&"))
        button.setDescription(metrics.elidedText(str(path.parent), dots, room))
        button.setAccessibleName(str(path))
        button.setToolTip(str(path))
        kind = (
            QStyle.StandardPixmap.SP_DirIcon if path.is_dir() else QStyle.StandardPixmap.SP_FileIcon
        )
        button.setIcon(_centre(self.style().standardIcon(kind).pixmap(_PICTURE)))
        button.setIconSize(_PICTURE)
        button.clicked.connect(lambda: self.recent_wanted.emit(path))
        FocusRing(button)
        return button

    def _show_picture(self, pictured: tuple[QCommandLinkButton, str], picture: QImage) -> None:
        button, _ = pictured
        if button not in self.recent:  # others are offered by now
            return
        ratio = self.devicePixelRatio()
        small = picture.scaled(
            _PICTURE * ratio,
            Qt.AspectRatioMode.KeepAspectRatio,
            Qt.TransformationMode.SmoothTransformation,
        )
        pixmap = QPixmap.fromImage(small)
        pixmap.setDevicePixelRatio(ratio)
        button.setIcon(_centre(pixmap))

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802 - Qt's name
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "buttons"):
            self._restyle()

    def _restyle(self) -> None:
        """Draw the icons in the theme's colour."""
        icons = Icon.FOLDER, Icon.CAMERA, Icon.PICTURE, Icon.BOARD, Icon.PRINTER
        for button, icon in zip(self.buttons, icons, strict=True):
            button.setIcon(draw_icon(icon))

    def _link(self, text: str, tip: str, wanted: SignalInstance) -> QCommandLinkButton:
        button = QCommandLinkButton(text, tip)
        button.setMinimumHeight(button.heightForWidth(_WIDTH))
        button.setIconSize(QSize(24, 24))
        button.clicked.connect(lambda: wanted.emit())
        FocusRing(button)
        return button


def _centre(pixmap: QPixmap) -> QIcon:
    """Return an icon of the size of all, so that the texts beside them stand below each other."""
    ratio = pixmap.devicePixelRatio()
    whole = QPixmap(_PICTURE * ratio)
    whole.setDevicePixelRatio(ratio)
    whole.fill(Qt.GlobalColor.transparent)
    size = pixmap.deviceIndependentSize()
    painter = QPainter(whole)
    place = QPointF(_PICTURE.width() - size.width(), _PICTURE.height() - size.height()) / 2
    painter.drawPixmap(place, pixmap)
    painter.end()
    return QIcon(whole)


def _read_picture(pictured: tuple[QCommandLinkButton, str]) -> QImage:
    """Read the small picture of an image; in a worker, which leaves the button alone.

    Raises:
        CalibrationError: if the image cannot be read.
    """
    return make_qimage(read_thumbnail(pictured[1]).grey)


def _leave_icon(_: Exception) -> None:
    """An image that is gone, or cannot be read, is not missed before its project is opened."""
