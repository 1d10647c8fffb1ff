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

Nobody waits for the compiler: until a module's kernels are kept on disk the readable functions
work. They are compiled in a `compile_missing` block, which ``calibgui prepare``, set-up and the
window enter, and where the readable functions have taken as long as compiling would: who rents
until the rent has reached the price never pays more than twice the least (Karlin, Manasse, Rudolph
and Sleator, Competitive snoopy caching, Algorithmica 3, 1988).
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import update_wrapper
from importlib import import_module
from importlib.util import find_spec
from pkgutil import iter_modules
from typing import Any, Generic, ParamSpec, TypeVar

import numpy as np

COMPILED = find_spec("numba") is not None
"""True if numba is installed, and was not found to be unusable."""
_PRICE_SECONDS = 3.0
"""Time of the processor, s, that compiling a module of kernels counts as: the mean of some 25 that
take 80 s together (`calibgui prepare`)."""

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
place of each camera parameter among fx, fy, cx, cy and the coefficients of its kind
(``kernels.cameras.CameraTuple``)."""
QUOTIENT_LENSES = {"rational": (*range(12), 16), "thin-prism": tuple(range(17))}
"""Lens models whose radial part is a quotient, and the place of each camera parameter likewise."""
COMPILED_LENSES = POLYNOMIAL_LENSES | RAY_LENSES | QUOTIENT_LENSES
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
            self._kernel = getattr(_import_kernels(self._module), self._name)
        return self._kernel

    def __call__(self, *args: _P.args, **kwargs: _P.kwargs) -> _T:
        """Call the kernel if it is ready and serves the arguments, else the reference."""
        is_served = COMPILED and (self._serves is None or self._serves(*args, **kwargs))
        if is_served and self._kernel is not None:
            return self._kernel(*args, **kwargs)
        if not is_served or not can_compile():
            return self.reference(*args, **kwargs)
        if _is_worth_loading(self._module):
            return self.kernel(*args, **kwargs)
        result: _T = self._count(self.reference)(*args, **kwargs)
        return result

    def _count(self, readable: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that adds its time to its module's, as do functions that it returns."""

        def run(*args: Any, **kwargs: Any) -> Any:
            begin = time.thread_time()
            with np.errstate(all="ignore"):  # nor do kernels tell of what is not finite
                result = readable(*args, **kwargs)
            spent = time.thread_time() - begin
            _spent[self._module] = _spent.get(self._module, 0.0) + spent
            return self._count(result) if callable(result) else result

        return run


_spent: dict[str, float] = {}
"""Time, s, that readable functions took in this process in place of each module's kernels."""
_missed: dict[str, int] = {}
"""State of the place of kept kernels when those of a module were looked for in vain."""
_is_compiling = False
"""True if kernels that are called are compiled (`compile_missing`)."""


def _import_kernels(module: str) -> Any:
    return import_module(f"{__name__}.{module}")


def _is_worth_loading(module: str) -> bool:
    """Return whether the kernels of a module are kept, or are to be compiled now."""
    if _is_compiling or _spent.get(module, 0.0) >= _PRICE_SECONDS:
        return True
    keeping = _import_kernels("common")
    state = keeping.read_keeping_state()
    if _missed.get(module) == state:
        return False
    if keeping.are_kept(_import_kernels(module)):
        return True
    _missed[module] = state
    return False


def are_all_kept() -> bool:
    """Return whether every kernel is kept on disk; true where there is no numba to compile them.

    It loads all modules of kernels, which takes half a second.
    """
    if not can_compile():
        return True
    modules = [_import_kernels(each.name) for each in iter_modules(__path__)]
    return all(map(_import_kernels("common").are_kept, modules))


def was_any_missed() -> bool:
    """Return whether readable functions worked in this process whose kernels were not kept."""
    return bool(_missed)


@contextmanager
def compile_missing() -> Iterator[None]:
    """Compile all kernels that are called in the `with` block and are not kept on disk yet."""
    global _is_compiling
    before, _is_compiling = _is_compiling, True
    try:
        yield
    finally:
        _is_compiling = before


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
