"""Compiled counterparts of readable code: same sums, tested against it, an order faster.

A readable function that has a kernel says so with the decorator `with_kernel`, and nothing else in
the engine chooses between the two: each call goes to the kernel where numba is installed, otherwise
to the readable reference, which stays within reach as ``function.reference``. A kernel takes the
same arguments, positional or by name, and returns the same to rounding (``tests/engine/kernels``).

``COMPILED`` says whether numba is there. Importing this package does not import it, because that
takes a third of a second; the module of a kernel is loaded at its first call.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import update_wrapper
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Generic, ParamSpec, TypeVar

COMPILED = find_spec("numba") is not None
FINDER_SECONDS, SOLVER_SECONDS = 20, 8
"""About what compiling the kernels of either takes, once after an installation, s."""


_P = ParamSpec("_P")
_T = TypeVar("_T")


class Kernelled(Generic[_P, _T]):
    """A readable function with a compiled counterpart; a call goes to whichever there is."""

    def __init__(self, reference: Callable[_P, _T], module: str, name: str) -> None:
        """
        Args:
            reference: the readable function.
            module: the module in this package that holds its kernel.
            name: the kernel's name there.
        """
        update_wrapper(self, reference)
        self.reference = reference
        self._module, self._name = module, name
        self._kernel: Callable[_P, _T] | None = None

    @property
    def kernel(self) -> Callable[_P, _T]:
        """The compiled counterpart, loaded when first asked for; needs numba."""
        if self._kernel is None:
            self._kernel = getattr(import_module(f"{__name__}.{self._module}"), self._name)
        return self._kernel

    def __call__(self, *args: _P.args, **kwargs: _P.kwargs) -> _T:
        """Call the kernel where numba is installed, otherwise the reference."""
        return (self.kernel if COMPILED else self.reference)(*args, **kwargs)


def with_kernel(module: str, name: str) -> Callable[[Callable[_P, _T]], Kernelled[_P, _T]]:
    """Decorate a readable function that has a kernel `name` in ``kernels.<module>``."""

    def decorate(reference: Callable[_P, _T]) -> Kernelled[_P, _T]:
        return Kernelled(reference, module, name)

    return decorate


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
