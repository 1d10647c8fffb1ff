"""Faces load a file when one of its names is first asked for, whatever was loaded before."""

from __future__ import annotations

import subprocess
import sys

from calibgui import engine
from calibgui.engine import boards


def test_a_face_loads_what_is_asked_for() -> None:
    code = (
        "import sys\n"
        "from calibgui.engine import calibration, detection\n"
        "from calibgui.engine.features import MIN_LINES\n"
        "assert 'calibgui.engine.features.lattice' in sys.modules\n"
        "heavy = 'calibgui.engine.detection.find_corners', 'calibgui.engine.calibration.refit'\n"
        "assert not set(heavy) & set(sys.modules)\n"
        # A function that has its file's name, before and after the file is loaded.
        "import calibgui.engine.detection.find_corners\n"
        "assert callable(detection.find_corners)\n"
        "assert callable(calibration.refit) and callable(calibration.refit)\n"
        "assert 'look_for_marks' in dir(detection) and 'corners' not in dir(detection)\n"
        "assert not hasattr(detection, 'find_nothing')\n"
        "from calibgui.engine.detection import *\n"
        "assert look_for_marks is detection.look_for_marks\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_faces_offer_every_pattern_of_a_board() -> None:
    for pattern in boards.KINDS.values():
        name = type(pattern).__name__
        assert getattr(boards, name) is getattr(engine, name) is type(pattern)
