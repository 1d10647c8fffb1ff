"""Cameras of USD, read by Pixar's own library where it is installed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Hardware, Result
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.undistortion import choose_ideal_cameras
from calibgui.formats import export
from tests.formats.readers import in_other_python

_USD = """
import json, sys
import numpy as np
from pxr import Gf, Usd, UsdGeom

stage = Usd.Stage.Open(sys.argv[1])
prim = stage.GetDefaultPrim()
points, seen, images = json.loads(sys.argv[2]), [], []
width, height = json.loads(sys.argv[3])
for k in range(int(stage.GetStartTimeCode()), int(stage.GetEndTimeCode()) + 1):
    camera = UsdGeom.Camera(prim).GetCamera(k)
    frustum = camera.frustum
    whole = frustum.ComputeViewMatrix() * frustum.ComputeProjectionMatrix()
    ndc = [whole.Transform(Gf.Vec3d(*point)) for point in points]
    seen.append([[(p[0] + 1) / 2 * width, (1 - p[1]) / 2 * height] for p in ndc])
    images.append(prim.GetAttribute("image").Get(k))
print(json.dumps({
    "seen": seen, "images": images, "unit": UsdGeom.GetStageMetersPerUnit(stage),
    "up": UsdGeom.GetStageUpAxis(stage), "film": camera.horizontalAperture,
}))
"""


@pytest.mark.parametrize("crop", [None, 1.5])
def test_usd_sees_the_board_where_the_undistorted_images_show_it(
    tmp_path: Path, result: Result, crop: float | None
) -> None:
    stated = replace(result, hardware=Hardware(crop=crop))
    path = export(stated, "usd", tmp_path / "camera.usda").path
    board = np.pad(result.observations()[0].xy, ((0, 0), (0, 1)))
    world = board * [0.1, -0.1, -0.1]  # cm, Y up and Z out of the board
    size = result.calibration.camera.size
    read = in_other_python(_USD, path, world.tolist(), list(size), needs="import pxr")
    assert (read["unit"], read["up"]) == (0.01, "Z")
    assert read["images"] == [view.image for view in result.used]
    film = 36.0 if crop is None else np.hypot(36, 24) / 1.5 * 0.8
    assert read["film"] == pytest.approx(film, rel=1e-6)
    (ideal,) = choose_ideal_cameras(result.calibration.camera).values()
    for seen, pose in zip(read["seen"], result.calibration.poses, strict=True):
        rays = board @ rotation_from_vector(pose.rvec).T + pose.tvec
        # USD keeps lengths of the camera in single precision.
        assert np.abs(np.array(seen) - 0.5 - ideal.find_pixels(rays)).max() < 2e-3
