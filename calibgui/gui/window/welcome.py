"""The page of an empty window: how to begin, and with which photographs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QPointF, QSize, Qt, Signal, SignalInstance
from PySide6.QtGui import QIcon, QImage, QPainter, QPixmap, QResizeEvent
from PySide6.QtWidgets import (
    QCommandLinkButton,
    QGridLayout,
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
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.picture import make_qimage, shrink_picture
from calibgui.gui.widgets.scrolling import make_calm
from calibgui.gui.window.good_set import (
    DropPlace,
    GoodSet,
    leave_as_it_is,
    make_heading,
)

_SHOWN = 6
_TITLE = 24
"""Size of the title's letters, px."""
_WIDTH, _RECENT_WIDTH, _LEAST = 440, 340, 300
"""Widths of the parts, and the least of each, device-independent px."""
_THREE, _TWO = 1240, 820
"""Widths of the page from which so many parts stand side by side, device-independent px."""
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
    tour_wanted = Signal()
    camera_wanted = Signal()
    board_wanted = Signal()
    recent_wanted = Signal(Path)
    """A recent project's file or folder of images is to be opened."""

    def __init__(self, jobs: Jobs) -> None:
        super().__init__()
        make_calm(self)
        self._jobs = jobs
        title = QLabel(self.tr("Calibrate a camera"))
        title.setFont(theme.make_font(_TITLE, bold=True))
        drop = DropPlace(
            self.tr(
                "Drop photographs of a flat board here, or a saved project. The board's kind and "
                "size are found."
            )
        )
        self.buttons = [
            self._link(
                self.tr("Open a f&older of images"),
                self.tr("Corners are found and the camera is calibrated at once."),
                self.folder_wanted,
            ),
            self._link(
                self.tr("&Photograph live"),
                self.tr("The camera's image shows where to hold the board."),
                self.camera_wanted,
            ),
            self._link(self.tr("&Add images"), self.tr("Choose single files."), self.images_wanted),
            self._link(
                self.tr("Open the &sample"),
                self.tr("Fourteen rendered photographs, to look around."),
                self.sample_wanted,
            ),
            self._link(
                self.tr("Take the to&ur"),
                self.tr("Two minutes on the sample; it can be left at any step."),
                self.tour_wanted,
            ),
            self._link(
                self.tr("Prin&t a board"),
                self.tr("A checkerboard, or one of the other kinds, in true size."),
                self.board_wanted,
            ),
        ]
        self._restyle()
        theme.follow(self._restyle)
        self.good_set = GoodSet(jobs)
        self._recent_part = QWidget()
        heading = make_heading(self.tr("Recent projects and folders"))
        self._list = _fill_part(self._recent_part, _RECENT_WIDTH, heading)
        self.recent: list[QCommandLinkButton] = []
        """Buttons that open what was opened lately, the newest first."""
        begin = QWidget()
        _fill_part(begin, _WIDTH, title, drop, *self.buttons)
        body = QWidget()
        self._grid = QGridLayout(body)
        self._grid.setContentsMargins(theme.MARGIN, theme.MARGIN, theme.MARGIN, theme.MARGIN)
        self._grid.setSpacing(2 * theme.MARGIN)
        self._parts = begin, self.good_set, self._recent_part
        self.setWidgetResizable(True)
        self.setWidget(body)
        self.show_recent([])

    def _arrange(self) -> None:
        """Stand the parts side by side where there is room, and below each other elsewhere."""
        grid, has_recent = self._grid, not self._recent_part.isHidden()
        width = self.viewport().width()
        columns = 3 if width >= _THREE and has_recent else 2 if width >= _TWO else 1
        places = {3: ((1, 1), (1, 2), (1, 3)), 2: ((1, 1), (1, 2), (2, 2))}.get(
            columns, ((1, 1), (2, 1), (3, 1))
        )
        for part, (row, column) in zip(self._parts, places, strict=True):
            below = 2 if columns == 2 and part is self._parts[0] and has_recent else 1
            grid.addWidget(part, row, column, below, 1, Qt.AlignmentFlag.AlignTop)
        for k in range(5):
            grid.setColumnStretch(k, int(k in (0, columns + 1)))
            grid.setRowStretch(k, {0: 1, 4: 2}.get(k, 0))

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 - Qt's name
        super().resizeEvent(event)
        self._arrange()

    def show_recent(self, recent: Sequence[Recent]) -> None:
        """Offer these projects and folders, each with its first image."""
        for button in self.recent:
            button.deleteLater()
        self.recent = [self._make_recent(entry) for entry in recent[:_SHOWN]]
        self._recent_part.setVisible(bool(recent))
        for place, button in enumerate(self.recent, start=1):
            self._list.insertWidget(place, button)
        self._arrange()
        pictured = [
            (button, entry.image)
            for button, entry in zip(self.recent, recent, strict=False)
            if entry.image
        ]
        if pictured:
            self._jobs.each(
                "", pictured, _read_picture, self._show_picture, failed=leave_as_it_is, owner=self
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
        button.setIcon(_centre(shrink_picture(picture, _PICTURE, self.devicePixelRatio())))

    def _restyle(self) -> None:
        """Draw the icons in the theme's colour."""
        icons = Icon.FOLDER, Icon.CAMERA, Icon.PICTURE, Icon.BOARD, Icon.PLAY, Icon.PRINTER
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


def _fill_part(part: QWidget, width: int, *widgets: QWidget) -> QVBoxLayout:
    """Fill a part of the page, of a width that it keeps where there is room."""
    part.setMaximumWidth(width)
    part.setMinimumWidth(min(width, _LEAST))
    return make_column(*widgets, None, of=part)
