"""Real rigs: the figures of their makers' programs, and what their pairs disagree about."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.rig.calibrating import search_cameras
from calibgui.app.rig.frames import write_frames
from calibgui.app.rig.pairing import pair_files, pair_photographs
from calibgui.cli.console import Console
from calibgui.dataset import CornerSet, RigPairing
from calibgui.engine.boards import Board, Charuco
from calibgui.engine.calibration import calibrate
from calibgui.engine.geometry import rotation_from_vector
from calibgui.engine.rig import Mistake, Rig, RigCamera, calibrate_rig

pytestmark = [pytest.mark.data, pytest.mark.slow, pytest.mark.usefixtures("search_here")]


def search(folder: Path, board: Board) -> tuple[RigPairing, dict[str, CornerSet]]:
    pairing = pair_photographs([str(folder)])

    def find(files: Sequence[str], _: Board | None) -> Detection:
        return find_views([Path(file) for file in files], board.grid_size, pattern=board.pattern)

    return pairing, search_cameras(pairing, find, board.square)


def calibrate_alone(
    pairing: RigPairing, corner_sets: dict[str, CornerSet], model: str, min_corners: int = 4
) -> list[RigCamera]:
    """The cameras from corners that all weigh alike, as OpenCV takes them."""
    cameras = []
    for camera in pairing.cameras:
        corner_set = corner_sets[camera.name]
        numbers = {str(file): k for k, file in camera.files.items()}
        views = {
            numbers[view.image]: view.observation(corner_set.board)._replace(cov=None)
            for view in corner_set.views
            if view.usable and len(view.observation(corner_set.board).uv) >= min_corners
        }
        found = calibrate(list(views.values()), corner_set.size, model=model)
        cameras.append(RigCamera(camera.name, found.camera, views, found.fixed))
    return cameras


def list_less_agreeing(rig: Rig) -> set[int]:
    return {
        instant
        for mistake in rig.mistakes
        if mistake.kind is Mistake.LESS_AGREEMENT
        for instant in mistake.instants
    }


def test_two_webcams_are_as_opencv_has_them(data_dir: Path) -> None:
    found = search(data_dir / "stereo_sourishg", Board(6, 9, 24.23))
    cameras = calibrate_alone(*found, "brown-conrady")
    rig = calibrate_rig(cameras)
    assert rig.rms < 0.227165
    board = np.c_[Board(6, 9, 24.23).points(), np.zeros(54)].astype(np.float32)
    points = [
        [camera.views[k].uv.astype(np.float32) for k in sorted(camera.views)] for camera in cameras
    ]
    size = cameras[0].camera.size
    alone = []
    for each in points:
        alone += cv2.calibrateCamera([board] * len(each), each, size, None, None)[1:3]
    criteria = (3, 300, 1e-12)
    count = len(points[0])
    theirs = cv2.stereoCalibrate([board] * count, *points, *alone, size, flags=0, criteria=criteria)
    assert np.abs(rig.poses[1].tvec - theirs[6].ravel()).max() < 1e-3
    np.testing.assert_allclose(rotation_from_vector(rig.poses[1].rvec), theirs[5], atol=1e-5)
    # The corners' noise alone would say 0.05 mm. The jackknife over pairs says 0.34, halves of the
    # pairs 0.33, and the pairs' scatter with the cameras held 0.27.
    assert np.sqrt(np.diag(rig.noise_covariance))[rig.layout.pose(1)][3] < 0.06
    assert 0.2 < rig.pose_sigma(1)[3:5].min() and rig.pose_sigma(1)[3] < 0.4
    assert {3, 16, 17, 19, 23} <= list_less_agreeing(rig) and len(list_less_agreeing(rig)) <= 7
    assert not rig.left_out


def test_a_pair_of_fisheye_lenses(data_dir: Path) -> None:
    found = search(data_dir / "fisheye_pairs_sourishg", Board(6, 9, 24.23))
    rig = calibrate_rig(calibrate_alone(*found, "kannala-brandt"))
    assert rig.rms == pytest.approx(0.4686, abs=5e-4)
    np.testing.assert_allclose(rig.poses[1].tvec, [-109.74, 0.36, 0.62], atol=0.02)
    assert rig.rms / rig.rms_alone > 2.5
    assert {11, 19, 22, 23} <= list_less_agreeing(rig)


def test_four_cameras_with_clocks_that_do_not_agree(data_dir: Path, tmp_path: Path) -> None:
    folder = data_dir / "four_cameras_charuco_video" / "calibration" / "extrinsic"
    videos = [folder / f"cam_{c}.mp4" for c in range(4)]
    frames = write_frames(videos, tmp_path, 1, Console(quiet=True).show_progress)
    # The board comes into sight in frame 64: what is before it need not be searched.
    pairing = pair_files({name: files[62:] for name, files in frames.items()})
    board = Board(4, 3, 54.0, Charuco())

    def find(files: Sequence[str], _: Board | None) -> Detection:
        return find_views([Path(file) for file in files], board.grid_size, pattern=board.pattern)

    corner_sets = search_cameras(pairing, find, board.square)
    cameras = calibrate_alone(pairing, corner_sets, "brown-conrady", min_corners=6)
    first = 26  # the frame of the table that is the videos' first
    rows = list(csv.DictReader((folder / "timestamps.csv").read_text().splitlines()))
    times = [
        {
            int(row["frame_index"]) - first: float(row["frame_time"])
            for row in rows
            if int(row["cam_id"]) == c
        }
        for c in range(4)
    ]
    told = [replace(camera, times=own) for camera, own in zip(cameras, times, strict=True)]
    late, plain = calibrate_rig(told, estimate_offsets=True), calibrate_rig(told)
    assert late.rms < 0.60 < 1.0 < plain.rms
    # Held at 0, 79, -36 and -28 ms they leave 1.81 px, with the other signs 0.585, and so 0.551.
    np.testing.assert_allclose(1000 * late.offsets, [0, -112, 34, 28], atol=5)
