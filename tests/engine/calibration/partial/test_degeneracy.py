"""Sets of views that do not determine a camera: each is refused by name."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.partial import degeneracy
from calibgui.engine.calibration.result import DegenerateError
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import Scene, barrel, looking, scene, seen

CAMERA = barrel()
NOISES = [0.0, 0.05, 0.3, 1.0]


def parallel_planes(count: int, tilt: float, seed: int = 0) -> Scene:
    """Boards moved and turned within planes of one direction."""
    rng = np.random.default_rng(seed)
    poses = [looking(CAMERA, rng, (tilt, tilt), towards=40) for _ in range(count)]
    return seen(CAMERA, poses, partial=True)


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("count", [2, 5, 20])
def test_parallel_to_the_sensor(count: int, noise: float) -> None:
    made = parallel_planes(count, 0.0)
    views = made.noisy(noise, np.random.default_rng(1))
    # At 1 px the tilts that noise makes of a wandering focal length need not look small.
    expected = "parallel to the sensor" if noise < 1 else "parallel to|in one orientation"
    with pytest.raises(DegenerateError, match=expected) as caught:
        calibrate(views, made.size)
    assert "20 to 45 degrees" in caught.value.hint


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("count", [2, 5, 20])
def test_one_orientation(count: int, noise: float) -> None:
    made = parallel_planes(count, 30.0)
    views = made.noisy(noise, np.random.default_rng(1))
    with pytest.raises(DegenerateError, match="in one orientation"):
        calibrate(views, made.size)


@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("own", [False, True])
def test_ten_copies_of_one_view(own: bool, noise: float) -> None:
    made = scene(CAMERA, 1)
    copies = seen(CAMERA, [made.poses[0]] * 10)
    views = copies.noisy(noise, np.random.default_rng(2))
    expected = "in one orientation and place" if own and noise else "All 10 views are copies of one"
    with pytest.raises(DegenerateError, match=expected):
        calibrate(views if own else [views[0]] * 10, made.size)


@pytest.mark.parametrize("cost", ["image", "reference", "paper"])
def test_every_cost_refuses(cost: str) -> None:
    made = parallel_planes(5, 30.0)
    with pytest.raises(DegenerateError):
        calibrate(made.noisy(0.2, np.random.default_rng(3)), made.size, cost=cost)


def test_one_view() -> None:
    made = scene(CAMERA, 1)
    with pytest.raises(DegenerateError, match="One view"):
        calibrate(made.views, made.size)


def test_as_many_unknowns_as_coordinates() -> None:
    made = scene(CAMERA, 2, seed=1)
    few = [Observation(v.uv[[0, 11, 96, 107]], v.xy[[0, 11, 96, 107]]) for v in made.views]
    with pytest.raises(DegenerateError, match="no more corner coordinates than unknowns"):
        calibrate(few, made.size)


def test_planes_that_differ_but_say_too_little() -> None:
    """Two boards tilted about the same axis, 1 px of noise: fx 200 px from the truth."""
    rng = np.random.default_rng(5)
    poses = [looking(CAMERA, rng, (25, 45), roll=0.0, towards=180 * i) for i in range(2)]
    made = seen(CAMERA, poses, partial=True)
    with pytest.raises(DegenerateError, match="2 views leave fy/fx"):
        calibrate(made.noisy(1.0, np.random.default_rng(0)), made.size)


@pytest.mark.parametrize("noise", [0.05, 0.3])
def test_small_tilts_are_enough(noise: float) -> None:
    """Never refuse what the data hold: tilts of 2 to 5 degrees, answered with honest sigmas."""
    made = scene(CAMERA, 10, seed=1, tilt=(2.0, 5.0))
    found = calibrate(made.noisy(noise, np.random.default_rng(0)), made.size)
    miss = np.abs(found.camera.params[:4] - CAMERA.params[:4])
    assert (miss < 4 * found.sigma[:4]).all()
    assert found.sigma[0] > noise * 20


def test_one_orientation_is_enough_with_a_known_centre() -> None:
    made = parallel_planes(5, 30.0)
    cx, cy = CAMERA.params[2:4].tolist()
    views = made.noisy(0.1, np.random.default_rng(1))
    found = calibrate(views, made.size, fix={"cx": cx, "cy": cy})
    assert (np.abs(found.camera.params[:2] - 650.0) < 4 * found.sigma[:2]).all()


def test_normals_face_away_from_the_camera() -> None:
    R = np.stack([np.eye(3), np.diag([1.0, -1.0, -1.0])])
    np.testing.assert_array_equal(degeneracy.compute_normals(R), [[0, 0, 1], [0, 0, 1]])


def test_one_misnumbered_view_is_named_rather_than_what_it_hides() -> None:
    made = scene(CAMERA, 8, seed=4)
    views = made.noisy(0.1, np.random.default_rng(2))
    wrong = views[3]
    views[3] = Observation(wrong.uv, np.roll(wrong.xy, 1, axis=0))
    with pytest.raises(
        CalibrationError, match="No camera sees a flat board as in View 4"
    ) as caught:
        calibrate(views, made.size)
    assert not isinstance(caught.value, DegenerateError)
    assert np.isfinite(calibrate(views[:3] + views[4:], made.size).sigma[:4]).all()
