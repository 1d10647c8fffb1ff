"""The synthetic check (paper 5.2): Table 3 and figures 13 to 16 beside the real ones."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import QWidget

from calibgui.app.calibrating.calibration import shorten_names
from calibgui.app.calibrating.synthetic import (
    BLUR_PX,
    SyntheticCheck,
    measure_corner_noise,
    run_synthetic_check,
)
from calibgui.app.calibrating.synthetic_verdict import (
    describe_synthetic_verdict,
    judge_synthetic_check,
)
from calibgui.dataset import Result
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.images import Image, render_view
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.method.synthetic_figures import (
    Histograms,
    ParameterTable,
    PoseErrors,
    Scatters,
)
from calibgui.gui.panels.on_demand import OnDemandPanel
from calibgui.gui.panels.parts.divided_images import DividedImages, Grey
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets.tab_bar import TabWidget


class SyntheticPanel(OnDemandPanel[SyntheticCheck]):
    """Renders the views from the result, calibrates them again and compares."""

    title = str(QT_TRANSLATE_NOOP("SyntheticPanel", "Synthetic check"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "SyntheticPanel",
            "Whether the method finds this camera again.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(
            services,
            button=self.tr("&Render and calibrate"),
            tip=self.tr(
                "Renders every view from the result, finds the corners again, adds the noise that\n"
                "was found and calibrates: what must come back is known exactly."
            ),
            label=self.tr("Synthetic check"),
            working=self.tr("Rendering the views and searching them…"),
        )
        self._read_image = services.read_image
        self._pictures = Latest(services.jobs, self)
        self._drawn: set[QWidget] = set()
        """Tabs that show the check already."""
        self.table = ParameterTable()
        self.images = DividedImages(self.tr("real"), self.tr("synthetic"))
        self.errors = PoseErrors()
        self.scatters = Scatters()
        self.histograms = Histograms()
        self.tabs = TabWidget()
        self._draw: dict[QWidget, Callable[[SyntheticCheck], None]] = {}
        """Function that draws each tab."""
        for widget, name, draw in (
            (self.table, self.tr("Table"), self.table.show_check),
            (self.images, self.tr("Images"), self._render),
            (self.errors, self.tr("Poses"), self.errors.show_check),
            (self.scatters, self.tr("Residuals"), self._scatter),
            (self.histograms, self.tr("Histograms"), self.histograms.show_check),
        ):
            self.tabs.addTab(widget, name)
            self._draw[widget] = draw
        self.tabs.setTabToolTip(0, self.tr("Table 3 of the paper"))
        self.tabs.currentChanged.connect(self._draw_tab)
        self._lay_out(self.tabs)

    def _missing(self, result: Result) -> str:
        if result.board is not None:
            return ""
        return self.tr("The board's pattern is not known, so its views cannot be rendered.")

    def _invite(self, result: Result) -> str:  # noqa: ARG002 - the same for all
        return self.tr("Would the method find this camera again, if it were just so?")

    def _find(self, result: Result, job: Job) -> SyntheticCheck:
        noise = measure_corner_noise(result)
        return run_synthetic_check(result, corner_noise=noise, progress=job.advance)

    def _show_found(self, result: Result, found: SyntheticCheck) -> None:  # noqa: ARG002 - holds it
        self._drawn.clear()
        self._draw_tab()
        real, made = (
            summarise_residuals(r.calibration.residuals) for r in (found.real, found.synthetic)
        )
        verdict = describe_synthetic_verdict(found, judge_synthetic_check(found))
        self.words.setText(
            verdict
            + "\n"
            + self.tr(
                "{0} of {1} views found again. e′ = {2:.4f} ± {3:.4f} reference px, "
                "real images {4:.3f} ± {5:.3f}."
            ).format(
                len(found.synthetic.used),
                len(found.synthetic.views),
                made.reference_mean,
                made.reference_sd,
                real.reference_mean,
                real.reference_sd,
            )
        )

    def _draw_tab(self) -> None:
        """Draw the tab in front, unless it is up to date; the others can wait."""
        tab, check = self.tabs.currentWidget(), self.found
        if check is None or tab in self._drawn:
            return
        self._drawn.add(tab)
        self._draw[tab](check)

    def _select(self, k: int, corner: int) -> None:
        if self.found is None:
            return
        if self.scatters in self._drawn:
            self.scatters.select(self.found, k, corner)
        self._drawn.discard(self.images)
        self._draw_tab()

    def _scatter(self, check: SyntheticCheck) -> None:
        self.scatters.show_check(check)
        self.scatters.select(check, *self._selected)

    def _render(self, check: SyntheticCheck) -> None:
        """Show the selected view beside its synthetic version."""
        result, view = check.real, max(self._selected[0], 0)
        self._pictures.start(
            self.tr("Rendering {0}").format(shorten_names(result.used)[view]),
            lambda _: render_pair(result, view, self._read_image),
            lambda images: self.images.show_images(*images),
            lambda error: self.words.setText(str(error)),
        )


def render_pair(result: Result, k: int, read: Callable[[str], Image]) -> tuple[Grey, Grey]:
    """Figure 13: the image of calibrated view k, and its synthetic version.

    Raises:
        CalibrationError: if the image cannot be read.
    """
    assert result.board is not None
    real = read(result.used[k].image).grey
    pose = result.calibration.poses[k]
    return real, render_view(result.calibration.camera, pose, result.board, blur=BLUR_PX)
