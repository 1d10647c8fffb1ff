"""What another thread imports finds Qt's classes made."""

from __future__ import annotations

import subprocess
import sys

_SCRIPT = """
from PySide6 import QtCore, QtGui, QtSvg, QtWidgets
from PySide6.QtCore import QCoreApplication, QTimer
from calibgui.gui.jobs import qt_names

modules = (QtCore, QtGui, QtSvg, QtWidgets)
unmade = lambda: sum(name not in vars(m) for m in modules for name in dir(m))
app = QCoreApplication([])
assert unmade() > 0, "PySide makes its classes at once: nothing is to be done"
turns = []
beat = QTimer(interval=0)
beat.timeout.connect(lambda: turns.append(unmade()))
beat.start()
qt_names.make_classes(app, app.quit)
app.exec()
assert unmade() == 0
assert len(set(turns)) > 2, "all in one turn"
"""


def test_all_are_made_a_few_in_each_turn() -> None:
    run = subprocess.run(
        [sys.executable, "-c", _SCRIPT], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
