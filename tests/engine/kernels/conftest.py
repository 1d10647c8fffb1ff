"""What the tests of all kernels share."""

from __future__ import annotations

import pytest

from calibgui.engine import kernels


@pytest.fixture(autouse=True)
def _compiled() -> None:
    """There is nothing to compare where nothing is compiled."""
    if not kernels.COMPILED:
        pytest.skip("numba is not installed")
