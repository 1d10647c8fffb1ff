"""What OpenCV and mrcal answer to the same faulty sets.

Neither names a cause. OpenCV is ``cv2.calibrateCameraExtended`` with five coefficients and its own
standard deviations; mrcal starts from OpenCV's answer, leaves outliers out and estimates the
board's warp, as ``mrcal-calibrate-cameras`` does, and its standard deviations come from its own
Jacobian. An answer is wrong if fx, fy, cx or cy is farther from the truth than `MAX_DEVIATION` of
its own standard deviations.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path

import cv2
import numpy as np

from calibgui.engine.arrays import Array
from tests.faults.campaign import MAX_DEVIATION
from tests.faults.sets import FaultySet

MRCAL_PYTHON = Path("/usr/bin/python3")
"""Where Debian's python3-mrcal is."""
_CRITERIA = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 100, 1e-12)


def answer_by_opencv(made: FaultySet) -> tuple[Array, dict[str, Array] | None]:
    """Calibrate with OpenCV.

    Returns:
        fx, fy, cx, cy and their standard deviations (2, 4), NaN if it refuses, and what mrcal
        starts from, None if there is nothing.
    """
    places = [np.pad(view.xy, [(0, 0), (0, 1)]).astype(np.float32) for view in made.views]
    corners = [view.uv.astype(np.float32) for view in made.views]
    try:
        _, K, k, rvecs, tvecs, sd, *_ = cv2.calibrateCameraExtended(
            places, corners, made.size, None, None, criteria=_CRITERIA
        )
    except cv2.error:
        return np.full((2, 4), np.nan), None
    lengths = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2]])
    start = {
        "params": np.append(lengths, np.ravel(k)[:5]),
        "poses": np.column_stack([np.reshape(rvecs, (-1, 3)), np.reshape(tvecs, (-1, 3))]),
        "size": np.array(made.size),
    }
    return np.stack([lengths, np.ravel(sd)[:4]]), start | _arrange_corners(made)


def _arrange_corners(made: FaultySet) -> dict[str, Array]:
    """Arrange the corners on the whole board, (K, rows, columns, 2), with the side of a square."""
    xy = np.round(np.concatenate([view.xy for view in made.views]), 6)
    x, y = np.unique(xy[:, 0]), np.unique(xy[:, 1])
    boards = np.full((len(made.views), len(y), len(x), 2), np.nan)
    for board, view in zip(boards, made.views, strict=True):
        at = np.round(view.xy, 6)
        board[np.searchsorted(y, at[:, 1]), np.searchsorted(x, at[:, 0])] = view.uv
    return {"boards": boards, "square": np.array(np.median(np.diff(x)))}


def answer_by_mrcal(starts: list[dict[str, Array] | None]) -> Array | None:
    """Calibrate with mrcal from OpenCV's answers.

    Returns:
        fx, fy, cx, cy and their standard deviations (n, 2, 4), NaN where there is no answer; None
        where mrcal is not installed.
    """
    given = {}
    chosen = [k for k, start in enumerate(starts) if start is not None]
    for number, k in enumerate(chosen):
        given |= {f"{name}{number}": array for name, array in (starts[k] or {}).items()}
    with tempfile.TemporaryDirectory() as folder:
        source, result = Path(folder, "given.npz"), Path(folder, "result.npz")
        np.savez(source, **given)
        command = [str(MRCAL_PYTHON), "-m", "tests.faults.mrcal_answers", str(source), str(result)]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        environment = os.environ | {"PYTHONPATH": "."}
        if subprocess.run(command, env=environment, check=False, **quiet).returncode:  # type: ignore[call-overload]
            return None
        answers = np.full((len(starts), 2, 4), np.nan)
        answers[chosen] = np.load(result)["answers"]
    return answers


def is_wrong(answer: Array, made: FaultySet) -> bool:
    """Return whether an answer (2, 4) is farther from the truth than its own sigmas allow.

    No answer is not a wrong one.
    """
    values, sigma = answer
    if not np.isfinite(answer).all():
        return False
    return bool((np.abs(values - made.truth.params[:4]) > MAX_DEVIATION * sigma).any())


def count_peers(sets: dict[str, list[FaultySet]]) -> dict[str, tuple[float, float]]:
    """Return for each fault the shares of wrong answers of OpenCV and mrcal.

    That of mrcal is NaN where it is not installed.
    """
    answers = {name: [answer_by_opencv(made) for made in draws] for name, draws in sets.items()}
    by_mrcal = answer_by_mrcal([start for draws in answers.values() for _, start in draws])
    shares, first = {}, 0
    for name, draws in sets.items():
        own = [answer for answer, _ in answers[name]]
        others = None if by_mrcal is None else by_mrcal[first : first + len(draws)]
        first += len(draws)
        shares[name] = (
            measure_share_of_wrong(own, draws),
            np.nan if others is None else measure_share_of_wrong(list(others), draws),
        )
    return shares


def measure_share_of_wrong(answers: list[Array], draws: list[FaultySet]) -> float:
    """Return the share of the answers (2, 4) that are wrong."""
    return float(np.mean([is_wrong(a, made) for a, made in zip(answers, draws, strict=True)]))
