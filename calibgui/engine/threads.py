"""One thread for BLAS: on small matrices it is the fastest, and its results never vary."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import cache, wraps
from typing import Any, ParamSpec, TypeVar

from threadpoolctl import ThreadpoolController

_P = ParamSpec("_P")
_T = TypeVar("_T")


@cache
def _controller() -> ThreadpoolController:
    """Of the libraries that are loaded; looking for them takes milliseconds."""
    import scipy.linalg  # noqa: F401 - brings a BLAS of its own, which has to be there to be found

    return ThreadpoolController()


def one_blas_thread() -> AbstractContextManager[Any]:
    """NumPy's and SciPy's BLAS have one thread from now on, or to the end of a `with` block."""
    return _controller().limit(limits=1, user_api="blas")


def on_one_blas_thread(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """`function` with one BLAS thread, so that it sums in the same order on every machine."""

    @wraps(function)
    def limited(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        with one_blas_thread():
            return function(*args, **kwargs)

    return limited
