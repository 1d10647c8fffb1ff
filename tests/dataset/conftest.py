"""A result to look into."""

from __future__ import annotations

import pytest

from calibgui.dataset import Result
from tests.engine import scenes
from tests.formats.conftest import solved


@pytest.fixture(scope="session")
def result() -> Result:
    """The paper's model."""
    return solved(scenes.barrel())
