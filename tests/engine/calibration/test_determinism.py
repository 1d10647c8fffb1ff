"""The same bits from processes that were given different numbers of threads."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from tests.engine.scenes import VGA, Scene, barrel, scene

ROOT = Path(__file__).parents[3]
LIMITS = ("NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def bits(calibration: Calibration) -> bytes:
    """All numbers of a result."""
    poses = [np.concatenate([pose.rvec, pose.tvec]) for pose in calibration.poses]
    arrays = [calibration.camera.params, calibration.covariance, calibration.pose_covariances]
    arrays += [*poses, *(view.image for view in calibration.residuals)]
    return b"".join(array.tobytes() for array in arrays)


def weighted(made: Scene) -> list[Observation]:
    """Views with covariances that differ from corner to corner."""
    rng = np.random.default_rng(1)
    scale = rng.uniform(0.5, 2.0, size=len(made.views[0].uv))
    cov = 0.01 * scale[:, None, None] * np.eye(2)
    return [view._replace(cov=cov) for view in made.noisy(0.1, rng)]


def digest() -> str:
    """Digest results of many views, of a free board shape and of weighted corners."""
    many, few = (scene(barrel(), count, seed=7) for count in (400, 12))
    noise = np.random.default_rng(0)
    results = [
        calibrate(many.noisy(0.1, noise), VGA),
        calibrate(few.noisy(0.1, noise), VGA, board_shape="free"),
        calibrate(weighted(few), VGA, model="brown-conrady"),
    ]
    return hashlib.sha256(b"".join(map(bits, results))).hexdigest()


@pytest.mark.slow
def test_threads_do_not_change_a_bit() -> None:
    code = "from tests.engine.calibration.test_determinism import digest; print(digest())"
    found = set()
    for threads in ("1", "2"):
        environment = os.environ | dict.fromkeys(LIMITS, threads)
        done = subprocess.run(
            [sys.executable, "-c", code],
            cwd=ROOT,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        found.add(done.stdout.strip())
    assert len(found) == 1
