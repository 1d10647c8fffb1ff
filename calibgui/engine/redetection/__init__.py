"""Searching again with a known camera, and counting symmetric boards alike in all views."""

from __future__ import annotations

from calibgui.engine.redetection.labelling import Placing, identified, turned_alike, upside_down
from calibgui.engine.redetection.search_again import find_again

__all__ = [
    "Placing",
    "find_again",
    "identified",
    "turned_alike",
    "upside_down",
]
