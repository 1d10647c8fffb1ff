"""The scatter of corners of a board that stands still, against what was drawn."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.changes.repeatability import measure_repeatability
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import BOARD, barrel, imaged, looking

NOISE = 0.05


def draw_frames(
    count: int, motion: float = 0.0, noise: float = NOISE, seed: int = 1
) -> list[Observation]:
    """Frames of one board whose pose differs by `motion` mm and mrad from frame to frame."""
    rng = np.random.default_rng(seed)
    camera, xy = barrel(), BOARD.points()
    pose = looking(camera, rng)
    frames = []
    for _ in range(count):
        moved = type(pose)(
            pose.rvec + rng.normal(0, motion / 1000, 3), pose.tvec + rng.normal(0, motion, 3)
        )
        uv = imaged(camera, moved, xy) + rng.normal(0, noise, xy.shape)
        frames.append(Observation(uv, xy, np.tile(noise**2 * np.eye(2), (len(xy), 1, 1))))
    return frames


@pytest.mark.parametrize("motion", [0.0, 0.05])
def test_the_noise_is_what_was_drawn_whether_or_not_frames_move(motion: float) -> None:
    found = [measure_repeatability(draw_frames(20, motion, seed=seed)) for seed in range(12)]
    z = [(each.rms - NOISE) / each.rms_sigma for each in found]
    assert abs(np.mean(z)) < 0.9 and 0.5 < np.std(z) < 1.6
    assert found[0].stated == pytest.approx(NOISE)
    assert np.sqrt(np.mean(found[0].sigma ** 2)) == pytest.approx(found[0].rms)
    if motion:
        assert all(each.motion > 0.02 for each in found)
    else:
        assert all(each.motion == 0.0 for each in found)


def test_the_motion_is_as_large_as_the_corners_moved() -> None:
    still = draw_frames(30, 0.1, noise=0.0)
    uv = np.stack([frame.uv for frame in still])
    moved = np.sqrt(np.mean(np.sum((uv - uv.mean(axis=0)) ** 2, axis=-1)))
    found = measure_repeatability(draw_frames(30, 0.1, noise=1e-3))
    assert found.motion == pytest.approx(moved, rel=0.2)


def test_corners_that_a_frame_lacks_are_left_out() -> None:
    frames = draw_frames(5)
    uv, xy, _ = frames[2]
    frames[2] = Observation(uv[::-1][:-3], xy[::-1][:-3])
    found = measure_repeatability(frames)
    assert len(found.uv) == len(xy) - 3 and np.isnan(found.stated)
    assert found.rms == pytest.approx(NOISE, rel=0.3)


def test_what_does_not_show_noise_is_refused() -> None:
    frames = draw_frames(3)
    with pytest.raises(CalibrationError, match="One frame"):
        measure_repeatability(frames[:1])
    with pytest.raises(CalibrationError, match="copies of one photograph"):
        measure_repeatability([frames[0]] * 3)
    with pytest.raises(CalibrationError, match="does not stand still"):
        measure_repeatability(draw_frames(5, 20.0))
    few = [Observation(uv[:4], xy[:4]) for uv, xy, _ in frames]
    with pytest.raises(CalibrationError, match="only 4 of"):
        measure_repeatability(few)
