"""Inputs larger than anybody's, which end in bounded time and without a traceback."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Observation
from calibgui.formats.corners_json import write_corners
from tests.engine import scenes

MAX_SECONDS = 900
"""Processor time after which a command counts as endless, and is ended by the system, s."""
_ROOT = Path(__file__).parents[3]
_SIDE_PX = 10_000


@dataclass(frozen=True, slots=True)
class Ended:
    """How a command ended."""

    code: int
    """Its exit code; negative if it was ended."""
    seconds: float
    """Processor time of it and of its workers, s."""
    megabytes: int
    """The largest memory of it or of one of its workers."""
    said: str
    """Its last lines."""

    @property
    def is_right(self) -> bool:
        """Whether it ended by itself, as a success or with a refusal."""
        return self.code in (0, 1, 2) and "Traceback" not in self.said


def make_sizes_table(folder: Path) -> str:
    """Return a table in Markdown of large inputs."""
    lines = ["| input | processor time, s | memory, MB | end |", "| --- | ---: | ---: | --- |"]
    for name in INPUTS:
        ended = run_input(name, folder)
        end = "as it should" if ended.is_right else f"wrong: {ended.said[-200:]!r}"
        lines.append(f"| {name} | {ended.seconds:.0f} | {ended.megabytes} | {end} |")
    return "\n".join(lines)


def run_input(name: str, folder: Path) -> Ended:
    """Make a large input and run the command that takes it."""
    with tempfile.TemporaryDirectory(dir=folder) as place:
        return _run(INPUTS[name](Path(place)), Path(place))


def _run(arguments: list[str], folder: Path) -> Ended:
    with (folder / "said").open("w+") as said:
        process = subprocess.Popen(
            [sys.executable, "-m", "calibgui", *arguments],
            stdout=said,
            stderr=said,
            cwd=_ROOT,
            preexec_fn=_limit_time,
        )
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        seconds = usage.ru_utime + usage.ru_stime
        return Ended(process.returncode, seconds, usage.ru_maxrss >> 10, said.read()[-4000:])


def _limit_time() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (MAX_SECONDS, MAX_SECONDS))


def _make_many_images(folder: Path) -> list[str]:
    grey = np.full((48, 64), 128, dtype=np.uint8)
    for k in range(2000):
        grey[:] = k % 250
        (folder / f"{k}.png").write_bytes(opencv.encode_image(".png", grey) or b"")
    return ["detect", str(folder), "-o", str(folder / "corners.json")]


def _make_large_image(folder: Path) -> list[str]:
    squares = np.indices((9, 12)).sum(axis=0) % 2
    board = np.kron(squares, np.ones((700, 700), dtype=np.uint8)) * 200 + 20
    pixels = np.full((_SIDE_PX, _SIDE_PX), 220, dtype=np.uint8)
    pixels[1000 : 1000 + board.shape[0], 800 : 800 + board.shape[1]] = board
    (folder / "large.png").write_bytes(opencv.encode_image(".png", pixels) or b"")
    return ["detect", str(folder / "large.png"), "-o", str(folder / "corners.json")]


def _make_many_views(folder: Path) -> list[str]:
    return _make_corners(folder, Board(3, 4, 30.0), views=20_000)


def _make_many_corners(folder: Path) -> list[str]:
    return _make_corners(folder, Board(200, 200, 1.0), views=3)


def _make_corners(folder: Path, board: Board, views: int) -> list[str]:
    camera, rng = scenes.brown(), np.random.default_rng(0)
    poses = [scenes.looking(camera, rng, board=board) for _ in range(min(views, 50))]
    seen = scenes.seen(camera, poses, board)
    found = []
    for k in range(views):
        one = seen.views[k % len(poses)]
        noise: Array = rng.normal(scale=0.1, size=one.uv.shape)
        points = Observation(one.uv + noise, one.xy)
        found.append(View(f"{k}.png", ViewStatus.FOUND, points=points))
    file = folder / "corners.json"
    write_corners(CornerSet(camera.size, tuple(found), board), file)
    return ["calibrate", str(file), "-o", str(folder / "result.json")]


INPUTS: Mapping[str, Callable[[Path], list[str]]] = {
    "a folder of 2,000 images": _make_many_images,
    "an image of 100 megapixels": _make_large_image,
    "20,000 views in a corners.json": _make_many_views,
    "40,000 corners in each of three views": _make_many_corners,
}
"""Functions that make an input in a folder and return the arguments of the command for it."""
