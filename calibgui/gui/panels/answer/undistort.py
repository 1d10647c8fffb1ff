"""Images without distortion, or rectified to the board (figure 9), beside the originals."""

from __future__ import annotations

import math

from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import QComboBox, QSpinBox

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.app.outputs.previews import Grey, transform_image
from calibgui.app.outputs.resampling import Undistortion
from calibgui.dataset import Result, ViewStatus
from calibgui.engine.images import FieldOfView, Projection
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.divided_images import DividedImages
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.elided import elide_name
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.gui.widgets.reserved_label import ReservedLabel

RECTIFIED = "rectified"
"""Stands beside the projections for an image rectified to the board."""
STATED_ANGLE = "angle"
"""Stands beside the views for a field of view in degrees."""

_WIDEST_DEGREES = {
    Projection.PERSPECTIVE: 179,
    Projection.CYLINDRICAL: 360,
    Projection.EQUIRECTANGULAR: 360,
    Projection.STEREOGRAPHIC: 359,
}
"""Largest whole number of degrees that each projection can show."""


class UndistortPanel(Panel):
    """Shows an image as taken, undistorted or rectified.

    Args:
        jobs: that do the work.
        read: the image of a path, called in a worker.
    """

    title = str(QT_TRANSLATE_NOOP("UndistortPanel", "Undistort"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "UndistortPanel", "An image without the lens's distortion, or rectified to the board."
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._read_image = services.read_image
        self._work = Latest(services.jobs, self)
        self._shown = 0
        self.way = self._make_ways()
        self.view = self._make_views()
        self.angle = QSpinBox(minimum=1, maximum=179, value=120, suffix="°")
        self.angle.setKeyboardTracking(False)
        self.angle.setToolTip(self.tr("Angle from the left edge of the new image to the right one"))
        self.angle.setAccessibleName(self.tr("Field of view in degrees"))
        self.way.currentIndexChanged.connect(self._change)
        self.view.currentIndexChanged.connect(self._change)
        self.angle.valueChanged.connect(self._refresh_now)
        self.save_one = Button(self.tr("Save &this…"))
        self.save_all = Button(self.tr("&Save all…"))
        self.save_one.setToolTip(
            self.tr("Write the selected image as it is shown here into a folder")
        )
        self.save_all.setToolTip(
            self.tr("Write all images like this into a folder, those that were left out as well")
        )
        self.save_one.clicked.connect(lambda: self._save((self._indices[self._shown],)))
        self.save_all.clicked.connect(lambda: self._save(self._list_all()))
        self.images = DividedImages(self.tr("as taken"), self.tr("undistorted"))
        self.lost, self.words = ReservedLabel(3), ReservedLabel(2)
        above = make_row((self.way, 3), (self.view, 2), self.angle)
        below = make_row((self.words, 1), self.save_one, self.save_all)
        self._fill_body(above, (self.images, 1), self.lost, below)
        self._enable_choices()

    def _make_ways(self) -> QComboBox:
        """The choice of the projection, or of an image rectified to the board."""
        choice = NarrowCombo()
        for way, name in (
            (Projection.PERSPECTIVE, self.tr("Perspective")),
            (Projection.CYLINDRICAL, self.tr("Cylindrical")),
            (Projection.EQUIRECTANGULAR, self.tr("Equirectangular")),
            (Projection.STEREOGRAPHIC, self.tr("Stereographic")),
            (Projection.CUBE, self.tr("Cube")),
            (RECTIFIED, self.tr("Rectified to the board")),
        ):
            choice.addItem(name, str(way))
        choice.setToolTip(
            self.tr(
                "Perspective keeps straight lines straight, and shows less than 180°.\n"
                "Cylindrical unrolls the horizon; upright lines stay straight.\n"
                "Equirectangular is a map of longitude and latitude, for viewers of 360° images.\n"
                "Stereographic is a wide view in which small things keep their shape.\n"
                "Cube makes perspective images of 90° to all sides.\n"
                "Rectified shows the board from straight above."
            )
        )
        choice.setAccessibleName(self.tr("What to make of the image"))
        return choice

    def _make_views(self) -> QComboBox:
        """The choice of how much to show."""
        choice = NarrowCombo()
        for view, name in (
            (FieldOfView.ALL, self.tr("All pixels")),
            (FieldOfView.NO_BORDER, self.tr("No black border")),
            (FieldOfView.SAME_SCALE, self.tr("Same scale")),
            (STATED_ANGLE, self.tr("Field of view")),
        ):
            choice.addItem(name, str(view))
        choice.setToolTip(
            self.tr(
                "All pixels keeps everything, with black beyond it; no black border cuts to a "
                "full rectangle;\nsame scale keeps the size of the middle; field of view shows an "
                "angle of your choice."
            )
        )
        choice.setAccessibleName(self.tr("How much of the image to show"))
        return choice

    @property
    def choice(self) -> Undistortion | None:
        """The choice of the user; None for an image rectified to the board."""
        way, view = str(self.way.currentData()), str(self.view.currentData())
        if way == RECTIFIED:
            return None
        projection = Projection(way)
        if projection is Projection.CUBE:
            return Undistortion(projection)
        if view == STATED_ANGLE:
            angle = math.radians(self.angle.value())
            return Undistortion(projection, field_of_view=angle)
        return Undistortion(projection, FieldOfView(view))

    def _change(self) -> None:
        """Show what is chosen now."""
        self._enable_choices()
        self._refresh_now()

    def _enable_choices(self) -> None:
        """Let only those choices be made that matter, of what the projection can show."""
        widest = _WIDEST_DEGREES.get(self.way.currentData())
        self.view.setEnabled(widest is not None)
        self.angle.setEnabled(widest is not None and self.view.currentData() == STATED_ANGLE)
        if widest is not None:
            self.angle.setMaximum(widest)

    def _refresh(self, result: Result) -> None:
        """Nothing but what `_select` shows depends on the result."""

    def _restyle(self) -> None:
        """Whatever has colours follows them by itself."""

    def _select(self, k: int, corner: int) -> None:  # noqa: ARG002 - the image is shown whole
        assert self._result is not None
        result, choice = self._result, self.choice
        self._shown = max(k, 0)
        name = elide_name(shorten_names(result.used)[self._shown])
        self.words.setText(self.tr("{0}: working…").format(name))
        shown = self._shown
        self._work.start(
            self.tr("Undistorting {0}").format(name),
            lambda _: transform_image(result, shown, choice, self._read_image),
            lambda made: self._show(name, *made),
            self._fail,
        )

    def _show(self, name: str, before: Grey | None, after: Grey, lost: str) -> None:
        self.images.show_images(before, after)
        height, width = after.shape
        self.words.setText(self.tr("{0}: {1} × {2} px").format(name, width, height))
        self.lost.setText(lost)

    def _fail(self, error: Exception) -> None:
        self.images.show_images(None, None)
        self.words.setText("")  # clearing it would leave what it was shortened from
        self.lost.setText(str(error))  # which has the panel's whole width: paths are long

    def _list_all(self) -> tuple[int, ...]:
        """List the views that can be written: to be rectified, one needs a pose."""
        assert self._result is not None
        if self.choice is None:
            return self._indices
        lost = (ViewStatus.UNREADABLE, ViewStatus.WRONG_SIZE)
        return tuple(k for k, view in enumerate(self._result.views) if view.status not in lost)

    def _save(self, views: tuple[int, ...]) -> None:
        self.save_wanted.emit(views, self.choice)
