"""How long does the window keep one waiting? 300 photographs of 12 megapixels, task by task.

    python -m tests.benchmarks.responsiveness [--count 300] [--busy] [--trace] [FOLDER]

draws the photographs into the folder (once; by default one among the temporary files), opens the
window offscreen and does in it what a user does. Of each task it prints the longest gap between two
beats of a timer of 5 ms on the event loop, in ms: by the clock; in processor time of the whole
program, as another thread of it may hold the interpreter's lock; and in processor time of the
window's own thread. Only the first can be blamed on other programs. Then come the seconds that the
task took, and the most memory that the window held so far; last the most that a worker held, MB.

``--busy`` lets another process compute meanwhile; ``--trace`` prints what the threads did in each
task's longest gap, by the program's processor time: one of them may have held the interpreter's
lock. Goals of the project: at most 50 ms, 100 beside a busy process, and 800 MB.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from multiprocessing import active_children, get_context
from multiprocessing.process import BaseProcess
from pathlib import Path
from types import FrameType

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import cv2
import numpy as np
from PySide6.QtCore import (
    QEventLoop,
    QItemSelection,
    QItemSelectionModel,
    QSettings,
    Qt,
    QTimer,
)
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.gui.dialogs.bug_dialog import BugDialog
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.widgets import theme
from calibgui.gui.window.main_window import MainWindow
from tests.benchmarks.memory import peak
from tests.engine.scenes import looking

SIZE = (4000, 3000)
FOCAL = 4100.0
BOARD = Board(rows=9, cols=12, square=30.0)
TEXELS = 7.0
"""Resolution of the drawn board, per mm: about that of the photographs."""
BEAT = 5
"""Interval of the timer, ms."""
SAMPLE = 0.005
"""Interval of the sampler, s."""
LATE = 0.02
"""Time without samples after which the other threads are looked at, s."""
INNERMOST = 6
"""Number of functions that are named of each thread."""
PATIENCE = 60.0
"""Time after which a task is stopped, s: to judge 300 views takes minutes."""


def draw_photographs(folder: Path, count: int) -> list[Path]:
    """Draw those of `count` photographs of a board, without distortion, that are not there."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"photograph-{k:03}.jpg" for k in range(count)]
    rng = np.random.default_rng(0)
    camera = Camera(SIZE, [FOCAL, FOCAL, SIZE[0] / 2, SIZE[1] / 2], "pinhole")
    matrix = np.array([[FOCAL, 0, SIZE[0] / 2], [0, FOCAL, SIZE[1] / 2], [0, 0, 1]])
    side = round(TEXELS * BOARD.square)
    squares = np.indices((BOARD.rows + 1, BOARD.cols + 1)).sum(axis=0) % 2
    sheet = np.pad(np.where(squares == 1, 230, 30).astype(np.uint8), 1, constant_values=230)
    sheet = cv2.GaussianBlur(np.kron(sheet, np.ones((side, side), np.uint8)), (0, 0), 1.5)
    noise = rng.normal(scale=2.0, size=SIZE[::-1]).astype(np.float32)
    # The first inner corner is two squares from the sheet's corner; its pixels count from middles.
    board_from_sheet = np.array([[1, 0, 0.5 - 2 * side], [0, 1, 0.5 - 2 * side], [0, 0, TEXELS]])
    for path in paths:
        pose = looking(camera, rng, board=BOARD, fill=(0.4, 0.8))
        columns = rotation_from_vector(np.array(pose.rvec))[:, :2]
        image_from_board = matrix @ np.column_stack([columns, pose.tvec])
        turned = np.roll(noise, tuple(rng.integers(0, SIZE[1], 2)), (0, 1))
        if not path.exists():
            seen = cv2.warpPerspective(
                sheet, image_from_board @ board_from_sheet, SIZE, borderValue=(110,)
            )
            pixels = np.clip(np.rint(seen + turned), 0, 255).astype(np.uint8)
            cv2.imwrite(str(path), pixels, [cv2.IMWRITE_JPEG_QUALITY, 90])
    return paths


def resident(process: BaseProcess) -> float:
    """MB that a process held at most so far; 0 where the system does not tell."""
    try:
        status = Path(f"/proc/{process.pid}/status").read_text()
    except OSError:
        return 0.0
    lines = [line.split() for line in status.splitlines() if line.startswith("VmHWM")]
    return float(lines[0][1]) * 1024 / 1e6 if lines else 0.0


