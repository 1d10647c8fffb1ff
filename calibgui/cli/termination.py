"""SIGTERM, which ends a command as Ctrl-C does: workers and temporary files are removed.

It is raised as an exception wherever the command is, so that every `with` block and every
`finally` on the way out does what it is for. It waits while a module is imported, where a library
may take it for a fault of its own parts. Python drops exceptions that are raised in callbacks, as
when an object is freed: the request is made again a moment later, and nothing is printed. A library
may raise an error of its own in its place: `is_made` tells.
"""

from __future__ import annotations

import contextlib
import signal
import sys
from collections.abc import Iterator
from types import FrameType

_AGAIN_S = 0.01
"""Time after which a request is made again that was dropped or came during an import, s."""
_IMPORT = "<frozen importlib._bootstrap>"
"""Name of the file of Python's own import, as its frames tell it."""
_CAN_WAIT = hasattr(signal, "setitimer")
"""True if the system has a clock that signals; Windows has none."""


class Terminated(KeyboardInterrupt):
    """A request to end."""


class TerminationRequest:
    """Tells whether the program was asked to end."""

    def __init__(self) -> None:
        self.is_made = False

    @contextlib.contextmanager
    def heed(self) -> Iterator[None]:
        """Raise `Terminated` in the `with` block when SIGTERM comes; further ones change nothing.

        Elsewhere than in the main thread nothing can be heeded.
        """
        try:
            before = signal.signal(signal.SIGTERM, self._end)
        except ValueError:
            yield
            return
        usual = sys.unraisablehook

        def hear_again(dropped: sys.UnraisableHookArgs) -> None:
            if not issubclass(dropped.exc_type, Terminated):
                usual(dropped)
            elif _CAN_WAIT:
                self._make_again()

        sys.unraisablehook = hear_again
        try:
            yield
        finally:
            sys.unraisablehook = usual
            signal.signal(signal.SIGTERM, before)

    def _end(self, number: int, frame: FrameType | None) -> None:
        self.is_made = True
        # What is removed on the way out is removed to the end.
        signal.signal(number, signal.SIG_IGN)
        if _CAN_WAIT and _is_import(frame):
            self._make_again()
        else:
            raise Terminated

    def _make_again(self) -> None:
        """Make the request once more in a moment."""
        signal.signal(signal.SIGALRM, self._end)
        signal.setitimer(signal.ITIMER_REAL, _AGAIN_S)


def _is_import(frame: FrameType | None) -> bool:
    """Return whether a frame or one of its callers imports a module."""
    while frame is not None:
        if frame.f_code.co_filename == _IMPORT:
            return True
        frame = frame.f_back
    return False
