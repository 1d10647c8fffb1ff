"""Marking by hand: joins the tools, their bars and the document."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from PySide6.QtCore import QObject, Signal

from calibgui.app.photographs import marking
from calibgui.app.projects.project import change_views
from calibgui.dataset import View, ViewStatus
from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import Corners
from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.canvas.corner_tool import CornerTool
from calibgui.gui.canvas.marking_bar import CornerBar, RoiBar
from calibgui.gui.canvas.roi_tool import RoiTool
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session
from calibgui.gui.widgets.pattern_texts import name_points

_MARKABLE = (ViewStatus.WAITING, ViewStatus.FOUND, ViewStatus.NO_BOARD)
"""States of images whose boards can be marked."""


class Marker(QObject):
    """Runs one tool at a time on the selected image."""

    finished = Signal()
    """The tool was left, or no image needs it any more."""

    def __init__(self, session: Session, canvas: Canvas) -> None:
        super().__init__(session)
        self._session, self._canvas = session, canvas
        self.roi_bar, self.corner_bar = RoiBar(), CornerBar()
        self._roi: RoiTool | None = None
        self._tool: RoiTool | CornerTool | None = None
        self._image = self._next = ""
        self._job: Job | None = None
        self.roi_bar.board_changed.connect(self._board_stated)
        self.roi_bar.accept.clicked.connect(self._accept)
        self.roi_bar.leave.clicked.connect(self.leave)
        self.corner_bar.left.connect(self.leave)
        self.corner_bar.turn_wanted.connect(
            lambda: self._change_corners(self.tr("Turn axes"), marking.turn_board)
        )
        self.corner_bar.flip_wanted.connect(
            lambda: self._change_corners(self.tr("Flip axes"), marking.flip_board)
        )
        session.selected.connect(self._selected)

    def mark_board(self) -> None:
        """Let the user point at the board of the selected image."""
        self.leave()
        self._image = self._session.image
        image = self._session.images.kept(self._image)
        if image is None:
            return
        self._tool = self._roi = RoiTool(self._canvas, image.grey)
        self._roi.changed.connect(self._points_changed)
        self._roi.accepted.connect(self._accept)
        self._roi.left.connect(self.leave)
        self._canvas.set_tool(self._roi)
        self._canvas.setFocus()
        if (board := self._session.project.board) is not None:
            self.roi_bar.show_board((board.rows, board.cols))
        self.roi_bar.counted.setText(name_points(self._session.project.pattern))
        self.roi_bar.show()
        self._points_changed()

    def edit_corners(self) -> None:
        """Let the user move, remove and restore corners of the selected image."""
        self.leave()
        self._image = self._session.image
        image = self._session.images.kept(self._image)
        if image is None or self._corners() is None:
            return
        self._tool = tool = CornerTool(self._canvas, image.grey, self._corners)
        tool.chosen.connect(lambda k: self._session.select(self._session.image, k))
        tool.moved.connect(self._move)
        tool.removed.connect(self._remove)
        tool.restored.connect(self._restore)
        tool.left.connect(self.leave)
        self._canvas.set_tool(tool)
        self._canvas.setFocus()
        self.corner_bar.show()

    def leave(self) -> None:
        """Put the tool away; what was not accepted is forgotten."""
        if self._job is not None:
            self._job.cancel()
            self._job = None
        tool, self._tool, self._roi = self._tool, None, None
        self._canvas.set_tool(None)
        self.roi_bar.hide()
        self.corner_bar.hide()
        if tool is not None:
            tool.deleteLater()
            self.finished.emit()

    def _selected(self, image: str) -> None:
        if self._canvas.tool is not None and image != self._image:
            self.leave()

    # The board

    def _points_changed(self) -> None:
        tool = self._roi
        if tool is None:
            return
        if tool.complete:
            self._search(None)
            return
        self._forget_preview(tool)
        self.roi_bar.words.setText(
            self.tr("Click the four outermost {1}, going round the board: {0} of 4.").format(
                len(tool.points), name_points(self._session.project.pattern).lower()
            )
            + (self.tr(" Backspace takes one back.") if tool.points else "")
        )

    def _board_stated(self) -> None:
        tool, grid_size = self._roi, self.roi_bar.grid_size
        if tool is not None and tool.complete and grid_size != tool.grid_size:
            self._search(grid_size)

    def _forget_preview(self, tool: RoiTool) -> None:
        tool.preview = None
        self.roi_bar.accept.setEnabled(False)
        self._canvas.viewport().update()

    def _search(self, grid_size: tuple[int, int] | None) -> None:
        """Find the corners between the four points, beside the main thread."""
        tool = self._roi
        assert tool is not None
        self._forget_preview(tool)
        project = self._session.project
        board = project.board
        usual = None if board is None else board.grid_size
        pattern = project.pattern if board is None else board.pattern
        tool.grid_size = grid_size or usual
        if self._job is not None:
            self._job.cancel()
        image = self._session.images.read(self._image).pixels
        points = np.array(tool.points)
        self.roi_bar.words.setText(self.tr("Counting…"))
        self._job = self._session.jobs.start(
            "",
            lambda _: marking.mark_board(image, points, grid_size, usual, pattern, project.method),
            self._found,
            failed=self._not_found,
        )

    def _found(self, corners: Corners) -> None:
        tool = self._roi
        if tool is None:
            return
        tool.preview, tool.grid_size = corners, corners.shape
        self.roi_bar.show_board(corners.shape)
        rows, cols = corners.shape
        text = self.tr("{0} of {1} corners. Enter accepts; drag a handle to change them.").format(
            len(corners), rows * cols
        )
        board = self._session.project.board
        if board is not None and (board.rows, board.cols) != corners.shape:
            text += self.tr(" The other images show {0} × {1}.").format(board.rows, board.cols)
        self.roi_bar.words.setText(text)
        self.roi_bar.accept.setEnabled(True)
        self._canvas.viewport().update()

    def _not_found(self, error: Exception) -> None:
        if not isinstance(error, CalibrationError):
            self._session.failed.emit(error)
        elif self._roi is not None:
            self.roi_bar.words.setText(str(error))

    def _accept(self) -> None:
        tool = self._roi
        if tool is None or tool.preview is None:
            return
        corners, points = tool.preview, np.array(tool.points)
        image = self._session.images.read(self._image)
        size = image.size
        others = self._session.project.confirmed_image_size
        if others is not None and others != size:
            self._session.failed.emit(
                CalibrationError(
                    self.tr("This image has {0} × {1} pixels, the others {2} × {3}.").format(
                        *size, *others
                    ),
                    self.tr("Calibrate images of each size by themselves."),
                )
            )
            return

        def change(view: View) -> View:
            return replace(
                view,
                status=ViewStatus.FOUND,
                reason="",
                corners=corners,
                points=None,
                roi=points,
                orientation=image.orientation,
                enabled=True,
            )

        self._session.edit(
            self.tr("Mark board"),
            lambda p: replace(change_views(p, [self._image], change), size=size),
        )
        self._next = self._next_in_need()
        self.leave()
        if self._next:
            self._session.select(self._next)

    def goes_on(self, image: str) -> bool:
        """Return whether `image`, which has just been read, is the next in a row to be marked."""
        expected, self._next = self._next, ""
        return image == expected

    def _next_in_need(self) -> str:
        """The next image to be marked, "" if there is none.

        That is one in which no board was found; where all boards are marked by hand, one that has
        not been marked, whatever was found in it.
        """
        project = self._session.project
        here = project.find(self._image)

        def needs(view: View) -> bool:
            if project.by_hand:
                return view.roi is None and view.status in _MARKABLE
            return view.status is ViewStatus.NO_BOARD

        others = (*project.views[here + 1 :], *project.views[:here])
        return next((view.image for view in others if view.enabled and needs(view)), "")

    # Single corners

    def _corners(self) -> Corners | None:
        view = self._session.view
        return None if view is None else view.corners

    def _move(self, k: int, uv: Array) -> None:
        self._change_corners(self.tr("Move corner"), partial(marking.move_corner, k=k, uv=uv))

    def _remove(self, k: int) -> None:
        self._session.select(self._session.image)
        self._change_corners(self.tr("Remove corner"), partial(marking.remove_corners, k=k))

    def _restore(self, place: IntArray) -> None:
        image = self._session.images.read(self._image).pixels
        self._change_corners(
            self.tr("Restore corner"), lambda corners: marking.restore_corner(image, corners, place)
        )

    def _change_corners(self, label: str, change: Callable[[Corners], Corners]) -> None:
        corners = self._corners()
        if corners is None:
            return
        try:
            new = change(corners)
        except CalibrationError as error:
            self._session.failed.emit(error)
            return
        self._edit(label, lambda view: replace(view, corners=new))

    def _edit(self, label: str, change: Callable[[View], View]) -> None:
        images = [self._image]
        self._session.edit(label, lambda p: change_views(p, images, change))
