"""The camera that is known from a file, in the set-up of the lens."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QWidget

from calibgui.dataset import KnownCamera
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.elided import elide_name
from calibgui.gui.widgets.layouts import make_row
from calibgui.report.lens_models import get_lens_title

_NAME_LENGTH = 22
"""Letters of a file's name that have room beside the button."""


class KnownCameraChoice(QWidget):
    """Names the file of the camera that is held, and lets it be chosen or given up."""

    file_wanted = Signal()
    """The user wants to choose a file."""
    given_up = Signal()
    """The camera is to be calibrated again."""

    def __init__(self) -> None:
        super().__init__()
        self._known: KnownCamera | None = None
        self.name = QLabel()
        self.button = Button(kind=Kind.LINK)
        self.button.clicked.connect(self._click)
        make_row((self.name, 1), self.button, of=self)
        self.show_known(None)

    def show_known(self, known: KnownCamera | None) -> None:
        """Show the camera that is held; None for one that is to be calibrated."""
        self._known = known
        self.name.setText(
            self.tr("calibrated") if known is None else elide_name(known.file, _NAME_LENGTH)
        )
        self.name.setToolTip("" if known is None else _describe(known))
        self.button.setText(self.tr("Choose…") if known is None else self.tr("Calibrate again"))
        self.button.setToolTip(
            self.tr(
                "Hold the camera of a file of this or another program, and locate the board in "
                "photographs with it. Such a file can also be dropped on the window."
            )
            if known is None
            else self.tr("Give the camera of the file up: calibrate one from the photographs.")
        )

    def _click(self) -> None:
        (self.file_wanted if self._known is None else self.given_up).emit()


def _describe(known: KnownCamera) -> str:
    """Describe a camera that is held: its file, lens model and parameters."""
    camera = known.camera
    values = ", ".join(
        f"{name} {value:.6g}"
        for name, value in list(zip(camera.names, camera.params.tolist(), strict=True))[
            :_MAX_VALUES
        ]
    )
    return (
        f"{known.file} ({known.title})\n{get_lens_title(camera.model)},"
        f" {camera.size[0]} × {camera.size[1]} px\n{values}"
    )


_MAX_VALUES = 14
"""Number of parameters that are listed: a splined lens has hundreds."""
