"""A session takes frames that are still, sharp and worth it, of a rendered hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.arrays import GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.capture.board_tracking import track_corners
from calibgui.engine.capture.frame_sources import Frame
from calibgui.engine.capture.session import CaptureSession
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.uncertainty.projection_uncertainty import estimate_projection_uncertainty
from tests.scenes.hand import Film, follow, go, shake

CAMERA = Camera((320, 240), [300, 300, 157, 122, -0.2, 0.05, 0, 0, 0], "brown-conrady")
BOARD = Board(6, 8, 20.0)
FIRST = Pose([0.1, -0.1, 0.0], [-75, -50, 330])
STILL = 8
"""Frames for which the hand holds still: longer than a session waits."""


def _find(image: GreyImage) -> Corners:
    return find_corners(image, BOARD.grid_size)


@pytest.fixture
def session() -> CaptureSession:
    return CaptureSession(_find, BOARD.square, limit=0.08)


@pytest.fixture
def film() -> Film:
    return Film(CAMERA, BOARD)


@pytest.mark.parametrize("scale", [1, 3])  # of the larger one halves are followed
def test_corners_are_followed_and_lost_with_the_board(scale: int) -> None:
    params = np.r_[scale * CAMERA.params[:4], CAMERA.params[4:]]
    camera = Camera((scale * CAMERA.size[0], scale * CAMERA.size[1]), params, CAMERA.model)
    film = Film(camera, BOARD)
    near = Pose(FIRST.rvec, FIRST.tvec + np.array([3, -2, 4]))
    far = Pose(FIRST.rvec, FIRST.tvec + np.array([400, 0, 0]))
    frames = [film.take(pose).image for pose in (FIRST, near, far)]
    corners = _find(frames[0])
    followed = track_corners(*(np.repeat(each[..., None], 3, 2) for each in frames[:2]), corners)
    assert followed is not None
    assert len(followed) == len(corners)
    truth = project_points(BOARD.points(followed.grid), camera, near)
    assert np.linalg.norm(followed.uv - truth, axis=1).max() < 0.2
    assert track_corners(frames[1], frames[2], followed) is None


def test_a_hand_that_follows_ends_the_capture(session: CaptureSession, film: Film) -> None:
    rng = np.random.default_rng(1)
    pose, taken = FIRST, []
    state = session.observe(film.take(pose))
    while not session.is_complete and len(session.pictures) < 20:
        wanted = FIRST
        if state.goal is not None:
            wanted = shake(follow(state.goal, CAMERA, BOARD), BOARD, rng, 10, 3)
        for each in go(pose, wanted, 3):
            state = session.observe(film.take(each))
            assert state.taken is None
        pose = wanted
        for _ in range(STILL):
            state = session.observe(film.take(pose))
            taken += [state.taken] if state.taken else []
            if state.taken:
                break
    assert session.is_complete
    assert len(session.pictures) <= 12
    assert taken == session.pictures
    assert [each.for_validation for each in taken] == [k % 5 == 4 for k in range(len(taken))]
    assert session.calibration is not None
    found = estimate_projection_uncertainty(session.calibration, session.views)
    assert found.worst == session.worst <= 0.08
    uv = np.array([[20.0, 20.0], [160.0, 120.0], [300.0, 220.0]])
    rays = np.linalg.norm(
        rays_from_pixels(uv, session.calibration.camera) - rays_from_pixels(uv, CAMERA), axis=1
    )
    assert rays.max() * 300 < 4 * session.worst, (rays.max() * 300, len(taken))
    assert 0 < session.measure_unseen_error() < 0.3


def test_the_same_pose_is_taken_once(session: CaptureSession, film: Film) -> None:
    states = [session.observe(film.take(FIRST)) for _ in range(3 * STILL)]
    assert sum(state.taken is not None for state in states) == 1
    assert states[-1].wanted is not None


def test_a_moving_board_is_not_taken(session: CaptureSession, film: Film) -> None:
    end = Pose(FIRST.rvec, FIRST.tvec + np.array([30, 0, 0]))
    for pose in go(FIRST, end, 3 * STILL):
        assert session.observe(film.take(pose)).taken is None


def test_a_blurred_picture_is_refused(session: CaptureSession, film: Film) -> None:
    assert session.take(film.take(FIRST)) is not None
    assert session.take(film.take(FIRST, blur=2.0)) is None
    state = session.examine(film.take(FIRST, blur=2.0))
    assert "blurred" in state.instruction


def test_a_part_whose_place_on_the_board_is_open_is_not_taken(film: Film) -> None:
    session = CaptureSession(lambda image: replace(_find(image), relative=True), 20.0, 0.1)
    assert session.examine(film.take(FIRST)).instruction == "Hold the whole board in the picture."
    assert not session.pictures


def test_a_picture_that_contradicts_the_others_is_refused(film: Film) -> None:
    """A board that is counted in a mirror fits no camera together with the others."""
    is_mirrored = [False, False, True]

    def find(image: GreyImage) -> Corners:
        corners = _find(image)
        if is_mirrored.pop(0):
            grid = np.array([0, BOARD.cols - 1]) + corners.grid * [1, -1]
            corners = replace(corners, grid=grid)
        return corners

    session = CaptureSession(find, BOARD.square, limit=0.08)
    tilted = Pose([0.6, 0.1, 0.1], [-70, -45, 280])
    other = Pose([-0.6, 0.2, 0.0], [-75, -55, 330])
    assert session.take(film.take(FIRST)) is not None
    assert session.take(film.take(tilted)) is not None
    state = session.examine(film.take(other))
    assert state.taken is None
    assert state.instruction.startswith("It contradicts the pictures")
    assert len(session.pictures) == 2
    assert session.calibration is not None


def test_no_board_is_said(session: CaptureSession) -> None:
    state = session.observe(Frame(np.full((240, 320), 128, np.uint8), 0.0))
    assert state.corners is None
    assert state.instruction == "Hold the whole board in the picture."


def test_images_of_another_size_are_refused(session: CaptureSession, film: Film) -> None:
    session.observe(film.take(FIRST))
    with pytest.raises(CalibrationError, match="320 x 240 px to 640 x 480 px"):
        session.observe(Frame(np.zeros((480, 640), np.uint8), 1.0))


def test_a_board_too_bright_is_not_taken_while_the_light_can_be_changed(
    session: CaptureSession, film: Film
) -> None:
    frame = film.take(FIRST)
    bright = frame._replace(image=np.where(frame.image > 110, 255, frame.image).astype(np.uint8))
    states = [session.observe(bright) for _ in range(STILL)]
    assert states[-1].instruction.startswith("Too bright")
    assert not session.pictures
    assert session.observe(bright, is_live=False).taken is not None
