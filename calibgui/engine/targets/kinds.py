"""The patterns that there are, by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from calibgui.engine.targets.charuco import Charuco
from calibgui.engine.targets.circles import Circles
from calibgui.engine.targets.pattern import CHECKERBOARD, Pattern

KINDS: Mapping[str, Pattern] = MappingProxyType(
    {
        pattern.kind: pattern
        for pattern in (CHECKERBOARD, Charuco(), Circles(), Circles(asymmetric=True))
    }
)
"""One of each kind, with everything left open that can be found out from images."""
