"""COLMAP's cameras.txt, read by pycolmap where it is installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.formats.camera_refit import express_in_models
from calibgui.formats.colmap_cameras import write_colmap
from tests.formats.readers import RAYS, in_other_python

_COLMAP = """
import json, sys
from pathlib import Path
import numpy as np
import pycolmap

folder = Path(sys.argv[1])
for name in ("images.txt", "points3D.txt"):
    (folder / name).write_text("")
model = pycolmap.Reconstruction()
model.read_text(folder)
(camera,) = model.cameras.values()
print(json.dumps({
    "size": [camera.width, camera.height],
    "model": camera.model_name,
    "seen": np.asarray(camera.img_from_cam(np.array(json.loads(sys.argv[2])))).tolist(),
}))
"""


def test_half_a_pixel_is_added(tmp_path: Path, result: Result) -> None:
    """Whoever reads it: the first pixel's corner is COLMAP's origin."""
    report = write_colmap(result, tmp_path / "cameras.txt")
    first, *_, last = (tmp_path / "cameras.txt").read_text().splitlines()
    assert first == f"# {report.note}"
    number, model, width, height, *values = last.split()
    camera = express_in_models(result).calibration.camera
    assert (number, model, int(width), int(height)) == ("1", "FULL_OPENCV", *camera.size)
    fx, fy, cx, cy, *lens = map(float, values)
    assert np.array_equal([fx, fy, cx - 0.5, cy - 0.5], camera.params[:4])
    assert np.array_equal(lens, [*camera.coefficients, 0.0, 0.0, 0.0])


def test_colmap_projects_what_it_reads_to_our_pixels(tmp_path: Path, result: Result) -> None:
    write_colmap(result, tmp_path / "cameras.txt")
    read = in_other_python(_COLMAP, tmp_path, RAYS.tolist(), needs="import pycolmap")
    camera = express_in_models(result).calibration.camera
    assert (tuple(read["size"]), read["model"]) == (camera.size, "FULL_OPENCV")
    ours = pixels_from_rays(RAYS[:, :2] / RAYS[:, 2:], camera)
    assert np.abs(np.array(read["seen"]) - 0.5 - ours).max() < 1e-9
