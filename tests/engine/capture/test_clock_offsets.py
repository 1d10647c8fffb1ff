"""How far the clocks of two cameras are apart is told by a board that moves before both."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.capture.clock_offsets import Seen, Track, estimate_clock_offset
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.rendering import render_view
from tests.engine.rig.scenes import compose
from tests.scenes.hand import FRAMES_PER_SECOND, Walk, spread_places

CAMERAS = (
    Camera((640, 480), [600, 600, 317, 243, -0.1, 0.02, 0, 0, 0], "brown-conrady"),
    Camera((640, 480), [420, 420, 322, 238, -0.25, 0.07, 0, 0, 0], "brown-conrady"),
)
POSES = (Pose([0, 0, 0], [0, 0, 0]), Pose([0.01, -0.12, 0.0], [-60.0, 1.0, 6.0]))
BOARD = Board(6, 8, 20.0)
PLACES = spread_places(BOARD, 8, np.array([30.0, 0.0, 330.0]))
NOISE = 0.03


def _track(c: int, walk: Walk, late: float, phase: float, rng: np.random.Generator) -> Track:
    """What a camera sees of a walk, with noise, in frames that come by its clock."""
    image = render_view(CAMERAS[0], PLACES[0], BOARD)
    pattern = find_corners(image, BOARD.grid_size)
    seen = []
    for time in np.arange(phase, walk.seconds, 1 / FRAMES_PER_SECOND).tolist():
        pose = compose(POSES[c], walk(time + late))
        uv = project_points(BOARD.points(pattern.grid), CAMERAS[c], pose)
        seen.append(Seen(time, replace(pattern, uv=uv + rng.normal(0, NOISE, uv.shape))))
    return Track(CAMERAS[c], seen)


@pytest.mark.parametrize("late", [0.0, 0.037, -0.3])
def test_the_offset_is_told_within_its_standard_deviation(late: float) -> None:
    rng = np.random.default_rng(1)
    pulls = []
    for k in range(0, 8, 2):
        walk = Walk(PLACES[k : k + 2], hold=0.3, move=0.6)
        tracks = [_track(0, walk, 0.0, 0.0, rng), _track(1, walk, late, 0.013, rng)]
        found = estimate_clock_offset(*tracks, BOARD)
        assert found is not None
        assert found[1] < 1e-3
        pulls.append((found[0] - late) / found[1])
    assert np.sqrt(np.mean(np.square(pulls))) < 2


def test_a_board_at_rest_tells_next_to_nothing() -> None:
    rng = np.random.default_rng(1)
    walk = Walk(PLACES[:1], hold=1.0, move=0.0)
    found = estimate_clock_offset(*(_track(c, walk, 0.1, 0.0, rng) for c in (0, 1)), BOARD)
    assert found is None or found[1] > 2e-3


def test_too_few_frames_tell_nothing() -> None:
    assert estimate_clock_offset(*(Track(camera, []) for camera in CAMERAS), BOARD) is None
