"""Nothing moves under the cursor: what changes its length has its place, for one word or many."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from calibgui.app.projects.document import Document
from calibgui.dataset import ViewStatus
from calibgui.engine.assessment import Action, ActionKind, Grade, PixelError
from calibgui.gui.panels.analysis import PANELS
from calibgui.gui.panels.on_demand import OnDemandPanel
from calibgui.gui.panels.panel import Panel
from calibgui.gui.verdict.texts import describe_button, describe_grade
from calibgui.gui.widgets.overlay import Overlay
from calibgui.gui.widgets.reserved_label import ReservedLabel
from calibgui.gui.widgets.wrapped_label import WrappedLabel
from calibgui.gui.window.inspector import Inspector
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples

SIZES = [(960, 1000), (1280, 720)]
LONG = "2026-01-15_workshop_left-camera_exposure-1-250_second-attempt_0001"
MANY = "Words of a sentence that has many of them, 0.0088 px and 30 mm. " * 9

Places = dict[QWidget, tuple[QPoint, object]]


@pytest.fixture(params=SIZES, ids=[f"{width}x{height}" for width, height in SIZES])
def sized(request: pytest.FixtureRequest, full: MainWindow, qtbot: QtBot) -> MainWindow:
    full.resize(*request.param)
    qtbot.waitUntil(lambda: (full.width(), full.height()) == request.param)
    qtbot.waitUntil(lambda: full.verdict.verdict is not None)
    return full


def find_places(window: MainWindow, qtbot: QtBot, *but: QWidget) -> Places:
    """Where all that is in sight stands and how large it is, but some widgets, once it is still."""
    places: Places = {}

    def is_still() -> bool:
        before = dict(places)
        places.clear()
        places.update(
            (widget, (widget.mapTo(window, QPoint()), widget.size()))
            for widget in window.findChildren(QWidget)
            if widget.isVisible() and widget not in but
        )
        return places == before

    qtbot.waitUntil(is_still)
    return places


def list_moved(before: Places, after: Places) -> list[str]:
    return [
        f"{type(widget).__name__} {widget.accessibleName() or widget.objectName()}: "
        f"{before[widget]} -> {after[widget]}"
        for widget in before.keys() & after.keys()
        if before[widget] != after[widget]
    ]


def is_over_the_desk(widget: QWidget) -> bool:
    """Return whether it is part of what lies over the picture, or over the desk."""
    part: QWidget | None = widget
    while part is not None:
        if any(isinstance(child, Overlay) for child in part.children()):
            return True
        part = part.parentWidget()
    return False


def show_pages(window: MainWindow) -> Iterator[Panel | None]:
    """Show what lies over the desk, the words of the tools, and what the modes show."""
    window.show_setup()
    yield None
    window.header.setup.setChecked(False)
    for tool in window.page.tools:
        tool.trigger()
        yield None
    window.page.marker.leave()
    yield None
    for kind in PANELS:
        yield window.need_analysis().show_panel(kind)


def test_words_of_any_length_leave_everything_where_it_is(sized: MainWindow, qtbot: QtBot) -> None:
    for panel in show_pages(sized):
        find_places(sized, qtbot)  # its work has begun
        qtbot.waitUntil(lambda: not sized.session.jobs.running, timeout=60_000)
        labels = [label for label in sized.findChildren(ReservedLabel) if label.isVisible()]
        for label in labels:
            label.setText("Yes.")
        before = find_places(sized, qtbot)
        for label in labels:
            label.setText(MANY)
        assert list_moved(before, find_places(sized, qtbot)) == [], panel


def test_every_text_of_several_lines_has_its_place(sized: MainWindow, qtbot: QtBot) -> None:
    """A `WrappedLabel` would push aside what is below it, which a button's answer may."""
    loose = []
    for panel in show_pages(sized):
        answers = [each.words for each in sized.findChildren(OnDemandPanel)]
        loose += [
            label.text()
            for label in sized.findChildren(WrappedLabel)
            if not isinstance(label, ReservedLabel)
            and label.isVisible()
            and not is_over_the_desk(label)
            and (panel is None or label is not panel._empty)
            and label not in answers
        ]
    assert loose == []
    qtbot.waitUntil(lambda: not sized.session.jobs.running, timeout=60_000)


