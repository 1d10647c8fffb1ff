"""Residuals of all corners (figure 10)."""

from __future__ import annotations

from html import escape

from PySide6.QtCore import QT_TRANSLATE_NOOP

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.dataset import Result
from calibgui.dataset.judging import recall_verdict
from calibgui.engine.assessment import (
    FAR_OFF,
    NoiseReport,
    Verdict,
    check_residuals,
    find_explanation,
    summarise_residuals,
)
from calibgui.gui.panels.evidence.plane import PlaneChoice
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.parts.scatter import ResidualScatter
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets.layouts import make_row
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.report.boards import name_point
from calibgui.report.numbers import format_count

_MARKS = {True: "✓", False: "✗"}


class ResidualsPanel(Panel):
    """Shows what the calibration leaves unexplained; a click shows the corner in its image.

    Args:
        jobs: that examine whether it looks like noise.
    """

    title = str(QT_TRANSLATE_NOOP("ResidualsPanel", "Residuals"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "ResidualsPanel",
            "Measured minus predicted corners.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._work = Latest(services.jobs, self)
        self._examined: Result | None = None
        self._report: NoiseReport | None = None
        """What was found out about `_examined`; None while it is examined."""
        self.plane = PlaneChoice()
        self.plane.currentIndexChanged.connect(self._refresh_now)
        self.scatter = ResidualScatter()
        self.scatter.setToolTip(self.tr("Click a point to see its corner in the image."))
        self.scatter.picked.connect(self._pick)
        self.verdict = ReservedLabel(3)
        choice = make_row(self.plane, None)
        self._fill_body(self.verdict, choice, (self.scatter, 1))

    def _refresh(self, result: Result) -> None:
        self._examine(result)
        calibration = result.calibration
        summary = summarise_residuals(calibration.residuals)
        x, y, e = self.plane.names
        self.scatter.show_residuals(
            self.plane.residuals(calibration), self._indices, x, y, self.plane.unit
        )
        self.scatter.set_title(
            self.tr("{0}: mean {1:.3f}, SD {2:.3f} {3}").format(
                e, summary.reference_mean, summary.reference_sd, self.plane.unit
            )
            if self.plane.on_reference
            else self.tr("σ: {0} {1:.3f}, {2} {3:.3f} px").format(
                x, summary.sigma_x, y, summary.sigma_y
            )
        )

    def _examine(self, result: Result) -> None:
        if result is self._examined:
            return
        self._examined, self._report = result, None
        self.verdict.setText(self.tr("Do the residuals look like noise? Working…"))
        self.verdict.explain("")
        self._work.start(
            self.tr("Examining the residuals"),
            lambda job: check_residuals(
                result.calibration, result.observations(), shorten_names(result.used), job.advance
            ),
            self._show_report,
            lambda error: self.verdict.setText(str(error)),
            self._forgo,
        )

    def _forgo(self) -> None:
        """The user does not want to wait; it is tried again when the panel is drawn anew."""
        self._examined = None
        self.verdict.setText(self.tr("Whether the residuals look like noise was not examined."))

    def note_verdict(self) -> None:
        """Name the cause of residuals that are no noise: the verdict on the result is known."""
        if self._report is not None:
            self._show_report(self._report)

    def _show_report(self, report: NoiseReport) -> None:
        """Say what the residuals look like; what every test found is in the tooltip.

        One trouble makes several tests fail, so the cause is taken from the verdict.
        """
        result, self._report = self._examined, report
        assert result is not None
        rows = "".join(
            f"<tr><td>{_MARKS[check.passed]}&nbsp;</td><td>{escape(check.name)}&nbsp;</td>"
            f"<td>{escape(check.finding)}</td></tr>"
            for check in report.checks
        )
        self.verdict.explain(f"<table>{rows}</table>")
        if report.passed:
            text = self.tr(
                "The residuals look like noise: nothing speaks against the ± of the result."
            )
            if report.far_corners:
                text += self.tr(
                    " Beyond {0:g} σ: {1} in {2}, each within its own uncertainty."
                ).format(
                    FAR_OFF,
                    format_count(report.far_corners, name_point(result.board)),
                    format_count(report.far_views, "view"),
                )
            self.verdict.setText(text)
            return
        if (verdict := recall_verdict(result)) is None:
            self.verdict.setText(self.tr("The residuals are not just noise. Why is being tried."))
        else:
            self._explain(verdict)

    def _explain(self, verdict: Verdict) -> None:
        """Name the cause that the verdict singles out, or none."""
        finding = find_explanation(verdict.findings)
        self.verdict.setText(
            self.tr("The residuals are not just noise, but no cause of it stands out that matters.")
            if finding is None
            else self.tr("The residuals are not just noise. {0} {1}").format(
                finding.message, finding.remedy
            )
        )

    def _select(self, k: int, corner: int) -> None:
        self.scatter.select(k, corner)

    def _hover_view(self, k: int) -> None:
        if k >= 0:
            self.scatter.select(k)
        else:
            self.scatter.select(*self._selected)
