"""Mistakes of people are named with their photographs, and none where there is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.rig import Mistake, calibrate_rig
from tests.engine.rig.mistaken_rigs import MISTAKES, make_mistaken
from tests.engine.rig.scenes import make_rig


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_named(name: str) -> None:
    rig = calibrate_rig(make_mistaken(name, seed=3))
    wanted = MISTAKES[name][1]
    named = {mistake.kind for mistake in rig.mistakes} - {Mistake.LESS_AGREEMENT}
    assert named == wanted
    if not wanted:
        assert not rig.mistakes
        return
    (mistake,) = (each for each in rig.mistakes if each.kind in wanted)
    match mistake.kind:
        case Mistake.OTHER_INSTANT:
            assert set(mistake.instants) <= {3, 8, 14, 20}
        case Mistake.SHIFTED:
            assert mistake.value == -1 and mistake.camera == 1
        case Mistake.EXCHANGED:
            assert set(mistake.instants) <= {4, 11, 17}
        case Mistake.MOVED:
            assert abs(mistake.instants[0] - 12) <= 1
            assert mistake.value == pytest.approx(np.sqrt(7.25), rel=0.5)
        case Mistake.REFOCUSED:
            assert abs(mistake.instants[0] - 12) <= 1
            assert mistake.value == pytest.approx(1.01, abs=0.002)
        case Mistake.OTHER_SCALE:
            assert all(instant % 4 == 1 for instant in mistake.instants)
            assert mistake.value == pytest.approx(25 / 30, rel=0.01)


def test_instants_that_agree_less_than_the_others_are_named() -> None:
    """The board of one instant was a few pixels further on in the second camera."""
    scene = make_rig(2, instants=20)
    rng = np.random.default_rng(1)
    left, right = scene.noisy(0.1, rng)
    shaken = {
        instant: view._replace(uv=view.uv + rng.normal(0, 0.3 if instant != 7 else 3.0, 2))
        for instant, view in right.views.items()
    }
    rig = calibrate_rig([left, replace(right, views=shaken)])
    assert rig.disagreement > 1
    named = [each for each in rig.mistakes if each.kind is Mistake.LESS_AGREEMENT]
    assert any(7 in each.instants for each in named) or any(
        view.instant == 7 for view in rig.left_out
    )
