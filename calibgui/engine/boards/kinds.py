"""The patterns that exist, by kind. A new pattern is a file of its own and one entry here."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.listed_circles import ListedCircles
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard

KINDS: Mapping[str, Pattern] = MappingProxyType(
    {
        pattern.kind: pattern
        for pattern in (
            CHECKERBOARD,
            Charuco(),
            Circles(),
            Circles(asymmetric=True),
            ListedCircles(),
            AprilGrid(),
            TaggedCheckerboard(),
            PuzzleBoard(),
        )
    }
)
"""One pattern of each kind, by its name in files and on the command line; every field that can be
inferred from images is None."""
