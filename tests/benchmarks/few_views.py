"""Standard deviations of few views, checked on real sets: `python -m tests.benchmarks.few_views`.

From every real image set, random subsets of 2 to 12 views, no two of them alike, are calibrated by
themselves, with the lens model that is chosen for the whole set. What all views together say, with
the board's shape estimated where that predicts unseen views better, stands for the truth: elsewhere
a shape stands in for what differs from view to view, as in the seven photographs of a phone whose
principal point moves, where it shifts cy by five of its standard deviations. |z| is the distance of
fx, fy, cx and cy of a subset from it over the standard deviation of that distance, which is the
subset's own, and the truth's where that is not small beside it: the ten views of `charuco video 0`,
which know fx to 56 px, test little.

Goal: 90 % of them within 2.5, and medians between 0.3 and 1.0 over all sets. The medians of one set
share one board, one lens and their deviations: they scatter about those of many sets. Subsets that
are refused, or of which a value is not determined or assumed, are counted apart.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.choices.board_shape_choice import choose_board_shape
from calibgui.engine.assessment.choices.lens_choice import choose_lens_stepwise
from calibgui.engine.assessment.choices.lens_trial import LensTrial
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.errors import CalibrationError
from tests.benchmarks.unseen_views import ImageSet, list_sets, load
from tests.conftest import find_data_dir

COUNTS = (2, 3, 4, 6, 8, 12)
"""Numbers of views of the subsets."""
BOUND = 2.5
"""Distance from the truth, in standard deviations, within which 90 % of the values are to lie."""
NAMES = ("fx", "fy", "cx", "cy")


class Subsets(NamedTuple):
    """What subsets of one number of views say."""

    z: Array
    """(n, 4) distances of fx, fy, cx, cy from the truth, in standard deviations."""
    partial: int
    """Number of subsets that are refused or partial, by name."""


def calibrate_all(images: ImageSet, trial: LensTrial) -> Calibration:
    """Calibrate from all views, with the board's shape that predicts unseen views best."""
    settings = {"model": trial.model, "fix": trial.fixed}
    return choose_board_shape(images.views, images.size, **settings).chosen


def draw_subsets(total: int, count: int, draws: int) -> list[tuple[int, ...]]:
    """Draw distinct subsets of a number of views; all of them if there are no more than draws."""
    rng = np.random.default_rng(count)
    drawn: dict[tuple[int, ...], None] = {}  # in the order in which they are drawn
    while len(drawn) < min(draws, math.comb(total, count)):
        drawn[tuple(np.sort(rng.choice(total, count, replace=False)).tolist())] = None
    return list(drawn)


def calibrate_subsets(
    images: ImageSet, trial: LensTrial, truth: Calibration, count: int, draws: int
) -> Subsets:
    """Calibrate random subsets of a number of views."""
    z, partial = [], 0
    for chosen in draw_subsets(len(images.views), count, draws):
        try:
            found = calibrate(
                [images.views[k] for k in chosen], images.size, model=trial.model, fix=trial.fixed
            )
        except CalibrationError:
            partial += 1
            continue
        if found.diagnosis is not None or found.undetermined:
            partial += 1
            continue
        distance = np.abs(found.camera.params[:4] - truth.camera.params[:4])
        z.append(distance / np.hypot(found.sigma[:4], truth.sigma[:4]))
    return Subsets(np.reshape(z, (-1, 4)), partial)


def print_row(name: str, count: int, subsets: Subsets) -> None:
    """Print a row of the table."""
    cells = [name, str(count), str(subsets.partial)]
    if len(subsets.z):
        inside, medians = np.mean(subsets.z < BOUND, axis=0), np.median(subsets.z, axis=0)
        cells += [f"{100 * share:.0f}" for share in inside] + [f"{m:.2f}" for m in medians]
    print("| " + " | ".join(cells) + " |", flush=True)


def measure_sets(wanted: Sequence[str], draws: int) -> dict[int, list[Subsets]]:
    """Measure all sets, or those whose names begin as wanted, and print a row for each."""
    totals: dict[int, list[Subsets]] = {count: [] for count in COUNTS}
    for name, make in list_sets(find_data_dir()).items():
        if wanted and not name.startswith(tuple(wanted)):
            continue
        try:
            images = load(name, make)
            trial = choose_lens_stepwise(images.views, images.size).chosen
            truth = calibrate_all(images, trial)
        except FileNotFoundError as error:
            print(f"| {name} | absent: {error} |")
            continue
        except CalibrationError as error:
            print(f"| {name} | {error.message} |")
            continue
        for count in COUNTS:
            if 2 * count > len(images.views):
                continue
            totals[count].append(calibrate_subsets(images, trial, truth, count, draws))
            print_row(name, count, totals[count][-1])
    return totals


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="+", help="names of sets, or their beginnings")
    parser.add_argument(
        "--draws", type=int, default=40, help="number of subsets of each size, at most"
    )
    arguments = parser.parse_args()
    data = find_data_dir()
    if not data.is_dir():
        print(f"No real image sets: set CALIBGUI_DATA ({data} does not exist).")
        return
    columns = ["set", "views", "partial"]
    columns += [f"{name} < {BOUND}σ, %" for name in NAMES] + [f"{name}, median" for name in NAMES]
    print("| " + " | ".join(columns) + " |\n|" + " --- |" * len(columns))
    with threadpool_limits(1):
        totals = measure_sets(arguments.sets or (), arguments.draws)
    for count, parts in totals.items():
        if parts:
            z = np.concatenate([part.z for part in parts])
            print_row("all", count, Subsets(z, sum(part.partial for part in parts)))


if __name__ == "__main__":
    main()
