"""Two results side by side: their parameters, their difference over the image, and one image."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import QComboBox, QLabel

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.app.outputs.previews import undistort_alike
from calibgui.dataset import Result
from calibgui.engine.assessment import CameraDifference, compare_cameras
from calibgui.engine.numbers import format_two_digits
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.difference_map import DifferenceMap
from calibgui.gui.panels.parts.divided_images import DividedImages
from calibgui.gui.panels.parts.estimates import estimate_columns
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.gui.widgets.tab_bar import TabWidget
from calibgui.gui.widgets.tables import Column, Table, with_decimals, with_digits
from calibgui.report.comparison import ParameterChange, compare_parameters

_MUCH_SIGMAS = 3.0
"""Difference of a parameter, in sigma, from which its row is marked: one in 370 by chance."""


class ComparePanel(Panel):
    """Sets any two named results of the project side by side.

    At first they are the one that is shown, right, and the one before it, left.
    """

    title = str(QT_TRANSLATE_NOOP("ComparePanel", "Compare"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "ComparePanel",
            "Two results side by side: parameters, difference over the image, one image by both.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._read_image = services.read_image
        self._difference_work = Latest(services.jobs, self)
        self._image_work = Latest(services.jobs, self)
        self._results: Mapping[str, Result] = {}
        self._difference: CameraDifference | None = None
        self.left = self._make_choice(self.tr("Left result"))
        self.right = self._make_choice(self.tr("Right result"))
        self.words = ReservedLabel(3)
        self.parameters = Table()
        self.parameters.setAccessibleName(self.tr("Parameters of both results"))
        self.map = DifferenceMap()
        self.images = DividedImages("", "")
        self.images.setAccessibleName(self.tr("One image undistorted by both results"))
        self.tabs = TabWidget()
        for widget, name in (
            (self.parameters, self.tr("Parameters")),
            (self.map, self.tr("Difference [px]")),
            (self.images, self.tr("Split image")),
        ):
            self.tabs.addTab(widget, name)
        self.tabs.currentChanged.connect(self._show_image)
        against = QLabel(self.tr("and"))
        above = make_row((self.left, 1), against, (self.right, 1))
        self._fill_body(above, self.words, (self.tabs, 1))

    def _make_choice(self, name: str) -> QComboBox:
        choice = NarrowCombo()
        choice.setAccessibleName(name)
        choice.setToolTip(self.tr("Every calibration keeps its result under a name"))
        choice.activated.connect(self._refresh_now)
        return choice

    @property
    def names(self) -> tuple[str, str]:
        """Names of the left and the right result."""
        return self.left.currentText(), self.right.currentText()

    def offer_results(self, results: Mapping[str, Result]) -> None:
        """Offer the project's results, the oldest first; those chosen stay while they exist."""
        if results is self._results:
            return
        self._results = results
        chosen = self.names
        for choice, name in zip((self.left, self.right), chosen, strict=True):
            choice.clear()
            choice.addItems(list(results))
            choice.setCurrentText(name)
        if self._result is not None:
            self.show_result(self._result)

    def show_result(self, result: Result | None) -> None:
        """Set the result that is shown at the right, and the one before it at the left."""
        names = [name for name, one in self._results.items() if one is result]
        left, right = self.names
        if names and (right != names[-1] or left == right):
            self._choose_beside(names[-1])
        super().show_result(result)

    def compare(self, left: str, right: str) -> None:
        """Compare the results of these names."""
        self.left.setCurrentText(left)
        self.right.setCurrentText(right)
        self._refresh_now()

    def _choose_beside(self, right: str) -> None:
        """Choose a result for the right, and another one for the left."""
        names = list(self._results)
        left = self.left.currentText()
        if left == right or left == self.right.currentText():
            left = names[max(names.index(right) - 1, 0)]
        if left == right:
            left = next((name for name in names if name != right), right)
        self.left.setCurrentText(left)
        self.right.setCurrentText(right)

    def _missing(self, result: Result) -> str:  # noqa: ARG002 - it is about all results
        if len(self._results) > 1:
            return ""
        return self.tr(
            "There is one result. Calibrate again with other settings or other images, and compare "
            "the two here."
        )

    def _refresh(self, result: Result) -> None:  # noqa: ARG002 - the choices say which
        a, b = (self._results[name] for name in self.names)
        rows = compare_parameters(a.calibration, b.calibration)
        self._show_parameters(rows)
        self._difference = None
        self.words.setText(self.tr("Comparing…"))
        self.images.set_names(*self.names)
        self.images.show_images(None, None)
        self._difference_work.start(
            self.tr("Comparing {0} and {1}").format(*self.names),
            lambda _: compare_cameras(
                a.calibration.camera, b.calibration.camera, views=b.observations()
            ),
            partial(self._show_difference, b, rows),
            self._fail,
        )

    def _restyle(self) -> None:
        """Whatever has colours follows them by itself."""

    def _show_parameters(self, rows: Sequence[ParameterChange]) -> None:
        names = self.names
        self.parameters.show_columns(
            [
                Column(self.tr("Parameter"), [row.name for row in rows]),
                *estimate_columns(names[0], [r.a for r in rows], [r.sigma_a for r in rows]),
                *estimate_columns(names[1], [r.b for r in rows], [r.sigma_b for r in rows]),
                Column(
                    self.tr("Difference"),
                    [row.change for row in rows],
                    with_digits(3),
                    self.tr("{1} less {0}").format(*names),
                    optional=True,
                ),
                Column(
                    self.tr("in σ"),
                    [row.sigmas for row in rows],
                    with_decimals(2),
                    self.tr(
                        "Over the standard deviation of a difference of independent estimates.\n"
                        "Results from the same images share their errors: even 1 is much then."
                    ),
                ),
            ],
            {
                k: self.tr("differs by more than 3 σ")
                for k, row in enumerate(rows)
                if abs(row.sigmas) > _MUCH_SIGMAS
            },
        )

    def _show_difference(
        self, b: Result, rows: Sequence[ParameterChange], difference: CameraDifference
    ) -> None:
        self._difference = difference
        corners = np.concatenate([view.uv for view in b.observations()])
        self.map.show_difference(difference, difference.size, corners)
        words = self.tr(
            "Where corners were seen the two image the same point up to {0} px apart, {1} px RMS."
        ).format(*map(format_two_digits, (difference.worst, difference.rms)))
        comparable = [row for row in rows if np.isfinite(row.sigmas)]
        if comparable:
            most = max(comparable, key=lambda row: abs(row.sigmas))
            words += " " + self.tr("Of the parameters {0} differs most, by {1:.1f} σ.").format(
                most.name, abs(most.sigmas)
            )
        self.words.setText(words)
        self._show_image()

    def _fail(self, error: Exception) -> None:
        self._difference = None
        self.words.setText(str(error))
        self.map.show_reason(str(error))

    def _select(self, k: int, corner: int) -> None:  # noqa: ARG002 - the image is shown whole
        self._show_image()

    def _show_image(self) -> None:
        """Undistort the selected image by both results, if that is to be seen."""
        result, difference = self._result, self._difference
        if result is None or difference is None or self.tabs.currentWidget() is not self.images:
            return
        view = max(self._selected[0], 0)
        image, name = result.used[view].image, shorten_names(result.used)[view]
        a, b = (self._results[name] for name in self.names)
        self._image_work.start(
            self.tr("Undistorting {0}").format(name),
            lambda _: undistort_alike(a, b, difference.turn, image, self._read_image),
            lambda images: self.images.show_images(*images),
            self._fail_image,
        )

    def _fail_image(self, error: Exception) -> None:
        self.images.show_images(None, None)
        self.words.setText(str(error))
