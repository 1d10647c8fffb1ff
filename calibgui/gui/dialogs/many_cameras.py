"""Opening what is of several calibrations: the ledger of a fleet, and the results of a series."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QFileDialog, QWidget

from calibgui.gui.dialogs.files import Files
from calibgui.gui.session.session import Session
from calibgui.gui.widgets.actions import show_dialog

if TYPE_CHECKING:
    from calibgui.report.fleet_overview import FleetOverview


class ManyCameras(QObject):
    """Asks for the files and opens the dialogs, which are loaded when they are first wanted.

    Args:
        session: whose jobs read the files.
        files: which open a single camera.
        window: over which the dialogs open.
    """

    def __init__(self, session: Session, files: Files, window: QWidget) -> None:
        super().__init__(window)
        self._session, self._files, self._window = session, files, window

    def ask_for_fleet(self) -> None:
        """Open a ledger of the user's choice."""
        name, _ = QFileDialog.getOpenFileName(
            self._window, self.tr("Open fleet"), "", self.tr("Fleets (*.db)")
        )
        if name:
            self.open_fleet(Path(name))

    def open_fleet(self, path: Path) -> None:
        """Read a ledger and show its cameras."""
        self._session.jobs.start(
            self.tr("Reading {0}").format(path.name),
            lambda _: _read_fleet(path),
            lambda overview: self._show_fleet(path, overview),
            failed=self._session.failed.emit,
            owner=self,
        )

    def _show_fleet(self, path: Path, overview: FleetOverview) -> None:
        from calibgui.gui.dialogs.fleet_dialog import FleetDialog

        jobs = self._session.jobs
        show_dialog(FleetDialog(path, overview, self._files.open_result, jobs, self._window))

    def show_series(self) -> None:
        """Show the dialog of a series, in which the user chooses the results."""
        from calibgui.gui.dialogs.series_dialog import SeriesDialog

        show_dialog(SeriesDialog(self._session.jobs, self._window))


def _read_fleet(path: Path) -> FleetOverview:
    """Read a ledger and compare its cameras.

    Raises:
        CalibrationError: if it is no ledger.
    """
    from calibgui.formats.fleet_ledger import open_ledger
    from calibgui.report.fleet_overview import make_overview

    with open_ledger(path) as ledger:
        cameras = tuple(ledger.read())
    return make_overview(cameras)
