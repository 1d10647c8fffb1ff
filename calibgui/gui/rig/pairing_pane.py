"""The pairing, which is corrected by hand: the matrix of photographs, and what changes it."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from calibgui.app.rig.pairing import leave_photographs_out, move_photographs
from calibgui.dataset import CornerSet, RigPairing, RigResult
from calibgui.gui.rig.pairing_matrix import PairingMatrix
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button

_WIDTH = 300
"""Width, device-independent px."""


class PairingPane(QWidget):
    """Moves chosen photographs to other instants, leaves them out, and takes that back."""

    changed = Signal()
    """The pairing is another one; the rig of the last one no longer holds."""

    def __init__(self) -> None:
        super().__init__()
        self.pairing: RigPairing | None = None
        self._undo: list[RigPairing] = []
        self._is_running = False
        self.matrix = PairingMatrix()
        self.earlier, self.later = Button(self.tr("Earli&er")), Button(self.tr("La&ter"))
        self.leave_out, self.undo = Button(self.tr("Lea&ve out")), Button(self.tr("&Undo"))
        self.earlier.setToolTip(
            self.tr("Move the chosen photographs of a camera to the instant before")
        )
        self.later.setToolTip(
            self.tr("Move the chosen photographs of a camera to the instant after")
        )
        self.setFixedWidth(_WIDTH)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, theme.SPACING)
        column.addWidget(self.matrix, 1)
        row = QHBoxLayout()
        row.setContentsMargins(theme.SPACING, 0, theme.SPACING, 0)
        row.setSpacing(theme.SPACING // 2)
        for button, run in (
            (self.earlier, lambda: self._move(-1)),
            (self.later, lambda: self._move(1)),
            (self.leave_out, self._leave_out),
            (self.undo, self._take_back),
        ):
            button.clicked.connect(run)
            row.addWidget(button)
        row.addStretch(1)
        column.addLayout(row)
        self.matrix.itemSelectionChanged.connect(self._show_buttons)
        self._show_buttons()

    def begin(self, pairing: RigPairing) -> None:
        """Take another set of photographs."""
        self.pairing, self._undo = pairing, []

    def change(self, pairing: RigPairing) -> None:
        """Take another pairing of the same photographs, which can be taken back."""
        assert self.pairing is not None
        self._undo.append(self.pairing)
        self.pairing = pairing
        self.changed.emit()

    def show_pairing(self, found: Mapping[str, CornerSet], result: RigResult | None) -> None:
        """Show the pairing, with what was found in the photographs and how well each fits."""
        assert self.pairing is not None
        self.matrix.show_pairing(self.pairing, found, result)
        self._show_buttons()

    def hold(self, is_running: bool) -> None:
        """Let nothing be changed while photographs are searched; or let it again."""
        self._is_running = is_running
        self._show_buttons()

    def _move(self, step: int) -> None:
        """Move the chosen photographs to other instants."""
        assert self.pairing is not None
        pairing = self.pairing
        chosen: dict[int, list[int]] = {}
        for camera, instants in self.matrix.list_chosen().items():
            files = pairing.cameras[camera].files
            moved = [files[instant] for instant in instants if instant in files]
            pairing = move_photographs(pairing, camera, instants, step)
            there = pairing.cameras[camera].files
            chosen[camera] = [instant for instant, file in there.items() if file in moved]
        self.change(pairing)
        self.matrix.choose(chosen)

    def _leave_out(self) -> None:
        assert self.pairing is not None
        pairing = self.pairing
        for camera, instants in self.matrix.list_chosen().items():
            pairing = leave_photographs_out(pairing, camera, instants)
        self.change(pairing)

    def _take_back(self) -> None:
        self.pairing = self._undo.pop()
        self.changed.emit()

    def _show_buttons(self) -> None:
        chosen = bool(self.matrix.list_chosen()) and not self._is_running
        for button in (self.earlier, self.later, self.leave_out):
            button.setEnabled(chosen)
        self.undo.setEnabled(bool(self._undo) and not self._is_running)
