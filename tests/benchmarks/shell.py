"""How much processor time does a calibration take from the shell? Ours, and OpenCV's.

    python -m tests.benchmarks.shell [--repeats 3] [--fisheye] FOLDER

prints the processor time, s, of ``calibgui calibrate FOLDER --square 30 --quiet`` and of programs
that find the same board with OpenCV's SB finder and calibrate with cv2.calibrateCamera, or with
cv2.fisheye.calibrate: all their processes, from the start of Python to the end, taken in turns,
with the number of views that each calibrates from and the ratios in this run. SB comes twice, as it
is and with CALIB_CB_ACCURACY, which is as exact as it gets. What has to be compiled is compiled
before, and Python keeps its bytecode as in any installation. Goal of the project: a ratio of at
most 1.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

OPENCV = """
import sys
from pathlib import Path
import cv2
import numpy as np
rows, cols, flags, is_fisheye = map(int, sys.argv[2:])
board = np.zeros((rows * cols, 3), np.float32)
board[:, :2] = 30 * np.mgrid[:cols, :rows].T.reshape(-1, 2)
found = []
for file in sorted(Path(sys.argv[1]).iterdir()):
    image = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE) if file.is_file() else None
    if image is not None:
        size = image.shape[::-1]
        is_found, corners = cv2.findChessboardCornersSB(image, (cols, rows), flags=flags)
        if is_found:
            found.append(corners)
if is_fisheye:
    found = [corners.reshape(1, -1, 2) for corners in found]
    w, h = size  # without a guess it ends with an error
    K = np.array([[w / 4, 0, w / 2], [0, w / 4, h / 2], [0, 0, 1]])
    flags = cv2.CALIB_RECOMPUTE_EXTRINSIC | cv2.CALIB_FIX_SKEW | cv2.CALIB_USE_INTRINSIC_GUESS
    cv2.fisheye.calibrate([board[None]] * len(found), found, size, K, np.zeros(4), flags=flags)
else:
    cv2.calibrateCamera([board] * len(found), found, size, None, None)
print(len(found), "views")
"""
ACCURACY = 32
"""cv2.CALIB_CB_ACCURACY."""
ENVIRONMENT = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
"""Without what makes Python compile every module at every start."""


def measure_processor_time(command: list[str]) -> tuple[float, str]:
    """Processor time, s, of a program with all its processes, and what it printed last."""
    before = os.times()
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=ENVIRONMENT)
    after = os.times()
    spent = after.children_user + after.children_system
    spent -= before.children_user + before.children_system
    return spent, (done.stdout.strip().splitlines() or [""])[-1]


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path, help="photographs of one checkerboard")
    parser.add_argument("--board", type=int, nargs=2, default=(12, 13), metavar=("ROWS", "COLS"))
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--fisheye", action="store_true", help="by cv2.fisheye.calibrate")
    options = parser.parse_args()
    ours = [sys.executable, "-m", "calibgui", "calibrate", str(options.folder)]
    theirs = [sys.executable, "-c", OPENCV, str(options.folder), *map(str, options.board)]
    lens = str(int(options.fisheye))
    commands = {
        "calibgui": [*ours, "--square", "30", "--quiet"],
        "OpenCV, SB": [*theirs, "0", lens],
        "OpenCV, SB with ACCURACY": [*theirs, str(ACCURACY), lens],
    }
    measure_processor_time(commands["calibgui"])
    least = dict.fromkeys(commands, float("inf"))
    said = dict.fromkeys(commands, "")
    for _ in range(options.repeats):
        for name, command in commands.items():
            spent, said[name] = measure_processor_time(command)
            least[name] = min(least[name], spent)
    print(f"{'':26}{'CPU s':>8}{'ours over it':>14}")
    for name, spent in least.items():
        print(f"{name:26}{spent:8.2f}{least['calibgui'] / spent:14.2f}   {said[name][:80]}")


if __name__ == "__main__":
    main()
