"""What the comparison of methods is asked: which views, against which camera, with which poses."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.method_comparison import compare_methods, compare_methods_again
from calibgui.app.calibrating.settings import Settings
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine import assessment
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose
from tests.engine.scenes import VGA, barrel, scene

POSES = {f"folder/{k}.png": Pose(np.zeros(3), np.array([0.0, 0.0, k])) for k in range(6)}


@pytest.fixture(scope="module")
def corner_set() -> CornerSet:
    views = scene(barrel(), 6, seed=1).noisy(0.1, np.random.default_rng(2))
    found = [View(f"folder/{k}.png", ViewStatus.FOUND, points=view) for k, view in enumerate(views)]
    return CornerSet(VGA, tuple(found))


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What the engine was asked last: views, size, chosen camera if any, and settings."""
    noted: list[Any] = []

    def note(views: Any, size: Any, chosen: Any = None, **settings: Any) -> None:
        noted[:] = [views, size, chosen, settings]

    monkeypatch.setattr(assessment, "compare_methods", note)
    return noted


def test_copies_and_unusable_views_are_left_out(corner_set: CornerSet, asked: list[Any]) -> None:
    blank = View("blank.png", ViewStatus.NO_BOARD, "No checkerboard was found.")
    copy = replace(corner_set.views[2], image="copy.png")
    compare_methods(replace(corner_set, views=(blank, *corner_set.views, copy)))
    views, size, chosen, settings = asked
    assert (len(views), size, chosen) == (6, VGA, None)
    assert settings["names"] == [f"{k}.png" for k in range(6)]
    assert settings["board_poses"] is None


def test_a_result_is_compared_with_its_own_camera(corner_set: CornerSet, asked: list[Any]) -> None:
    result = calibrate_views(corner_set, Settings(model="brown-conrady"))
    compare_methods_again(result)
    views, size, chosen, _ = asked
    assert (len(views), size) == (6, VGA)
    assert chosen is result.calibration.camera


def test_poses_go_by_the_names_of_images(corner_set: CornerSet, asked: list[Any]) -> None:
    short = {name.removeprefix("folder/"): pose for name, pose in POSES.items()}
    for given in (POSES, dict(reversed(short.items()))):
        compare_methods(corner_set, given)
        assert [pose.tvec[2] for pose in asked[3]["board_poses"]] == list(range(6))
    few = {name: pose for name, pose in POSES.items() if name[-5] not in "25"}
    with pytest.raises(CalibrationError, match=r"not stated for 2.png, 5.png\."):
        compare_methods(corner_set, few)
