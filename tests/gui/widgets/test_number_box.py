"""Numbers of fields are written as those of tables and files, whatever the country."""

from __future__ import annotations

from PySide6.QtCore import QLocale
from pytestqt.qtbot import QtBot

from calibgui.gui.widgets.number_box import NumberBox


def test_a_field_shows_a_point_and_takes_a_comma_for_one(qtbot: QtBot) -> None:
    before = QLocale()
    QLocale.setDefault(QLocale("de_DE"))
    try:
        box = NumberBox(decimals=2, maximum=5000.0, suffix=" mm")
        qtbot.addWidget(box)
        box.setValue(1234.5)
        assert box.text() == "1234.50 mm"
        for typed in ("25,4", "25.4"):
            box.clear()
            qtbot.keyClicks(box, typed)
            assert box.value() == 25.4
            assert box.text() == f"{typed[:2]}.{typed[3:]} mm"
    finally:
        QLocale.setDefault(before)
