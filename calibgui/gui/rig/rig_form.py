"""The form that asks what is known of a rig before it is calibrated."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QCheckBox, QFormLayout, QSpinBox, QWidget

from calibgui.dataset import DEFAULT_SQUARE, RigPairing
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.wrapped_label import WrappedLabel


class RigForm(QWidget):
    """Words on the pairing, and the choices below them."""

    pairing_wanted = Signal()
    """Photographs are to be paired anew, by other times or of other frames."""

    def __init__(self) -> None:
        super().__init__()
        self.words = WrappedLabel()
        self.square = NumberBox(decimals=3, minimum=0.0, maximum=10_000.0)
        self.square.setSuffix(self.tr(" mm"))
        self.square.setSpecialValueText(
            self.tr("not measured (as if {0} mm)").format(f"{DEFAULT_SQUARE:g}")
        )
        self.square.setAccessibleName(self.tr("Side of a square"))
        self.within = NumberBox(decimals=1, minimum=0.0, maximum=1e6)
        self.within.setSuffix(self.tr(" ms"))
        self.within.setSpecialValueText(self.tr("automatic"))
        self.within.setToolTip(
            self.tr(
                "Photographs that were taken at most so far apart are of one instant: by their "
                "names (seconds or nanoseconds since 1970, as of ROS) or by EXIF"
            )
        )
        self.within.setAccessibleName(self.tr("Pair photographs taken within"))
        self.every = QSpinBox(minimum=1, maximum=1000)
        self.every.setPrefix(self.tr("one of "))
        self.every.setSpecialValueText(self.tr("all"))
        self.every.setAccessibleName(self.tr("Frames of videos that are taken"))
        for box in (self.within, self.every):
            box.setKeyboardTracking(False)  # a number that is being typed is not meant yet
            box.valueChanged.connect(self.pairing_wanted)
        self.robust = QCheckBox(self.tr("Leave out what no camera e&xplains"))
        self.robust.setToolTip(self.tr("Corners and views that no camera explains take no part"))
        self.offsets = QCheckBox(self.tr("Estimate how late each camera &is"))
        self.offsets.setToolTip(
            self.tr(
                "From a board that moves, in videos or in photographs that are paired by time: the "
                "clock of each camera may be late"
            )
        )
        self._rows = QFormLayout(self)
        self._rows.setContentsMargins(0, 0, 0, 0)
        self._rows.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapAllRows)
        self._rows.addRow(self.words)
        self._rows.addRow(self.tr("Side of a square (distance of circles)"), self.square)
        self._rows.addRow(self.tr("Pair photographs taken within"), self.within)
        self._rows.addRow(self.tr("Frames of videos"), self.every)
        self._rows.addRow(self.robust)
        self._rows.addRow(self.offsets)
        self.show_choices(None, False)

    def show_choices(self, pairing: RigPairing | None, is_of_videos: bool) -> None:
        """Offer what the photographs leave to choose."""
        has_times = pairing is not None and all(camera.times for camera in pairing.cameras)
        self._rows.setRowVisible(self.every, is_of_videos)
        self._rows.setRowVisible(self.within, pairing is not None and not is_of_videos)
        self._rows.setRowVisible(self.offsets, has_times)
        if not has_times:
            self.offsets.setChecked(False)

    def begin(self) -> None:
        """Forget how other photographs were paired."""
        with QSignalBlocker(self.within), QSignalBlocker(self.every):
            self.within.setValue(self.within.minimum())
            self.every.setValue(self.every.minimum())

    @property
    def side(self) -> float | None:
        """Side of a square, mm; None if it is not stated."""
        return self.square.value() or None

    @property
    def tolerance(self) -> float | None:
        """Largest time between photographs of one instant, s; None to pair by what pairs most."""
        return self.within.value() / 1e3 or None
