"""Does a live image of 1080p keep up? `python -m tests.benchmarks.live_speed [--frames 10000]`.

A rendered hand moves a board before a camera of 1920 x 1080 px, 25 times a second by the clock, on
the page of the window (offscreen) for half a minute. Printed are the frames that the session looked
at in a second; the time from a frame to what is drawn over it, median and nine in ten, ms; the
processor time of all threads, and of the window's own, for a frame; the longest gap of the event
loop, by the clock and in processor time of its own thread, and the share of gaps above 50 ms; and
what else ran beside (the load of the machine). Then come the MB resident after 1,000 and after all
frames of VGA that a session looks at without a window, and the ms that one of them takes. Goals: 25
frames a second, 120 ms, 50 ms, and memory that stays as it is.
"""

from __future__ import annotations

import argparse
import itertools
import os
import tempfile
import time
from pathlib import Path
from typing import ClassVar

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import cv2
import numpy as np
from PySide6.QtCore import QEventLoop, QTimer
from PySide6.QtWidgets import QApplication

from calibgui.app.photographs import recording
from calibgui.app.photographs.recording import RecordedInstant, Recorder
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.capture.frame_sources import Frame
from calibgui.engine.capture.latest_frames import Instant, PairedFrames
from calibgui.engine.capture.session import CaptureSession
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.geometry.homography import fit_homography
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.rendering import Appearance, render_view
from calibgui.gui.jobs.jobs import Jobs
from calibgui.gui.live import live_page
from tests.scenes.hand import FRAMES_PER_SECOND, go

BOARD = Board(7, 10, 25.0)
SIZES = {"1080p": (1920, 1080), "VGA": (640, 480)}
SECONDS = 30.0
BEAT, LONG = 5, 50.0
"""Interval of the timer, and length of a gap that is felt, ms."""
PLACES = [
    Pose([0.1, -0.1, 0.0], [-110, -75, 420]),
    Pose([0.6, 0.1, 0.1], [-130, -75, 480]),
    Pose([-0.5, 0.3, 0.0], [-90, -60, 450]),
    Pose([0.1, 0.6, 0.0], [-120, -85, 400]),
]
WARM = 1000
"""Frames after which memory is measured first."""
STEPS, STILL = 6, 10
"""Frames from one place to the next, and in each."""


def draw_frames(size: tuple[int, int]) -> list[np.ndarray]:
    """Draw the frames of a hand that goes from place to place, RGB.

    A board is rendered once and put into perspective after that: a frame of 1080p takes two seconds
    to render.
    """
    camera = Camera(size, [size[0] * 0.9, size[0] * 0.9, size[0] / 2, size[1] / 2], "pinhole")
    facing = Pose([0, 0, 0], [-112, -75, 300])
    board = BOARD.points()
    rendered = render_view(camera, facing, BOARD, blur=0.7)
    rng, frames = np.random.default_rng(0), []

    def draw(pose: Pose) -> np.ndarray:
        H = fit_homography(
            project_points(board, camera, facing),
            project_points(board, camera, pose),
            np.ones(len(board)),
        )
        seen = cv2.warpPerspective(rendered, H, size, borderValue=(Appearance().background,))
        noisy = np.clip(np.rint(seen + rng.normal(0, 4.0, seen.shape)), 0, 255).astype(np.uint8)
        return np.repeat(noisy[:, :, None], 3, axis=2)

    for start, end in itertools.pairwise([*PLACES, PLACES[0]]):
        frames += [draw(start)] * STILL + [draw(pose) for pose in go(start, end, STEPS)]
    return frames


class Camera1080:
    """Sends its frames by the clock, and those that nobody takes are lost."""

    title, remark = "a drawn camera", ""
    is_continuous = is_live = True

    def __init__(self, frames: list[np.ndarray]) -> None:
        self._frames, self._count = itertools.cycle(frames), 0
        self._begin = time.monotonic()

    def read(self) -> Frame:
        """Wait for the next frame."""
        self._count += 1
        time.sleep(max(0.0, self._begin + self._count / FRAMES_PER_SECOND - time.monotonic()))
        return Frame(next(self._frames), time.monotonic())

    def close(self) -> None:
        """Release nothing."""


