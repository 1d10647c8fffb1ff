"""Hand and eye in words: how the poses were read, what they leave open, and what is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.dataset import HandEyeSet
from calibgui.engine.arrays import Array
from calibgui.engine.hand_eye import HandEye, ToolError, calibrate_hand_eye
from calibgui.report.hand_eye import (
    describe_in_a_line,
    describe_tool,
    find_outliers,
    list_hand_eye_remarks,
    tabulate_hand_eye,
)
from tests.engine.hand_eye.arms import (
    CAMERA,
    Arm,
    make_arm,
    make_standing_arm,
    move_four_axes,
    move_without_turning,
)


def solve(arm: Arm, rows: Array | None = None, in_hand: bool | None = True) -> HandEye:
    rows = arm.take_matrices() if rows is None else rows
    return calibrate_hand_eye(CAMERA, arm.views, rows, eye_in_hand=in_hand)


def remark_on(found: HandEye, **settings: object) -> str:
    remarks = list_hand_eye_remarks(HandEyeSet(found, **settings))  # type: ignore[arg-type]
    return "\n".join(remarks)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return make_arm(np.random.default_rng(0), 12, noise=0.1, robot=(5e-4, 0.3))


def test_the_tool_in_a_line(arm: Arm) -> None:
    found = replace(solve(arm), tool=ToolError(0.4, np.radians(0.025), 0.85))
    said = "tool ± 0.8 mm, ± 0.05 degrees (k = 2); robot 85 %, camera 15 %"
    assert describe_tool(found) == said
    assert describe_in_a_line(HandEyeSet(found)) == f"{said}, from 12 poses"


def test_the_table_has_all_poses(arm: Arm) -> None:
    table = tabulate_hand_eye(HandEyeSet(solve(arm)))
    assert all(f"View {k + 1} " in table for k in range(12))
    assert "camera in the hand" in table and "board in the base" in table
    assert all(len(line) <= 80 for line in table.splitlines())
    standing = solve(make_standing_arm(np.random.default_rng(1)), in_hand=False)
    table = tabulate_hand_eye(HandEyeSet(standing))
    assert "camera in the base" in table and "board in the hand" in table


def test_the_reading_and_the_robots_accuracy_are_told(arm: Arm) -> None:
    said = remark_on(solve(arm))
    assert "poses are matrices row by row, millimetres, base from hand. Read so, the board" in said
    assert (
        "mm in any other way." in said
        and "e+" not in said
        and "A pose of the robot is off by 0." in said
    )
    assert "Open" not in said and "shifted" not in said and "No ±" not in said
    assert "Left out" not in said and "fit as well" not in said and "does not fit" not in said


def test_shifted_orders(arm: Arm) -> None:
    early = Arm(arm.views[1:], arm.poses.select(slice(None, -1)))
    late = Arm(arm.views[:-1], arm.poses.select(slice(1, None)))
    assert "each pose stands one line late" in remark_on(solve(early))
    assert "each pose stands one line early" in remark_on(solve(late))


def test_repeated_poses(arm: Arm) -> None:
    again = arm.select([0, 0, *range(1, 12)])
    assert "View 1, View 2 have the same pose of the robot" in remark_on(solve(again))


def test_a_pose_that_does_not_fit(arm: Arm) -> None:
    rows = arm.take_matrices()
    rows[4, 3] += 15.0
    said = remark_on(solve(arm, rows))
    assert "The robot's pose does not fit in View 5 (1" in said


def test_what_is_open() -> None:
    rng = np.random.default_rng(3)
    said = remark_on(solve(move_four_axes(rng)))
    assert "Open: the camera may be shifted along (" in said and "about a second axis" in said
    assert "turned" not in said
    said = remark_on(solve(move_four_axes(rng, still=True)))
    assert "Open: the camera may be turned about (" in said and "shifted along (" in said
    assert "The poses fit as well as " in said
    said = remark_on(solve(move_without_turning(rng)))
    assert "shifted along any axis of the hand" in said and "about two axes" in said


def test_what_took_no_part(arm: Arm) -> None:
    said = remark_on(solve(arm), left_out=("a.png: no board.",), has_covariance=False)
    assert "Left out: a.png: no board." in said
    assert "No ± counts the camera's errors" in said


def test_a_single_reading(arm: Arm) -> None:
    said = remark_on(replace(solve(arm), next_scatter=np.inf))
    assert "in any other way" not in said


def test_rounding_makes_no_outlier(arm: Arm) -> None:
    """A pose that is off by 3e-7 mm among others that are off by nothing is no mistake."""
    found = solve(arm)
    corrections = np.full((12, 6), 1e-12)
    corrections[4] = [*np.full(3, 1e-10), 0.0, 3e-7, 0.0]
    assert find_outliers(replace(found, corrections=corrections)) == []
    corrections[4, 4] = 3e-3
    assert find_outliers(replace(found, corrections=corrections)) == [4]
