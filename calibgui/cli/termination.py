"""SIGTERM, which ends a command as Ctrl-C does: workers and temporary files are removed.

It is raised as an exception wherever the command is, so that every `with` block and every
`finally` on the way out does what it is for. Python drops exceptions that are raised in callbacks,
as when an object is freed: the request is made again a moment later, and nothing is printed. A
library may raise an error of its own in its place, as where it is being imported: `is_made` tells.
"""

from __future__ import annotations

import contextlib
import signal
import sys
from collections.abc import Iterator
from types import FrameType

_AGAIN_S = 0.01
"""Time after which a request is made again that was dropped, s."""


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
            elif hasattr(signal, "setitimer"):  # not on Windows
                signal.signal(signal.SIGALRM, self._end)
                signal.setitimer(signal.ITIMER_REAL, _AGAIN_S)

        sys.unraisablehook = hear_again
        try:
            yield
        finally:
            sys.unraisablehook = usual
            signal.signal(signal.SIGTERM, before)

    def _end(self, number: int, _: FrameType | None) -> None:
        self.is_made = True
        # What is removed on the way out is removed to the end.
        signal.signal(number, signal.SIG_IGN)
        raise Terminated
