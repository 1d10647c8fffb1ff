"""A target in words."""

from __future__ import annotations

from calibgui.engine.targets.charuco import Charuco
from calibgui.engine.targets.circles import Circles
from calibgui.engine.targets.pattern import Pattern
from calibgui.engine.types import Target


def described(target: Target) -> str:
    """What the target is, as "ChArUco board of 6 x 8 inner corners, DICT_4X4_50, ..."."""
    rows, cols, pattern = target.rows, target.cols, target.pattern
    if isinstance(pattern, Charuco):
        text = f"ChArUco board of {rows} x {cols} inner corners"
        if pattern.dictionary is not None:
            text += f", {pattern.dictionary}"
        if pattern.marker is not None:
            text += f", markers {pattern.marker:.2f} of a square"
        legacy = not pattern.first_dark((rows, cols))
        return text + (", first square white (layout before OpenCV 4.6)" if legacy else "")
    if isinstance(pattern, Circles):
        kind = "Asymmetric" if pattern.asymmetric else "Symmetric"
        text = f"{kind} grid of {rows} x {cols} circles"
        size = pattern.diameter
        return text if size is None else f"{text}, diameter {size:.3f} of their distance"
    return f"Checkerboard of {rows} x {cols} inner corners"


def learnt(stated: Pattern, target: Target | None) -> str:
    """In words the target of which only `stated` was given before; empty if nothing was open."""
    if target is None or target.pattern == stated:
        return ""
    return f"The photographs show: {described(target)}."
