"""How far the solve reaches: `python -m tests.benchmarks.convergence`.

Calibrates random problems (``tests.engine.random_problems``), or with `--lenses` random lenses of
60 to 220 degrees (``tests.engine.random_lenses``), and lists those that miss the minimum, silent
ones apart.
"""

from __future__ import annotations

import argparse
import os
from concurrent.futures import ProcessPoolExecutor

from tests.engine import random_lenses, random_problems


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", type=int, default=0, help="seed of the first problem")
    parser.add_argument("--problems", type=int, default=1800)
    parser.add_argument("--lenses", action="store_true", help="lenses of all models, of any angle")
    parser.add_argument("--processes", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.first + arguments.problems)
    outcome = random_lenses.outcome if arguments.lenses else random_problems.outcome
    with ProcessPoolExecutor(arguments.processes) as pool:
        outcomes = list(pool.map(outcome, seeds, chunksize=20))
    missed = [result for result in outcomes if not result.reached]
    for result in missed:
        print(f"{result.seed}: {'SILENT ' if result.silent else ''}{result.words}")
    silent = sum(result.silent for result in missed)
    reached = len(outcomes) - len(missed)
    print(
        f"{reached} of {len(outcomes)} reach the minimum ({100 * reached / len(outcomes):.2f} %), "
        f"{silent} others say so without having done so"
    )


if __name__ == "__main__":
    main()
