"""Solve faulty sets with mrcal: ``/usr/bin/python3 -m tests.faults.mrcal_answers IN.npz OUT.npz``.

IN holds of every set k "boards{k}" (K, rows, columns, 2) with NaN where no corner is seen, and
"params{k}", "poses{k}", "size{k}" and "square{k}" to start from. OUT holds "answers" (sets, 2, 4):
fx, fy, cx, cy and their standard deviations; NaN where mrcal gives up.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import mrcal
import numpy as np

from tests.engine.uncertainty.mrcal_reference import problem


def solve(data: Mapping[str, Any]) -> np.ndarray:
    """Solve as mrcal-calibrate-cameras does at its end: without outliers, on a warped board."""
    inputs = problem(data)
    seen = np.isfinite(data["boards"]).all(axis=-1)
    observed = inputs["observations_board"]
    observed[~seen] = [0.0, 0.0, -1.0]
    inputs |= {
        "calobject_warp": np.zeros(2),
        "do_optimize_calobject_warp": True,
        "do_apply_outlier_rejection": True,
    }
    mrcal.optimize(**inputs)
    inputs["do_apply_outlier_rejection"] = False
    packed, residuals, _, factor = mrcal.optimizer_callback(**inputs)
    used = 2 * int(np.count_nonzero(observed[..., 2] > 0))
    variance = float(residuals @ residuals) / (used - len(packed))
    sigma = np.zeros_like(packed)
    for i in range(4):
        unit = np.zeros_like(packed)
        unit[i] = 1.0
        sigma[i] = np.sqrt(variance * factor.solve_xt_JtJ_bt(unit)[i])
    mrcal.unpack_state(sigma, **inputs)
    return np.stack([inputs["intrinsics"][0, :4], sigma[:4]])


def main(given: str, result: str) -> None:
    data = np.load(given)
    answers = []
    for k in range(sum(name.startswith("boards") for name in data)):
        one = {name: data[f"{name}{k}"] for name in ("boards", "params", "poses", "size", "square")}
        try:
            answers.append(solve(one))
        except Exception:  # whatever its C code refuses, it gives no answer
            answers.append(np.full((2, 4), np.nan))
    np.savez(result, answers=np.array(answers))


if __name__ == "__main__":
    main(*sys.argv[1:])
