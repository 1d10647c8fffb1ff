"""Every kind of button on a finding is clicked, and does what it says on a real calibration."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.calibrating.true_board import GLASS
from calibgui.app.projects.document import Document
from calibgui.app.projects.lengths import confirm_lengths
from calibgui.app.projects.project import Project, record_result
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.camera import Camera
from calibgui.engine.features.corners import Corners
from calibgui.gui.verdict.before_after import BeforeAndAfter
from calibgui.gui.window.main_window import MainWindow
from tests.engine import scenes
from tests.faults.sets import change_camera, project_corners

LEFT = Qt.MouseButton.LeftButton
BOARD = Board(rows=6, cols=7, square=30.0)
CAMERA = scenes.example("brown-conrady")


def photograph(
    camera: Camera,
    count: int,
    *,
    first: int = 0,
    noise: float = 0.05,
    fill: tuple[float, float] = (0.5, 0.7),
) -> tuple[View, ...]:
    """Views of a board."""
    rng = np.random.default_rng(5 + first)
    xy = BOARD.points()
    points = np.column_stack([xy, np.zeros(len(xy))])
    grid = np.rint(xy[:, ::-1] / BOARD.square)
    views = []
    for k in range(first, first + count):
        pose = scenes.looking(camera, rng, fill=fill, board=BOARD)
        uv = project_corners(camera, pose, points) + rng.normal(0, noise, xy.shape)
        corners = Corners((6, 7), grid, uv, np.rint(uv), method="saddle")
        views.append(View(f"/none/{k}.png", ViewStatus.FOUND, corners=corners))
    return tuple(views)


def make_project(
    views: tuple[View, ...],
    model: str = "brown-conrady",
    size: tuple[int, int] = CAMERA.size,
    *,
    lengths_confirmed: bool = True,
) -> Project:
    """A project of these views with their calibration."""
    settings = Settings(model=model)
    project = Project(
        views=views, size=size, settings=settings, lengths_confirmed=lengths_confirmed
    )
    result = calibrate_views(CornerSet(size, views, BOARD), settings)
    return record_result(
        replace(project, results=MappingProxyType({})), "Calibration 1", views, result
    )


class Case(NamedTuple):
    """A trouble, the button that mends it, and what it changes."""

    make: Callable[[], Project]
    button: str
    is_done: Callable[[Project], bool]


_ZOOMED = change_camera(CAMERA, fx=1.15, fy=1.15)
CASES = {
    "lens": Case(
        lambda: make_project(photograph(CAMERA, 8), "pinhole"),
        "Take the lens model that fits",
        lambda p: p.settings.model not in (None, "pinhole"),
    ),
    "views": Case(
        lambda: make_project((*photograph(CAMERA, 8), *photograph(_ZOOMED, 2, first=8))),
        "Leave 8 and 1 more out",
        lambda p: [v.enabled for v in p.views] == [True] * 8 + [False] * 2,
    ),
    "coefficients": Case(
        lambda: make_project(photograph(CAMERA, 6, noise=0.3, fill=(0.2, 0.3)), "rational"),
        "Hold k",
        lambda p: set(p.settings.fixed.values()) == {0.0},
    ),
}


def begin(window: MainWindow, qtbot: QtBot, project: Project) -> None:
    window.session.begin(Document(project))
    qtbot.waitUntil(
        lambda: window.verdict.verdict is not None and not window.session.jobs.running,
        timeout=60_000,
    )


@pytest.mark.parametrize(
    ("name", "keeps"), [("lens", True), ("views", False), ("coefficients", True)]
)
def test_an_action_is_shown_before_and_after_and_kept_or_taken_back(
    window: MainWindow, qtbot: QtBot, name: str, keeps: bool
) -> None:
    case = CASES[name]
    project = case.make()
    begin(window, qtbot, project)
    bar, session = window.verdict, window.session
    assert bar.button.isVisible() and bar.button.text().startswith(case.button)
    label, headline = bar.button.text(), bar.headline.text()
    before = bar.verdict
    assert before is not None

    qtbot.mouseClick(bar.button, LEFT)
    assert not bar.button.isEnabled()  # while it runs
    qtbot.waitUntil(
        lambda: (
            bar.comparison is not None and bar.comparison.isVisible() and not session.jobs.running
        ),
        timeout=60_000,
    )
    shown = bar.comparison
    assert isinstance(shown, BeforeAndAfter)
    after = bar.verdict
    assert after is not None and after.error.covered < before.error.covered
    assert shown.title.text().startswith(f"{label}: the error where there are corners is ")
    assert shown.title.text().endswith(" times smaller")
    cells = shown.errors.model()
    covered = [float(cells.index(1, column).data()) for column in (1, 2)]
    stated = [before.error.covered, after.error.covered]
    assert covered == pytest.approx(stated, rel=0.05)  # two digits
    assert shown.parameters.model().rowCount() >= 4
    bar.square.show()  # as it stands there until the length is confirmed
    window.resize(960, 500)  # a screen of 1920 x 1080 px at twice the scale
    qtbot.waitUntil(lambda: shown.width() == window.pages.width() < 700)
    qtbot.waitUntil(lambda: shown.errors.geometry().bottom() < shown.parameters.geometry().top())
    assert case.is_done(session.project) and len(session.project.results) == 2
    qtbot.mouseClick(shown.keep if keeps else shown.back, LEFT)
    assert not shown.isVisible()
    if keeps:
        assert case.is_done(session.project) and session.document.undo_label == label
        session.document.undo()
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
    assert session.project is project and bar.headline.text() == headline


def test_look_at_shows_the_view(window: MainWindow, qtbot: QtBot) -> None:
    width, height = CAMERA.size
    views = photograph(CAMERA, 8)
    project = make_project(views, size=(2 * width + 200, 2 * height + 200))
    begin(window, qtbot, project)
    bar = window.verdict
    assert bar.headline.text() == "NOT USABLE"
    assert "upper left quarter" in bar.reason.text()
    window.session.select(views[5].image)
    assert bar.button.text() == "Look at 0"
    qtbot.mouseClick(bar.button, LEFT)
    assert window.session.image == views[0].image and window.session.project is project
    qtbot.waitUntil(lambda: not window.session.jobs.running, timeout=60_000)


def test_a_board_of_glass_is_offered_once_lengths_hold_and_stated_in_one_edit(
    window: MainWindow, qtbot: QtBot
) -> None:
    camera = scenes.barrel()
    project = make_project(photograph(camera, 12), size=camera.size, lengths_confirmed=False)
    begin(window, qtbot, project)
    bar, session, panel = window.verdict, window.session, window.settings.board_shape
    assert not bar.unfold.isVisible() and bar.findings.glass is None
    session.edit("Confirm", confirm_lengths)
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
    before = session.result
    assert before is not None and not before.condition
    assert bar.unfold.text() == "Is it &glass?" and panel.prior is None
    qtbot.mouseClick(bar.unfold, LEFT)
    row = bar.findings.glass
    assert row is not None and row.what.isVisible()
    assert row.what.text().startswith(
        "If the board is of glass, printed true to 0.002 mm and flat to 0.01 mm: "
    )
    promised = re.findall(r"(\w+) ± ([.\d]+)", row.what.text())
    confirmed = session.project
    qtbot.mouseClick(row.button, LEFT)
    qtbot.waitUntil(
        lambda: (
            bar.comparison is not None and bar.comparison.isVisible() and not session.jobs.running
        ),
        timeout=60_000,
    )
    after = session.result
    assert after is not None and after.calibration.settings.prior == GLASS
    names, sigma = after.calibration.camera.names, after.calibration.sigma
    assert {"cx", "cy"} <= dict(promised).keys()
    for name, stated in promised:
        found = sigma[names.index(name)]
        assert found == pytest.approx(float(stated), rel=0.05)
        assert found < 0.5 * before.calibration.sigma[names.index(name)]
    assert bar.findings.glass is None  # it is done
    assert session.project.settings.prior == panel.prior == GLASS
    assert session.document.undo_label == "State a board of glass"
    window.settings.robust.click()  # another setting keeps it
    assert session.project.settings.prior == GLASS
    session.document.undo()
    session.document.undo()
    assert session.project is confirmed and panel.prior is None
    qtbot.waitUntil(lambda: not session.jobs.running, timeout=60_000)
