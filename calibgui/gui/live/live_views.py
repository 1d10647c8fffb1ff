"""The live images of one or several cameras side by side."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QGridLayout, QSizePolicy, QWidget

from calibgui.engine.capture import Frame, JointState
from calibgui.gui.live.live_view import LiveView
from calibgui.gui.widgets import theme


class LiveViews(QWidget):
    """Shows a live image for each camera, with the place where the board is wanted, and what to do
    in that of the camera that it is about."""

    def __init__(self) -> None:
        super().__init__()
        self.views: list[LiveView] = []
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setSpacing(2)
        self.shown: list[Frame | None] = []
        """The frames that are on the screen."""
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName(self.tr("Live image"))
        self.begin([""])

    def begin(self, names: Sequence[str]) -> None:
        """Show no images yet, of cameras that are called so."""
        for view in self.views:
            self._grid.removeWidget(view)
            view.deleteLater()
        self.views = [LiveView(name if len(names) > 1 else "") for name in names]
        self.shown = [None] * len(names)
        for k, view in enumerate(self.views):
            self._grid.addWidget(view, *divmod(k, 2))

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802, ARG002 - Qt's name
        QPainter(self).fillRect(self.rect(), QColor(theme.current().canvas))

    def show_frames(self, frames: Sequence[Frame | None]) -> None:
        """Show the newest frames, of the cameras that have another one."""
        for k, frame in enumerate(frames):
            if frame is not None and frame is not self.shown[k]:
                self.shown[k] = frame
                self.views[k].show_image(frame.image)

    def show_state(self, state: JointState) -> None:
        """Show where the board is, where it is wanted, and what to do."""
        for k, (view, own) in enumerate(zip(self.views, state.cameras, strict=True)):
            words = state.instruction if k == state.leading else ""
            view.show_state(own, words, state.goals[k])
        self.setAccessibleDescription(state.instruction)

    def show_words(self, words: str) -> None:
        """Show words in place of what to do."""
        for k, view in enumerate(self.views):
            view.show_words(words if not k else "")
        self.setAccessibleDescription(words)
