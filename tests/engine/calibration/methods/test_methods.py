"""The method of a calibration: one entry of a table, looked up by name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.calibration import methods
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import DEFAULT_METHOD, METHODS, find_method
from calibgui.engine.calibration.problem import recover_arguments
from calibgui.engine.calibration.result import Cost
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import VGA, barrel, scene

VIEWS = scene(barrel(), 4, seed=1).noisy(0.1, np.random.default_rng(0))


def test_every_method_is_described() -> None:
    for name, method in METHODS.items():
        assert method.name == name
        assert method.title
        assert method.source
        assert method.lens_models
        assert method.costs


def test_an_unknown_method_is_refused_with_the_choices() -> None:
    with pytest.raises(CalibrationError, match="no calibration method 'no-such-method'") as caught:
        calibrate(VIEWS, VGA, method="no-such-method")
    assert DEFAULT_METHOD in caught.value.hint


def test_the_default_method_leaves_no_trace_in_the_settings() -> None:
    """Results and digests of the default must stay what they were without a choice."""
    found = calibrate(VIEWS, VGA)
    named = calibrate(VIEWS, VGA, method=DEFAULT_METHOD)
    assert "method" not in found.settings
    assert named.settings == found.settings
    assert named.digest == found.digest
    assert recover_arguments(found)["method"] == DEFAULT_METHOD


def test_a_further_method_is_used_and_recorded(monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[str] = []
    own = METHODS[DEFAULT_METHOD]

    def initialise(*args: object) -> methods.Initialisation:
        ran.append("initialise")
        return own.initialise(*args)  # type: ignore[arg-type]

    def refine(*args: object) -> methods.Refinement:
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
    assert found.settings["method"] == "trial"
    assert recover_arguments(found)["method"] == "trial"
    assert found.digest != calibrate(VIEWS, VGA).digest
    with pytest.raises(CalibrationError, match="cannot estimate the lens model 'opencv'"):
        find_method("trial", "opencv", Cost.IMAGE)
    with pytest.raises(CalibrationError, match="cannot minimise the cost 'reference'"):
        find_method("trial", "lucchese", Cost.REFERENCE)
