"""mrcal's camera model, read by mrcal."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.formats.camera_refit import express_in_models
from calibgui.formats.mrcal_model import write_mrcal
from tests.formats.readers import RAYS, in_other_python

_MRCAL = """
import json, sys
import mrcal
import numpy as np

model = mrcal.cameramodel(sys.argv[1])
seen = mrcal.project(np.array(json.loads(sys.argv[2])), *model.intrinsics())
region = model.valid_intrinsics_region()
print(json.dumps({
    "size": model.imagersize().tolist(),
    "pose": model.extrinsics_rt_fromref().tolist(),
    "region": region.tolist(),
    "inside": [bool(mrcal.is_within_valid_intrinsics_region(np.array(uv), model))
               for uv in (region[:-1].mean(axis=0), region[0] - 1000)],
    "seen": seen.tolist(),
}))
"""


def test_mrcal_projects_what_it_reads_to_our_pixels(tmp_path: Path, result: Result) -> None:
    file = tmp_path / "left.cameramodel"
    report = write_mrcal(result, file)
    assert f"# {report.note}\n" in file.read_text()
    read = in_other_python(_MRCAL, file, RAYS.tolist(), needs="import mrcal")
    camera = express_in_models(result).calibration.camera
    assert tuple(read["size"]) == camera.size
    assert read["pose"] == [0.0] * 6
    assert np.abs(read["seen"] - pixels_from_rays(RAYS[:, :2] / RAYS[:, 2:], camera)).max() < 1e-9
    corners = np.concatenate([view.uv for view in result.observations()])
    assert read["region"][0] == read["region"][-1]
    assert {tuple(uv) for uv in read["region"]} <= {tuple(uv) for uv in corners.tolist()}
    assert np.array_equal(np.max(read["region"], axis=0), corners.max(axis=0))
    assert read["inside"] == [True, False]
