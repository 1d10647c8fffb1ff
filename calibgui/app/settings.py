"""How to calibrate, as the window keeps it and the command line is given it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from calibgui.engine.types import Cost, Plate, PlateModel, Prior


@dataclass(frozen=True, slots=True)
class Settings:
    """How to calibrate; ``calibration.calibrate_views`` does."""

    cost: Cost = Cost.IMAGE
    fixed: tuple[str, ...] | Mapping[str, float | None] = ()
    """Names of intrinsics to hold, with their values where these are not left open."""
    freed: tuple[str, ...] = ()
    """Names of intrinsics to estimate that are held by default."""
    plate: PlateModel | Plate | None = PlateModel.NOMINAL
    """The board's shape: a model to estimate, a plate to hold, or None for the model that
    predicts unseen views best."""
    prior: Prior | None = None
    """What is known of a free plate."""
    robust: bool = False
    """Whether to leave outliers out."""
    weigh_views: bool = False
    """Whether to weigh every view by the noise that is found in it; with the image cost only."""


USUAL = Settings()
