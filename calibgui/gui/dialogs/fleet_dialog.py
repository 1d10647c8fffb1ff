"""A fleet: the cameras of its ledger in one table, each of which opens as a project."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QDate, QLocale, QModelIndex, QSize, Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QLabel,
    QLineEdit,
    QWidget,
)

from calibgui.app.photographs.image_store import read_thumbnail
from calibgui.formats.camera_import import read_result_file
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.panels.latest import Latest
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_buttons
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.picture import make_qimage, shrink_picture
from calibgui.gui.widgets.tables import Column, Table, with_decimals
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.fleet_overview import FleetOverview, PlacedCamera

_PICTURE = QSize(96, 72)
"""The first photograph of a camera, device-independent px."""


class FleetDialog(QDialog):
    """Shows the cameras of a ledger, those that are unlike the others first.

    Args:
        ledger: its file.
        overview: its cameras.
        open_result: opens a result.json under a name, and returns whether it did.
        jobs: that read the cameras' photographs.
        parent: over which the dialog opens.
    """

    def __init__(
        self,
        ledger: Path,
        overview: FleetOverview,
        open_result: Callable[[Path, str], bool],
        jobs: Jobs,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Fleet {0}").format(ledger.name))
        self._folder, self._open_result = ledger.parent, open_result
        self._work = Latest(jobs, self)
        self.placed = sorted(overview.placed, key=_rank)
        self.words = WrappedLabel()
        self.words.setText(
            self.tr(
                "{0} cameras. Failing: {1}. Unlike the others of their image size and lens "
                "model: {2}. Changed: {3}."
            ).format(
                len(overview.placed),
                len(overview.failed),
                len(overview.outliers),
                len(overview.changed),
            )
        )
        self.filter = QLineEdit(placeholderText=self.tr("Camera, serial number, reason…"))
        self.filter.setAccessibleName(self.tr("Filter"))
        self.filter.setMinimumWidth(30 * self.fontMetrics().averageCharWidth())
        self.kind = QComboBox()
        self.kind.setAccessibleName(self.tr("Which cameras are shown"))
        self.kind.addItems(
            [self.tr("all"), self.tr("failing"), self.tr("unlike the others"), self.tr("changed")]
        )
        self.filter.textChanged.connect(lambda _: self._filter())
        self.kind.currentIndexChanged.connect(lambda _: self._filter())
        self.reason, self.picture = WrappedLabel(), QLabel()
        self.picture.setFixedSize(_PICTURE)
        self.picture.setAccessibleName(self.tr("First photograph of the camera"))
        self.table = Table()
        self.table.show_columns(self._list_columns(), self._list_reasons())
        self.table.picked.connect(self._pick)
        self.table.doubleClicked.connect(self._open_clicked)
        self.open_camera = Button(self.tr("&Open camera"), Kind.MAIN)
        self.open_camera.setEnabled(False)
        self.open_camera.clicked.connect(self._open_picked)
        buttons = make_buttons(self, self.open_camera)
        above = make_row((self.words, 1), self.filter, self.kind)
        below = make_row(self.picture, (self.reason, 1), buttons)
        make_column(above, (self.table, 1), below, of=self, margins=theme.MARGIN)
        self._picked = 0
        if self.placed:
            self.table.select(0)
            self._pick(0)
        self.table.setFocus()
        self.resize(1000, 560)

    def _list_columns(self) -> list[Column]:
        cameras = [one.camera for one in self.placed]
        figures = [camera.figures for camera in cameras]
        changes = [camera.change for camera in cameras]
        px = self.tr("px")
        return [
            Column(self.tr("Camera"), [camera.id for camera in cameras]),
            Column(self.tr("Serial number"), [camera.entry.serial for camera in cameras]),
            Column(
                self.tr("Date"),
                [camera.entry.date for camera in cameras],
                _format_date,
                optional=True,
            ),
            Column(
                self.tr("Verdict"),
                [self.tr("pass") if camera.passed else self.tr("fail") for camera in cameras],
                tip=self.tr("Whether the camera keeps the limits of its fleet"),
                ink=self._choose_ink,
            ),
            Column(self.tr("Views"), [0 if f is None else f.views for f in figures], optional=True),
            Column(
                self.tr("RMS"),
                [math.nan if f is None else f.rms for f in figures],
                with_decimals(3),
                self.tr("Root mean square residual"),
                optional=True,
                unit=px,
            ),
            Column(
                "σ",
                [math.nan if f is None else f.noise for f in figures],
                with_decimals(3),
                self.tr("Standard deviation of one coordinate of a corner"),
                optional=True,
                unit=px,
            ),
            Column(
                self.tr("Corners"),
                [0 if f is None else f.corners for f in figures],
                optional=True,
            ),
            Column(
                self.tr("Error, edge"),
                [math.nan if f is None else f.error.edge for f in figures],
                with_decimals(3),
                self.tr("Error of a pixel at the image's edge, one standard deviation"),
                unit=px,
            ),
            Column(
                self.tr("Difference"),
                [one.difference for one in self.placed],
                with_decimals(3),
                self.tr(
                    "Distance from the median camera of the same image size and lens model, rms "
                    "over the image, after the rotation that brings both together"
                ),
                unit=px,
            ),
            Column(
                self.tr("In σ"),
                [one.z for one in self.placed],
                with_decimals(1),
                self.tr("The difference in standard deviations of the fleet"),
                optional=True,
            ),
            Column(
                self.tr("Changed by"),
                [math.nan if change is None else change.rms for change in changes],
                with_decimals(3),
                self.tr("Difference from the last calibration of the serial number"),
                unit=px,
            ),
        ]

    def _choose_ink(self, verdict: str) -> str:
        colours = theme.current()
        return colours.good if verdict == self.tr("pass") else colours.bad

    def _filter(self) -> None:
        """Show the cameras of a kind that a text is found in."""
        text = self.filter.text().casefold()
        is_of_kind: Callable[[PlacedCamera], bool] = (
            lambda _: True,
            lambda one: not one.camera.passed,
            lambda one: one.is_outlier,
            lambda one: one.camera.change is not None and one.camera.change.is_significant,
        )[self.kind.currentIndex()]

        def fits(one: PlacedCamera) -> bool:
            searched = one.camera.id, one.camera.entry.serial, self._explain(one)
            return is_of_kind(one) and text in " ".join(searched).casefold()

        self.table.filter_rows([row for row, one in enumerate(self.placed) if fits(one)])

    def _list_reasons(self) -> dict[int, str]:
        """Return why rows stand out, by row."""
        reasons = {}
        for row, one in enumerate(self.placed):
            if said := self._explain(one):
                reasons[row] = said
        return reasons

    def _explain(self, one: PlacedCamera) -> str:
        """Say in sentences why a camera fails or is unlike the others."""
        said = [*one.camera.failures]
        if one.is_outlier:
            said.append(self.tr("It is unlike the others of its kind."))
        if one.camera.change is not None and one.camera.change.is_significant:
            said.append(
                self.tr("It has changed since {0}, by {1:.2g} px at most.").format(
                    one.camera.change.against, one.camera.change.worst
                )
            )
        return " ".join(said)

    def _pick(self, row: int) -> None:
        self._picked = row
        one = self.placed[row]
        self.open_camera.setEnabled(bool(one.camera.result))
        self.reason.setText(self._explain(one) or self.tr("It passes."))
        self.picture.clear()
        self._work.cancel()
        if one.camera.result:
            file = self._folder / one.camera.result
            show = self._show_picture
            self._work.start("", lambda _: _read_picture(file), show, lambda _: None)

    def _show_picture(self, picture: QImage) -> None:
        self.picture.setPixmap(shrink_picture(picture, _PICTURE, self.devicePixelRatio()))

    def _open_clicked(self, _: QModelIndex) -> None:
        self._open_picked()

    def _open_picked(self) -> None:
        camera = self.placed[self._picked].camera
        if camera.result and self._open_result(self._folder / camera.result, camera.id):
            self.accept()


def _rank(one: PlacedCamera) -> tuple[bool, float, bool]:
    """Order cameras: those unlike the others first, the farthest before, then those that fail."""
    return not one.is_outlier, -one.z if one.is_outlier else 0.0, one.camera.passed


def _format_date(date: str) -> str:
    """Format a date as the system's language has it; what is none stays as it is."""
    day = QDate.fromString(date[:10], Qt.DateFormat.ISODate)
    return QLocale().toString(day, QLocale.FormatType.ShortFormat) if day.isValid() else date


def _read_picture(file: Path) -> QImage:
    """Read the first photograph of a result, small; in a worker.

    Raises:
        CalibrationError: if one of both is gone or cannot be read.
    """
    image = file.parent / read_result_file(file).used[0].image
    return make_qimage(read_thumbnail(str(image)).grey)
