"""Lines break between words, not within values."""

from __future__ import annotations

import pytest
from PySide6.QtGui import QTextLayout
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets.wrapped_label import WrappedLabel, typeset


@pytest.mark.parametrize(
    ("text", "joined"),
    [
        ("0.14 px in 2 % of them", "0.14_px in 2_% of them"),
        ("fx = 656.8 ± 6.1 px", "fx_=_656.8_±_6.1_px"),
        ("if squares are 30 mm.", "if squares are 30_mm."),
        ("tilted by 45 degrees", "tilted by 45_degrees"),
        ("12 mirrors and 3 sets of 5 pxs", "12 mirrors and 3 sets of 5 pxs"),
        ("a board of 7 x 10 corners", "a board of 7_×_10 corners"),
        ("the ± of the result", "the_±_of the result"),
    ],
)
def test_numbers_stay_with_their_units(text: str, joined: str) -> None:
    assert typeset(text) == joined.replace("_", "\N{NO-BREAK SPACE}")


def test_a_label_breaks_between_words_only(qtbot: QtBot) -> None:
    label = WrappedLabel("off by 0.14 px")
    qtbot.addWidget(label)
    assert label.text() == "off by 0.14 px"
    assert QLabel.text(label) == "off by 0.14\N{NO-BREAK SPACE}px"
    label.setText("off by 2 %")
    assert label.text() == "off by 2 %"
    metrics = label.fontMetrics()
    plain = QLabel("off by 2 %", wordWrap=True)
    qtbot.addWidget(plain)
    narrow = metrics.horizontalAdvance("off by 2") + 2
    joined = metrics.horizontalAdvance("2\N{NO-BREAK SPACE}%")
    assert joined < metrics.horizontalAdvance("off by") < narrow
    for shown, unit in ((plain, "%"), (label, "2\N{NO-BREAK SPACE}%")):
        shown.resize(narrow, 3 * metrics.lineSpacing())
        assert _find_last_line(shown) == unit


def _find_last_line(label: QLabel) -> str:
    """Return the last line of a label's text, as Qt breaks it."""
    layout = QTextLayout(QLabel.text(label), label.font())
    layout.beginLayout()
    while (line := layout.createLine()).isValid():
        line.setLineWidth(label.width())
        last = QLabel.text(label)[line.textStart() :]
    layout.endLayout()
    return last
