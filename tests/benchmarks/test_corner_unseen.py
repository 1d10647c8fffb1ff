"""Boards under conditions that nothing was tuned on."""

from __future__ import annotations

import pytest

from tests.benchmarks.corner_unseen import SCENES, Outcome, conditions, outcome
from tests.scenes.checkerboards import draw


@pytest.mark.slow
def test_whole_boards_are_found_in_full() -> None:
    small = [seed for seed in range(SCENES) if conditions(seed).size == (640, 480)][:8]
    total = sum((outcome(draw(conditions(seed), seed)) for seed in small), Outcome())
    assert total.whole >= 6
    assert total.found == total.whole
    assert total.corners.wrong == 0


def test_the_whole_range_is_sampled() -> None:
    drawn = [conditions(seed) for seed in range(500)]
    assert {c.size[0] for c in drawn} == {640, 1280, 1920, 4000, 8192}
    assert max(c.tilt for c in drawn) > 65
    assert min(c.square for c in drawn) < 12
    assert max(c.blur for c in drawn) > 4
    assert {c.deep for c in drawn} == {c.clutter for c in drawn} == {True, False}
    assert any(c.fisheye for c in drawn)
    assert min(c.distortion for c in drawn) < -0.2
    assert max(c.distortion for c in drawn) > 0.4
    assert min(c.ink for c in drawn) < -0.05
