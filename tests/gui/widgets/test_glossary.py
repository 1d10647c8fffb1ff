"""Every term of headings and axes has its sentence, where the cursor finds it."""

from __future__ import annotations

import re

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.widgets.glossary import explain, list_terms
from calibgui.gui.widgets.plots import Plot
from calibgui.gui.widgets.tables import Column, Table
from calibgui.gui.window.main_window import MainWindow

PLAIN = {"Parameter", "View", "Unit", "Remark", "Remarks", "Method", "Lens model", "Coefficients"}
"""Headings that every reader understands."""
TIP = Qt.ItemDataRole.ToolTipRole


def test_each_term_has_one_plain_sentence() -> None:
    for term, sentence in list_terms().items():
        assert re.fullmatch(r"[A-Z0-9Δ‘][^\n]*[^.]\.", sentence), term
        assert sentence.count(". ") == 0 and len(sentence) < 120, term
        assert not sentence.startswith(term)


@pytest.mark.parametrize(
    ("text", "terms"),
    [
        ("g(r)", ["g(r)"]),
        ("e′ [reference px]", ["reference px", "e′"]),
        ("first ± 1σ", ["± 1σ"]),
        ("tilt upwards [°]", ["tilt"]),
        ("density [1/px]", ["density"]),
        ("Steps", []),
        ("view", []),
    ],
)
def test_terms_are_found_as_whole_words(text: str, terms: list[str]) -> None:
    assert explain(text).splitlines() == [f"{term}: {list_terms()[term]}" for term in terms]


def test_a_heading_without_a_tip_of_its_own_is_explained(qtbot: QtBot) -> None:
    table = Table()
    qtbot.addWidget(table)
    table.show_columns([Column("Parameter", ["k1", "cx"]), Column("RMS", [1.0, 2.0], tip="own")])
    model = table.model()
    assert model.index(0, 0).data(TIP) == list_terms()["k1"]
    assert model.headerData(1, Qt.Orientation.Horizontal, TIP) == "own"


def test_headings_and_axes_say_what_they_mean(full: MainWindow, qtbot: QtBot) -> None:
    for kind in PANELS:
        full.need_analysis().show_panel(kind)
        qtbot.waitUntil(lambda: not full.session.jobs.running, timeout=60_000)
    panel = full.need_analysis()
    for table in panel.findChildren(Table):
        for section in range(table.model().columnCount()):
            header = table.model().headerData(section, Qt.Orientation.Horizontal)
            tip = table.model().headerData(section, Qt.Orientation.Horizontal, TIP)
            assert tip or header in PLAIN or table.isColumnHidden(section), header
    for plot in panel.findChildren(Plot):
        for name, label in plot._labels.items():
            axis = plot.area.axes[name]
            assert axis.toolTip() or plot.toolTip() or label in ("", "view"), label
