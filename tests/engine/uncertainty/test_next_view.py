"""The next view: worth what it promises, and where its words say."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration, DegenerateError
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.uncertainty.next_view import propose_views
from calibgui.engine.uncertainty.view_design import build_design
from tests.engine.scenes import BOARD, VGA, barrel, brown, scene, seen

SIZE = barrel().size


def _calibrated(count: int, noise: float = 0.2) -> tuple[Calibration, list[Observation]]:
    views = scene(barrel(), count, seed=1).noisy(noise, np.random.default_rng(2))
    return calibrate(views, SIZE), views


def test_the_next_view_is_worth_what_it_promises() -> None:
    whole, views = _calibrated(4)
    proposed = propose_views(whole, views)
    promised = [one.after for one in proposed]
    assert [one.before for one in proposed[1:]] == pytest.approx(promised[:-1], rel=1e-12)
    assert all(one.after < one.before for one in proposed)
    true = seen(barrel(), [one.pose for one in proposed])
    taken = views + true.noisy(0.2, np.random.default_rng(7))
    better = calibrate(taken, SIZE)
    after = (
        np.sqrt(build_design(better, taken).compute_loss(np.ones(len(taken))))
        * whole.noise
        / better.noise
    )
    assert after == pytest.approx(proposed[-1].after, rel=0.15)


def test_the_next_view_beats_another_of_the_same_kind() -> None:
    whole, views = _calibrated(6)
    proposed = propose_views(whole, views, count=1)[0]
    for seed in range(10):
        view = scene(barrel(), 1, seed=50 + seed).views[0]
        if ((view.uv < 0) | (view.uv > np.array(SIZE) - 1)).any():
            continue
        other = [*views, view]
        result = calibrate(other, SIZE)
        loss = build_design(result, other).compute_loss(np.ones(7))
        assert proposed.after < np.sqrt(loss) * whole.noise / result.noise


@pytest.mark.parametrize("up", [1.0, -1.0])
def test_the_words_describe_the_pose(up: float) -> None:
    views = [  # `up` -1: the board's Y runs up in the image
        Observation(view.uv, view.xy * np.array([1.0, up]))
        for view in scene(barrel(), 5, seed=1).noisy(0.2, np.random.default_rng(2))
    ]
    whole = calibrate(views, SIZE)
    for one in propose_views(whole, views, count=8):
        u, v = one.corners.mean(axis=0) / SIZE
        assert abs(u - one.place[0]) < 0.1
        assert abs(v - one.place[1]) < 0.1
        assert (one.corners >= 0).all()
        assert (one.corners <= np.array(SIZE) - 1).all()
        if one.side is None:
            continue
        # On the receding side the squares look smaller.
        angle = 2 * np.pi * one.side / 8
        across = (one.corners - one.corners.mean(axis=0)) @ [np.cos(angle), np.sin(angle)]
        gaps = np.array([np.sort(np.linalg.norm(one.corners - c, axis=1))[1] for c in one.corners])
        far, near = across > np.quantile(across, 0.8), across < np.quantile(across, 0.2)
        assert gaps[far].mean() < gaps[near].mean()
        assert f"{one.tilt:.0f} degrees away" in one.instruction


def test_views_that_do_not_determine_the_camera_need_a_tilted_one() -> None:
    views = seen(barrel(), [Pose(np.zeros(3), [-90.0, -75.0, 400.0])]).noisy(
        0.02, np.random.default_rng(2)
    )
    with pytest.raises(DegenerateError) as caught:
        calibrate(views, SIZE)
    partial = caught.value.partial
    assert partial is not None
    assert all(one.tilt > 0 for one in propose_views(partial, views))


def test_another_lens_model() -> None:
    views = scene(brown(), 5, seed=1).noisy(0.2, np.random.default_rng(2))
    result = calibrate(views, SIZE, model="brown-conrady")
    assert propose_views(result, views, count=1)[0].instruction.startswith("Hold the board")


def test_boards_at_the_edge_of_a_fisheye_face_it() -> None:
    """At 80 degrees off the axis a board parallel to the sensor would be seen edge-on."""
    camera = Camera(VGA, [150, 150, 322, 236, -0.03, 0.004, -0.001, 0], "kannala-brandt")
    views = scene(camera, 8).noisy(0.1, np.random.default_rng(1))
    best = propose_views(calibrate(views, VGA, model="kannala-brandt"), views)
    for view in best:
        normal = rotation_from_vector(view.pose.rvec)[:, 2]
        middle = BOARD.points().mean(axis=0)
        towards = rotation_from_vector(view.pose.rvec)[:, :2] @ middle + view.pose.tvec
        cosine = abs(normal @ towards) / np.linalg.norm(towards)
        assert cosine > np.cos(np.deg2rad(80))
