"""Export: every format with what it keeps, what is lost, and how far a refitted camera is off."""

from __future__ import annotations

import math
import os
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtCore import Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import (
    QDialog,
    QFileDialog,
    QFormLayout,
    QListWidget,
    QPlainTextEdit,
    QWidget,
)

from calibgui.app.outputs.export_folder import ExportOutcome, export_all
from calibgui.dataset import Result
from calibgui.formats import EXPORTERS, export
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.gui.jobs.job import Job
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.actions import make_buttons
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.kept_settings import keep, read_kept_text
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.save_names import ask_for_name
from calibgui.gui.widgets.scrolling import make_thin
from calibgui.gui.widgets.wrapped_label import WrappedLabel

_FORMAT = "export format"
"""Setting with the name of the format that was saved last, which is shown first."""
_SHOWN = 20_000
"""Characters of a file that are shown."""


class ExportDialog(QDialog):
    """Shows a result in every format before it is written.

    Each format that is looked at is written to a temporary folder by a job: what is shown is
    what will be saved, and the refit's error is known beforehand.

    Args:
        jobs: which prepare and write the files.
        result: what is exported.
        parent: over which the dialog opens.
        age: a sentence that the result is out of date; "" if it is not.
    """

    exported = Signal(object)
    """The `ExportReport` of a file that was saved."""

    def __init__(
        self, jobs: Jobs, result: Result, parent: QWidget | None = None, *, age: str = ""
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(self.tr("Export"))
        self._jobs, self._result = jobs, result
        self._folder = TemporaryDirectory(prefix="calibgui-", ignore_cleanup_errors=True)
        self._drafts: dict[str, ExportReport] = {}
        self._job: Job | None = None
        self.formats = QListWidget()
        self.formats.addItems([exporter.title for exporter in EXPORTERS.values()])
        self.formats.setAccessibleName(self.tr("Formats"))
        self.formats.setMaximumWidth(self.formats.sizeHintForColumn(0) + 4 * theme.SPACING)
        self.readers, self.keeps, self.loses = (WrappedLabel() for _ in range(3))
        self.note, self.error, self.saved = (WrappedLabel() for _ in range(3))
        self.text = QPlainTextEdit(readOnly=True)
        self.text.setFont(theme.fixed_font())
        make_thin(self.text)
        self.text.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.text.setAccessibleName(self.tr("The file's text"))
        self._facts = facts = QFormLayout()
        if age:
            self.age = WrappedLabel(age)
            self.age.setStyleSheet(f"color: {theme.current().warning}")
            facts.addRow(self.tr("Result"), self.age)
        facts.addRow(self.tr("Read by"), self.readers)
        facts.addRow(self.tr("Keeps"), self.keeps)
        facts.addRow(self.tr("Loses"), self.loses)
        facts.addRow(self.tr("Camera"), self.note)
        facts.addRow(self.tr("Largest error"), self.error)
        right = make_column(facts, (self.text, 1))
        columns = make_row(self.formats, (right, 1))
        self.copy = Button(self.tr("&Copy text"), takes_enter=False)
        self.save = Button(self.tr("&Save…"), Kind.MAIN)
        self.save_all = Button(self.tr("Save &all…"), takes_enter=False)
        self.save_all.setToolTip(
            self.tr("Every format in a folder, with a page that tells who reads which file")
        )
        buttons = make_buttons(self, self.copy, self.save_all, self.save)
        self.copy.clicked.connect(self._copy)
        self.save.clicked.connect(self._save)
        self.save_all.clicked.connect(self._save_all)
        last = make_row((self.saved, 1), buttons)
        make_column((columns, 1), last, of=self, margins=theme.MARGIN)
        self.resize(880, 520)
        self.formats.currentRowChanged.connect(self._chosen)
        last_saved = read_kept_text(_FORMAT)
        names = list(EXPORTERS)
        self.formats.setCurrentRow(names.index(last_saved) if last_saved in names else 0)

    @property
    def exporter(self) -> Exporter:
        """The chosen format."""
        return list(EXPORTERS.values())[self.formats.currentRow()]

    def done(self, code: int) -> None:
        """Close, and remove the drafts."""
        if self._job is not None:
            self._job.cancel()
        self._folder.cleanup()
        super().done(code)

    def _chosen(self) -> None:
        exporter = self.exporter
        self.readers.setText(exporter.readers)
        self.keeps.setText(exporter.keeps)
        self.loses.setText(exporter.loses)
        self.saved.clear()
        if self._job is not None:
            self._job.cancel()  # of a format that was passed by
        if exporter.name in self._drafts:
            self._show(self._drafts[exporter.name])
            return
        self.note.setText(self.tr("working…"))
        self._facts.setRowVisible(self.note, True)
        self.error.clear()
        self.text.clear()
        for button in (self.copy, self.save):
            button.setEnabled(False)
        # Some formats hold the file's own name.
        draft = Path(self._folder.name) / exporter.name / exporter.file_name
        draft.parent.mkdir(exist_ok=True)
        self._job = self._jobs.start(
            self.tr("Preparing {0}").format(exporter.title),
            lambda _: exporter.write(self._result, draft),
            lambda report: self._drafted(exporter, report),
            # The draft's folder is of no use to the user.
            failed=lambda error: self.note.setText(
                str(error).replace(f"{draft.parent}{os.sep}", "")
            ),
            owner=self,
        )

    def _drafted(self, exporter: Exporter, report: ExportReport) -> None:
        self._drafts[exporter.name] = report
        if exporter is self.exporter:
            self._show(report)

    def _show(self, report: ExportReport) -> None:
        self.note.setText(report.note)
        self.error.setText(self._error(report.largest_error_px))
        is_text = True
        try:
            with report.path.open(encoding="utf-8") as file:
                shown = file.read(_SHOWN)
                shown += "\n…" if file.read(1) else ""
        except UnicodeDecodeError:
            is_text = False
            size = report.path.stat().st_size / 1e6
            shown = self.tr("A binary file of {0:.1f} MB").format(size)
        self.text.setPlainText(shown)
        self.save.setEnabled(True)
        self.copy.setEnabled(is_text)

    def _error(self, largest: float | None) -> str:
        if largest is None:
            return self.tr("none: nothing is refitted")
        if math.isnan(largest):
            return self.tr("unlimited in parts of the image that no corner covers")
        return self.tr("{0:.3g} px over the whole image").format(largest)

    def _copy(self) -> None:
        text = self._drafts[self.exporter.name].path.read_text(encoding="utf-8")
        QGuiApplication.clipboard().setText(text)
        self.saved.setText(self.tr("The text is on the clipboard."))

    def _save(self) -> None:
        exporter = self.exporter
        pattern = " ".join(f"*{suffix}" for suffix in exporter.suffixes)
        path = ask_for_name(
            self,
            self.tr("Export"),
            exporter.file_name,
            f"{exporter.title} ({pattern})",
        )
        if path is None:
            return
        keep(_FORMAT, exporter.name)
        self._jobs.start(
            self.tr("Writing {0}").format(path),
            lambda _: export(self._result, exporter.name, path),
            self._saved,
            failed=lambda error: self.saved.setText(str(error)),
            owner=self,
        )

    def _save_all(self) -> None:
        folder = QFileDialog.getExistingDirectory(self, self.tr("Folder for all formats"))
        if not folder:
            return
        self._jobs.start(
            self.tr("Writing all formats"),
            lambda _: export_all(self._result, Path(folder)),
            lambda outcomes: self._saved_all(Path(folder), outcomes),
            failed=lambda error: self.saved.setText(str(error)),
            owner=self,
        )

    def _saved_all(self, folder: Path, outcomes: list[ExportOutcome]) -> None:
        written = sum(one.report is not None for one in outcomes)
        self.saved.setText(
            self.tr("{0} of {1} formats are in {2}").format(written, len(outcomes), folder)
        )

    def _saved(self, report: ExportReport) -> None:
        self.saved.setText(self.tr("Saved as {0}").format(report.path))
        self.exported.emit(report)
