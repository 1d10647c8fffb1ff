"""The report on a calibration: what the program cannot know is stated, and the file is written."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFormLayout,
    QLineEdit,
    QWidget,
)

from calibgui.app.outputs.report_files import ReportStyle, write_report
from calibgui.app.projects.project import Project
from calibgui.dataset import Result
from calibgui.dataset.details import Details
from calibgui.gui.jobs.job import Job
from calibgui.gui.session.session import Session
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_buttons
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.report.calibration_report import Layout
from calibgui.report.rendering import PAPERS

_NAME = "report.pdf"
"""The name that a file is given unless the user chooses another."""


class ReportDialog(QDialog):
    """Takes what a report says beside the calibration, keeps it with the project, and writes.

    Args:
        session: whose project keeps the details.
        result: the calibration.
        parent: over which the dialog opens.
        age: a sentence that the result is out of date; "" if it is not.
    """

    written = Signal(object)
    """The path of a report that was written."""

    def __init__(
        self, session: Session, result: Result, parent: QWidget | None = None, *, age: str = ""
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Report"))
        self._session, self._result = session, result
        self.layout_choice, self.paper = NarrowCombo(), QComboBox()
        for layout, text, tip in (
            (Layout.REPORT, self.tr("Report"), self.tr("All that is known")),
            (
                Layout.CERTIFICATE,
                self.tr("Certificate"),
                self.tr("After ISO/IEC 17025, 7.8.2 and 7.8.4"),
            ),
        ):
            self.layout_choice.add_explained(text, layout, tip)
        for name, text in zip(PAPERS, ("A4", self.tr("Letter")), strict=True):
            self.paper.addItem(text, name)
        known = session.project.details
        self.boxes = {
            name: QLineEdit(getattr(known, name), placeholderText=self.tr("not stated"))
            for name in self._list_labels()
        }
        labels = list(self._list_labels().items())
        half = (len(labels) + 1) // 2
        forms = QFormLayout(), QFormLayout()
        for k, (name, label) in enumerate(labels):
            self.boxes[name].setMinimumWidth(20 * self.fontMetrics().averageCharWidth())
            forms[k // half].addRow(label, self.boxes[name])
        forms[0].insertRow(0, self.tr("&Layout"), self.layout_choice)
        forms[1].insertRow(0, self.tr("Pa&per"), self.paper)
        columns = make_row(*((form, 1) for form in forms))
        self.words = WrappedLabel(
            age
            or self.tr(
                "What stands here is kept with the project. For PDF: "
                "pip install 'calibgui[report]'."
            )
        )
        self.save = Button(self.tr("&Save…"), Kind.MAIN)
        buttons = make_buttons(self, self.save)
        self.save.clicked.connect(self._save)
        last = make_row((self.words, 1), buttons)
        make_column(columns, None, last, of=self, margins=theme.MARGIN)
        self.resize(820, self.sizeHint().height())

    def _list_labels(self) -> dict[str, str]:
        """Return what the fields of `Details` are called."""
        return {
            "id": self.tr("Number of the report"),
            "operator": self.tr("Operator"),
            "laboratory": self.tr("Laboratory"),
            "place": self.tr("Place of calibration"),
            "temperature": self.tr("Temperature"),
            "customer": self.tr("Customer"),
            "camera": self.tr("Camera"),
            "camera_serial": self.tr("Serial number of the camera"),
            "lens": self.tr("Lens"),
            "lens_serial": self.tr("Serial number of the lens"),
            "setting": self.tr("Aperture, focus, zoom"),
            "condition": self.tr("Condition of the item"),
            "received": self.tr("Date of receipt"),
            "calibrated": self.tr("Date of calibration"),
            "board": self.tr("Identification of the board"),
            "board_certificate": self.tr("Certificate of the board"),
            "remarks": self.tr("Remarks"),
            "signatory": self.tr("Authorised by"),
        }

    @property
    def details(self) -> Details:
        """The details that are stated now."""
        return Details(**{field.name: self.boxes[field.name].text() for field in fields(Details)})

    def done(self, code: int) -> None:
        """Keep what is stated, and close."""
        self._keep()
        super().done(code)

    def _keep(self) -> None:
        """Keep what is stated with the project."""
        details = self.details

        def change(project: Project) -> Project:
            return replace(project, details=details)

        if details != self._session.project.details:
            self._session.edit(self.tr("Details of the report"), change)

    def _save(self) -> None:
        kinds = f"PDF (*.pdf);;{self.tr('Web page')} (*.html)"
        path = ask_for_name(self, self.tr("Report"), _NAME, kinds)
        if path is None:
            return
        self._keep()
        details, result = self.details, self._result
        layout = Layout(self.layout_choice.currentData())
        style = ReportStyle(layout, self.paper.currentData())

        def work(job: Job) -> Path:
            write_report(result, path, details, style, check=job.check)
            return path

        self._session.jobs.start(
            self.tr("Writing {0}").format(path),
            work,
            self._written,
            failed=lambda error: self.words.setText(str(error)),
            owner=self,
        )

    def _written(self, path: Path) -> None:
        self.words.setText(self.tr("Saved as {0}").format(path))
        self.written.emit(path)
