"""Stage II's residuals: what they are zero for, their derivatives, and scipy's minimum of them."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observations, pack_observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import minimise
from calibgui.engine.calibration.refinement.residuals import (
    Linearised,
    State,
    build_stage_two,
    compute_image_residuals,
    compute_reference_residuals,
    compute_registration_errors,
    linearise_residuals,
    predict_corners,
)
from calibgui.engine.calibration.refinement.whitening import whiten_observations
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.models import find_model, list_parameter_names
from tests.engine.scenes import LENSES, Scene, barrel, central_differences, example, relative, scene

CASES = [
    *product(
        (model for model in LENSES if model != "lucchese-pixels"), (Cost.IMAGE, Cost.REFERENCE)
    ),
    ("lucchese-pixels", Cost.PAPER),
]
SCALE = 1.2


def truth_of(made: Scene) -> State:
    """The scene's camera and poses as the solver's unknowns, some of p3 included."""
    params = np.array(made.camera.params)
    R = Rotation.from_rotvec(np.array([pose.rvec for pose in made.poses])).as_matrix()
    return State(params, R, np.array([pose.tvec for pose in made.poses]))


def made_with(model: str) -> Scene:
    """A scene of a camera with all coefficients at work."""
    return scene(example(model, 0.85), 3, seed=5)


def residual(model: str, cost: Cost, state: State, views: Observations) -> Linearised:
    if cost is Cost.IMAGE:
        return compute_image_residuals(state, views, model)
    return compute_reference_residuals(state, views, find_model(model), SCALE, cost is Cost.PAPER)


@pytest.mark.parametrize(("model", "cost"), CASES)
def test_the_registration_error_is_the_residual_of_the_reference_plane(
    model: str, cost: Cost
) -> None:
    made = made_with(model)
    state, views = truth_of(made), pack_observations(made.noisy(0.5, np.random.default_rng(0)))
    on_paper_grid = cost is Cost.PAPER
    expected = compute_reference_residuals(
        state, views, find_model(model), SCALE, on_paper_grid
    ).residual
    found = compute_registration_errors(state, views, find_model(model), cost)
    np.testing.assert_allclose(SCALE * found, expected, atol=1e-10)


def test_a_corner_off_the_plane_is_registered_beside_its_place() -> None:
    made = made_with("lucchese")
    state, views = truth_of(made), pack_observations(made.views)
    height = np.random.default_rng(0).normal(0, 3, (*views.mask.shape, 1))
    bent = replace(views, xy=np.concatenate([views.xy, height], axis=-1))
    seen = replace(bent, uv=predict_corners(state, bent, find_model("lucchese"), Cost.IMAGE))
    found = compute_registration_errors(state, seen, find_model("lucchese"), Cost.IMAGE)
    np.testing.assert_allclose(found, 0.0, atol=1e-10)


@pytest.mark.parametrize(("model", "cost"), CASES[:-1])
def test_no_residual_at_the_truth(model: str, cost: Cost) -> None:
    made = made_with(model)
    assert (
        np.abs(residual(model, cost, truth_of(made), pack_observations(made.views)).residual).max()
        < 1e-9
    )


def test_the_literal_grid_is_the_board_stretched() -> None:
    """Eq. 29: a square board is fy/fx times as high as wide on the paper's grid of equal pixels."""
    made = made_with("lucchese-pixels")
    stretched = [(uv, xy * [1.0, 0.85]) for uv, xy, _ in made.views]
    found = residual("lucchese-pixels", Cost.PAPER, truth_of(made), pack_observations(stretched))
    assert np.abs(found.residual).max() < 1e-9


@pytest.mark.parametrize(("model", "cost"), CASES)
def test_derivatives_against_differences(model: str, cost: Cost) -> None:
    made = made_with(model)
    views = pack_observations(made.noisy(0.5, np.random.default_rng(0)))
    state = truth_of(made)
    lens_count = len(state.params) - 4
    # Steps of 3e-4 of each unknown's scale: truncation 1e-13 times a fifth derivative.
    step = np.concatenate([np.full(4, 0.2), np.full(lens_count, 3e-4)])

    def by_params(p: Array) -> Array:
        return residual(model, cost, state._replace(params=p), views).residual

    def by_pose(move: Array) -> Array:
        moved = state.take_step(np.zeros(len(state.params)), np.tile(move, (3, 1)))
        return residual(model, cost, moved, views).residual

    found = residual(model, cost, state, views)
    numeric = central_differences(by_params, state.params, step)
    for i in range(len(step)):
        # A control point that corners barely touch moves them by less than differences show.
        assert relative(found.by_params[..., i], numeric[..., i], floor=1.0) < 1e-7
    pose_step = np.array([3e-4] * 3 + [0.2] * 3)
    numeric = central_differences(by_pose, np.zeros(6), pose_step)
    for i in range(6):
        assert relative(found.by_pose[..., i], numeric[..., i]) < 1e-7