class Trace:
    """Samples what the threads do, whenever they let the window's thread look."""

    def __init__(self) -> None:
        self._samples: list[tuple[float, str]] = []

    def __enter__(self) -> Trace:
        signal.signal(signal.SIGALRM, self._sample)
        signal.setitimer(signal.ITIMER_REAL, SAMPLE, SAMPLE)
        return self

    def __exit__(self, *_: object) -> None:
        signal.setitimer(signal.ITIMER_REAL, 0)

    def _sample(self, _: int, frame: FrameType | None) -> None:
        now, before = time.monotonic(), self._samples[-1][0] if self._samples else np.inf
        self._samples.append((now, f"the window: {describe_stack(frame)}"))
        if now - before > LATE:  # another thread may have held the interpreter's lock until now
            late = f"a thread after {1e3 * (now - before):.0f} ms"
            others = sys._current_frames()
            del others[threading.get_ident()]
            self._samples.extend(
                (now, f"{late}: {describe_stack(other)}")
                for other in others.values()
                if other.f_code.co_name not in ("_worker", "wait")
            )

    def print_most(self, begin: float, end: float) -> None:
        """Print what was seen most often between two times."""
        seen = Counter(what for at, what in self._samples if begin <= at <= end + SAMPLE)
        for what, times in seen.most_common(9):
            print(f"    {times:4} x {what}")


def describe_stack(frame: FrameType | None) -> str:
    """Name the innermost functions that a thread is in."""
    stack: list[str] = []
    while frame is not None and len(stack) < INNERMOST:
        code = frame.f_code
        stack.append(f"{code.co_filename.rpartition('/')[2]}:{frame.f_lineno} {code.co_name}")
        frame = frame.f_back
    return " < ".join(stack)


def wait(duration: int) -> None:
    """Run the event loop for so many ms.

    ``QTest.qWait`` sleeps without letting go of the interpreter, so that the window's threads stand
    still in most of that time.
    """
    loop = QEventLoop()
    QTimer.singleShot(duration, loop.quit)
    loop.exec()


@contextmanager
def heartbeat(task: str, trace: Trace | None) -> Iterator[None]:
    """Print the longest gaps while the block runs the event loop."""
    beats: list[tuple[float, float, float]] = []

    def beat() -> None:
        beats.append((time.monotonic(), time.process_time(), time.thread_time()))

    timer = QTimer(interval=BEAT)
    timer.timeout.connect(beat)
    beat()
    timer.start()
    yield
    timer.stop()
    beat()
    gaps = np.diff(np.array(beats), axis=0)
    gaps[:, 1] = np.minimum(gaps[:, 0], gaps[:, 1])
    whole, program, thread = 1e3 * gaps.max(axis=0)
    seconds = beats[-1][0] - beats[0][0]
    print(
        f"{task:34}{whole:8.0f}{program:10.0f}{thread:8.0f}{seconds:9.1f}{peak():9.0f}", flush=True
    )
    if trace is not None:
        longest = int(np.argmax(gaps[:, 1]))
        trace.print_most(beats[longest][0], beats[longest + 1][0])


