"""What a calibration of many views holds in memory: `python -m tests.benchmarks.memory`.

Views of a 12 x 13 board are calibrated with everything that ``calibrate`` returns. Prints the
peak of the resident memory in MB with and before the calibration, and the processor's seconds.
"""

from __future__ import annotations

import argparse
import resource
import sys
import time

import numpy as np

from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Status
from tests.engine.scenes import VGA, barrel, looking, seen

BOARD = Board(rows=12, cols=13, square=30.0)
POSES = 200
"""Different ones; beyond these the views repeat with other noise."""


def peak() -> float:
    """MB that were resident at most so far."""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("views", type=int, nargs="?", default=20_000)
    parser.add_argument("--board-shape", default="nominal")
    arguments = parser.parse_args()
    camera, rng, xy = barrel(), np.random.default_rng(0), BOARD.points()
    poses = [looking(camera, rng, board=BOARD, fill=(0.4, 0.8)) for _ in range(POSES)]
    exact = [view.uv for view in seen(camera, poses, board=BOARD).views]
    noise = rng.normal(scale=0.1, size=(arguments.views, *xy.shape))
    views = [Observation(exact[k % POSES] + noise[k], xy) for k in range(arguments.views)]
    before, began = peak(), time.process_time()
    found = calibrate(views, VGA, board_shape=arguments.board_shape)
    assert found.status is Status.CONVERGED
    print(f"{peak():.0f} {before:.0f} {time.process_time() - began:.2f}")


if __name__ == "__main__":
    main()
