"""Rigs: several cameras that stand fast to each other, and instants that they photograph together.

`calibrate_rig` takes cameras that are known alone, each with its views by instants, and returns a
`Rig`: how the cameras stand to each other, and boards if there are several, and all their
parameters, solved together, with the covariance that the disagreement of the instants tells.
`triangulate_points` finds points in space from their pixels, `rectify_pair` images in whose rows
the same points lie.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.rig.calibrate_rig import calibrate_rig as calibrate_rig
    from calibgui.engine.rig.point_uncertainty import (
        PointUncertainty as PointUncertainty,
        estimate_point_uncertainty as estimate_point_uncertainty,
    )
    from calibgui.engine.rig.records import (
        Layout as Layout,
        LeftOutView as LeftOutView,
        Mistake as Mistake,
        PlacedBoard as PlacedBoard,
        Rig as Rig,
        RigBoard as RigBoard,
        RigCamera as RigCamera,
        RigMistake as RigMistake,
        RigPair as RigPair,
        RigView as RigView,
    )
    from calibgui.engine.rig.rectification import (
        StereoPair as StereoPair,
        find_epipolar_line as find_epipolar_line,
        rectify_pair as rectify_pair,
        rectify_stereo_image as rectify_stereo_image,
    )
    from calibgui.engine.rig.triangulation import (
        TriangulatedPoints as TriangulatedPoints,
        triangulate_points as triangulate_points,
    )

load_on_demand(
    __name__,
    {
        "calibrate_rig": ["calibrate_rig"],
        "point_uncertainty": ["PointUncertainty", "estimate_point_uncertainty"],
        "records": [
            "Layout",
            "LeftOutView",
            "Mistake",
            "PlacedBoard",
            "Rig",
            "RigBoard",
            "RigCamera",
            "RigMistake",
            "RigPair",
            "RigView",
        ],
        "rectification": [
            "StereoPair",
            "find_epipolar_line",
            "rectify_pair",
            "rectify_stereo_image",
        ],
        "triangulation": ["TriangulatedPoints", "triangulate_points"],
    },
)
