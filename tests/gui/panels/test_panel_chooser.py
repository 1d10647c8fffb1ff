"""The names of panels."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from calibgui.gui.panels.analysis import GROUPS, PANELS
from calibgui.gui.panels.groups import Group
from calibgui.gui.panels.panel_chooser import PanelChooser


@pytest.mark.parametrize("group", Group)
def test_every_name_says_what_its_panel_shows(qtbot: QtBot, group: Group) -> None:
    chooser = PanelChooser(GROUPS[group])
    qtbot.addWidget(chooser)
    tips = [button.toolTip() for button in chooser.buttons.values()]
    assert all(tip.endswith(".") for tip in tips)


def test_no_two_panels_have_one_purpose() -> None:
    assert len({kind.purpose for kind in PANELS}) == len(PANELS)
