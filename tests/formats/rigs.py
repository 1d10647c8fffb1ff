"""A small rig with its corners, for the tests of formats."""

from __future__ import annotations

from functools import cache

import numpy as np

from calibgui.dataset import RigResult
from calibgui.engine.camera import Camera
from calibgui.engine.rig import calibrate_rig
from tests.engine.rig.scenes import BOARD, LENSES, make_rig


@cache
def make_result(*lenses: Camera, count: int = 3) -> RigResult:
    """The rig of a scene with noise, whose cameras have these lenses in turn."""
    scene = make_rig(count, instants=6 * count, lenses=lenses or LENSES)
    cameras = scene.noisy(0.1, np.random.default_rng(1))
    rig = calibrate_rig(cameras)
    seen = {(c, 0, k): view for c, camera in enumerate(cameras) for k, view in camera.views.items()}
    return RigResult(
        rig,
        {instant: f"{instant:04d}" for instant in rig.instants},
        {(c, k): f"cam{c}/{k:04d}.png" for c, _, k in seen},
        seen,
        (BOARD,),
        remarks=("A remark.",),
    )