class TimedRecorder(Recorder):
    """Remembers when the frames were taken that it tells of."""

    taken_at: ClassVar[dict[int, float]] = {}

    def _look_at(self, instant: Instant, frames: PairedFrames) -> RecordedInstant:
        recorded = super()._look_at(instant, frames)
        (frame,) = instant
        if frame is not None:
            self.taken_at[id(recorded.state)] = frame.time
        return recorded


class TimedPage(live_page.LivePage):
    """Measures how old the frames are whose marks it draws."""

    def __init__(self, jobs: Jobs) -> None:
        super().__init__(jobs)
        self.latencies: list[float] = []

    def _show_seen(self, seen: live_page._Seen) -> None:
        super()._show_seen(seen)
        self.view.repaint()
        taken_at = TimedRecorder.taken_at.pop(id(seen.recorded.state))
        self.latencies.append(1000 * (time.monotonic() - taken_at))


def measure_page(frames: list[np.ndarray]) -> None:
    """Photograph live for half a minute, and print how it keeps up."""
    live_page.Recorder = TimedRecorder  # type: ignore[misc]
    recording.open_source = lambda *_: Camera1080(frames)  # type: ignore[assignment, return-value]
    application = QApplication.instance() or QApplication([])
    assert isinstance(application, QApplication)
    jobs = Jobs()
    page = TimedPage(jobs)
    page.resize(1280, 720)
    page.show()
    page.limit.setValue(0.01)
    beats: list[tuple[float, float]] = []
    heart = QTimer(interval=BEAT)
    heart.timeout.connect(lambda: beats.append((time.monotonic(), time.thread_time())))
    loop = QEventLoop()
    QTimer.singleShot(round(1000 * SECONDS), loop.quit)
    with tempfile.TemporaryDirectory() as folder:
        page.folder = Path(folder) / "pictures"
        page.start.click()
        heart.start()
        begun = time.process_time(), time.thread_time()
        loop.exec()
        spent = time.process_time() - begun[0], time.thread_time() - begun[1]
        heart.stop()
        page.stop()
        while page.is_running:
            application.processEvents()
    gaps = 1000 * np.diff(np.array(beats), axis=0)
    latency = np.percentile(page.latencies, (50, 90))
    print(f"frames per second at 1080p        {len(page.latencies) / SECONDS:.1f}")
    print(f"frame to overlay, ms              {latency[0]:.0f} (nine in ten {latency[1]:.0f})")
    of_all, own = (1000 * each / len(page.latencies) for each in spent)
    print(f"processor for a frame, ms         {of_all:.1f}, of the window's own thread {own:.1f}")
    print(
        f"longest gap, ms                   {gaps[:, 0].max():.0f} by the clock, "
        f"{gaps[:, 1].max():.0f} of its own; {np.mean(gaps[:, 0] > LONG):.1%} above {LONG:.0f}"
    )
    print(f"pictures taken                    {page.strip.list.count()}")
    print(f"load of the machine               {os.getloadavg()[0]:.1f}", flush=True)


def measure_session(name: str, drawn: list[np.ndarray], count: int) -> None:
    """Let a session look at so many frames, and print what one takes and what it holds."""
    session = CaptureSession(lambda image: find_corners(image, BOARD.grid_size), 25.0, 1e-6)
    frames = itertools.cycle(drawn)
    taken = []
    for k in range(count):
        begun = time.process_time()
        session.observe(Frame(next(frames), k / FRAMES_PER_SECOND))
        taken.append(1000 * (time.process_time() - begun))
        if k + 1 in (WARM, count):
            print(f"MB after {k + 1:6d} frames            {measure_resident():.0f}", flush=True)
    warm = taken[min(WARM, count // 2) :]
    middle, most = np.percentile(warm, (50, 90))
    print(
        f"processor for a frame of {name}, ms {np.mean(warm):.1f} "
        f"(median {middle:.1f}, nine in ten {most:.1f}), {len(session.pictures)} taken"
    )


def measure_resident() -> float:
    """Measure the MB that are resident now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def main() -> None:
    """Measure the page, and then sessions."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--frames", type=int, default=10_000)
    options = parser.parse_args()
    frames = draw_frames(SIZES["1080p"])
    measure_page(frames)
    measure_session("1080p", frames, options.frames // 20)
    measure_session("VGA", draw_frames(SIZES["VGA"]), options.frames)


if __name__ == "__main__":
    main()
