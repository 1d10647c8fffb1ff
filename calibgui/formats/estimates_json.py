"""What a calibration says of each view, as result.json holds it.

Beside what ``views_json.py`` lists, a view that was used has

    corners, rms_px                  their number, and the RMS length of their residuals
    rvec, tvec_mm                    pose cam_from_plate, array frame
    sigma_rvec, sigma_tvec_mm        one standard deviation; `pose_covariance` is (6, 6) of both
    paper                            the pose as the paper writes it, with the distance L + f
    residuals_px                     (n, 2) measured minus predicted
    residuals_reference_px           (n, 2) Dx', Dy' of eq. 38; null for a corner beyond the fold
                                     of a forward lens model, which has no place on the plate

and a row of Stage I's table of its own; a view that was not used has null for its pose.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from calibgui.dataset.result import Result
from calibgui.dataset.view import View
from calibgui.engine.arrays import Array
from calibgui.engine.calibration import StageOne, ViewResiduals
from calibgui.engine.geometry import Pose
from calibgui.formats.json_document import Node

_STAGE_ONE = ("xp", "yp", "k1", "aspect", "fx", "fy", "iterations", "rms", "converged")
_PAPER_POSE = ("omega", "phi", "theta", "tx", "ty", "tz")


def estimate_records(result: Result) -> list[dict[str, Any]]:
    """The JSON objects of the used views' estimates."""
    calibration = result.calibration
    records = []
    for pose, covariance, residuals, paper in zip(
        calibration.poses,
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
                "paper": {k: getattr(paper, k) for k in _PAPER_POSE}
                | {"distance_mm": paper.distance},
                "pose_covariance": covariance,
                "residuals_px": residuals.image,
                "residuals_reference_px": residuals.reference,
            }
        )
    return records


def no_estimate(view: View) -> dict[str, Any]:
    """The same of a view that was not used."""
    found = view.points or view.corners
    empty = ("rms_px", "rvec", "tvec_mm", "sigma_rvec", "sigma_tvec_mm", "paper")
    return {"corners": len(found.uv) if found else 0, **dict.fromkeys(empty)}


def stage_one_records(result: Result) -> list[dict[str, Any]]:
    """The rows of Stage I's table."""
    rows = zip(result.used, result.calibration.stage_one, strict=True)
    return [
        {"image": view.image, **{k: getattr(row, k) for k in _STAGE_ONE}, "backward": row.backward}
        for view, row in rows
    ]


def read_pose(view: Node) -> Pose:
    """The pose of a used view."""
    return Pose(view["rvec"].numbers(3), view["tvec_mm"].numbers(3))


def read_pose_covariance(view: Node) -> Array:
    """(6, 6) its covariance, rad and mm; NaN where unknown."""
    return view["pose_covariance"].numbers(6, 6, nullable=True)


def read_residuals(view: Node) -> ViewResiduals:
    """The residuals of a used view."""
    n = len(view["uv"].value)
    return ViewResiduals(
        view["residuals_px"].numbers(n, 2),
        view["residuals_reference_px"].numbers(n, 2, nullable=True),
    )


def read_stage_one(node: Node) -> StageOne:
    """A row of Stage I's table; NaN where the view leaves it open."""
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
