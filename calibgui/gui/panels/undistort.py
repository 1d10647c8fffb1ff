"""Images without distortion, or rectified to the board (figure 9), beside the originals."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from PySide6.QtCore import QT_TRANSLATE_NOOP, Qt
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QPushButton, QVBoxLayout

from calibgui.app.calibration import shorten_names
from calibgui.dataset import Result
from calibgui.engine.images import FieldOfView, Image, rectify_image, undistort_image
from calibgui.gui.panels.before_after import BeforeAfter, Grey
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.report.coverage import find_shown_extent, measure_natural_scale

RECTIFIED = "rectified"
"""Stands beside the fields of view for an image rectified to the board."""


class UndistortPanel(Panel):
    """Shows an image as taken, undistorted or rectified.

    Args:
        jobs: that do the work.
        read: the image of a path, called in a worker.
    """

    title = str(QT_TRANSLATE_NOOP("UndistortPanel", "Undistort"))

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._read_image = services.read_image
        self._work = Latest(services.jobs, self)
        self._shown = 0
        self.way = QComboBox()
        for way, name in (
            (FieldOfView.ALL, self.tr("Undistorted: all pixels")),
            (FieldOfView.NO_BORDER, self.tr("Undistorted: no black border")),
            (FieldOfView.SAME_SCALE, self.tr("Undistorted: same scale")),
            (RECTIFIED, self.tr("Rectified to the board")),
        ):
            self.way.addItem(name, str(way))
        self.way.setToolTip(
            self.tr(
                "All pixels keeps everything, with black beyond it; no black border cuts to a "
                "full rectangle;\nsame scale keeps the focal length. Rectified shows the board "
                "from straight above."
            )
        )
        self.way.setAccessibleName(self.tr("What to make of the image"))
        self.way.currentIndexChanged.connect(self._refresh_now)
        self.save_one = QPushButton(self.tr("Save &this…"))
        self.save_all = QPushButton(self.tr("&Save all…"))
        self.save_one.clicked.connect(lambda: self._save((self._indices[self._shown],)))
        self.save_all.clicked.connect(lambda: self._save(self._indices))
        self.images = BeforeAfter(self.tr("as taken"), self.tr("undistorted"))
        self.words = QLabel()
        self.words.setWordWrap(True)
        below = QHBoxLayout()
        below.addWidget(self.words, 1)
        below.addWidget(self.save_one)
        below.addWidget(self.save_all)
        layout = QVBoxLayout(self.body)
        layout.addWidget(self.way, 0, Qt.AlignmentFlag.AlignLeft)
        layout.addWidget(self.images, 1)
        layout.addLayout(below)

    def _refresh(self, result: Result) -> None:
        """Nothing but what `_select` shows depends on the result."""

    def _select(self, k: int, corner: int) -> None:  # noqa: ARG002 - the image is shown whole
        assert self._result is not None
        result, way = self._result, str(self.way.currentData())
        self._shown = max(k, 0)
        name = shorten_names(result.used)[self._shown]
        self.words.setText(self.tr("{0}: working…").format(name))
        shown = self._shown
        self._work.start(
            self.tr("Undistorting {0}").format(name),
            lambda _: transform_image(result, shown, way, self._read_image),
            lambda images: self._show(name, *images),
            self._fail,
        )

    def _show(self, name: str, before: Grey | None, after: Grey) -> None:
        self.images.show_images(before, after)
        height, width = after.shape
        self.words.setText(self.tr("{0}: {1} × {2} px").format(name, width, height))

    def _fail(self, error: Exception) -> None:
        self.images.show_images(None, None)
        self.words.setText(str(error))

    def _save(self, views: tuple[int, ...]) -> None:
        self.save_wanted.emit(views, str(self.way.currentData()))


def transform_image(
    result: Result, k: int, way: str, read: Callable[[str], Image]
) -> tuple[Grey | None, Grey]:
    """The image of calibrated view k and what becomes of it; a rectified one stands alone.

    Raises:
        CalibrationError: if the image cannot be read, or not be changed so.
    """
    grey = read(result.used[k].image).grey
    camera = result.calibration.camera
    if way != RECTIFIED:
        return grey, cast(Grey, undistort_image(grey, camera, way).image)
    pose, extent = result.calibration.poses[k], find_shown_extent(result)
    rectified = rectify_image(grey, camera, pose, extent, measure_natural_scale(result))
    return None, cast(Grey, rectified.image)