class User:
    """Does in the window what a user does, and waits until it is done."""

    def __init__(self, window: MainWindow, trace: Trace | None) -> None:
        self.window, self.trace = window, trace
        self.largest_worker = 0.0
        """MB that a process of the window held at most."""

    def do(self, task: str, *steps: Callable[[], object]) -> None:
        """Do a task step by step, a third of a second apart, until nothing runs any more.

        Raises:
            RuntimeError: if the window shows a bug, behind which nothing is done any more.
        """
        with heartbeat(task, self.trace):
            for step in steps:
                step()
                wait(300)
            self._wait()
        if any(isinstance(widget, BugDialog) for widget in QApplication.topLevelWidgets()):
            raise RuntimeError(f"{task}: the window shows a bug")

    def _wait(self) -> None:
        end = time.monotonic() + PATIENCE
        jobs = self.window.session.jobs
        while jobs.running or self.window.calibrator.running:
            if time.monotonic() > end and self.window.session.result is not None:
                for job in jobs.running:
                    job.cancel()
            wait(200)
            self.largest_worker = max(self.largest_worker, *map(resident, active_children()), 0)
        wait(300)

    def scroll(self) -> None:
        """Scroll the film strip from one end to the other and back."""
        bar = self.window.images.list.horizontalScrollBar()
        for place in np.concatenate([np.linspace(0, 1, 150), np.linspace(1, 0, 50)]):
            bar.setValue(round(place * bar.maximum()))
            wait(10)

    def walk(self) -> None:
        """Look at one image after the other, faster than they can be read."""
        for _ in range(20):
            QTest.keyClick(self.window.images.list, Qt.Key.Key_Right)
            wait(100)

    def leave_out(self, count: int) -> None:
        """Leave selected images out, or take them in again."""
        strip = self.window.images.list
        rows = strip.model().rowCount()
        chosen = QItemSelection()
        for row in range(0, rows, rows // count):
            index = strip.model().index(row, 0)
            chosen.select(index, index)
        strip.selectionModel().select(chosen, QItemSelectionModel.SelectionFlag.ClearAndSelect)
        strip.setFocus()
        QTest.keyClick(strip, Qt.Key.Key_Space)

    def drag_threshold(self) -> None:
        """Drag the threshold down and up again."""
        strip = self.window.images.list
        view = strip.viewport()
        at = view.rect().center()
        at.setY(round(strip.place_of(strip.threshold)))
        QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=at)
        for step in (*range(30), *range(30, 0, -1)):
            moved = at + type(at)(0, step)
            QTest.mouseMove(view, moved)
            wait(10)
        QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=at)


def measure(folder: Path, scratch: Path, trace: Trace | None) -> None:
    """Do everything in a window of its own and print the gaps."""
    window = MainWindow()
    window.open_up()
    QTest.qWaitForWindowActive(window)
    user = User(window, trace)
    user.do("the window by itself", window.preparation.start)
    window.board.by_hand.click()  # what is read and what is searched are told apart
    user.do("opening, first thumbnails", lambda: window.files.open_paths([str(folder)]))
    user.do("scrolling", user.scroll)
    user.do("looking at images", user.walk)
    user.do("searching, and scrolling", window.board.by_hand.click, user.scroll, user.walk)
    user.do("calibrating, judging", window.calibrate.click)
    user.do("scrolling", user.scroll)
    user.do("looking at images", user.walk)
    user.leave_out(1)  # the kernels are loaded that follow it
    user.do("leaving another image out", lambda: user.leave_out(1))
    quarter = len(window.session.project.views) // 4
    user.do("leaving a quarter out", lambda: user.leave_out(quarter))
    user.do("undo", window.session.document.undo)
    user.do("dragging the threshold", user.drag_threshold)
    for kind in PANELS:
        show = partial(window.need_analysis().show_panel, kind)
        user.do(f"first {kind.__name__}", show)
    for kind in PANELS:
        show = partial(window.need_analysis().show_panel, kind)
        user.do(f"again {kind.__name__}", show)
    user.do("leaving one out, all panels there", lambda: user.leave_out(1))
    user.do("undo", window.session.document.undo)
    file = scratch / "project.json"
    user.do("saving", lambda: window.files.saver.save_beside(file))
    user.do("opening the project", lambda: window.files.open_project(file))
    print(f"the largest worker held {user.largest_worker:.0f} MB")
    window.close()


def compute_for_ever() -> None:
    while True:
        np.linalg.svd(np.ones((200, 200)))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    kept = Path(tempfile.gettempdir(), "calibgui-photographs")
    parser.add_argument("folder", type=Path, nargs="?", default=kept)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--busy", action="store_true")
    parser.add_argument("--trace", action="store_true")
    arguments = parser.parse_args()
    draw_photographs(arguments.folder, arguments.count)
    with tempfile.TemporaryDirectory() as scratch:
        for name in ("XDG_CONFIG_HOME", "XDG_STATE_HOME"):
            os.environ[name] = scratch
        app = QApplication(sys.argv[:1])
        QSettings.setPath(QSettings.Format.NativeFormat, QSettings.Scope.UserScope, scratch)
        theme.apply(app, theme.Scheme.LIGHT)
        print(f"{'':34}{'clock':>8}{'program':>10}{'thread':>8}{'seconds':>9}{'MB':>9}")
        other = get_context("spawn").Process(target=compute_for_ever, daemon=True)
        if arguments.busy:
            other.start()
        trace = Trace() if arguments.trace else None
        with trace or nullcontext():
            measure(arguments.folder, Path(scratch), trace)
        if arguments.busy:
            other.kill()


if __name__ == "__main__":
    main()
