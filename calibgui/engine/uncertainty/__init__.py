"""Uncertainty of a calibration where the camera is used, and the views that would lower it.

`estimate_projection_uncertainty` maps how far the pixel of a point is uncertain over the image;
`study_number_of_views` says how that falls with the number of views, `propose_views` where to hold
the board next. `find_rays` and `find_board_points` lead from pixels to the world, with the
uncertainty that they have there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.uncertainty.back_projection import (
        BoardPoints as BoardPoints,
        PixelRays as PixelRays,
        find_board_points as find_board_points,
        find_rays as find_rays,
    )
    from calibgui.engine.uncertainty.next_view import (
        NextView as NextView,
        predict_uncertainty as predict_uncertainty,
        propose_views as propose_views,
    )
    from calibgui.engine.uncertainty.number_of_views import (
        QUANTITIES as QUANTITIES,
        ViewCountStudy as ViewCountStudy,
        study_number_of_views as study_number_of_views,
    )
    from calibgui.engine.uncertainty.projection_uncertainty import (
        ProjectionUncertainty as ProjectionUncertainty,
        estimate_projection_uncertainty as estimate_projection_uncertainty,
    )

load_on_demand(
    __name__,
    {
        "back_projection": ["BoardPoints", "PixelRays", "find_board_points", "find_rays"],
        "next_view": ["NextView", "predict_uncertainty", "propose_views"],
        "number_of_views": ["QUANTITIES", "ViewCountStudy", "study_number_of_views"],
        "projection_uncertainty": ["ProjectionUncertainty", "estimate_projection_uncertainty"],
    },
)
