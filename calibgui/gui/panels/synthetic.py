"""The synthetic check (paper 5.2): Table 3 and figures 13 to 16 beside the real ones."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QPushButton,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.calibration import shorten_names
from calibgui.app.synthetic import BLUR_PX, SyntheticCheck, run_synthetic_check
from calibgui.dataset import Result
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.images import Image, render_view
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.before_after import BeforeAfter, Grey
from calibgui.gui.panels.latest import Latest
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.gui.panels.synthetic_figures import Histograms, ParameterTable, PoseErrors, Scatters


class SyntheticPanel(Panel):
    """Renders the views from the result, calibrates them again and compares.

    Args:
        jobs: that do the work.
        read: the image of a path, called in a worker.
    """

    title = str(QT_TRANSLATE_NOOP("SyntheticPanel", "Synthetic check"))

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._jobs, self._read_image = services.jobs, services.read_image
        self._job: Job | None = None
        self._pictures = Latest(services.jobs, self)
        self._drawn: set[QWidget] = set()
        """Tabs that show the check already."""
        self.check: SyntheticCheck | None = None
        self.run = QPushButton(self.tr("&Render and calibrate"))
        self.run.setToolTip(
            self.tr(
                "Renders every view from the result, finds the corners again and calibrates:\n"
                "what comes back is known exactly, so it shows the error of the method itself."
            )
        )
        self.run.clicked.connect(self._run)
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.table = ParameterTable()
        self.images = BeforeAfter(self.tr("real"), self.tr("synthetic"))
        self.errors = PoseErrors()
        self.scatters = Scatters()
        self.histograms = Histograms()
        self.tabs = QTabWidget(documentMode=True)
        self._draw: dict[QWidget, Callable[[SyntheticCheck], None]] = {}
        """How each tab is drawn."""
        for widget, name, draw in (
            (self.table, self.tr("Table 3"), self.table.show_check),
            (self.images, self.tr("Images"), self._render),
            (self.errors, self.tr("Poses"), self.errors.show_check),
            (self.scatters, self.tr("Residuals"), self._scatter),
            (self.histograms, self.tr("Histograms"), self.histograms.show_check),
        ):
            self.tabs.addTab(widget, name)
            self._draw[widget] = draw
        self.tabs.currentChanged.connect(self._draw_tab)
        keeping = self.tabs.sizePolicy()
        keeping.setRetainSizeWhenHidden(True)
        self.tabs.setSizePolicy(keeping)
        bar = QHBoxLayout()
        bar.addWidget(self.run)
        bar.addWidget(self.words, 1)
        layout = QVBoxLayout(self.body)
        layout.addLayout(bar)
        layout.addWidget(self.tabs, 1)

    def show_result(self, result: Result | None) -> None:
        """Forget the check of another result."""
        self.check = None
        if self._job is not None:
            self._job.cancel()
        super().show_result(result)

    def _run(self) -> None:
        result = self._result
        assert result is not None
        if self._job is not None:
            self._job.cancel()
            return
        self.run.setText(self.tr("&Cancel"))
        self.words.setText(self.tr("Rendering the views and searching them…"))
        self._job = self._jobs.start(
            self.tr("Synthetic check"),
            lambda job: run_synthetic_check(result, progress=job.advance),
            self._done,
            failed=lambda error: self.words.setText(str(error)),
            ended=self._ended,
        )

    def _done(self, check: SyntheticCheck) -> None:
        if check.real is self._result:
            self.check = check
            self._refresh_now()

    def _ended(self) -> None:
        self._job = None
        self.run.setText(self.tr("&Render and calibrate"))
        if self.check is None and self._result is not None:
            self._refresh_now()

    def _refresh(self, result: Result) -> None:
        check = self.check
        self.tabs.setVisible(check is not None)
        self.run.setEnabled(result.board is not None)
        if check is None:
            if self._job is None:
                self.words.setText(self._invitation(result))
            return
        self._drawn.clear()
        self._draw_tab()
        real, made = (
            summarise_residuals(r.calibration.residuals) for r in (check.real, check.synthetic)
        )
        self.words.setText(
            self.tr(
                "{0} of {1} views found again. e′ = {2:.4f} ± {3:.4f} reference px, "
                "real images {4:.3f} ± {5:.3f}."
            ).format(
                len(check.synthetic.used),
                len(check.synthetic.views),
                made.reference_mean,
                made.reference_sd,
                real.reference_mean,
                real.reference_sd,
            )
        )

    def _invitation(self, result: Result) -> str:
        if result.board is None:
            return self.tr("The board's pattern is not known, so its views cannot be rendered.")
        return self.tr("Would the method find this camera again, if it were just so?")

    def _draw_tab(self) -> None:
        """Draw the tab in front, unless it is up to date; the others can wait."""
        tab, check = self.tabs.currentWidget(), self.check
        if check is None or tab in self._drawn:
            return
        self._drawn.add(tab)
        self._draw[tab](check)

    def _select(self, k: int, corner: int) -> None:
        if self.check is None:
            return
        if self.scatters in self._drawn:
            self.scatters.select(self.check, k, corner)
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
