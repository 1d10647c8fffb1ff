"""Turns, and what their iterations say, on the two methods that take them."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods.method import Method
from calibgui.engine.calibration.methods.weng import WENG
from calibgui.engine.calibration.methods.zhang import ZHANG_ALTERNATION
from calibgui.engine.calibration.result import Iteration, Status
from tests.engine.scenes import VGA, brown, scene

VIEWS = scene(brown(), 5, seed=1).noisy(0.1, np.random.default_rng(0))
TURNS = pytest.mark.parametrize("method", [ZHANG_ALTERNATION, WENG], ids=lambda m: m.name)


@TURNS
def test_an_iteration_tells_how_far_a_turn_has_come(method: Method) -> None:
    told: list[Iteration] = []

    def listen(iteration: Iteration) -> bool:
        told.append(iteration)
        return True

    found = calibrate(VIEWS, VGA, method=method, max_iterations=8, report=listen)
    assert found.history == tuple(told)
    assert [turn.index for turn in told] == list(range(9))
    residuals = np.concatenate([view.image for view in found.residuals])
    assert told[-1].cost == pytest.approx(np.sum(residuals**2))
    assert told[-1].rms == pytest.approx(np.sqrt(np.mean(np.sum(residuals**2, axis=1))))
    assert (np.diff([turn.cost for turn in told]) < 0).all()
    assert (np.diff([turn.seconds for turn in told]) > 0).all()
    assert all(turn.damping == 0.0 for turn in told)
    for one in told:
        assert one.gradient > 0
        assert one.step > 0


@TURNS
def test_a_stop_keeps_the_last_turn(method: Method) -> None:
    found = calibrate(VIEWS, VGA, method=method, report=lambda iteration: iteration.index < 2)
    assert found.status is Status.STOPPED
    assert len(found.history) == 3


def test_turns_that_have_not_ended_are_remarked() -> None:
    method = ZHANG_ALTERNATION
    short = calibrate(VIEWS, VGA, method=method, max_iterations=3)
    assert any("3 turns did not reach" in remark for remark in method.list_remarks(short))
    done = calibrate(VIEWS, VGA, method=method, fix=["k2"], max_iterations=2000)
    assert done.status is Status.CONVERGED
    assert done.history[-1].step < 1e-2 * done.history[1].step
    assert not any("did not reach" in remark for remark in method.list_remarks(done))
