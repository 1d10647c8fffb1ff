"""How well a camera is known where it is used, how many views that takes, and which next."""

from __future__ import annotations

from calibgui.engine.uncertainty.next_view import NextView, next_views
from calibgui.engine.uncertainty.number_of_views import QUANTITIES, ViewCount, study
from calibgui.engine.uncertainty.projection_uncertainty import (
    ProjectionUncertainty,
    estimate_projection_uncertainty,
)

__all__ = [
    "QUANTITIES",
    "NextView",
    "ProjectionUncertainty",
    "ViewCount",
    "estimate_projection_uncertainty",
    "next_views",
    "study",
]
