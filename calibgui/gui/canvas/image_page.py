"""The selected image with its marks, beside the bar of the tools that work on it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QPointF, QSize, Qt, Signal
from PySide6.QtGui import QAction, QPolygonF
from PySide6.QtWidgets import QToolBar, QToolButton, QWidget

from calibgui.app.projects.project import Project
from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.images import Image
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.canvas.caption import Caption
from calibgui.gui.canvas.layer_menu import LayerMenu
from calibgui.gui.canvas.layers import Layer, Marks, trace_hull
from calibgui.gui.canvas.marker import Marker
from calibgui.gui.canvas.world_reading import describe_world
from calibgui.gui.images.image_model import status_text
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import enable_action, make_action
from calibgui.gui.widgets.icons import Icon, draw_icon
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.overlay import Overlay
from calibgui.gui.widgets.picture import Levels, stretch_levels
from calibgui.gui.widgets.wrapped_label import WrappedLabel


class ImagePage(QWidget):
    """Follows the session: whatever image and corner are selected are shown."""

    tool_changed = Signal(bool)
    """A tool for corners was taken, or put away."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self._image: Image | None = None
        self._failure = ""
        """Why the selected image cannot be read; "" if it can."""
        self._job: Job | None = None
        self._is_over_board = False
        self.canvas = Canvas()
        self.caption = Caption(self.canvas)
        # Over the image, which must not move when the next one is chosen; and at its bottom, as
        # messages to the whole window hang from its top.
        self.reason = WrappedLabel()
        self.reason.setAutoFillBackground(True)
        self.reason.setMargin(theme.SPACING)
        self.reason.hide()
        Overlay(self.reason, self.canvas, at_bottom=True)
        self.marker = Marker(session, self.canvas)
        self.layer_menu = LayerMenu(self.canvas)
        self.layers = self.layer_menu.actions_by_layer
        self.bar = QToolBar(self.tr("Tools"), orientation=Qt.Orientation.Vertical)
        """Beside the picture, of which it covers nothing."""
        self.bar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
        self.bar.setIconSize(_ICON)
        self.bar.setAutoFillBackground(True)
        self.bar.setPalette(theme.make_dark_palette())
        self._add_tools()
        self._add_zoom()
        self.layers_button = QToolButton()
        self.layers_button.setText(self.tr("Layers"))
        self.layers_button.setToolTip(self.tr("Choose what is drawn over the image"))
        self.layers_button.setMenu(self.layer_menu)
        self.layers_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.layers_button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
        self.bar.addSeparator()
        self.bar.addWidget(self.layers_button)
        self._restyle()
        make_row(self.bar, self.canvas, of=self, spacing=0)
        self.canvas.hovered.connect(self._hovered)
        self.canvas.stepped.connect(session.select_next)
        self.canvas.picked.connect(lambda corner: session.select(session.image, corner))
        for changes_axes in (self.marker.corner_bar.turn, self.marker.corner_bar.flip):
            changes_axes.clicked.connect(lambda: self.layers[Layer.ORDER].setChecked(True))
        session.selected.connect(self._selected)
        session.renewed.connect(lambda image: self._load(image) if image == session.image else None)
        session.changed.connect(self._project_changed)
        session.result_changed.connect(lambda _: self._show_marks())
        self._show_marks()

    def _add_tools(self) -> None:
        self.tools = [
            make_action(
                self,
                self.tr("&Mark board"),
                "M",
                self.tr("Point at the board's four outermost corners"),
                self._mark_or_leave,
            ),
            make_action(
                self,
                self.tr("&Edit corners"),
                "E",
                self.tr("Move, remove and restore single corners; turn the axes"),
                self._edit_or_leave,
            ),
        ]
        for action, name in zip(self.tools, (self.tr("Mark"), self.tr("Edit")), strict=True):
            action.setCheckable(True)
            action.setIconText(name)
        self.bar.addActions(self.tools)
        self.marker.finished.connect(self._untoggle)
        self.marker.finished.connect(lambda: self.tool_changed.emit(False))

    def _mark_or_leave(self) -> None:
        self._run_tool(self.tools[0], self.marker.mark_board)

    def _edit_or_leave(self) -> None:
        self._run_tool(self.tools[1], self.marker.edit_corners)

    def _run_tool(self, action: QAction, run: Callable[[], None]) -> None:
        if not action.isChecked():
            self.marker.leave()
            return
        run()
        self._untoggle()
        action.setChecked(self.canvas.tool is not None)
        self.tool_changed.emit(action.isChecked())

    def _untoggle(self) -> None:
        for action in self.tools:
            action.setChecked(False)

    def _add_zoom(self) -> None:
        self.zoom_actions = [
            make_action(
                self, self.tr("&Fit"), "Ctrl+0", self.tr("Show the whole image"), self.canvas.fit
            ),
            make_action(
                self,
                self.tr("&1:1"),
                "Ctrl+1",
                self.tr("Show the image's pixels as pixels of the screen"),
                self.canvas.actual_size,
            ),
        ]
        self.bar.addSeparator()
        self.bar.addActions(self.zoom_actions)

    def _restyle(self) -> None:
        """Draw the icons in the theme's colour."""
        icons = Icon.MARK, Icon.EDIT, Icon.FIT, Icon.ACTUAL_SIZE
        for action, icon in zip([*self.tools, *self.zoom_actions], icons, strict=True):
            action.setIcon(draw_icon(icon, theme.DARK.text))
            action.setIconVisibleInMenu(False)
        self.layers_button.setIcon(draw_icon(Icon.LAYERS, theme.DARK.text))
        # Qt's own button for what has no room is as dark as the bar.
        more = self.bar.findChild(QToolButton, "qt_toolbar_ext_button")
        if isinstance(more, QToolButton):
            more.setIcon(draw_icon(Icon.MORE, theme.DARK.text))

    def _selected(self, image: str, corner: int) -> None:
        if self.shown_path != image:
            self._load(image)
        self._show_marks()
        view = self._session.view
        if view is not None and view.corners is not None and 0 <= corner < len(view.corners):
            self.canvas.show_place(view.corners.uv[corner])

    @property
    def shown_path(self) -> str:
        """The image whose pixels are on the canvas; "" while it is being read."""
        return "" if self._image is None else str(self._image.path)

    def _load(self, path: str) -> None:
        if self._job is not None:
            self._job.cancel()
            self._job = None
        self._image, self._failure = None, ""
        if not path:
            self.canvas.show_image(())
            return

        def done(found: tuple[Image, Levels]) -> None:
            self._image = found[0]
            self.canvas.show_image(found[1])
            self._show_marks()
            if self.marker.goes_on(path):
                self.tools[0].trigger()

        def read(_: Job) -> tuple[Image, Levels]:
            image = self._session.images.read(path)
            return image, stretch_levels(image)

        def fail(error: Exception) -> None:
            self.canvas.show_image(())
            self._failure = str(error)
            self._show_marks()

        self._job = self._session.jobs.start("", read, done, failed=fail)

    def _project_changed(self, before: Project, after: Project) -> None:
        if before.views is not after.views:
            self._show_marks()

    def _show_marks(self) -> None:
        session, view = self._session, self._session.view
        remark = "" if view is None or view.corners is None else view.corners.remark
        self.reason.setText("" if view is None else self._failure or view.why_unused or remark)
        self.reason.setVisible(bool(self.reason.text()))
        for action in self.tools:
            enable_action(
                action,
                view is not None and view.status is not ViewStatus.UNREADABLE,
                self.tr("No image is shown that can be read."),
            )
        if view is None:
            self.caption.show_name("")
            self.canvas.show_marks(Marks())
            return
        measured, predicted = _find_residuals(session.result, view)
        region = view.roi
        if region is None and view.corners is not None:
            region = view.corners.roi
        marks = Marks(view.corners, region, measured, predicted, session.corner)
        self.canvas.show_marks(marks)
        self.caption.show_name(view.name, self._describe(view, marks))

    def _describe(self, view: View, marks: Marks) -> str:
        """Say what is known of the chosen corner, or of the image if none is chosen."""
        corners, k = marks.corners, marks.chosen
        if corners is None or not 0 <= k < len(corners):
            status = status_text(view)
            text = status
            if marks.measured is not None and marks.predicted is not None:
                residuals = marks.measured - marks.predicted
                rms = math.sqrt(float((residuals**2).sum(axis=1).mean()))
                text += self.tr(", {0} px").format(format_two_digits(rms))
            return text
        (row, col), (u, v) = corners.grid[k], corners.uv[k]
        text = self.tr("corner in row {0}, column {1}: u {2:.3f}, v {3:.3f} px").format(
            row, col, u, v
        )
        if marks.measured is None or marks.predicted is None:
            return text
        nearest = np.linalg.norm(marks.measured - corners.uv[k], axis=1).argmin()
        du, dv = marks.measured[nearest] - marks.predicted[nearest]
        return text + self.tr("; residual Δu {0:+.3f}, Δv {1:+.3f}, {2:.3f} px").format(
            du, dv, math.hypot(du, dv)
        )

    def _point_at_board(self, u: float, v: float) -> None:
        """Tell everybody whether the cursor is over the board."""
        corners = self.canvas.marks.corners
        is_over = self._is_over_board
        self._is_over_board = (
            corners is not None
            and len(corners) > 2
            and math.isfinite(u)
            and QPolygonF([QPointF(*at) for at in trace_hull(corners.uv)]).containsPoint(
                QPointF(u, v), Qt.FillRule.OddEvenFill
            )
        )
        if self._is_over_board or is_over:
            self._session.hover(self._session.image if self._is_over_board else "")

    def _hovered(self, u: float, v: float) -> None:
        self._point_at_board(u, v)
        image = self._image
        width, height = (0, 0) if image is None else image.size
        is_inside = -0.5 <= u < width - 0.5 and -0.5 <= v < height - 0.5
        if image is None or not is_inside:  # NaN is outside as well
            self.caption.show_reading("")
            return
        text = self.tr("u {0:.2f}  v {1:.2f} px").format(u, v)
        text += self.tr("   grey {0}").format(int(image.pixels[round(v), round(u)]))
        result = self._session.result
        world = (
            ""
            if result is None
            else describe_world(result, self._session.image, image.size, (u, v))
        )
        self.caption.show_reading(text + self._board_index(u, v), world)

    def _board_index(self, u: float, v: float) -> str:
        corners = self.canvas.marks.corners
        if corners is None or len(corners) < 2:
            return ""
        distance = np.linalg.norm(corners.uv - [u, v], axis=1)
        k = int(np.argmin(distance))
        spacing = np.partition(np.linalg.norm(corners.uv - corners.uv[k], axis=1), 1)[1]
        if distance[k] > spacing / 2:
            return ""
        row, col = corners.grid[k]
        return (
            self.tr("   corner: row {0}, column {1}; click to see its place")
            if self.canvas.marks.predicted is None
            else self.tr("   corner: row {0}, column {1}; click to see its residual")
        ).format(row, col)


_ICON = QSize(20, 20)


def _find_residuals(
    result: Result | None, view: View
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Measured corners (n, 2) of the result that has this very view, and where it expects them."""
    if result is None or not view.usable:
        return None, None
    for used, residuals in zip(result.used, result.calibration.residuals, strict=True):
        if used.image == view.image and used.corners is view.corners:
            measured = used.observation(result.board).uv
            return measured, measured - residuals.image
    return None, None
