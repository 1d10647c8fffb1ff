"""Whether a kernel has to be compiled is told, and only when it is so."""

from __future__ import annotations

import pytest

from calibgui.engine import kernels
from calibgui.engine.kernels import when_compiling

numba = pytest.importorskip("numba", reason="numba is not installed")


def test_only_a_kernel_that_is_not_there_yet_is_told() -> None:
    told: list[str] = []
    one, other = numba.njit(lambda x: x + 1), numba.njit(lambda x: x + 2)
    with when_compiling(lambda: told.append("first")):
        assert (one(1), other(1)) == (2, 3)
    assert told == ["first"]
    with when_compiling(lambda: told.append("second")):
        assert (one(1), other(1)) == (2, 3)
    assert numba.njit(lambda x: x + 3)(1) == 4
    assert told == ["first"]


def test_without_numba_there_is_nothing_to_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernels, "COMPILED", False)
    told: list[None] = []
    with when_compiling(lambda: told.append(None)):
        numba.njit(lambda x: x + 1)(1)
    assert told == []
