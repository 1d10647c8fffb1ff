"""Latest frames: a source that is read beside whoever looks at its frames.

Looking at a frame takes longer than a camera waits, at times: after each picture the camera is
calibrated. Meanwhile the source goes on to be read, so that its newest frame can be shown and the
next one that is looked at is not an old one.
"""

from __future__ import annotations

from threading import Condition, Thread

from calibgui.engine.capture.frame_sources import Frame, FrameSource


class LatestFrames:
    """A source that a thread of its own reads, and that is a source itself.

    A live source is read as it sends, and frames that nobody asks for in time are passed over; of
    any other each frame waits until it is asked for.

    Args:
        source: what is read, and closed at the end.
    """

    def __init__(self, source: FrameSource) -> None:
        self.title = source.title
        self.is_continuous, self.is_live = source.is_continuous, source.is_live
        self.newest: Frame | None = None
        """The last frame that came; None before the first."""
        self._source = source
        self._changed = Condition()
        self._next: Frame | None = None
        self._failure: Exception | None = None
        self._is_over = False
        self._thread = Thread(target=self._read_all, name="frames", daemon=True)
        self._thread.start()

    def read(self) -> Frame | None:
        """Wait for a frame that was not given yet; None if there is none any more.

        Raises:
            CalibrationError: if the source has failed.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._next is not None or self._is_over)
            frame, self._next = self._next, None
            self._changed.notify_all()
            if frame is None and self._failure is not None:
                raise self._failure
            return frame

    def stop(self) -> None:
        """Let no frame come any more, without waiting for the source."""
        with self._changed:
            self._is_over, self._next = True, None
            self._changed.notify_all()

    def close(self) -> None:
        """Release the device or the file, which may have to be waited for."""
        self.stop()
        if not self.is_continuous:  # it would wait for the next photograph
            self._source.close()
        self._thread.join()
        self._source.close()

    def _read_all(self) -> None:
        """Read the source to its end; runs in the thread."""
        while not self._is_over:
            frame = failure = None
            try:
                frame = self._source.read()
            except Exception as error:  # whatever it is, it is raised where frames are asked for
                failure = error
            with self._changed:
                if not self.is_live:
                    self._changed.wait_for(lambda: self._next is None or self._is_over)
                if frame is None or self._is_over:
                    self._failure, self._is_over = failure, True
                else:
                    self.newest = self._next = frame
                self._changed.notify_all()
