"""The window answers while it works: the longest gap between two beats of a timer."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QTimer
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.projects.project import Project, add_result
from calibgui.app.projects.project_file import write_project
from calibgui.dataset import CornerSet
from calibgui.gui.panels.method.synthetic import SyntheticPanel
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples
from tests.engine import scenes

pytestmark = pytest.mark.slow

LIMIT = 0.25
"""Longest gap, s, on a slow machine; 0.1 is aimed at."""


@pytest.fixture(autouse=True)
def search_in_threads() -> None:
    """Photographs are searched in processes, as they are for the user."""


@contextmanager
def heartbeat(what: str) -> Iterator[None]:
    """Measure the gaps while the block runs the event loop.

    Of a gap counts what this program computed in it, in any of its threads: one of them may hold
    the interpreter's lock. The rest went to other programs on the same processors.
    """
    beats = [(time.monotonic(), time.process_time())]
    timer = QTimer(interval=5)
    timer.timeout.connect(lambda: beats.append((time.monotonic(), time.process_time())))
    timer.start()
    yield
    timer.stop()
    beats.append((time.monotonic(), time.process_time()))
    gaps = [(b[0] - a[0], min(b[0] - a[0], b[1] - a[1])) for a, b in pairwise(beats)]
    whole, own = (1000 * max(gap[k] for gap in gaps) for k in (0, 1))
    seconds = beats[-1][0] - beats[0][0]
    print(f"\n{what}: longest gap {whole:.0f} ms, of its own {own:.0f} ms, in {seconds:.1f} s")
    assert own < 1000 * LIMIT, f"{what} stopped the window for {own:.0f} ms"


def prepare(window: MainWindow, qtbot: QtBot) -> None:
    """Import all that is needed, as after the window's first moments."""
    gc.unfreeze()
    window.preparation.start()
    qtbot.waitUntil(lambda: gc.get_freeze_count() > 0, timeout=30_000)


@pytest.mark.data
def test_while_the_papers_images_are_calibrated_and_checked(
    window: MainWindow, qtbot: QtBot, bouguet: Path
) -> None:
    prepare(window, qtbot)
    images = [str(bouguet / f"Image{k}.tif") for k in range(1, 26, 4)]
    begun = time.monotonic()
    with heartbeat("searching and calibrating 7 images"):
        window.files.open_paths(images)
        qtbot.waitUntil(lambda: window.session.result is not None, timeout=200_000)
    print(f"calibrated after {time.monotonic() - begun:.1f} s")
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=30_000)
    assert window.analysis is not None
    panel = window.analysis.show_panel(SyntheticPanel)
    qtbot.wait(200)
    with heartbeat("the synthetic check"):
        panel.run.click()
        qtbot.waitUntil(lambda: panel.found is not None, timeout=400_000)


def test_while_a_project_of_200_images_is_opened_and_calibrated(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    project = many_views(200, tmp_path)
    path = tmp_path / "project.json"
    write_project(project, path)
    prepare(window, qtbot)
    with heartbeat(f"opening 200 images ({path.stat().st_size / 1e6:.0f} MB)"):
        window.files.open_project(path)
        qtbot.waitUntil(lambda: len(window.session.project.views) == 200, timeout=60_000)
        qtbot.wait(300)
    with heartbeat("calibrating 200 views"):
        window.calibrate.click()
        qtbot.waitUntil(lambda: len(window.session.project.results) == 2, timeout=60_000)


def many_views(count: int, folder: Path) -> Project:
    """A project with `count` views of 108 corners and a result, without image files."""
    scene = scenes.scene(scenes.barrel(), count, seed=1)
    observations = scene.noisy(0.1, np.random.default_rng(1))
    template = examples.views(folder)[0]
    assert template.corners is not None
    views = []
    for k, observation in enumerate(observations):
        grid = (observation.xy[:, ::-1] / scenes.BOARD.square).round()
        corners = replace(
            template.corners, shape=(9, 12), grid=grid, uv=observation.uv, estimate=observation.uv
        )
        views.append(replace(template, image=str(folder / f"{k}.png"), corners=corners))
    project = Project(views=tuple(views), size=scene.size)
    corner_set = CornerSet(scene.size, project.views, project.board)
    return add_result(project, "Calibration 1", calibrate_views(corner_set))


def test_an_empty_window_is_there_at_once(tmp_path: Path) -> None:
    """Reported, and bounded generously: machines differ and this one may be busy."""
    code = (
        "import gc, time; begun = time.monotonic(), time.process_time()\n"
        "gc.disable()\n"  # as the command line does while it loads the window
        "from calibgui.gui.app import MainWindow, QApplication, theme\n"
        "gc.freeze(); gc.enable()\n"
        "app = QApplication([])\n"
        "theme.apply(app, theme.Scheme.LIGHT)\n"
        "window = MainWindow(); window.show(); app.processEvents()\n"
        "print(time.monotonic() - begun[0], time.process_time() - begun[1])\n"
        "window.close()\n"
        "import sys\n"
        "parts = ('linalg', 'ndimage', 'optimize', 'sparse', 'spatial', 'special', 'stats')\n"
        "heavy = {'scipy.' + part for part in parts}\n"
        "heavy |= {'numba', 'pyqtgraph', 'matplotlib', 'urllib.request'}\n"
        "heavy |= {'calibgui.engine.detection.find_corners'}\n"
        "heavy |= {'calibgui.engine.redetection.redetect_corners'}\n"
        "heavy &= set(sys.modules)\n"
        "assert not heavy, heavy\n"
        "assert 'feature' not in __import__.__name__\n"  # PySide's, which reads all sources
    )
    env = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    env |= dict.fromkeys(("XDG_STATE_HOME", "XDG_CONFIG_HOME"), str(tmp_path))
    env["PYTHONPYCACHEPREFIX"] = str(tmp_path)  # warm: the first run leaves its bytecode
    env.pop("PYTHONDONTWRITEBYTECODE", None)
    runs = [
        subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, check=True)
        for _ in range(3)
    ]
    wall, own = min(tuple(map(float, run.stdout.split())) for run in runs)
    print(f"\nfirst paint after {wall:.2f} s, of its own {own:.2f} s")
    assert own < 2.0
