"""Compiled counterparts of readable code: same sums, tested against it, an order faster.

A readable function that has a kernel says so with the decorator `with_kernel`, and nothing else in
the engine chooses between the two: each call goes to the kernel where numba is installed, otherwise
to the readable reference, which stays within reach as ``function.reference``. A kernel takes the
same arguments, positional or by name, and returns the same to rounding (``tests/engine/kernels``).
A kernel that serves some arguments only, such as polynomial lenses, says so with a predicate.

``COMPILED`` says whether numba is there. Importing this package does not import it, because that
takes a third of a second; the module of a kernel is loaded at its first call. If numba turns out
to be unusable then, as after an update of NumPy that it does not know yet, a `NumbaWarning` says so
once, and the readable functions go on.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import update_wrapper
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Generic, ParamSpec, TypeVar

COMPILED = find_spec("numba") is not None
"""True if numba is installed, and was not found to be unusable."""
SOLVER_SECONDS = 15
"""Rough time, s, of compiling the kernels of the calibration, once after an installation."""

POLYNOMIAL_LENSES = {
    "lucchese": (0, 1, 2, 3, 4, 5, 6, 7, 8, 9),
    "pinhole": (0, 1, 2, 3),
    "brown-conrady-4": (0, 1, 2, 3, 4, 5, 8, 7, 10),  # k1 k2 p1 p2 skew; its p1 is eq. 10's p2
    "brown-conrady": (0, 1, 2, 3, 4, 5, 8, 7, 6, 10),  # k1 k2 p1 p2 k3 skew
}
"""Lens models that the calibration's kernels know, and the place of each camera parameter among
fx, fy, cx, cy, eq. 10's k1, k2, k3, p1, p2, p3 and skew (``kernels.polynomial_lens``)."""
RAY_LENSES = {
    "kannala-brandt": (0, 1, 2, 3, 4, 5, 6, 7),
    "kannala-brandt-decentering": (0, 1, 2, 3, 4, 5, 6, 7, 8, 9),
    "ucm": (0, 1, 2, 3, 5),
    "eucm": (0, 1, 2, 3, 5, 6),
    "double-sphere": (0, 1, 2, 3, 4, 5),
}
"""Lens models of rays in all directions that the kernels of the normal equations know, and the
place of each camera parameter among fx, fy, cx, cy and either k1, k2, k3, k4, p1, p2 or xi, alpha,
beta (``kernels.ray_lenses``)."""
COMPILED_LENSES = POLYNOMIAL_LENSES | RAY_LENSES
"""Lens models that have kernels of the normal equations with the image cost."""

_P = ParamSpec("_P")
_T = TypeVar("_T")


class NumbaWarning(RuntimeWarning):
    """A warning that numba is installed, but cannot be used."""


def can_compile() -> bool:
    """Import numba, and return whether it can be used; say so once if it is there and cannot."""
    global COMPILED
    if COMPILED:
        try:
            import_module(f"{__name__}.common")  # numba, and what is taken of its inside
        except Exception as error:  # its versions of NumPy, its compiler's library
            COMPILED = False
            warnings.warn(
                f"numba is installed but cannot be used ({error}). Everything works without it, "
                "five to ten times slower; pip install --upgrade numba may help.",
                NumbaWarning,
                stacklevel=2,
            )
    return COMPILED


class Kernelled(Generic[_P, _T]):
    """A readable function with a compiled counterpart; a call goes to the one that serves it."""

    def __init__(
        self,
        reference: Callable[_P, _T],
        module: str,
        name: str,
        serves: Callable[..., bool] | None = None,
    ) -> None:
        """Pair a readable function with its kernel.

        Args:
            reference: the readable function.
            module: the module in this package that holds its kernel.
            name: the kernel's name there.
            serves: a predicate on the same arguments, true if the kernel serves them; it serves
                all arguments if this is None.
        """
        update_wrapper(self, reference)
        self.reference = reference
        self._module, self._name, self._serves = module, name, serves
        self._kernel: Callable[_P, _T] | None = None

    @property
    def kernel(self) -> Callable[_P, _T]:
        """The compiled counterpart, loaded at its first use; it needs numba."""
        if self._kernel is None:
            self._kernel = getattr(import_module(f"{__name__}.{self._module}"), self._name)
        return self._kernel

    def __call__(self, *args: _P.args, **kwargs: _P.kwargs) -> _T:
        """Call the kernel if numba is installed and it serves the arguments, else the reference."""
        is_served = COMPILED and (self._serves is None or self._serves(*args, **kwargs))
        if is_served and self._kernel is not None:
            return self._kernel(*args, **kwargs)
        if is_served and can_compile():
            return self.kernel(*args, **kwargs)
        return self.reference(*args, **kwargs)


def with_kernel(
    module: str, name: str, serves: Callable[..., bool] | None = None
) -> Callable[[Callable[_P, _T]], Kernelled[_P, _T]]:
    """Decorate a readable function that has a kernel `name` in ``kernels.<module>``.

    Args:
        module: the module in this package.
        name: the kernel's name there.
        serves: a predicate on the function's arguments, true if the kernel serves them; it serves
            all arguments if this is None.
    """

    def decorate(reference: Callable[_P, _T]) -> Kernelled[_P, _T]:
        return Kernelled(reference, module, name, serves)

    return decorate


@contextmanager
def when_compiling(notify: Callable[[], None]) -> Iterator[None]:
    """Call `notify` once if a kernel has to be compiled in the `with` block.

    Kernels are compiled once and then kept on disk. Entering the block imports numba, if it is
    installed.
    """
    if not can_compile():
        yield
        return
    from numba.core import event

    class Notifier(event.Listener):  # type: ignore[misc]  # numba is not typed
        has_notified = False

        def on_start(self, event: Any) -> None:  # noqa: ARG002 - numba's signature
            if not self.has_notified:
                self.has_notified = True
                notify()

        def on_end(self, event: Any) -> None:
            """Do nothing: one notification is enough."""

    with event.install_listener("numba:compile", Notifier()):
        yield
