"""Hand and eye with the photographs that were left out: what is saved, exported and tabulated."""

from __future__ import annotations

from dataclasses import dataclass

from calibgui.engine.hand_eye import HandEye


@dataclass(frozen=True, eq=False, slots=True)
class HandEyeSet:
    """Hand and eye from a set of photographs and poses."""

    found: HandEye
    left_out: tuple[str, ...] = ()
    """Sentences on photographs and poses that took no part."""
    has_covariance: bool = True
    """False if the camera counts as exact, because the errors of its parameters are not known."""
