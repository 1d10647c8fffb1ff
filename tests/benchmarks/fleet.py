"""Cost of a fleet: workers against each other, overhead over a plain loop, rerun, memory.

    python -m tests.benchmarks.fleet FOLDER --cameras 60

renders cameras of 12 VGA photographs to FOLDER, unless they are there, and calibrates them

- in a plain loop in this process, as a script would, and
- by `run_batch` on 1 and on 2 processes.

Times are seconds of the clock and of the processors, the latter of this process and all workers.
Overhead is the processor time of a batch that its cameras did not take themselves, as a share of
what they took; what it takes to start is stated by itself, as it does not grow with the cameras.
Where other programs run the clock tells little, and the processor time must do: 2 workers are twice
as fast as 1 if they have a processor each and cameras do not take more of it than with one worker.
The rerun is of 1,000 cameras whose rows are made up: nothing but the driver works then.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from calibgui.app.calibrating.settings import Settings
from calibgui.app.fleet.batch import run_batch
from calibgui.app.fleet.camera_task import (
    FleetFolder,
    Work,
    calibrate_camera,
    compute_state,
)
from calibgui.app.fleet.manifest import BoardSought, CameraTask, read_manifest
from calibgui.app.fleet.photographs import list_photographs
from calibgui.app.fleet.schedulers import open_scheduler
from calibgui.app.system.workers import map_in_processes
from calibgui.dataset.fleet import FleetCamera, FleetStatus
from calibgui.formats.fleet_ledger import open_ledger
from tests.scenes.fleet import make_camera, write_camera

T = TypeVar("T")
R = TypeVar("R")
BOARD = BoardSought(30.0, (6, 7), pattern=None)
SIZE = (640, 480)
VIEWS = 12
RERUN_CAMERAS = 1000


class Pretend:
    """A scheduler that makes up the rows of cameras."""

    def run(self, _: Callable[[T], R], items: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        for k, work in enumerate(items):
            state = compute_state(work.task, list_photographs(work.task.paths))
            words = "It is made up."
            row = FleetCamera(work.task.entry, FleetStatus.REFUSED, words, failures=(words,))
            yield k, replace(row, digest=state, state=state)


def render(folder: Path) -> None:
    """Render a camera whose folder is named by its number."""
    seed = int(folder.name)
    if not folder.exists():
        part = folder.with_name(f".{folder.name}")
        shutil.rmtree(part, ignore_errors=True)
        write_camera(part, make_camera(seed, SIZE), seed, VIEWS)
        part.rename(folder)


def read_tasks(folder: Path, count: int) -> tuple[CameraTask, ...]:
    """Return the cameras, rendered if they are not there."""
    folder.mkdir(parents=True, exist_ok=True)
    for _ in map_in_processes(render, [folder / str(k) for k in range(count)]):
        pass
    return read_manifest(folder, BOARD, Settings())[:count]


def measure_processor() -> float:
    """Return the processor time of this process and of those that it has waited for, s."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def measure_memory(process: int) -> float:
    """Return the memory of a process, by its number, MB; 0 of one that has ended."""
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    except OSError:
        return 0.0
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def measure_largest_worker() -> float:
    """Return the memory of the largest of the processes that come from this one, MB."""
    listed = subprocess.check_output(["ps", "-eo", "pid=,ppid="], text=True).split()
    parents = dict(zip(map(int, listed[::2]), map(int, listed[1::2]), strict=True))
    family = {os.getpid()}
    while more := {child for child, parent in parents.items() if parent in family} - family:
        family |= more
    return max(map(measure_memory, family - {os.getpid()}), default=0.0)


def loop(tasks: Sequence[CameraTask]) -> None:
    """Calibrate in a plain loop."""
    memory = []
    with tempfile.TemporaryDirectory() as name:
        folder = FleetFolder(Path(name) / "fleet.db")
        folder.make()
        calibrate_camera(Work(tasks[0], None, folder))  # loads libraries and kernels
        clock, used = time.perf_counter(), measure_processor()
        for task in tasks[1:]:
            calibrate_camera(Work(task, None, folder))
            memory.append(measure_memory(os.getpid()))
        clock, used = time.perf_counter() - clock, measure_processor() - used
    count = len(tasks) - 1
    print(f"plain loop          clock {clock / count:.3f}, processor {used / count:.3f} s a camera")
    print(
        f"memory of the loop  after a quarter {memory[count // 4]:.0f}, at the end "
        f"{memory[-1]:.0f} MB"
    )


def batch(tasks: Sequence[CameraTask], workers: int) -> None:
    """Calibrate by `run_batch`, and print what it costs."""
    clocks: list[float] = []
    memory: list[float] = []

    def note(done: int, count: int) -> None:
        clocks.append(time.perf_counter())
        if done in (count // 4, count):
            memory.append(measure_largest_worker())

    clock, used = time.perf_counter(), measure_processor()
    with (
        tempfile.TemporaryDirectory() as folder,
        open_ledger(Path(folder) / "fleet.db", create=True) as ledger,
        open_scheduler(workers) as scheduler,
    ):
        run_batch(tasks, ledger, scheduler, progress=note)
        cameras = sorted(row.cpu_seconds for row in ledger.read())
    used = measure_processor() - used
    # Each worker's first camera loads kernels.
    typical, total = cameras[len(cameras) // 2], sum(cameras)
    first = workers  # cameras until all workers have begun
    rate = (len(tasks) - first) / (clocks[-1] - clocks[first - 1])
    print(
        f"pool of {workers}           clock {1 / rate:.3f}, processor {typical:.3f} s a camera; "
        f"start and end {clocks[0] - clock:.1f} s; beside the cameras {used - total:.1f} s of "
        f"processor, {100 * (used - total) / total:.1f} %; largest worker after a quarter "
        f"{memory[0]:.0f}, at the end {memory[-1]:.0f} MB"
    )


def rerun(task: CameraTask) -> None:
    """Check cameras that are all done."""
    with tempfile.TemporaryDirectory(dir=Path(task.paths[0]).parent.parent) as name:
        fleet = Path(name) / "fleet"
        for k in range(RERUN_CAMERAS):
            (fleet / str(k)).mkdir(parents=True)
            for file in Path(task.paths[0]).iterdir():
                os.link(file, fleet / str(k) / file.name)
        tasks = read_manifest(fleet, BOARD, Settings())
        with open_ledger(Path(name) / "fleet.db", create=True) as ledger:
            run_batch(tasks, ledger, Pretend())
            clock, used = time.perf_counter(), time.process_time()
            summary = run_batch(read_manifest(fleet, BOARD, Settings()), ledger, Pretend())
            assert summary.worked_on == 0
            clock, used = time.perf_counter() - clock, time.process_time() - used
        print(f"rerun of {RERUN_CAMERAS} done cameras   clock {clock:.2f}, processor {used:.2f} s")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cameras", type=int, default=1000)
    options = parser.parse_args()
    tasks = read_tasks(options.folder / "photographs", options.cameras)
    print(f"{len(tasks)} cameras of {VIEWS} photographs, load {os.getloadavg()[0]:.1f}")
    rerun(tasks[0])
    loop(tasks)
    for workers in (1, 2):
        batch(tasks, workers)


if __name__ == "__main__":
    main()
