"""Starts that methods share: beside a camera of another lens model."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.lucchese import LUCCHESE
from calibgui.engine.calibration.methods.method import (
    Initialisation,
    Problem,
    start_from_other_model,
)
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from tests.engine.scenes import VGA, example, scene


@cache
def _see_fisheye() -> tuple[list[Observation], Calibration]:
    """Views of a fisheye lens with noise, and its calibration by its own model."""
    views = scene(example("kannala-brandt"), 8).noisy(0.1, np.random.default_rng(1))
    return views, calibrate(views, VGA, model="kannala-brandt")


def _guess_nothing(problem: Problem) -> Initialisation:
    raise AssertionError(f"a start of {problem.model} was guessed")


@pytest.mark.parametrize(
    "model", ["lucchese", "brown-conrady", "ucm", "eucm", "double-sphere", "mei", "scaramuzza"]
)
def test_a_model_begun_beside_another_ends_where_it_does_by_itself(model: str) -> None:
    views, other = _see_fisheye()
    method = start_from_other_model(replace(LUCCHESE, initialise=_guess_nothing), other)
    begun = calibrate(views, VGA, model=model, method=method)
    guessed = calibrate(views, VGA, model=model)
    assert begun.history[-1].cost <= guessed.history[-1].cost * (1 + 1e-6)


def test_what_is_held_stays_at_its_value() -> None:
    views, other = _see_fisheye()
    method = start_from_other_model(LUCCHESE, other)
    held = {"k2": 0.01, "p1": None, "cx": 305.0}
    begun = calibrate(views, VGA, model="brown-conrady", fix=held, method=method)
    values = dict(zip(begun.camera.names, begun.camera.params, strict=True))
    assert (values["k2"], values["p1"], values["cx"]) == (0.01, 0.0, 305.0)
    assert other.camera.params[2] != 305.0  # nothing of the other calibration was changed


def test_a_camera_that_misses_the_corners_is_no_start() -> None:
    views, _ = _see_fisheye()
    pinhole = calibrate(views, VGA, model="pinhole")
    with pytest.raises(AssertionError, match="guessed"):
        calibrate(
            views,
            VGA,
            model="ucm",
            method=start_from_other_model(replace(LUCCHESE, initialise=_guess_nothing), pinhole),
        )
    begun = calibrate(views, VGA, model="ucm", method=start_from_other_model(LUCCHESE, pinhole))
    guessed = calibrate(views, VGA, model="ucm")
    assert np.array_equal(begun.camera.params, guessed.camera.params)
