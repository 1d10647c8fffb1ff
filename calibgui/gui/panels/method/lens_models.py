"""The panel that compares lens models, and takes the recommended one or another over."""

from __future__ import annotations

from PySide6.QtCore import QT_TRANSLATE_NOOP
from PySide6.QtWidgets import QWidget

from calibgui.app.calibrating.lens_comparison import compare_lenses_again
from calibgui.dataset import Result
from calibgui.engine.assessment import LensChoice
from calibgui.gui.jobs.job import Job
from calibgui.gui.panels.method.lens_tables import LensTables
from calibgui.gui.panels.on_demand import OnDemandPanel, have_same_views
from calibgui.gui.panels.services import Services
from calibgui.gui.widgets.buttons import Button
from calibgui.gui.widgets.layouts import make_column
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.report.boards import name_point
from calibgui.report.lens_choice import LensRow, describe_lens_choice, list_lens_rows
from calibgui.report.lens_models import describe_lens_model, get_lens_title
from calibgui.report.numbers import format_count

_SETTINGS = ("cost", "method", "board_shape", "is_board_shape_held", "prior")
"""Settings of a result that a comparison of lens models depends on."""


class LensModelsPanel(OnDemandPanel[LensChoice]):
    """Tries all lens models on the views of the result, and takes the one that the user chooses."""

    title = str(QT_TRANSLATE_NOOP("LensModelsPanel", "Lens models"))
    purpose = str(
        QT_TRANSLATE_NOOP(
            "LensModelsPanel",
            "All lens models on the same corners, by what they predict of unseen views.",
        )
    )

    def __init__(self, services: Services) -> None:
        super().__init__(
            services,
            button=self.tr("C&ompare lens models"),
            tip=self.tr(
                "Calibrates every lens model from these views, and again without some of them, to "
                "see how well it predicts what it has not seen. Takes a while."
            ),
            label=self.tr("Comparing lens models"),
            working=self.tr("Calibrating every lens model several times…"),
        )
        self._rows: list[LensRow] = []
        self._chosen: LensRow | None = None
        """The selected row."""
        self.use = Button(self.tr("&Use this model"))
        self.use.setToolTip(self.tr("Set the selected lens model in the Set-up and calibrate."))
        self.use.clicked.connect(self._use)
        self.tables = LensTables()
        self.tables.picked.connect(self._show_row)
        self.remarks = ReservedLabel(6)
        compared = QWidget()
        make_column((self.tables, 1), self.remarks, of=compared)
        self._lay_out(compared, self.use)

    def _missing(self, result: Result) -> str:
        if result.calibration.diagnosis is None:
            return ""
        return self.tr(
            "The views do not determine the camera: lens models cannot be compared on them."
        )

    def _forget(self) -> None:
        super()._forget()
        self._chosen = None

    def _holds_for(self, asked: Result, result: Result) -> bool:
        a, b = asked.calibration.settings, result.calibration.settings
        alike = all(getattr(a, name) == getattr(b, name) for name in _SETTINGS)
        return alike and have_same_views(asked, result)

    def _invite(self, result: Result) -> str:
        model = get_lens_title(result.calibration.camera.model)
        return self.tr("This result is of the lens model {0}. Does another one do better?").format(
            model
        )

    def _find(self, result: Result, job: Job) -> LensChoice:
        return compare_lenses_again(result, job.advance)

    def _show_found(self, result: Result, found: LensChoice) -> None:  # noqa: ARG002 - of no result
        refused = [
            self.tr("{0} cannot be calibrated: {1}").format(get_lens_title(model), reason)
            for model, reason in found.refused.items()
        ]
        self.words.setText("\n".join([describe_lens_choice(found), *refused]))
        self._rows = list_lens_rows(found)
        self.tables.show_rows(self._rows)
        models = [row.model for row in self._rows]
        chosen = found.model if self._chosen is None else self._chosen.model
        shown = models.index(chosen if chosen in models else found.model)
        self.tables.select(shown)
        self._show_row(shown)

    def _use(self) -> None:
        if self._chosen is not None:
            self.lens_wanted.emit(self._chosen.model, self._chosen.held)

    def _show_row(self, row: int) -> None:
        """Show what there is to know of a lens model, and offer it."""
        shown = self._chosen = self._rows[row]
        board = None if self._result is None else self._result.board
        fit = self.tr("{0}: RMS {1:.3f} px, σx {2:.3f} px and σy {3:.3f} px of {4}.").format(
            get_lens_title(shown.model),
            shown.rms,
            shown.sigma_x,
            shown.sigma_y,
            format_count(shown.corners, name_point(board)),
        )
        remarks = [f"{'; '.join(shown.remarks)}."] if shown.remarks else []
        self.remarks.setText("\n".join([fit, *remarks, describe_lens_model(shown.model)]))
