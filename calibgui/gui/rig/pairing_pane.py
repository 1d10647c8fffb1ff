"""The pane of what is stated of a rig: a matrix to correct its pairing in, and undo."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from calibgui.app.rig.pairing import leave_photographs_out, move_photographs
from calibgui.app.rig.rig_setup import RigSetup, SearchedBoards
from calibgui.dataset import RigPairing, RigResult
from calibgui.gui.rig.pairing_matrix import PairingMatrix
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_column, make_row

_WIDTH = 300
"""Width, device-independent px."""


class PairingPane(QWidget):
    """Moves chosen photographs to other instants, leaves them out, and takes that back."""

    changed = Signal()
    """Pairing or boards are others; the rig of the last ones no longer holds."""

    def __init__(self) -> None:
        super().__init__()
        self.setup: RigSetup | None = None
        self._undo: list[RigSetup] = []
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
        for button, run in (
            (self.earlier, lambda: self._move(-1)),
            (self.later, lambda: self._move(1)),
            (self.leave_out, self._leave_out),
            (self.undo, self._take_back),
        ):
            button.clicked.connect(run)
        gap, around = theme.SPACING // 2, (theme.SPACING, 0, theme.SPACING, 0)
        make_column(
            (self.matrix, 1),
            make_row(self.earlier, self.later, None, spacing=gap, margins=around),
            make_row(self.leave_out, self.undo, None, spacing=gap, margins=around),
            of=self,
            spacing=gap,
            margins=(0, 0, 0, theme.SPACING),
        )
        self.matrix.itemSelectionChanged.connect(self._show_buttons)
        self._show_buttons()

    def begin(self, setup: RigSetup) -> None:
        """Take another set of photographs."""
        self.setup, self._undo = setup, []

    def change(self, setup: RigSetup) -> None:
        """Take what else is stated of the same photographs, which can be taken back."""
        assert self.setup is not None
        self._undo.append(self.setup)
        self.setup = setup
        self.changed.emit()

    def change_pairing(self, pairing: RigPairing) -> None:
        """Take another pairing of the same photographs."""
        assert self.setup is not None
        self.change(replace(self.setup, pairing=pairing))

    def show_pairing(self, found: SearchedBoards, result: RigResult | None) -> None:
        """Show the pairing, with what was found in the photographs and how well each fits."""
        assert self.setup is not None
        self.matrix.show_pairing(self.setup.pairing, found.corner_sets, result)
        self._show_buttons()

    def hold(self, is_running: bool) -> None:
        """Let nothing be changed while photographs are searched; or let it again."""
        self._is_running = is_running
        self._show_buttons()

    def _move(self, step: int) -> None:
        """Move the chosen photographs to other instants."""
        assert self.setup is not None
        pairing = self.setup.pairing
        chosen: dict[int, list[int]] = {}
        for camera, instants in self.matrix.list_chosen().items():
            files = pairing.cameras[camera].files
            moved = [files[instant] for instant in instants if instant in files]
            pairing = move_photographs(pairing, camera, instants, step)
            there = pairing.cameras[camera].files
            chosen[camera] = [instant for instant, file in there.items() if file in moved]
        self.change_pairing(pairing)
        self.matrix.choose(chosen)

    def _leave_out(self) -> None:
        assert self.setup is not None
        pairing = self.setup.pairing
        for camera, instants in self.matrix.list_chosen().items():
            pairing = leave_photographs_out(pairing, camera, instants)
        self.change_pairing(pairing)

    def _take_back(self) -> None:
        self.setup = self._undo.pop()
        self.changed.emit()

    def _show_buttons(self) -> None:
        chosen = bool(self.matrix.list_chosen()) and not self._is_running
        for button in (self.earlier, self.later, self.leave_out):
            button.setEnabled(chosen)
        self.undo.setEnabled(bool(self._undo) and not self._is_running)
