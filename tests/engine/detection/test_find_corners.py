"""The registry of detectors."""

from __future__ import annotations

from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.detection.find_corners import DETECTORS


def test_every_kind_of_board_has_a_detector() -> None:
    assert list(DETECTORS) == list(KINDS)
