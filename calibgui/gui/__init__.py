"""The window: the only part of the program that imports Qt.

PySide puts an import of its own in the place of Python's, for ``from __feature__ import``, which
nobody here uses. It would read the source of all that is imported later, in an eighth of the time
until the window is there; so Python's own is put back.
"""

from __future__ import annotations

import builtins
from importlib import import_module

_pythons_own = builtins.__import__
import_module("PySide6.QtCore")
builtins.__import__ = _pythons_own
