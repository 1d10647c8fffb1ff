"""Maps of undistortion: applied by cv2.remap, and read by OpenEXR where it is installed."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.images.undistortion import undistort_image
from calibgui.formats import export
from calibgui.formats.camera_conversion import export_camera
from calibgui.formats.undistortion_map import EXPORTER, choose_shown_camera, make_map
from tests.formats.cameras import example, holding, splined
from tests.formats.readers import in_other_python

_EXR = """
import json, sys
import numpy as np
import OpenEXR

with OpenEXR.File(sys.argv[1], separate_channels=True) as file:
    channels = file.channels()
    np.save(sys.argv[2], np.dstack([channels["R"].pixels, channels["G"].pixels]))
    print(json.dumps({"names": sorted(channels), "comments": file.header()["comments"]}))
"""


@pytest.mark.parametrize("model", ["lucchese", "double-sphere", "splined", "brown-conrady"])
def test_remap_undistorts_as_we_do(tmp_path: Path, result: Result, model: str) -> None:
    known = {"lucchese": result.calibration.camera, "splined": splined()}
    camera = known[model] if model in known else example(model)
    path = export(holding(result, camera), "map", tmp_path / "map.npy").path
    places = np.load(path)
    assert places.dtype == np.float32 and places.shape == (480, 640, 2)
    rng = np.random.default_rng(0)
    image = cv2.GaussianBlur(rng.integers(0, 256, (480, 640)).astype(np.float32), (0, 0), 8)
    folds = model == "brown-conrady"  # at the edge: the middle keeps its scale there
    ours = undistort_image(image, camera, "same-scale" if folds else "all")
    theirs = cv2.remap(image, places, None, cv2.INTER_LINEAR)
    inside = cv2.erode(ours.valid.astype(np.uint8), np.ones((5, 5)), borderValue=0) > 0
    assert inside.mean() > 0.05
    assert np.abs(theirs - ours.image)[inside].max() < 0.2  # grey levels, of a range of 20
    assert not theirs[cv2.dilate(ours.valid.astype(np.uint8), np.ones((5, 5))) == 0].any()


def test_tiff_holds_shares_from_the_lower_left_corner(tmp_path: Path) -> None:
    camera = example("brown-conrady")
    path = export_camera(camera, EXPORTER, tmp_path / "map.tif").path
    blue, green, red = cv2.split(cv2.imread(str(path), cv2.IMREAD_UNCHANGED))
    assert red.dtype == np.float32 and not blue.any()
    there = np.dstack([red.astype(float) * 640 - 0.5, (1 - green.astype(float)) * 480 - 0.5])
    assert np.abs(there - make_map(camera, choose_shown_camera(camera))).max() < 1e-4
    assert b"calibgui as map" in path.read_bytes()


def test_openexr_reads_shares_from_the_lower_left_corner(tmp_path: Path) -> None:
    camera = example("brown-conrady")
    path = export_camera(camera, EXPORTER, tmp_path / "map.exr").path
    read = in_other_python(_EXR, path, tmp_path / "read.npy", needs="import OpenEXR")
    assert read["names"] == ["G", "R"] and "calibgui as map" in read["comments"]
    shares = np.load(tmp_path / "read.npy").astype(float)
    ideal = choose_shown_camera(camera)
    there = np.dstack([shares[..., 0] * 640 - 0.5, (1 - shares[..., 1]) * 480 - 0.5])
    assert np.abs(there - make_map(camera, ideal)).max() < 1e-4
