"""The method of a calibration: one entry of a table, looked up by name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.calibration import methods
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import (
    METHODS,
    check_method,
    find_method,
)
from calibgui.engine.calibration.methods.method import Initialisation, Problem, Refinement
from calibgui.engine.calibration.problem import recover_arguments
from calibgui.engine.calibration.result import DEFAULT_METHOD, Cost
from calibgui.engine.camera.models import MODELS
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import VGA, barrel, scene

VIEWS = scene(barrel(), 4, seed=1).noisy(0.1, np.random.default_rng(0))


def test_every_method_is_described() -> None:
    for name, method in METHODS.items():
        assert method.name == name
        assert 0 < len(method.label) <= 20
        assert method.title
        assert method.source
        assert method.limits.endswith(".")
        assert set(method.lens_models) <= set(MODELS)
        assert method.costs


def test_every_method_calibrates_its_own_lens_model_by_default() -> None:
    for method in (METHODS["bouguet"], METHODS[DEFAULT_METHOD]):
        found = calibrate(VIEWS, VGA, method=method.name)
        assert found.camera.model == method.lens_models[0]
        assert found.seconds > 0


def test_an_unknown_method_is_refused_with_the_choices() -> None:
    with pytest.raises(CalibrationError, match="no calibration method 'no-such-method'") as caught:
        calibrate(VIEWS, VGA, method="no-such-method")
    assert DEFAULT_METHOD in caught.value.hint


def test_the_default_method_leaves_no_trace_in_the_settings() -> None:
    """Results and digests of the default must stay what they were without a choice."""
    found = calibrate(VIEWS, VGA)
    named = calibrate(VIEWS, VGA, method=DEFAULT_METHOD)
    assert "method" not in found.settings.encode()
    assert named.settings == found.settings
    assert named.digest == found.digest
    assert recover_arguments(found)["method"] == DEFAULT_METHOD


def test_a_further_method_is_used_and_recorded(monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[str] = []
    own = METHODS[DEFAULT_METHOD]

    def initialise(problem: Problem) -> Initialisation:
        ran.append("initialise")
        return own.initialise(problem)

    def refine(*args: object) -> Refinement:
        ran.append("refine")
        return own.refine(*args)  # type: ignore[arg-type]

    trial = replace(
        own,
        name="trial",
        lens_models=("lucchese",),
        costs=(Cost.IMAGE,),
        initialise=initialise,
        refine=refine,
    )
    monkeypatch.setattr(methods, "METHODS", {**METHODS, "trial": trial})
    found = calibrate(VIEWS, VGA, method="trial")
    assert ran == ["initialise", "refine"]
    assert found.settings.method == "trial"
    assert recover_arguments(found)["method"] == "trial"
    assert found.digest != calibrate(VIEWS, VGA).digest
    assert find_method("trial") is trial
    made = calibrate(VIEWS, VGA, method=trial)
    assert made.digest == found.digest, "a method may be given by itself"
    with pytest.raises(CalibrationError, match="cannot estimate the lens model 'opencv'"):
        check_method(trial, "opencv", Cost.IMAGE)
    with pytest.raises(CalibrationError, match="cannot minimise the cost 'reference'"):
        check_method(trial, "lucchese", Cost.REFERENCE)
    check_method(own, "splined-stereographic-6x5-70", Cost.IMAGE)


def test_a_method_without_weights_ignores_covariances_and_refuses_board_shapes() -> None:
    noise = np.broadcast_to(np.diag([0.01, 0.04]), (len(VIEWS[0].uv), 2, 2))
    weighted = [view._replace(cov=noise) for view in VIEWS]
    found, plain = (calibrate(views, VGA, method="bouguet") for views in (weighted, VIEWS))
    np.testing.assert_array_equal(found.camera.params, plain.camera.params)
    with pytest.raises(CalibrationError, match="'bouguet' takes the board as it is drawn") as told:
        calibrate(VIEWS, VGA, method="bouguet", board_shape="free")
    assert DEFAULT_METHOD in told.value.hint
