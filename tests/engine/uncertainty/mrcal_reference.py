"""Solve a calibration with mrcal and save its projection uncertainty.

Run by ``/usr/bin/python3``, where Debian's python3-mrcal is: mrcal_reference.py IN.npz OUT.npz.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import mrcal
import numpy as np


def problem(data: Mapping[str, Any]) -> dict[str, Any]:
    """What ``mrcal.optimize`` takes for boards (K, rows, columns, 2) seen by one camera.

    Args:
        data: "boards", "params", "poses" (K, 6), "size" and "square".
    """
    boards = data["boards"]
    views = len(boards)
    return {
        "lensmodel": "LENSMODEL_OPENCV5",
        "intrinsics": data["params"][None].copy(),
        "extrinsics_rt_fromref": np.zeros((0, 6)),
        "frames_rt_toref": data["poses"].copy(),
        "points": None,
        "observations_board": np.concatenate([boards, np.ones((*boards.shape[:3], 1))], axis=-1),
        "indices_frame_camintrinsics_camextrinsics": np.column_stack(
            [np.arange(views), np.zeros(views), -np.ones(views)]
        ).astype(np.int32),
        "observations_point": None,
        "indices_point_camintrinsics_camextrinsics": None,
        "imagersizes": data["size"][None].astype(np.int32),
        "calobject_warp": None,
        "calibration_object_spacing": float(data["square"]),
        "do_optimize_intrinsics_core": True,
        "do_optimize_intrinsics_distortions": True,
        "do_optimize_extrinsics": True,
        "do_optimize_frames": True,
        "do_optimize_calobject_warp": False,
        "do_apply_outlier_rejection": False,
        "do_apply_regularization": False,
        "verbose": False,
    }


def main(given: str, result: str) -> None:
    data = np.load(given)
    inputs = problem(data)
    mrcal.optimize(**inputs)
    model = mrcal.cameramodel(optimization_inputs=inputs, icam_intrinsics=0)
    rays = mrcal.unproject(data["uv"], *model.intrinsics(), normalize=True)
    answers = {}
    for name, distance in (("infinite", np.inf), ("finite", float(data["distance"]))):
        answers[name] = mrcal.projection_uncertainty(
            rays * (distance if np.isfinite(distance) else 1.0),
            model=model,
            atinfinity=bool(np.isinf(distance)),
            what="covariance",
            observed_pixel_uncertainty=float(data["noise"]),
        )
    np.savez(result, params=model.intrinsics()[1], **answers)


if __name__ == "__main__":
    main(*sys.argv[1:])
