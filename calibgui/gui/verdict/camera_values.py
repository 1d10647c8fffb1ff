"""The camera's values with their ±, the choice among results, and the way to all that is known."""

from __future__ import annotations

from functools import partial
from html import escape

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QMenu, QWidget

from calibgui.app.projects.project import Project
from calibgui.dataset import Result
from calibgui.engine.camera import PINHOLE
from calibgui.gui.session.session import Session
from calibgui.gui.verdict.done_list import make_heading
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.buttons import Button, Kind
from calibgui.gui.widgets.glossary import explain
from calibgui.gui.widgets.layouts import make_column, make_row
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.report.numbers import format_with_sigma

_MOST = 10
"""Number of values that are listed: a splined lens has hundreds."""
_PAD = "padding-top:2px; padding-bottom:2px"


class CameraValues(QWidget):
    """The values of the shown result, under the results to choose from.

    Args:
        session: whose results they are.
    """

    all_wanted = Signal()
    """The user wants all values, correlations and the paper's units."""
    check_wanted = Signal()
    """The user wants to know whether the camera is still good."""
    compare_wanted = Signal(str)
    """A result that the user wants beside the one shown."""
    rename_wanted = Signal(str)
    delete_wanted = Signal(str)

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.results = NarrowCombo()
        self.results.setAccessibleName(self.tr("Result"))
        self.results.setToolTip(self.tr("Every calibration keeps its result under a name"))
        self.results.activated.connect(lambda k: session.show_result(self.results.itemText(k)))
        self.more = Button(self.tr("manage"), Kind.LINK)
        self.more.setToolTip(self.tr("Rename, delete or compare results"))
        menu = QMenu(self.more)
        self.compare = menu.addMenu(self.tr("&Compare with"))
        menu.addAction(self.tr("&Rename…"), lambda: self.rename_wanted.emit(session.result_name))
        menu.addAction(self.tr("&Delete"), lambda: self.delete_wanted.emit(session.result_name))
        self.more.setMenu(menu)
        self.values = QLabel()
        self.values.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.all = Button(self.tr("All values, correlations, the paper's units ›"), Kind.LINK)
        self.all.setToolTip(self.tr("Show everything that is known of this result"))
        self.all.clicked.connect(self.all_wanted)
        self.check = Button(self.tr("Still good? Check with new photographs ›"), Kind.LINK)
        self.check.setToolTip(
            self.tr("Or drop them here: they check the camera, and join no project")
        )
        self.check.clicked.connect(self.check_wanted)
        heading = make_heading(self.tr("Camera"))
        head = make_row(heading, (self.results, 1), None, self.more)
        parts = head, self.values, self.all, self.check, None
        make_column(*parts, of=self, spacing=theme.SPACING // 2)
        session.changed.connect(self._project_changed)
        session.result_changed.connect(self._show)
        theme.follow(self._restyle)
        self._show(session.result)

    def _project_changed(self, before: Project, after: Project) -> None:
        if before.results is not after.results:
            self._list_results()

    def _show(self, result: Result | None) -> None:
        self._list_results()
        rows = [] if result is None else _list_rows(result)
        self.values.setText(_format_html(rows))
        self.values.setAccessibleName(", ".join(" ".join(row) for row in rows))
        self.values.setToolTip("\n".join(filter(None, (explain(row[0]) for row in rows))))
        self.setVisible(result is not None)

    def _restyle(self) -> None:
        self._show(self._session.result)

    def _list_results(self) -> None:
        names, shown = list(self._session.project.results), self._session.result_name
        self.results.clear()
        self.results.addItems(names)
        self.results.setCurrentText(shown)
        self.compare.clear()
        for name in names:
            if name != shown:
                self.compare.addAction(name, partial(self.compare_wanted.emit, name))
        self.compare.setEnabled(len(names) > 1)
        self.results.setVisible(len(names) > 1)


def _list_rows(result: Result) -> list[tuple[str, str, str]]:
    """List the name of each value, the value and its ±, with the unit behind the last.

    A coefficient that is held at 0 is none of the lens.
    """
    calibration = result.calibration
    camera = calibration.camera
    rows = []
    for name, value, sigma in zip(camera.names, camera.params, calibration.sigma, strict=True):
        if value == 0 and name in calibration.fixed:
            continue
        text = format_with_sigma(float(value), float(sigma))
        unit = " px" if name in PINHOLE else ""
        digits, _, power = text.strip("(").partition(")")
        number, error = (part and part + power for part in digits.partition(" ± ")[::2])
        rows.append((name, number, f"± {error}{unit}" if error else ""))
    return rows[:_MOST]


def _format_html(rows: list[tuple[str, str, str]]) -> str:
    """Format rows as a table whose columns of numbers end alike."""
    muted = theme.current().muted
    lines = " ".join(
        f'<tr><td width="20%" style="color:{muted}; {_PAD}">{escape(name)}</td>'
        f'<td align="right" style="{_PAD}">{escape(value)}</td>'
        f'<td align="right" width="36%" style="color:{muted}; {_PAD}">{escape(sigma)}</td></tr>'
        for name, value, sigma in rows
    )
    return f'<table width="100%">{lines}</table>'
