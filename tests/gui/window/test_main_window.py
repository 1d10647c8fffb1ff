"""The window as a whole: what it imports beside the main thread."""

from __future__ import annotations

from importlib.util import find_spec

from calibgui.gui.window import main_window


def test_every_module_that_is_imported_soon_exists() -> None:
    missing = [name for name in main_window._NEEDED_SOON if find_spec(name) is None]
    assert missing == []
    assert len(main_window._NEEDED_SOON) > 2
