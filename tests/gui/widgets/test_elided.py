"""Names that are too long for a panel."""

from __future__ import annotations

import pytest
from PySide6.QtGui import QFontMetrics
from PySide6.QtWidgets import QApplication

from calibgui.gui.panels.mode_page import PANEL_WIDTH
from calibgui.gui.widgets.elided import elide_name


@pytest.mark.parametrize("length", [1, 29, 30, 31, 32, 80, 255])
def test_a_name_keeps_its_ends_and_fits_a_panel(qapp: QApplication, length: int) -> None:
    name = "".join(chr(ord("a") + k % 26) for k in range(length - 1)) + "7"
    shown = elide_name(name)
    assert (shown == name) == (length <= 30)
    start, _, end = shown.partition("…")
    assert name.startswith(start) and name.endswith(end)
    words = f"{shown}: aspect ratio"
    assert QFontMetrics(qapp.font()).horizontalAdvance(words) < PANEL_WIDTH