@pytest.mark.parametrize(("model", "cost"), CASES)
def test_predicted_corners_are_where_the_residual_is_zero(model: str, cost: Cost) -> None:
    made = made_with(model)
    views = pack_observations(made.noisy(0.5, np.random.default_rng(0)))
    state = truth_of(made)
    predicted = predict_corners(state, views, find_model(model), cost)
    there = Observations(predicted, views.xy, views.mask, None)
    assert np.abs(residual(model, cost, state, there).residual).max() < 1e-8


VALLEYS = ("p3", "xi", "k4", "k5", "k6", "s1", "s2", "s3", "s4")
"""Coefficients that four views barely tell from others: valleys without a floor. With these held
the others make a proper minimum."""


@pytest.mark.parametrize(
    ("model", "cost"),
    # Differences by 162 coefficients take minutes: test_local_support.py asks mrcal instead.
    [
        *((m, c) for m, c in CASES if c is not Cost.REFERENCE and not m.startswith("splined")),
        *((model, Cost.REFERENCE) for model in ("lucchese", "kannala-brandt")),
    ],
)
def test_the_minimum_is_scipys(model: str, cost: Cost) -> None:
    """The same residual minimised by another program ends at the same cost.

    scipy gets numbers only: its derivatives are differences, its poses rotation vectors.
    """
    aspect = 1.0 if cost is Cost.PAPER else 0.9  # which the paper's grid would misrepresent
    made = scene(example(model, aspect), 4, seed=9)
    views = pack_observations(made.noisy(0.3, np.random.default_rng(2)))
    count = len(list_parameter_names(model))
    free = np.flatnonzero([name not in VALLEYS for name in list_parameter_names(model)])
    truth, scale = truth_of(made), np.concatenate([np.full(4, 10.0), np.full(count - 4, 0.1)])
    ours = minimise(
        build_stage_two(views, model, cost, SCALE, free),
        truth,
        free,
        views.count,
        float(np.sum(views.uv**2)),
    )

    def whole(z: Array) -> Array:
        params = truth.params.copy()
        params[free] += z[: len(free)] * scale[free]
        moves = z[len(free) :].reshape(-1, 6) * np.array([0.01] * 3 + [1.0] * 3)
        R = Rotation.from_rotvec(moves[:, :3]).as_matrix() @ truth.R
        state = State(params, R, truth.T + moves[:, 3:])
        return residual(model, cost, state, views).residual.ravel()

    start = np.zeros(len(free) + 24)
    theirs = least_squares(whole, start, method="trf", x_scale="jac", ftol=1e-15, xtol=1e-13)
    assert ours.normal.cost == pytest.approx(2 * theirs.cost, rel=1e-9)


def test_padding_weighs_nothing_and_covariances_whiten() -> None:
    made = scene(barrel(), 2, seed=3)
    uv, xy, _ = made.noisy(0.4, np.random.default_rng(1))[0]
    cov = np.tile(np.array([[0.04, 0.01], [0.01, 0.09]]), (len(uv), 1, 1))
    views = whiten_observations(
        pack_observations([(uv, xy, cov), (made.views[1].uv[:30], xy[:30], cov[:30])])
    )
    state, lens = truth_of(made), "lucchese"
    found = linearise_residuals(state, views, slice(0, 2), lens, Cost.IMAGE, 1.0)
    assert not found.residual[1, 30:].any()
    assert not found.by_params[1, 30:].any()
    assert not found.by_pose[1, 30:].any()
    plain = compute_image_residuals(state, views, lens).residual[0]
    typical = np.trace(cov[0]) / 2  # in px of the median corner
    squares = typical * np.einsum("ni,nij,nj->n", plain, np.linalg.inv(cov), plain)
    np.testing.assert_allclose(np.sum(found.residual[0] ** 2, axis=1), squares, rtol=1e-9)


def test_a_board_behind_the_camera_has_no_image() -> None:
    made = scene(barrel(), 2)
    state = truth_of(made)
    behind = state._replace(T=-state.T)
    assert np.isnan(
        compute_image_residuals(behind, pack_observations(made.views), "lucchese").residual
    ).any()
