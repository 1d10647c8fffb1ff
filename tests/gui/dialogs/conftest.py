"""A result to export."""

from __future__ import annotations

import pytest

from calibgui.dataset import Result
from tests.gui.panels.conftest import made


@pytest.fixture(scope="session")
def result() -> Result:
    """A calibration of synthetic corners."""
    return made()
