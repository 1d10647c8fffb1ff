"""The whole calibration on synthetic scenes: truth recovered, and what must not change it."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Sequence
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from threadpoolctl import threadpool_limits

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.initialisation.stage_one import StageOneRegistration
from calibgui.engine.calibration.methods import method
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import (
    Calibration,
    Cost,
    Iteration,
    StageOne,
    StageOneTable,
    Status,
)
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import TRUE_BOARD, VGA, Scene, barrel, brown, looking, scene, seen

Views = Sequence[Observation]
NOISY = scene(barrel(0.9), 8, seed=2).noisy(0.2, np.random.default_rng(0))


def poses_agree(found: Calibration, made: Scene, rtol: float) -> None:
    for pose, truth in zip(found.poses, made.poses, strict=True):
        np.testing.assert_allclose(
            rotation_from_vector(pose.rvec), rotation_from_vector(truth.rvec), atol=rtol
        )
        np.testing.assert_allclose(pose.tvec, truth.tvec, atol=rtol * truth.tvec[2])


@pytest.mark.parametrize("cost", [Cost.IMAGE, Cost.REFERENCE])
@pytest.mark.parametrize("aspect", [0.7, 0.85, 1.0, 1.2, 1.4])
def test_perfect_data_give_the_truth(aspect: float, cost: Cost) -> None:
    made = scene(barrel(aspect), 8, seed=3)
    found = calibrate(made.views, made.size, cost=cost)
    assert found.status is Status.CONVERGED
    np.testing.assert_allclose(found.camera.params[:4], made.camera.params[:4], rtol=1e-9)
    # Coefficients against what they do at the image's corner, 1e-9 of its distance.
    reach = 0.6 ** -np.array([2.0, 4, 6, 1, 1, 2])
    miss = np.abs(found.camera.coefficients - made.camera.coefficients)
    assert (miss < 1e-9 * reach).all()
    poses_agree(found, made, 1e-9)
    assert found.noise < 1e-9
    assert max(np.abs(r.image).max() for r in found.residuals) < 1e-8


def test_perfect_data_of_the_forward_model() -> None:
    made = scene(brown(0.9), 8, seed=3)
    found = calibrate(made.views, made.size, model="brown-conrady")
    np.testing.assert_allclose(found.camera.params, made.camera.params, rtol=1e-8, atol=1e-9)
    poses_agree(found, made, 1e-9)


def test_the_papers_preset_recovers_square_pixels() -> None:
    made = scene(barrel(), 8, seed=3)
    found = calibrate(made.views, made.size, cost="paper", fix=["p3"])
    assert found.camera.model == "lucchese-pixels"
    np.testing.assert_allclose(found.camera.params[:4], made.camera.params[:4], rtol=1e-9)


def test_partial_boards() -> None:
    camera, rng = barrel(0.9), np.random.default_rng(8)
    made = seen(camera, [looking(camera, rng, fill=(0.9, 1.4)) for _ in range(8)], partial=True)
    counts = {len(view.uv) for view in made.views}
    assert len(counts) > 3
    assert min(counts) < 90
    found = calibrate(made.views, made.size)
    np.testing.assert_allclose(found.camera.params[:4], camera.params[:4], rtol=1e-9)
    assert [len(r.image) for r in found.residuals] == [len(view.uv) for view in made.views]
    poses_agree(found, made, 1e-9)


def test_four_corners_a_view_are_enough() -> None:
    made = scene(barrel(), 12, seed=5)
    corners = [0, 11, 96, 107]
    found = calibrate([(v.uv[corners], v.xy[corners]) for v in made.views], made.size)
    np.testing.assert_allclose(found.camera.params[:4], made.camera.params[:4], rtol=1e-7)


def same(found: Calibration, expected: Calibration, rtol: float = 1e-7) -> None:
    """Camera and its uncertainty agree to far less than a standard deviation."""
    sd = expected.sigma[:9]
    assert (np.abs(found.camera.params - expected.camera.params)[:9] < 1e-4 * sd).all()
    np.testing.assert_allclose(found.sigma[:9], sd, rtol=1e-3)
    assert found.noise == pytest.approx(expected.noise, rel=rtol)


@pytest.fixture(scope="module")
def expected() -> Calibration:
    return calibrate(NOISY, VGA)


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=8)
def test_order_of_corners_and_views_does_not_matter(expected: Calibration, seed: int) -> None:
    rng = np.random.default_rng(seed)
    shuffled = []
    for k in rng.permutation(len(NOISY)):
        order = rng.permutation(len(NOISY[k].uv))
        shuffled.append(Observation(NOISY[k].uv[order], NOISY[k].xy[order]))
    same(calibrate(shuffled, VGA), expected)


@given(st.floats(-2000, 2000), st.floats(-2000, 2000))
@settings(max_examples=8)
def test_the_boards_origin_is_free(expected: Calibration, x: float, y: float) -> None:
    moved = calibrate([(v.uv, v.xy + np.array([x, y])) for v in NOISY], VGA)
    same(moved, expected)
    for pose, was in zip(moved.poses, expected.poses, strict=True):
        np.testing.assert_allclose(pose.rvec, was.rvec, atol=1e-6)
        shift = rotation_from_vector(was.rvec)[:, :2] @ [x, y]
        np.testing.assert_allclose(pose.tvec, was.tvec - shift, atol=3e-3)


@given(st.floats(1e-3, 1e3))
@settings(max_examples=8)
def test_the_unit_of_the_board_scales_the_translations(expected: Calibration, unit: float) -> None:
    scaled = calibrate([(v.uv, v.xy * unit) for v in NOISY], VGA)
    same(scaled, expected)
    for pose, was in zip(scaled.poses, expected.poses, strict=True):
        np.testing.assert_allclose(pose.tvec, was.tvec * unit, rtol=1e-5, atol=1e-3 * unit)
    reference = np.concatenate([r.reference for r in scaled.residuals])
    was_there = np.concatenate([r.reference for r in expected.residuals])
    np.testing.assert_allclose(reference, was_there, atol=1e-4)


def test_a_board_numbered_with_y_up_is_the_same_board(expected: Calibration) -> None:
    up = calibrate([(v.uv, v.xy * [1, -1]) for v in NOISY], VGA)
    same(up, expected)
    half_turn = np.diag([1.0, -1.0, -1.0])
    np.testing.assert_allclose(
        rotation_from_vector(up.poses[0].rvec),
        rotation_from_vector(expected.poses[0].rvec) @ half_turn,
        atol=1e-6,
    )


def test_boards_turned_by_180_degrees_agree() -> None:
    turned = [NOISY[0], Observation(NOISY[1].uv, NOISY[1].xy[::-1]), *NOISY[2:]]
    found = calibrate(turned, VGA, prior=TRUE_BOARD)  # what a bent board does is averaged by turns
    same(found, calibrate(NOISY, VGA, prior=TRUE_BOARD))


MIRRORS: dict[str, Callable[[Array], Array]] = {
    "left to right": lambda uv: uv * [-1, 1] + [VGA[0] - 1, 0],
    "top to bottom": lambda uv: uv * [1, -1] + [0, VGA[1] - 1],
    "x and y exchanged": lambda uv: uv[:, ::-1],
}


@pytest.mark.parametrize("mirror", MIRRORS.values(), ids=MIRRORS)
def test_a_mirrored_view_is_named(mirror: Callable[[Array], Array]) -> None:
    views = [*NOISY[:7], Observation(mirror(np.array(NOISY[7].uv)), NOISY[7].xy)]
    with pytest.raises(CalibrationError, match=r"mirrored .* last\.png") as caught:
        calibrate(views, VGA, names=[*"abcdefg", "last.png"])
    assert "turning sense" in caught.value.hint


def test_held_parameters_keep_their_values(expected: Calibration) -> None:
    held = {"k2": None, "k3": None, "p1": None, "p2": 2e-4, "cx": 310.0, "fy": 580.0}
    found = calibrate(NOISY, VGA, fix=held)
    names = ("fx", "fy", "cx", "cy", "k1", "k2", "k3", "p1", "p2", "p3")
    assert set(found.fixed) == {*held, "p3"}
    for i, name in enumerate(names):
        if name in found.fixed:
            assert found.camera.params[i] == (held.get(name) or 0.0)
            assert found.sigma[i] == 0.0
        else:
            assert found.sigma[i] > 0.0
    assert found.history[-1].cost > expected.history[-1].cost


def test_a_centre_held_without_a_value_is_the_arrays() -> None:
    found = calibrate(NOISY, VGA, fix=["cx", "cy"])
    np.testing.assert_array_equal(found.camera.centre, [319.5, 239.5])


def test_a_known_camera_leaves_the_poses() -> None:
    camera = barrel(0.9)
    names = ("fx", "fy", "cx", "cy", "k1", "k2", "k3", "p1", "p2")
    known = dict(zip(names, camera.params.tolist(), strict=False))
    made = scene(camera, 8, seed=2)
    found = calibrate(made.views, VGA, fix=known)
    np.testing.assert_array_equal(found.camera.params, camera.params)
    poses_agree(found, made, 1e-9)


def test_p3_is_held_unless_freed() -> None:
    assert calibrate(NOISY, VGA).fixed == ("p3",)
    freed = calibrate(NOISY, VGA, free=["p3"])
    assert freed.fixed == ()
    assert freed.camera.params[9] != 0.0
    # All of its steps take 9 s: p3 goes far without becoming known.
    assert calibrate(NOISY, VGA, cost="paper", report=lambda _: False).fixed == ()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"fix": ["k7"]}, "no parameter 'k7'"),
        ({"free": ["k7"]}, "no parameter 'k7'"),
        ({"fix": ["p3"], "free": ["p3"]}, "both held and freed"),
        ({"fix": {"fx": -3.0}}, "fx cannot be held"),
        ({"fix": {"k1": float("nan")}}, "k1 cannot be held"),
        ({"fix": {"cx": 1e9}}, "cx cannot be held"),
        ({"model": "fisheye"}, "no lens model"),
        ({"cost": "reprojection"}, "no cost 'reprojection'"),
        ({"board_shape": "bent"}, "no board shape 'bent'"),
        ({"board_shape": "bow", "cost": "reference"}, "flat board as it is drawn"),
    ],
)
def test_impossible_settings_are_named(options: dict[str, object], says: str) -> None:
    with pytest.raises(CalibrationError, match=says):
        calibrate(NOISY, VGA, **options)  # type: ignore[arg-type]


def test_a_wrong_image_size_is_noticed() -> None:
    with pytest.raises(CalibrationError, match="far outside an image of 100 x 80"):
        calibrate(NOISY, (100, 80))
    within = [((v.uv > 0) & (v.uv < VGA)).all(axis=1) for v in NOISY]
    views = [(v.uv[good], v.xy[good]) for v, good in zip(NOISY, within, strict=True)]
    with pytest.raises(CalibrationError, match="corners outside an image of 480 x 640"):
        calibrate(views, VGA[::-1])
    with pytest.raises(CalibrationError, match="no image of 640 x 0"):
        calibrate(NOISY, (640, 0))


def test_one_name_is_as_good_as_a_list_of_it() -> None:
    assert calibrate(NOISY, VGA, fix="k3", free="p3").fixed == ("k3",)


def test_plain_tuples_and_lists_serve(expected: Calibration) -> None:
    same(calibrate([(v.uv.tolist(), v.xy.tolist()) for v in NOISY], VGA), expected)  # type: ignore[misc]


def weighted(views: Views, variances: Sequence[float]) -> list[Observation]:
    return [
        Observation(v.uv, v.xy, np.tile(s * np.eye(2), (len(v.uv), 1, 1)))
        for v, s in zip(views, variances, strict=True)
    ]


def test_equal_covariances_change_nothing(expected: Calibration) -> None:
    found = calibrate(weighted(NOISY, [0.04] * 8), VGA)
    sd = expected.sigma[:9]
    assert (np.abs(found.camera.params - expected.camera.params)[:9] < 1e-4 * sd).all()
    np.testing.assert_allclose(found.sigma[:9], sd, rtol=1e-3)
    assert found.noise == pytest.approx(expected.noise, rel=1e-6)


def test_a_view_of_large_covariance_hardly_counts() -> None:
    bad = scene(barrel(0.9), 8, seed=2).noisy(5.0, np.random.default_rng(1))[0]
    views = [bad, *NOISY[1:]]
    without = calibrate(NOISY[1:], VGA)
    blind = calibrate(views, VGA)
    known = calibrate(weighted(views, [25.0] + [0.04] * 7), VGA)
    sd = without.sigma[:4]
    assert (np.abs(known.camera.params - without.camera.params)[:4] < 0.3 * sd).all()
    assert (np.abs(blind.camera.params - without.camera.params)[:4] > 1.0 * sd).any()
    # The noise is that of the median corner, px.
    assert known.noise == pytest.approx(0.2, rel=0.1)


def test_report_stops_and_cancels() -> None:
    seen_: list[Iteration] = []

    def stop(iteration: Iteration) -> bool:
        seen_.append(iteration)
        return iteration.index < 2

    stopped = calibrate(NOISY, VGA, report=stop)
    assert stopped.status is Status.STOPPED
    assert stopped.history == tuple(seen_)
    assert len(seen_) == 3

    def cancel(_: Iteration) -> bool:
        raise Cancelled

    with pytest.raises(Cancelled):
        calibrate(NOISY, VGA, report=cancel)


def test_the_limit_of_iterations_is_a_status() -> None:
    found = calibrate(NOISY, VGA, max_iterations=1)
    assert found.status is Status.MAX_ITERATIONS
    found = calibrate(weighted(NOISY, [0.04] * 8), VGA, max_iterations=1)
    assert found.status is Status.MAX_ITERATIONS
    costs = [i.cost for i in calibrate(NOISY, VGA).history]
    assert costs == sorted(costs, reverse=True)
    assert len(costs) <= 10


def test_the_digest_answers_for_its_inputs(expected: Calibration) -> None:
    assert calibrate(NOISY, VGA).digest == expected.digest
    moved = [Observation(NOISY[0].uv + 1e-9, NOISY[0].xy), *NOISY[1:]]
    assert calibrate(moved, VGA).digest != expected.digest
    assert calibrate(NOISY, VGA, fix=["k3"]).digest != expected.digest


def test_stage_one_is_reported(expected: Calibration) -> None:
    assert len(expected.stage_one) == 8
    k1 = np.median([row.k1 for row in expected.stage_one])
    assert k1 == pytest.approx(0.25 / 650**2, rel=0.3)
    assert all(row.converged and row.rms < 1.0 for row in expected.stage_one)
    aspects = np.array([row.aspect for row in expected.stage_one])
    assert np.nanmedian(aspects) == pytest.approx(0.9, abs=0.05)


def test_the_table_of_stage_one_is_computed_once_and_when_it_is_read(
    expected: Calibration,
) -> None:
    rows, asked = tuple(expected.stage_one), []

    def tabulate() -> tuple[StageOne, ...]:
        asked.append(1)
        return rows

    table = StageOneTable(tabulate)
    assert not asked
    assert (len(table), table[0], table[-2:], [*table]) == (8, rows[0], rows[-2:], [*rows])
    assert len(asked) == 1
    copied = pickle.loads(pickle.dumps(expected)).stage_one  # other processes get it as well
    assert [row.xp for row in copied] == [row.xp for row in rows]


@pytest.mark.parametrize("count", [-1, 1.5, float("nan"), True, "3"])
def test_iterations_are_counted_in_whole_numbers(count: Any) -> None:
    views = scene(barrel(), 4).noisy(0.1, np.random.default_rng(2))
    with pytest.raises(CalibrationError, match=f"A solve cannot have {count} iterations"):
        calibrate(views, VGA, max_iterations=count)


def test_many_views_are_started_from_some_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    registered, register = [], method.register_views

    def count(xy: Array, reference: Array, mask: Array) -> StageOneRegistration:
        registered.append(len(xy))
        return register(xy, reference, mask)

    monkeypatch.setattr(method, "register_views", count)
    found = calibrate(scene(barrel(), 40).noisy(0.1, np.random.default_rng(2)), VGA)
    assert registered == [25]
    assert len(found.stage_one) == 40
    assert registered == [25, 40]


def test_arrays_of_results_are_frozen(expected: Calibration) -> None:
    for array in (expected.camera.params, expected.sigma, expected.covariance):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


@pytest.mark.parametrize("aspect", [0.9, 1.0])
def test_the_forward_model_agrees_with_opencv(aspect: float) -> None:
    made = scene(brown(aspect), 6, seed=11)
    views = made.noisy(0.2, np.random.default_rng(4))
    found = calibrate(views, VGA, model="brown-conrady")
    boards = [np.column_stack([v.xy, np.zeros(len(v.xy))]).astype(np.float32) for v in views]
    corners = [v.uv.astype(np.float32).reshape(-1, 1, 2) for v in views]
    criteria = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 200, 1e-15)
    result = cv2.calibrateCameraExtended(boards, corners, VGA, None, None, criteria=criteria)
    rms, K, distortion = result[0], result[1], result[2].ravel()
    # float32 corners are 3e-5 px from ours: a thousandth of a standard deviation.
    theirs = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2], *distortion[:5]])
    assert (np.abs(found.camera.params[:9] - theirs) < 2e-3 * found.sigma[:9]).all()
    squares = np.concatenate([r.image for r in found.residuals]) ** 2
    assert np.sqrt(squares.sum(axis=1).mean()) == pytest.approx(rms, rel=1e-5)
    sd = result[5].ravel()[:9][[0, 1, 2, 3, 4, 5, 6, 7, 8]]
    np.testing.assert_allclose(found.sigma_by_noise[:9], sd, rtol=5e-3)


@pytest.mark.parametrize(("count", "board_shape"), [(300, "nominal"), (12, "free")])
def test_the_same_bits_whatever_the_number_of_threads(
    count: int, board_shape: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    views = scene(barrel(), count, seed=7).noisy(0.1, np.random.default_rng(0))
    results = []
    for threads in (1, 2, 5):
        monkeypatch.setattr("calibgui.engine.kernels.common.THREADS", threads)
        with threadpool_limits(threads):
            results.append(calibrate(views, VGA, board_shape=board_shape))
    for other in results[1:]:
        for name in ("sigma", "covariance", "pose_covariances", "noise"):
            np.testing.assert_array_equal(getattr(results[0], name), getattr(other, name))
        np.testing.assert_array_equal(results[0].camera.params, other.camera.params)
        for ours, theirs in zip(results[0].residuals, other.residuals, strict=True):
            np.testing.assert_array_equal(ours.image, theirs.image)
