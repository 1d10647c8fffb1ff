"""Which photograph was taken when: a column for each camera, a row for each instant."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from statistics import fmean, median
from typing import NamedTuple

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem

from calibgui.dataset import CornerSet, RigPairing, RigResult, View, ViewStatus
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.rig import RigView
from calibgui.gui.widgets import theme

_WIDTH = 88
"""Least width of a column, device-independent px."""
_SEEN_AT_ONCE = 2
"""Number of columns that are seen beside each other."""
_STRONG, _WEAK = 150, 60
"""Opacity of a cell with three times the usual residuals, and of one where the board was found."""


class _Fit(NamedTuple):
    """The residuals of all boards in a photograph."""

    corners: int
    """Number of their corners."""
    rms: float
    """Root mean square length of their residuals, px."""
    alone: float
    """Root mean square length with the camera as it was calibrated alone, px."""


class PairingMatrix(QTableWidget):
    """Names the photographs, and says of each what was found and how well it fits."""

    instant_chosen = Signal(int, int)
    """The numbers of the camera and of the instant that the user looks at."""

    def __init__(self) -> None:
        super().__init__()
        self._pairing: RigPairing | None = None
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setTextElideMode(Qt.TextElideMode.ElideLeft)
        self.setFrameShape(QTableWidget.Shape.NoFrame)
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + theme.SPACING)
        self.horizontalHeader().setMinimumSectionSize(_WIDTH)
        self.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.setAccessibleName(self.tr("Photographs by cameras and instants"))
        self.setToolTip(
            self.tr(
                "A column for each camera, a row for each instant. Click a camera's name to choose "
                "all its photographs."
            )
        )
        self.currentCellChanged.connect(self._tell)

    def show_pairing(
        self,
        pairing: RigPairing,
        corner_sets: Sequence[Mapping[str, CornerSet]],
        result: RigResult | None,
    ) -> None:
        """Show which photographs belong together.

        Args:
            pairing: the cameras and instants.
            corner_sets: what was found in the photographs of each board, as far as they were
                searched.
            result: the rig; None while there is none.
        """
        at, chosen = (self.currentRow(), self.currentColumn()), self.list_chosen()
        self._pairing = pairing
        self.blockSignals(True)
        self.clear()
        self.setRowCount(len(pairing.instants))
        self.setColumnCount(len(pairing.cameras))
        self.setVerticalHeaderLabels(self._label_instants(pairing, result))
        self.setHorizontalHeaderLabels([camera.name for camera in pairing.cameras])
        fits = _gather_fits(result)
        out = set() if result is None else {(v.camera, v.instant) for v in result.rig.left_out}
        usual = median(view.rms for view in fits.values()) if fits else 0.0
        for c, camera in enumerate(pairing.cameras):
            found = _choose_views(corner_sets, camera.name)
            for row, instant in enumerate(pairing.instants):
                item = QTableWidgetItem()
                self.setItem(row, c, item)
                file = camera.files.get(instant)
                if file is None:
                    item.setText("–")
                    item.setForeground(QColor(theme.current().muted))
                    continue
                item.setText(file.name)
                item.setToolTip(str(file))
                view, fit = found.get(str(file)), fits.get((c, instant))
                if (c, instant) in out:
                    self._mark(item, theme.current().bad, _STRONG)
                    item.setText(self.tr("left out"))
                    item.setToolTip(self.tr("{0}: contradicts the others").format(file))
                elif fit is not None:
                    excess = (fit.rms / usual - 1) / 2 if usual else 0.0
                    strength = round(_STRONG * min(max(excess, 0.0), 1.0))
                    self._mark(item, theme.current().warning, strength)
                    item.setText(self.tr("{0} px").format(format_two_digits(fit.rms)))
                    item.setToolTip(
                        self.tr("{0}: {1} corners, {2} px rms; alone {3} px").format(
                            file, fit.corners, f"{fit.rms:.3f}", f"{fit.alone:.3f}"
                        )
                    )
                elif view is not None and view.status is not ViewStatus.FOUND:
                    self._mark(item, theme.current().bad, _WEAK)
                    item.setText(self.tr("no board"))
                    item.setToolTip(f"{file}: {view.reason}")
                elif view is not None:
                    self._mark(item, theme.current().good, _WEAK)
        self.blockSignals(False)
        if at[0] >= 0:
            self.setCurrentCell(min(at[0], self.rowCount() - 1), min(at[1], self.columnCount() - 1))
        self.choose(chosen)

    def _label_instants(self, pairing: RigPairing, result: RigResult | None) -> list[str]:
        """Return the names of the instants; in a rig of more cameras than are seen beside each
        other, with how well each fits."""
        labels = {instant: _shorten(name) for instant, name in pairing.instants.items()}
        if result is not None and len(pairing.cameras) > _SEEN_AT_ONCE:
            squares: dict[int, list[float]] = {instant: [] for instant in labels}
            for view in result.rig.views:
                squares[view.instant] += np.sum(view.residuals**2, axis=1).tolist()
            for instant, own in squares.items():
                if own:
                    fit = self.tr("{0} px").format(format_two_digits(math.sqrt(fmean(own))))
                    labels[instant] += f"  {fit}"
        return list(labels.values())

    def list_chosen(self) -> Mapping[int, list[int]]:
        """List the instants of the chosen photographs, by the number of the camera."""
        chosen: dict[int, list[int]] = {}
        if self._pairing is not None:
            instants = list(self._pairing.instants)
            for index in self.selectedIndexes():
                chosen.setdefault(index.column(), []).append(instants[index.row()])
        return chosen

    def choose(self, chosen: Mapping[int, Collection[int]]) -> None:
        """Choose photographs: instants, by the number of the camera."""
        self.clearSelection()
        shown = () if self._pairing is None else self._pairing.instants
        for row, instant in enumerate(shown):
            for camera, instants in chosen.items():
                item = self.item(row, camera)
                if instant in instants and item is not None:
                    item.setSelected(True)

    def _tell(self, row: int, column: int, *_: int) -> None:
        if self._pairing is not None and row >= 0:
            self.instant_chosen.emit(column, list(self._pairing.instants)[row])

    def _mark(self, item: QTableWidgetItem, colour: str, opacity: int) -> None:
        ground = QColor(colour)
        ground.setAlpha(opacity)
        item.setBackground(ground)


def _choose_views(corner_sets: Sequence[Mapping[str, CornerSet]], camera: str) -> dict[str, View]:
    """Return a view of each photograph of a camera: of a board that it shows, if there is one."""
    found: dict[str, View] = {}
    for corner_set in corner_sets:
        for view in corner_set[camera].views if camera in corner_set else ():
            if view.image not in found or view.status is ViewStatus.FOUND:
                found[view.image] = view
    return found


def _gather_fits(result: RigResult | None) -> dict[tuple[int, int], _Fit]:
    """Return how well the boards in a photograph fit, by the numbers of camera and instant."""
    views: dict[tuple[int, int], list[RigView]] = {}
    for view in () if result is None else result.rig.views:
        views.setdefault((view.camera, view.instant), []).append(view)
    return {place: _measure_fit(each) for place, each in views.items()}


def _measure_fit(views: Sequence[RigView]) -> _Fit:
    counts = [len(view.residuals) for view in views]
    rms, alone = (
        float(np.sqrt(np.average(np.square(values), weights=counts)))
        for values in ([view.rms for view in views], [view.alone for view in views])
    )
    return _Fit(sum(counts), rms, alone)


def _shorten(name: str) -> str:
    """Return the end of a name, in which names of instants differ."""
    return name if len(name) <= 8 else f"…{name[-7:]}"
