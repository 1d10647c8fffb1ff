"""The program's own files."""

from __future__ import annotations

import pytest

from calibgui.app.resources import resource
from calibgui.engine import CalibrationError


def test_a_resource_is_found_in_this_checkout() -> None:
    assert resource("schema").is_dir()


def test_a_missing_resource_is_named() -> None:
    with pytest.raises(CalibrationError, match=r"nothing\.png"):
        resource("nothing.png")
