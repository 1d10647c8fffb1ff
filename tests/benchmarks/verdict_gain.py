"""What a verdict promises, against the truth: `python -m tests.benchmarks.verdict_gain`.

Faults whose remedy is another calibration from the same views (rows shifted, wrong values held,
bowed boards, unequal squares) are injected into rendered sets (``tests/faults/``). Where the first
finding has a remedy that was tried, it is carried out, and both cameras are compared with the true
one. The true error is the root mean square displacement of pixels where there are corners. Beside
it stand the error that the verdict states (its ratio to the true one is `e`), and x, by how much
the remedy is to make it smaller; `gain` is by how much it did, over x.

A verdict allows for boards that deviate as real ones do. Rendered boards that are to be as drawn
have no deviations, and the calibration is told so: else all that is left would seem smaller than
was said. The truth is one draw of what the verdict states the standard deviation of: the error that
is left scatters by a half even if all is right, and so does the gain.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from calibgui.engine.assessment.action_trials import try_action
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.verdict import judge_calibration
from calibgui.engine.boards.shape import BoardShapePrior
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.errors import CalibrationError
from tests.faults.campaign import inject_fault
from tests.faults.sets import FaultySet

TRUE_BOARD = BoardShapePrior(0.001, 0.001)
"""What is stated of rendered boards that are as drawn, mm."""
FAULTS = {
    "row-shifted": TRUE_BOARD,
    "held-value": TRUE_BOARD,
    "bow": None,
    "wrong-square": None,
}
"""Faults that a calibration from the same views remedies, with what is stated of the board."""


class Promise(NamedTuple):
    """What a verdict said of a set, and what was true."""

    stated: float
    """Stated error before the remedy, rms where there are corners, px."""
    true: float
    """True error before the remedy, px."""
    left: float
    """True error after it, px."""
    times: float
    """Ratio by which the remedy was said to make the error smaller."""

    @property
    def error_ratio(self) -> float:
        """Ratio of the stated error to the true one."""
        return self.stated / self.true

    @property
    def gain_ratio(self) -> float:
        """Ratio of the true gain to the one that was said."""
        return self.true / self.left / self.times


def keep_promise(fault: FaultySet, prior: BoardShapePrior | None) -> Promise | None:
    """Judge a set, carry out the first remedy and compare; None if none was tried."""
    try:
        options: Mapping[str, Any] = fault.options
        found = calibrate(fault.views, fault.size, prior=prior, **options)
        verdict = judge_calibration(found, fault.views)
        first = verdict.findings[0] if verdict.findings else None
        if first is None or first.times_better <= 1:
            return None
        trial = try_action(first.action, found, fault.views)
        if trial is None:
            return None
        true = compare_cameras(fault.truth, found.camera, views=fault.views).rms
        left = compare_cameras(fault.truth, trial.calibration.camera, views=trial.views).rms
    except CalibrationError:
        return None
    return Promise(verdict.error.covered, true, left, first.times_better)


def main() -> None:
    """Print a row for each set, and how far promises hold."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--draws", type=int, default=6, help="number of rendered sets of each kind")
    draws = parser.parse_args().draws
    print("| fault | stated, px | true, px | e | x | gain |\n| --- | --: | --: | --: | --: | --: |")
    promises: list[Promise] = []
    with threadpool_limits(1):
        for name, prior in FAULTS.items():
            for fault in draw_rendered(name, draws):
                promise = keep_promise(fault, prior)
                if promise is None:
                    continue
                promises.append(promise)
                print(
                    f"| {name} | {promise.stated:.2g} | {promise.true:.2g} | "
                    f"{promise.error_ratio:.2f} | {promise.times:.2g} | {promise.gain_ratio:.2f} |",
                    flush=True,
                )
    for title, ratio in (
        ("stated error over the true one", [p.error_ratio for p in promises]),
        ("true gain over x", [p.gain_ratio for p in promises]),
    ):
        low, middle, high = np.percentile(ratio, [0, 50, 100])
        print(f"{title}, of {len(ratio)} sets: {low:.2f} to {high:.2f}, median {middle:.2f}")


def draw_rendered(name: str, draws: int) -> list[FaultySet]:
    """Draw sets with a fault, of which the first `draws` that are rendered are returned."""
    made: list[FaultySet] = []
    seed = 0
    while len(made) < draws:
        fault = inject_fault(name, seed)
        if fault.story.startswith("rendered"):  # the truth of real sets is a calibration, too
            made.append(fault)
        seed += 1
    return made


if __name__ == "__main__":
    main()
