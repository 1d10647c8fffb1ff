"""The choice of a board shape, on scenes of known truth."""

from __future__ import annotations

import numpy as np

from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.choices.board_shape_choice import choose_board_shape
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.observations import Observation
from tests.engine.scenes import BOARD, barrel, looking, scene
from tests.faults.sets import project_corners

SIZE = barrel().size


def _views(count: int, seed: int = 0) -> list[Observation]:
    return scene(barrel(), count, seed).noisy(0.2, np.random.default_rng(seed))


def _on_wide_squares(count: int) -> list[Observation]:
    """Views of a board whose squares are 0.5 % wider than they are said to be."""
    return [
        Observation(view.uv, view.xy / np.array([1.005, 1.0]))
        for view in scene(barrel(), count).noisy(0.1, np.random.default_rng(3))
    ]


def test_a_true_board_is_kept() -> None:
    choice = choose_board_shape(_views(10), SIZE)
    assert choice.model is BoardShapeModel.NOMINAL
    assert choice.chosen is choice.nominal
    assert "Keep the board as drawn" in choice.recommendation
    assert set(choice.validations) == set(BoardShapeModel)


def test_a_wrong_board_is_described_with_figures() -> None:
    choice = choose_board_shape(_on_wide_squares(10), SIZE)
    assert choice.model is BoardShapeModel.AFFINE
    error, nominal_error = (
        np.abs(result.camera.focal - barrel().focal).max()
        for result in (choice.chosen, choice.nominal)
    )
    assert error < 0.5 * nominal_error
    assert "deviates by" in choice.recommendation
    assert "moves fx by" in choice.recommendation


def test_no_board_shape_stands_in_for_a_lens_that_is_not_followed() -> None:
    choice = choose_board_shape(_views(10), SIZE, model="pinhole")
    assert choice.model is BoardShapeModel.NOMINAL
    assert choice.chosen is choice.nominal
    assert set(choice.validations) == {BoardShapeModel.NOMINAL}
    assert set(choice.refused) == set(BoardShapeModel) - {BoardShapeModel.NOMINAL}
    assert "The lens comes first" in choice.recommendation
    assert f"{choice.nominal.lens_error:.2g} px" in choice.recommendation


def test_a_board_far_from_flat_is_estimated_where_a_flat_one_leads_astray() -> None:
    """It is bowed by 14 % of its length, and some of its views do not determine a camera with a
    flat board."""
    angle = 0.58  # to both sides, on a cylinder
    rng = np.random.default_rng([5, 0])
    xy = BOARD.points()
    middle, half = (xy.min(axis=0) + xy.max(axis=0)) / 2, np.ptp(xy[:, 0]) / 2
    turn = (xy[:, 0] - middle[0]) / half * angle
    x, z = half / angle * np.sin(turn), half / angle * (np.cos(turn) - np.cos(angle))
    bowed = np.column_stack([middle[0] + x, xy[:, 1], z])
    views = [
        Observation(project_corners(barrel(), looking(barrel(), rng), bowed), xy) for _ in range(8)
    ]
    views = [view._replace(uv=view.uv + rng.normal(0, 0.05, view.uv.shape)) for view in views]
    choice = choose_board_shape(views, SIZE)
    assert choice.model is BoardShapeModel.FREE
    assert compare_cameras(barrel(), choice.nominal.camera, views=views).rms > 50
    assert compare_cameras(barrel(), choice.chosen.camera, views=views).rms < 0.2


def test_board_shapes_that_the_views_cannot_carry_are_named() -> None:
    choice = choose_board_shape(_views(5), SIZE)
    assert "needs 6" in choice.refused[BoardShapeModel.FREE]
