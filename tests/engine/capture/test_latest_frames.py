"""Sources are read beside whoever looks: nothing old is shown, nothing that waits is lost, and the
frames of several are paired by their times."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest

from calibgui.engine.capture.frame_sources import Frame
from calibgui.engine.capture.latest_frames import Instant, PairedFrames
from calibgui.engine.errors import CalibrationError

COUNT = 6


class Numbered:
    """A source of frames whose times count them."""

    title, remark = "numbers", ""
    is_continuous = True

    def __init__(self, is_live: bool, failure: CalibrationError | None = None) -> None:
        self.is_live, self.is_open = is_live, True
        self._failure, self._count = failure, 0
        self.has_ended = threading.Event()

    def read(self) -> Frame | None:
        if self._count == COUNT:
            self.has_ended.set()
            if self._failure is not None:
                raise self._failure
            return None
        self._count += 1
        return Frame(np.zeros((2, 2), np.uint8), float(self._count))

    def close(self) -> None:
        self.is_open = False


class Timed(Numbered):
    """A film whose frames have these times; it stops for a while before the last one."""

    def __init__(self, times: list[float], stall: float = 0.0, *, is_live: bool = False) -> None:
        super().__init__(is_live)
        self._times, self._stall = iter(times), stall
        self._left = len(times)

    def read(self) -> Frame | None:
        self._left -= 1
        if not self._left:
            time.sleep(self._stall)
        at = next(self._times, None)
        return None if at is None else Frame(np.zeros((2, 2), np.uint8), at)


def list_times(instant: Instant) -> list[float | None]:
    return [None if frame is None else frame.time for frame in instant]


def test_every_frame_of_a_film_is_given() -> None:
    source = Numbered(is_live=False)
    frames = PairedFrames([source], 5.0)
    assert [*map(list_times, iter(frames.read, None))] == [[1], [2], [3], [4], [5], [6]]
    frames.close()
    assert not source.is_open


def test_of_a_camera_only_the_newest_is_given() -> None:
    source = Numbered(is_live=True)
    frames = PairedFrames([source], 5.0)
    assert source.has_ended.wait(5.0)
    given = list(iter(frames.read, None))
    assert [*map(list_times, given)] == [[COUNT]]
    assert frames.cameras[0].newest is given[0][0]
    frames.close()


def test_a_failure_is_raised_after_the_last_frame() -> None:
    failure = CalibrationError("It stopped.", "")
    frames = PairedFrames([Numbered(is_live=True, failure=failure)], 5.0)
    assert frames.read() is not None
    with pytest.raises(CalibrationError, match="It stopped"):
        for _ in range(COUNT):
            frames.read()
    frames.close()


def test_who_waits_for_a_frame_is_let_go() -> None:
    class Silent(Numbered):
        def read(self) -> Frame | None:
            self.has_ended.wait(10.0)
            return None

    source = Silent(is_live=True)
    frames = PairedFrames([source], 5.0)
    threading.Timer(0.05, frames.stop).start()
    begun = time.monotonic()
    assert frames.read() is None
    assert time.monotonic() - begun < 5.0
    source.has_ended.set()
    frames.close()


def test_frames_of_two_films_are_paired_by_their_times() -> None:
    fast, slow = Timed([0.0, 0.1, 0.2, 0.3, 0.4, 0.5]), Timed([0.02, 0.22, 0.43])
    frames = PairedFrames([fast, slow], 5.0)
    given = [*map(list_times, iter(frames.read, None))]
    frames.close()
    assert given == [[0.0, 0.02], [0.2, 0.22], [0.4, 0.43], [0.5, None]]


def test_a_camera_that_fails_ends_no_other() -> None:
    failing = Numbered(is_live=False, failure=CalibrationError("It stopped.", "Look at it."))
    going = Timed([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0])
    frames = PairedFrames([failing, going], 5.0)
    given = [*map(list_times, iter(frames.read, None))]
    assert given[:6] == [[k, k] for k in range(1, 7)]
    assert given[6:] == [[None, 7.0], [None, 8.0]]
    assert frames.list_absent() == {0: "It stopped. Look at it."}
    frames.close()


def test_a_camera_that_falls_silent_is_named_until_it_sends_again() -> None:
    silent = Timed([0.0, 9.0], stall=1.0, is_live=True)
    frames = PairedFrames([silent, Timed([0.0, 3.0, 6.0, 9.0])], 0.2)
    assert list_times(frames.read() or ()) == [0.0, 0.0]
    assert list_times(frames.read() or ()) == [None, 3.0]
    assert frames.list_absent() == {0: "numbers sends no images."}
    time.sleep(1.5)
    frames.read()
    assert not frames.list_absent()
    frames.close()


def test_a_folder_beside_a_camera_is_refused() -> None:
    folder = Numbered(is_live=False)
    folder.is_continuous = False
    with pytest.raises(CalibrationError, match="numbers is a folder"):
        PairedFrames([folder, Numbered(is_live=True)], 1.0)
