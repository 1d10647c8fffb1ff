"""PhotonVision's calibrations: those of today, of older versions, and settings with several."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

from calibgui.engine.camera import pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.formats.json_document import dumps
from tests.formats.readers import RAYS

_K = [701.5, 0.0, 318.25, 0.0, 699.75, 243.5, 0.0, 0.0, 1.0]
_D = [0.11, -0.22, 0.003, -0.004, 0.05, 0.01, 0.02, -0.03]
_CALIBRATION: dict[str, Any] = {
    "resolution": {"width": 640.0, "height": 480.0},
    "cameraIntrinsics": {"rows": 3, "cols": 3, "type": 6, "data": _K},
    "distCoeffs": {"rows": 1, "cols": 8, "type": 6, "data": _D},
    "observations": [],
    "calobjectWarp": [0.0, 0.0],
    "calobjectSize": {"width": 7.0, "height": 7.0},
    "calobjectSpacing": 0.0254,
    "lensmodel": "LENSMODEL_OPENCV",
}


def _write(folder: Path, content: object) -> Path:
    (folder / "photon.json").write_text(dumps(content))
    return folder / "photon.json"


def _assert_images(file: Path, count: int, name: str | None = None) -> None:
    read = read_camera(file, name)
    assert read.title == "PhotonVision calibration"
    assert read.camera.size == (640, 480)
    D = np.array(_D[:count])
    theirs = cv2.projectPoints(RAYS, np.zeros(3), np.zeros(3), np.reshape(_K, (3, 3)), D)[0]
    assert np.abs(theirs.reshape(-1, 2) - pixels_from_rays(RAYS, read.camera)).max() < 1e-9


def test_a_calibration_is_read(tmp_path: Path) -> None:
    _assert_images(_write(tmp_path, _CALIBRATION), 8)


def test_coefficients_of_older_versions_are_called_extrinsics(tmp_path: Path) -> None:
    older = {name: _CALIBRATION[name] for name in ("resolution", "cameraIntrinsics")}
    older["cameraExtrinsics"] = {"rows": 1, "cols": 5, "type": 6, "data": _D[:5]}
    _assert_images(_write(tmp_path, older), 5)


def test_settings_hold_a_camera_for_each_size(tmp_path: Path) -> None:
    other = copy.deepcopy(_CALIBRATION)
    other["resolution"] = {"width": 320.0, "height": 240.0}
    file = _write(tmp_path, {"nickname": "front", "calibrations": [other, _CALIBRATION]})
    with pytest.raises(CalibrationError, match="2 cameras: 320x240, 640x480"):
        read_camera(file)
    _assert_images(file, 8, "640x480")


def test_lenses_of_another_kind_are_refused(tmp_path: Path) -> None:
    splined = _CALIBRATION | {"lensmodel": "LENSMODEL_SPLINED_STEREOGRAPHIC"}
    with pytest.raises(CalibrationError, match="SPLINED_STEREOGRAPHIC, which cannot be read"):
        read_camera(_write(tmp_path, splined))
