"""Photographs that are turned against the others are named, and nobody else is."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.action import ActionKind
from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.causes.turned_views import _turn_back
from calibgui.engine.assessment.finding import Cause
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera.camera import Camera
from tests.engine.scenes import VGA, barrel, scene

OFF_CENTRE = Camera(VGA, np.add(barrel().params, [0, 0, -16, 8, 0, 0, 0, 0, 0, 0]))


@pytest.mark.parametrize(
    ("count", "turned"),
    [
        (9, (8,)),
        (14, (2, 5)),
    ],
)
def test_turned_photographs_are_named_before_any_cause(count: int, turned: tuple[int, ...]) -> None:
    views = scene(OFF_CENTRE, count, seed=4).noisy(0.1, np.random.default_rng(4))
    for k in turned:
        views[k] = _turn_back(views[k], (-1, -1), VGA)
    names = [f"{k}.png" for k in range(count)]
    (finding,) = list_findings(calibrate(views, VGA), views, names)
    assert finding.cause is Cause.MIXED_VIEWS and finding.views == turned
    assert "upside down" in finding.message and all(names[k] in finding.message for k in turned)
    assert finding.action is not None and finding.action.kind is ActionKind.LEAVE_OUT_VIEWS


@pytest.mark.parametrize("seed", range(6))
def test_none_of_clean_photographs_is_named(seed: int) -> None:
    views = scene(OFF_CENTRE, 10, seed=seed).noisy(0.2, np.random.default_rng(seed))
    assert list_findings(calibrate(views, VGA), views) == ()
