"""Sizes in the engine's sentences, set as the window sets its own."""

from __future__ import annotations

import re

_TIMES = re.compile(r"(?<=\d) x (?=\d)")


def set_times_signs(text: str) -> str:
    """Set "7 x 10", which any terminal can print, as "7 × 10"."""
    return _TIMES.sub(" × ", text)
