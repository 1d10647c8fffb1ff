"""Compiled counterparts of readable code: same sums, tested against it, an order faster.

They need numba; ``COMPILED`` says whether it is there. Importing this package does not import
it, because that takes a third of a second.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

COMPILED = find_spec("numba") is not None
FINDER_SECONDS, SOLVER_SECONDS = 20, 8
"""About what compiling the kernels of either takes, once after an installation, s."""


@contextmanager
def when_compiling(tell: Callable[[], None]) -> Iterator[None]:
    """Call `tell` once if a kernel has to be compiled within, because none is kept from before.

    It imports numba, where that is there.
    """
    if not COMPILED:
        yield
        return
    from numba.core import event

    class Teller(event.Listener):  # type: ignore[misc]  # numba is not typed
        told = False

        def on_start(self, event: Any) -> None:  # noqa: ARG002 - numba's signature
            if not self.told:
                self.told = True
                tell()

        def on_end(self, event: Any) -> None:
            """What was told stands."""

    with event.install_listener("numba:compile", Teller()):
        yield
