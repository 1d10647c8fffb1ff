"""Latest frames: sources that are read beside whoever looks at their frames, paired by their times.

Looking at a frame takes longer than a camera waits, at times: after each picture the camera is
calibrated. Meanwhile the sources go on to be read, so that their newest frames can be shown and the
next ones that are looked at are not old ones.

The frames of several cameras are of one instant if none is older than the newest of them by more
than half the time from one frame of its camera to the next: a later one would be nearer. One camera
is the case of a single frame for each instant.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from threading import Condition, Thread

from calibgui.engine.capture.frame_sources import Frame, FrameSource
from calibgui.engine.errors import CalibrationError

Instant = tuple[Frame | None, ...]
"""The frame of each camera at one instant; None of one that sent none."""


class LatestFrames:
    """A source that a thread of its own reads.

    A live source is read as it sends, and frames that nobody asks for in time are passed over; of
    any other each frame waits until it is taken.

    Args:
        source: what is read, and closed at the end.
        changed: is notified of all that changes; it guards what is kept here.
    """

    def __init__(self, source: FrameSource, changed: Condition) -> None:
        self.source = source
        self.newest: Frame | None = None
        """The last frame that came; None before the first."""
        self.upcoming: Frame | None = None
        """The frame that was not taken yet; None if there is none."""
        self.interval = math.inf
        """Time from the last frame but one to the last one, s."""
        self.failure: Exception | None = None
        self.is_over = False
        """True if no frame will come any more."""
        self.is_silent = False
        """True if it was waited for in vain, until it sends again."""
        self._changed = changed
        self._thread = Thread(target=self._read_all, name="frames", daemon=True)
        self._thread.start()

    def take(self) -> Frame | None:
        """Take the frame that was not taken yet."""
        frame, self.upcoming = self.upcoming, None
        self._changed.notify_all()
        return frame

    def stop(self) -> None:
        """Let no frame come any more, without waiting for the source."""
        self.is_over, self.upcoming = True, None
        self._changed.notify_all()

    def close(self) -> None:
        """Release the device or the file, which may have to be waited for."""
        if not self.source.is_continuous:  # it would wait for the next photograph
            self.source.close()
        self._thread.join()
        self.source.close()

    def _read_all(self) -> None:
        """Read the source to its end; runs in the thread."""
        while not self.is_over:
            frame = failure = None
            try:
                frame = self.source.read()
            except Exception as error:  # whatever it is, it is raised where frames are asked for
                failure = error
            with self._changed:
                if not self.source.is_live:
                    self._changed.wait_for(lambda: self.upcoming is None or self.is_over)
                if frame is None or self.is_over:
                    self.failure, self.is_over = failure, True
                else:
                    if self.newest is not None:
                        self.interval = frame.time - self.newest.time
                    self.newest = self.upcoming = frame
                    self.is_silent = False
                self._changed.notify_all()


class PairedFrames:
    """The frames of one or several sources, instant by instant.

    A source that ends, fails or falls silent does not end the others.

    Args:
        sources: what is read, each in a thread of its own, and closed at the end.
        patience: time after which a live source that sends nothing is no longer waited for, s.

    Raises:
        CalibrationError: if one of several is a folder, whose photographs have no times.
    """

    def __init__(self, sources: Sequence[FrameSource], patience: float) -> None:
        for source in sources:
            if len(sources) > 1 and not source.is_continuous:
                raise CalibrationError(
                    f"{source.title} is a folder: its photographs cannot be paired by their times.",
                    "Name cameras or videos; 'calibgui rig' pairs photographs by their names.",
                )
        self._changed = Condition()
        self._patience = patience
        self.cameras = [LatestFrames(source, self._changed) for source in sources]
        self.remark = "\n".join(
            f"{source.title}: {source.remark}" if len(sources) > 1 else source.remark
            for source in sources
            if source.remark
        )
        """Lines on the sources' settings and what is wrong with them; empty if there are none."""

    @property
    def is_continuous(self) -> bool:
        """True if frames follow each other as in a film."""
        return all(camera.source.is_continuous for camera in self.cameras)

    @property
    def is_live(self) -> bool:
        """True if the light and the cameras can still be changed."""
        return any(camera.source.is_live for camera in self.cameras)

    def read(self) -> Instant | None:
        """Wait for the frames of the next instant; None if there are none any more.

        All are None where nothing came for too long.

        Raises:
            CalibrationError: if all sources have failed.
        """
        with self._changed:
            while self._wait_for_frames():
                times = [each.upcoming.time for each in self.cameras if each.upcoming is not None]
                old = [each for each in self.cameras if _is_old(each, max(times, default=0.0))]
                if not old:
                    return tuple(each.take() for each in self.cameras)
                for each in old:
                    each.take()
            failures = [each.failure for each in self.cameras]
        if failures[0] is not None and all(failures):
            raise failures[0]
        return None

    def list_absent(self) -> dict[int, str]:
        """List what is wrong with cameras that send nothing, by their numbers."""
        with self._changed:
            return {
                c: str(each.failure) if each.failure else f"{each.source.title} sends no images."
                for c, each in enumerate(self.cameras)
                if each.failure or each.is_silent
            }

    def stop(self) -> None:
        """Let no frame come any more, without waiting for the sources."""
        with self._changed:
            for camera in self.cameras:
                camera.stop()

    def close(self) -> None:
        """Release devices and files, which may have to be waited for."""
        self.stop()
        for camera in self.cameras:
            camera.close()

    def _wait_for_frames(self) -> bool:
        """Wait until all that send have sent; return False if nothing comes any more.

        A live source that was waited for too long counts as silent.
        """

        def list_running() -> list[LatestFrames]:
            return [each for each in self.cameras if each.upcoming or not each.is_over]

        def are_there() -> bool:
            running = list_running()
            waited = [each for each in running if not (each.upcoming or each.is_silent)]
            return not running or (not waited and any(each.upcoming for each in running))

        while not self._changed.wait_for(are_there, self._patience):
            missing = [each for each in list_running() if not each.upcoming]
            for each in missing:
                each.is_silent = each.source.is_live
            if all(each.is_silent for each in missing):
                break
        return bool(list_running())


def _is_old(camera: LatestFrames, newest: float) -> bool:
    """Return whether a camera's next frame will be nearer to the newest one's time."""
    frame = camera.upcoming
    return frame is not None and not camera.is_over and newest - frame.time > camera.interval / 2
