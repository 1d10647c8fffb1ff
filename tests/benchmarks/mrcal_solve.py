"""Time mrcal's solve: ``/usr/bin/python3 -m tests.benchmarks.mrcal_solve IN.npz REPEATS CLOCK``.

Prints the least time in seconds, then the RMS distance between corners and predictions, px.
"""

from __future__ import annotations

import sys
import time

import mrcal
import numpy as np

from tests.engine.uncertainty.mrcal_reference import problem


def main(given: str, repeats: str, clock: str) -> None:
    data = np.load(given)
    now = getattr(time, clock)
    times = []
    for _ in range(int(repeats)):
        inputs = problem(data)
        began = now()
        found = mrcal.optimize(**inputs)
        times.append(now() - began)
    corners = data["boards"].size // 2
    residuals = found["x"][: 2 * corners]
    print(min(times), np.sqrt(residuals @ residuals / corners))


if __name__ == "__main__":
    main(*sys.argv[1:])
