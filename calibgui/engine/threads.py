"""One thread for BLAS: it is the fastest on small matrices, and its results do not vary."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import cache, wraps
from typing import Any, ParamSpec, TypeVar

from threadpoolctl import ThreadpoolController

_P = ParamSpec("_P")
_T = TypeVar("_T")


@cache
def _find_blas() -> ThreadpoolController:
    """Return the controller of the libraries that are loaded; finding them takes milliseconds."""
    import scipy.linalg  # noqa: F401 - brings a BLAS of its own, which has to be there to be found

    return ThreadpoolController()


def limit_blas_threads() -> AbstractContextManager[Any]:
    """Limit NumPy's and SciPy's BLAS to one thread from now on, or to the end of a `with` block."""
    return _find_blas().limit(limits=1, user_api="blas")


def with_one_blas_thread(function: Callable[_P, _T]) -> Callable[_P, _T]:
    """Decorate a function to run on one BLAS thread: it then sums alike on every machine."""

    @wraps(function)
    def limited(*args: _P.args, **kwargs: _P.kwargs) -> _T:
        with limit_blas_threads():
            return function(*args, **kwargs)

    return limited
