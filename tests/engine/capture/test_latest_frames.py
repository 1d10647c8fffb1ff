"""A source is read beside whoever looks: nothing old is shown, and nothing that waits is lost."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest

from calibgui.engine.capture.frame_sources import Frame
from calibgui.engine.capture.latest_frames import LatestFrames
from calibgui.engine.errors import CalibrationError

COUNT = 6


class Numbered:
    """A source of frames whose times count them."""

    title = "numbers"
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


def test_every_frame_of_a_film_is_given() -> None:
    source = Numbered(is_live=False)
    frames = LatestFrames(source)
    assert [frame.time for frame in iter(frames.read, None)] == [1, 2, 3, 4, 5, 6]
    frames.close()
    assert not source.is_open


def test_of_a_camera_only_the_newest_is_given() -> None:
    source = Numbered(is_live=True)
    frames = LatestFrames(source)
    assert source.has_ended.wait(5.0)
    given = list(iter(frames.read, None))
    assert [frame.time for frame in given] == [COUNT]
    assert frames.newest is given[0]
    frames.close()


def test_a_failure_is_raised_after_the_last_frame() -> None:
    frames = LatestFrames(Numbered(is_live=True, failure=CalibrationError("It stopped.", "")))
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
    frames = LatestFrames(source)
    threading.Timer(0.05, frames.stop).start()
    begun = time.monotonic()
    assert frames.read() is None
    assert time.monotonic() - begun < 5.0
    source.has_ended.set()
    frames.close()
