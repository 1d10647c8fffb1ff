"""The closed form from motions of every kind."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.hand_eye.closed_form import solve_closed_form
from calibgui.engine.hand_eye.motions import Motions, project_on_rotations
from tests.engine.hand_eye.arms import CORNERS, W, X, make_arm, move_four_axes, move_without_turning

HALF_TURNS = np.stack([np.eye(3), *(np.diag(2.0 * axis - 1) for axis in np.eye(3))])


def see(hands: Motions) -> Motions:
    """Return cam_from_board from poses of the hand."""
    return X.invert().after(hands.invert().after(W))


def test_turns_about_several_axes() -> None:
    hands = make_arm(np.random.default_rng(0), 5).poses
    found = solve_closed_form(hands, see(hands), CORNERS)
    assert np.abs(found.X.measure_step_from(X)).max() < 1e-9
    assert np.abs(found.W.measure_step_from(W)).max() < 1e-9
    assert found.scatter < 1e-9


def test_turns_by_half_circles_have_no_sign() -> None:
    hands = make_arm(np.random.default_rng(5), 4).poses
    hands = Motions(HALF_TURNS @ hands.R[0], hands.t)
    found = solve_closed_form(hands, see(hands), CORNERS)
    assert np.abs(found.X.measure_step_from(X)).max() < 1e-9


@pytest.mark.parametrize("move", [move_four_axes, move_without_turning])
def test_motions_that_leave_shifts_open_tell_the_rotation(move: object) -> None:
    hands = move(np.random.default_rng(1)).poses  # type: ignore[operator]
    found = solve_closed_form(hands, see(hands), CORNERS)
    assert np.abs(found.X.R - X.R).max() < 1e-9
    assert found.scatter < 1e-9


def test_the_scatter_is_that_of_the_board_in_the_base() -> None:
    hands = make_arm(np.random.default_rng(0), 8, robot=(1e-3, 1.0)).poses
    boards = see(hands)
    moved = Motions(hands.R, hands.t + np.random.default_rng(1).normal(size=(8, 3)))
    found = solve_closed_form(moved, boards, CORNERS)
    places = np.array(
        [moved.select(k).after(found.X).after(boards.select(k)).move(CORNERS) for k in range(8)]
    )
    far = np.linalg.norm(places - places.mean(axis=0), axis=2)
    assert found.scatter == pytest.approx(np.sqrt(np.mean(far**2)))


def test_the_nearest_rotation_is_no_reflection() -> None:
    Z = np.diag([3.0, 2.0, -0.1])
    np.testing.assert_allclose(project_on_rotations(Z), np.eye(3), atol=1e-12)
