"""Do the findings name what is wrong? A few draws of the campaign, and its judge by itself."""

from __future__ import annotations

import numpy as np
import pytest

from tests.faults.campaign import (
    Answer,
    Verdict,
    count_verdicts,
    judge_causes,
    make_table,
    run_campaign,
)
from tests.faults.causes import CLEAN, FAULTS

_DRAWS = 1
"""Draws of each fault: of 34 one may be wrong, so that a cause that is no longer found is told."""
_CLEAN_DRAWS = 25
"""Of which none may raise an alarm: one chance in ten is told with 93 %."""
_MIN_RIGHT = 0.95
"""Least share of faults that are named, or harmless where nothing is said."""
_MAX_SILENT = 0.02
"""Largest share of wrong answers without a finding; the goal is none."""
_MAX_FALSE_ALARMS = 0.02
"""Largest share of clean sets with a finding."""


@pytest.mark.slow
def test_faults_are_named_by_their_cause() -> None:
    counts = count_verdicts(run_campaign(_DRAWS, [name for name in FAULTS if name != CLEAN]))
    assert counts[Verdict.RIGHT] + counts[Verdict.HARMLESS] >= _MIN_RIGHT * counts.total()
    assert counts[Verdict.SILENT] <= _MAX_SILENT * counts.total()


@pytest.mark.slow
def test_clean_sets_raise_no_alarm() -> None:
    counts = count_verdicts(run_campaign(_CLEAN_DRAWS, [CLEAN]))
    assert counts[Verdict.FALSE_ALARM] <= _MAX_FALSE_ALARMS * counts.total()
    assert counts[Verdict.SILENT] <= _MAX_SILENT * counts.total()


@pytest.mark.parametrize(
    ("fault", "causes", "deviation", "verdict"),
    [
        ("bow", ["board-shape", "lens"], 9.0, Verdict.RIGHT),
        ("bow", ["lens", "board-shape"], 0.0, Verdict.WRONG),
        ("bow", [], 2.0, Verdict.HARMLESS),
        ("bow", [], 4.0, Verdict.SILENT),
        ("bow", [], np.nan, Verdict.SILENT),
        (CLEAN, [], 2.0, Verdict.RIGHT),
        (CLEAN, [], 4.0, Verdict.SILENT),
        (CLEAN, ["lens"], 0.0, Verdict.FALSE_ALARM),
    ],
)
def test_judge_of_causes(fault: str, causes: list[str], deviation: float, verdict: Verdict) -> None:
    assert judge_causes(FAULTS[fault], causes, deviation) is verdict


@pytest.mark.parametrize("name", FAULTS)
def test_seed_repeats_a_draw_and_makes_usable_views(name: str) -> None:
    first, again = (FAULTS[name].inject(np.random.default_rng([1, 2])) for _ in range(2))
    assert first.story == again.story
    for view, same in zip(first.views, again.views, strict=True):
        np.testing.assert_array_equal(view.uv, same.uv)
        assert len(view.uv) == len(view.xy) >= 8
        assert np.isfinite(view.uv).all()


def test_the_table_has_the_shares_of_each_fault_and_of_all() -> None:
    said = {"bow": [Verdict.RIGHT, Verdict.HARMLESS], "blur": [Verdict.WRONG, Verdict.SILENT]}
    said[CLEAN] = [Verdict.RIGHT, Verdict.FALSE_ALARM]
    answers = [
        Answer(name, k, verdict, "", (), 1.0)
        for name, verdicts in said.items()
        for k, verdict in enumerate(verdicts)
    ]
    peers = {"bow": (1.0, 0.5), "blur": (0.0, np.nan), CLEAN: (0.1, 0.1)}
    _, _, *rows = make_table(answers, peers).splitlines()
    assert rows == [
        "| bow | 50% | 50% | 0% | 0% | 100% | 50% |",
        "| blur | 0% | 0% | 50% | 50% | 0% | - |",
        "| **all** | 25% | 25% | 25% | 25% | 50% | 50% |",
        "| clean | - | 50% | 50% | 0% | 10% | 10% |",
    ]
