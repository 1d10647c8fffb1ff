"""What the tests of all kernels share."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import pytest

from calibgui.engine import kernels


@cache
def make_callable(part: Callable[..., Any]) -> Callable[..., Any]:
    """A part of kernels, compiled so that Python can call it too."""
    from calibgui.engine.kernels import common

    function: Callable[..., Any] = common.njit(error_model="numpy")(part.py_func)  # type: ignore[attr-defined]
    return function


@pytest.fixture(autouse=True)
def _compiled() -> None:
    """There is nothing to compare where nothing is compiled."""
    if not kernels.COMPILED:
        pytest.skip("numba is not installed")
