"""The patterns that there are, by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Pattern

KINDS: Mapping[str, Pattern] = MappingProxyType(
    {
        pattern.kind: pattern
        for pattern in (CHECKERBOARD, Charuco(), Circles(), Circles(asymmetric=True))
    }
)
"""One of each kind, with everything left open that can be found out from images."""
