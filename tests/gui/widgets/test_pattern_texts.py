"""The window's words for the kinds of boards."""

from __future__ import annotations

from calibgui.engine.boards import KINDS
from calibgui.gui.widgets.pattern_texts import list_pattern_texts


def test_every_kind_of_board_has_its_words() -> None:
    assert list(list_pattern_texts()) == list(KINDS)
