"""The estimates of each view, as result.json holds them.

A view that was used has, beside the members that ``views_json.py`` lists,

    corners, rms_px                  their number, and the RMS length of their residuals
    rvec, tvec_mm                    pose cam_from_board, array frame
    sigma_rvec, sigma_tvec_mm        one standard deviation; `pose_covariance` is (6, 6) of both,
                                     `pose_covariance_by_views` without the board's scale
    paper                            the pose as the paper writes it, with the distance L + f
    residuals_px                     (n, 2) measured minus predicted
    residuals_reference_px           (n, 2) Dx', Dy' of eq. 38; null for a corner beyond the fold
                                     of a forward lens model, which has no place on the board

and a row in the table of Stage I; a view that was not used has null for its pose.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from calibgui.dataset import Result, View
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import StageOne, ViewResiduals
from calibgui.engine.geometry import Pose
from calibgui.formats.node import Node

_STAGE_ONE_KEYS = ("xp", "yp", "k1", "aspect", "fx", "fy", "iterations", "rms", "converged")
_PAPER_POSE_KEYS = ("omega", "phi", "theta", "tx", "ty", "tz")


def encode_estimates(result: Result) -> list[dict[str, Any]]:
    """Return the JSON objects of the estimates of the used views."""
    calibration = result.calibration
    records = []
    for pose, covariance, by_views, residuals, paper in zip(
        calibration.poses,
        result.pose_covariances,
        calibration.pose_covariances,
        calibration.residuals,
        result.paper_poses(),
        strict=True,
    ):
        sigma = np.sqrt(np.diag(covariance))
        records.append(
            {
                "corners": len(residuals.image),
                "rms_px": residuals.rms,
                "rvec": pose.rvec,
                "tvec_mm": pose.tvec,
                "sigma_rvec": sigma[:3],
                "sigma_tvec_mm": sigma[3:],
                "paper": {k: getattr(paper, k) for k in _PAPER_POSE_KEYS}
                | {"distance_mm": paper.distance},
                "pose_covariance": covariance,
                **({"pose_covariance_by_views": by_views} if result.scale_sigma else {}),
                "residuals_px": residuals.image,
                "residuals_reference_px": residuals.reference,
            }
        )
    return records


def encode_no_estimate(view: View) -> dict[str, Any]:
    """Return the members that a view has in place of estimates if it was not used."""
    found = view.points or view.corners
    empty = ("rms_px", "rvec", "tvec_mm", "sigma_rvec", "sigma_tvec_mm", "paper")
    return {"corners": len(found.uv) if found else 0, **dict.fromkeys(empty)}


def encode_stage_one(result: Result) -> list[dict[str, Any]]:
    """Return the rows of the table of Stage I."""
    rows = zip(result.used, result.calibration.stage_one, strict=True)
    return [
        {
            "image": view.image,
            **{k: getattr(row, k) for k in _STAGE_ONE_KEYS},
            "backward": row.backward,
        }
        for view, row in rows
    ]


def decode_pose(view: Node) -> Pose:
    """Return the pose of a used view."""
    return Pose(view["rvec"].numbers(3), view["tvec_mm"].numbers(3))


def decode_pose_covariance(view: Node) -> Array:
    """Return the covariance (6, 6) of a view's pose, rad and mm; NaN where unknown."""
    by_views = view.get("pose_covariance_by_views")
    return (by_views or view["pose_covariance"]).covariances(6, 6, nullable=True)


def decode_residuals(view: Node) -> ViewResiduals:
    """Return the residuals of a used view."""
    n = len(view["uv"].value)
    return ViewResiduals(
        view["residuals_px"].numbers(n, 2),
        view["residuals_reference_px"].numbers(n, 2, nullable=True),
    )


def decode_stage_one(node: Node) -> StageOne:
    """Return a row of the table of Stage I; NaN where the view does not determine a value."""
    return StageOne(
        xp=node["xp"].number(nullable=True),
        yp=node["yp"].number(nullable=True),
        k1=node["k1"].number(nullable=True),
        aspect=node["aspect"].number(nullable=True),
        fx=node["fx"].number(nullable=True),
        fy=node["fy"].number(nullable=True),
        iterations=node["iterations"].integer(),
        rms=node["rms"].number(nullable=True),
        backward=node["backward"].numbers(3, 3, nullable=True),
        converged=node["converged"].flag(),
    )
