"""Uncertainty of a calibration where the camera is used, and the views that would lower it.

`estimate_projection_uncertainty` maps how far the pixel of a point is uncertain over the image;
`study_number_of_views` says how that falls with the number of views, `propose_views` where to hold
the board next.
"""

from __future__ import annotations

from calibgui.engine.uncertainty.next_view import NextView, propose_views
from calibgui.engine.uncertainty.number_of_views import (
    QUANTITIES,
    ViewCountStudy,
    study_number_of_views,
)
from calibgui.engine.uncertainty.projection_uncertainty import (
    ProjectionUncertainty,
    estimate_projection_uncertainty,
)

__all__ = [
    "QUANTITIES",
    "NextView",
    "ProjectionUncertainty",
    "ViewCountStudy",
    "estimate_projection_uncertainty",
    "propose_views",
    "study_number_of_views",
]