def test_every_error_of_a_pixel_has_its_place(sized: MainWindow) -> None:
    """The numbers and what is below them stand apart, as long as they can be."""
    figures, verdict = sized.verdict.figures, sized.verdict.verdict
    assert verdict is not None
    for px in (0.0001, 0.0088, 0.088, 0.88, 8.8, 888.0, 8888.0):
        shown = replace(verdict, error=PixelError(*[px] * 6))
        figures.show_verdict(shown, sized.verdict._result, "RMS 0.12 px", dimmed=False)
        places = figures.list_places()
        assert all(figures.rect().contains(place.toAlignedRect()) for place in places), px
        assert not any(a.intersects(b) for a, b in combinations(places, 2)), px


def test_other_names_and_numbers_move_nothing(sized: MainWindow, qtbot: QtBot) -> None:
    session, bar = sized.session, sized.verdict
    result = session.result
    assert result is not None
    views = tuple(replace(v, image=f"{LONG}_{v.name}") for v in result.views)
    bar._result = replace(result, views=views)
    camera = sized.inspector.camera
    leave_out = Action(ActionKind.LEAVE_OUT_VIEWS, views=tuple(range(6)))
    bar.button.show()
    bar.unfold.show()

    def say(*, much: bool) -> None:
        bar.headline.setText(describe_grade(Grade.CAN_BE_BETTER if much else Grade.GOOD, 888.0))
        bar.button.setText(describe_button(leave_out, bar._list_names()) if much else "Free fx")
        bar.unfold.setText("88 &findings" if much else "&1 finding")
        sized.header.summary.setText("1,888 of 1,888 photographs" if much else "1 photograph")
        sized.header.name.setText("A name" if much else "A")
        camera.results.setItemText(0, LONG if much else "A")
        camera.results.setCurrentIndex(0)
        sized.calibrate.setText("Stopping…" if much else "&Stop")

    say(much=False)
    own = (bar.headline, bar.button, bar.unfold, camera.more)
    own += (sized.header.name, sized.header.summary, sized.calibrate, sized.progress)
    before = find_places(sized, qtbot, *own)
    say(much=True)
    job = session.jobs.start(MANY, lambda job: job.cancelling.wait(60))
    after = find_places(sized, qtbot)
    job.cancel()
    assert list_moved(before, after) == []
    assert sized.inspector.width() in (Inspector.WIDTH, sized.width())
    qtbot.waitUntil(lambda: not session.jobs.running)


def test_the_place_of_the_question_is_kept(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    """A board is found at any time, and the answer is a click; what is pointed at stays there."""
    project = replace(examples.calibrated(tmp_path), lengths_confirmed=False)
    waiting = tuple(replace(v, status=ViewStatus.WAITING, corners=None) for v in project.views)
    window.session.begin(Document(replace(project, views=waiting, results={})))
    assert not window.verdict.square.isVisible()
    before = find_places(window, qtbot, window.page.caption)  # which lies over the picture
    window.session.document.learn(lambda p: replace(p, views=project.views))
    assert window.verdict.square.isVisible()
    assert list_moved(before, find_places(window, qtbot)) == []
    qtbot.mouseClick(window.verdict.square.confirm, Qt.MouseButton.LeftButton)
    assert window.session.project.lengths_confirmed
    assert not window.verdict.square.confirm.isEnabled()
    assert list_moved(before, find_places(window, qtbot)) == []
    window.verdict.square.square.setValue(31.0)
    assert window.verdict.square.confirm.isEnabled()
    assert list_moved(before, find_places(window, qtbot)) == []
