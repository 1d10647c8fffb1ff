"""Metashape's cameras by the conventions of its manual: photographs see the board where we do."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from calibgui.dataset import Result
from calibgui.formats import read_camera
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.metashape_cameras_xml import EXPORTER, write_metashape_cameras
from tests.formats.cameras import seen_points
from tests.formats.test_metashape_xml import project


def test_each_photograph_sees_the_board_where_we_do(tmp_path: Path, result: Result) -> None:
    """The board lies in the world in metres, Y up along it; a camera looks along its Z, Y down."""
    path = write_metashape_cameras(result, tmp_path / "cameras.xml").path
    root = ET.parse(path).getroot()
    calibration = root.find("chunk/sensors/sensor/calibration")
    assert calibration is not None
    size = calibration.find("resolution")
    assert size is not None
    width, height = int(size.attrib["width"]), int(size.attrib["height"])
    calibration.remove(size)
    fitted = express_in_format(result, EXPORTER).calibration
    cameras = root.findall("chunk/cameras/camera")
    assert [each.attrib["label"] for each in cameras] == [Path(v.image).stem for v in result.used]
    for each, (board, uv) in zip(cameras, seen_points(result, fitted), strict=True):
        world_from_camera = np.reshape(
            [float(value) for value in each.findtext("transform", "").split()], (4, 4)
        )
        assert world_from_camera[2, 3] > 0, "the camera is in front of the board"
        world = np.column_stack([board * [1e-3, -1e-3, -1e-3], np.ones(len(board))])
        points = np.linalg.solve(world_from_camera, world.T).T[:, :3]
        there = project(calibration, points, width, height, calibration.attrib["type"])
        assert np.abs(there - 0.5 - uv).max() < 1e-6


def test_the_camera_is_read_back(tmp_path: Path, result: Result) -> None:
    path = write_metashape_cameras(result, tmp_path / "cameras.xml").path
    fitted = express_in_format(result, EXPORTER).calibration.camera
    found = read_camera(path).camera
    assert found.size == fitted.size
    np.testing.assert_allclose(found.focal, fitted.focal)
    np.testing.assert_allclose(found.centre, fitted.centre)
