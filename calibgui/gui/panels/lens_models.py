"""The lens models side by side, and the one that the views recommend."""

from __future__ import annotations

from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout

from calibgui.app.lens_comparison import compare_lenses_again
from calibgui.dataset import Result
from calibgui.engine.assessment import LensChoice
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.lens_tables import LensTables
from calibgui.gui.panels.panel import Panel
from calibgui.gui.panels.services import Services
from calibgui.report.lens_choice import LensRow, describe_lens_choice, list_lens_rows
from calibgui.report.lens_models import describe_lens_model, get_lens_title
from calibgui.report.numbers import format_count

_SETTINGS = ("cost", "method", "plate", "plate_held", "prior_mm")
"""Keys of a result's settings that a comparison of lens models depends on."""


class LensModelsPanel(Panel):
    """Tries all lens models on the views of the result, and takes the one that the user chooses."""

    title = str(QT_TRANSLATE_NOOP("LensModelsPanel", "Lens models"))

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self._jobs = services.jobs
        self._job: Job | None = None
        self._rows: list[LensRow] = []
        self._chosen: LensRow | None = None
        """The selected row."""
        self._compared: Result | None = None
        """Result whose views were compared on."""
        self.choice: LensChoice | None = None
        self.run = QPushButton(self.tr("C&ompare lens models"))
        self.run.setToolTip(
            self.tr(
                "Calibrates every lens model from these views, and again without some of them, to "
                "see how well it predicts what it has not seen. Takes a while."
            )
        )
        self.run.setMinimumWidth(self.run.sizeHint().width())  # also while it says Cancel
        self.run.clicked.connect(self._run)
        self.use = QPushButton(self.tr("&Use this model"))
        self.use.setToolTip(self.tr("Set the selected lens model in the Settings and calibrate."))
        self.use.clicked.connect(self._use)
        self.words, self.remarks = QLabel(), QLabel()
        for label in (self.words, self.remarks):
            label.setWordWrap(True)
        self.tables = LensTables()
        self.tables.picked.connect(self._show_row)
        bar = QHBoxLayout()
        bar.addWidget(self.run)
        bar.addStretch(1)
        bar.addWidget(self.use)
        layout = QVBoxLayout(self.body)
        layout.addLayout(bar)
        layout.addWidget(self.words)
        layout.addWidget(self.tables, 1)
        layout.addWidget(self.remarks)

    def show_result(self, result: Result | None) -> None:
        """Forget the comparison unless it is on the views of this result."""
        known = self._compared
        if known is None or result is None or not _have_same_question(known, result):
            self.choice = self._compared = None
            if self._job is not None:
                self._job.cancel()
        super().show_result(result)

    def _missing(self, result: Result) -> str:
        if result.calibration.diagnosis is None:
            return ""
        return self.tr(
            "The views do not determine the camera: lens models cannot be compared on them."
        )

    def _run(self) -> None:
        result = self._result
        assert result is not None
        if self._job is not None:
            self._job.cancel()
            return
        self.choice, self._compared, self._chosen = None, result, None
        self.run.setText(self.tr("&Cancel"))
        self.words.setText(self.tr("Calibrating every lens model several times…"))
        self._job = self._jobs.start(
            self.tr("Comparing lens models"),
            lambda job: compare_lenses_again(result, job.advance),
            self._done,
            failed=lambda error: self.words.setText(str(error)),
            ended=self._ended,
            owner=self,
        )
        self._refresh_now()

    def _done(self, choice: LensChoice) -> None:
        self.choice = choice
        self._refresh_now()

    def _ended(self) -> None:
        cancelled = self._job is not None and self._job.cancelled
        self._job = None
        self.run.setText(self.tr("C&ompare lens models"))
        if cancelled and self._result is not None:
            self._refresh_now()

    def _refresh(self, result: Result) -> None:
        choice = self.choice
        for widget in (self.tables, self.use, self.remarks):
            widget.setVisible(choice is not None)
        if choice is None:
            if self._job is None:
                self.words.setText(self._invite(result))
            return
        refused = [
            self.tr("{0} cannot be calibrated: {1}").format(get_lens_title(model), reason)
            for model, reason in choice.refused.items()
        ]
        self.words.setText("\n".join([describe_lens_choice(choice), *refused]))
        self._rows = list_lens_rows(choice)
        self.tables.show_rows(self._rows)
        models = [row.model for row in self._rows]
        chosen = choice.model if self._chosen is None else self._chosen.model
        shown = models.index(chosen if chosen in models else choice.model)
        self.tables.select(shown)
        self._show_row(shown)

    def _use(self) -> None:
        if self._chosen is not None:
            self.lens_wanted.emit(self._chosen.model, self._chosen.held)

    def _invite(self, result: Result) -> str:
        model = get_lens_title(result.calibration.camera.model)
        return self.tr("This result is of the lens model {0}. Does another one do better?").format(
            model
        )

    def _show_row(self, row: int) -> None:
        """Show what there is to know of a lens model, and offer it."""
        shown = self._chosen = self._rows[row]
        fit = self.tr("{0}: RMS {1:.3f} px, σx {2:.3f} px and σy {3:.3f} px of {4}.").format(
            shown.model,
            shown.rms,
            shown.sigma_x,
            shown.sigma_y,
            format_count(shown.corners, "corner"),
        )
        remarks = [f"{'; '.join(shown.remarks)}."] if shown.remarks else []
        self.remarks.setText("\n".join([fit, *remarks, describe_lens_model(shown.model)]))


def _have_same_question(a: Result, b: Result) -> bool:
    """Return whether two results are from the same views, calibrated alike but for the lens."""
    alike = all(a.calibration.settings.get(k) == b.calibration.settings.get(k) for k in _SETTINGS)
    same = len(a.used) == len(b.used) and all(x is y for x, y in zip(a.used, b.used, strict=True))
    return alike and same
