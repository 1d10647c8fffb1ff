"""The form that asks what is known of a rig before it is calibrated."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSignalBlocker, Signal
from PySide6.QtWidgets import QCheckBox, QFormLayout, QSpinBox, QWidget

from calibgui.app.rig.rig_setup import RigSetup
from calibgui.dataset import RigPairing
from calibgui.engine.boards import Board, BoardShapeModel
from calibgui.gui.rig.board_list import BoardList
from calibgui.gui.settings.board_shape_choice import add_board_shapes
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.gui.widgets.number_box import NumberBox
from calibgui.gui.widgets.wrapped_label import WrappedLabel


class RigForm(QWidget):
    """Words on the pairing, and the choices below them."""

    pairing_wanted = Signal()
    """Photographs are to be paired anew, by other times or of other frames."""
    changed = Signal()
    """The user states something else of boards, or of how the rig is calibrated."""

    def __init__(self) -> None:
        super().__init__()
        self.words = WrappedLabel()
        self.boards = BoardList()
        self.boards.changed.connect(self.changed)
        self.shape = NarrowCombo()
        self.shape.setAccessibleName(self.tr("Shape of the boards"))
        add_board_shapes(self.shape)
        self.shape.activated.connect(self.changed)
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
        for choice in (self.robust, self.offsets):
            choice.clicked.connect(self.changed)
        self._rows = QFormLayout(self)
        self._rows.setContentsMargins(0, 0, 0, 0)
        self._rows.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapAllRows)
        self._rows.addRow(self.words)
        self._rows.addRow(self.boards)
        self._rows.addRow(self.tr("The boards are"), self.shape)
        self._rows.addRow(self.tr("Pair photographs taken within"), self.within)
        self._rows.addRow(self.tr("Frames of videos"), self.every)
        self._rows.addRow(self.robust)
        self._rows.addRow(self.offsets)
        self.show_setup(None, (), False)

    def show_setup(
        self, setup: RigSetup | None, seen: Sequence[Board | None], is_of_videos: bool
    ) -> None:
        """Show what is stated, and offer what the photographs leave to choose.

        Args:
            setup: what is stated of the rig; None if there are no photographs.
            seen: the boards as the photographs show them; none if they were not searched.
            is_of_videos: True if the photographs are frames of videos.
        """
        has_times = setup is not None and all(camera.times for camera in setup.pairing.cameras)
        self._rows.setRowVisible(self.every, is_of_videos)
        self._rows.setRowVisible(self.within, setup is not None and not is_of_videos)
        self._rows.setRowVisible(self.offsets, has_times)
        for row in (self.boards, self.shape, self.robust):
            self._rows.setRowVisible(row, setup is not None)
        if setup is not None:
            self.boards.show_boards(setup.boards, seen)
            self.shape.setCurrentIndex(self.shape.findData(setup.shape))
            self.robust.setChecked(setup.robust)
            self.offsets.setChecked(setup.estimate_offsets and has_times)

    def state_setup(self, pairing: RigPairing) -> RigSetup:
        """Return what is stated of the rig whose photographs are paired so."""
        return RigSetup(
            pairing,
            self.boards.boards,
            BoardShapeModel(self.shape.currentData()),
            self.robust.isChecked(),
            self.offsets.isChecked(),
        )

    def begin(self) -> None:
        """Forget how other photographs were paired."""
        with QSignalBlocker(self.within), QSignalBlocker(self.every):
            self.within.setValue(self.within.minimum())
            self.every.setValue(self.every.minimum())

    @property
    def tolerance(self) -> float | None:
        """Largest time between photographs of one instant, s; None to pair by what pairs most."""
        return self.within.value() / 1e3 or None
