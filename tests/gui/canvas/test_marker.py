"""Marking boards by four clicks, one image after the other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PIL import Image as Pillow
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from calibgui.app.projects.document import Document
from calibgui.app.projects.project import Project
from calibgui.app.system.resources import find_resource
from calibgui.dataset import View, ViewStatus
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.reading import read_image
from calibgui.gui.window.main_window import MainWindow
from tests.gui.hand import Hand, outermost


def test_enter_accepts_and_goes_on_with_the_next_image_that_needs_it(
    window: MainWindow, qtbot: QtBot
) -> None:
    paths = [find_resource("sample") / f"view0{k}.png" for k in (1, 2, 3)]
    found = [find_corners(read_image(path).grey) for path in paths]
    nothing = [View(str(path), ViewStatus.NO_BOARD, "too dark") for path in paths]
    views = (nothing[0], View(str(paths[1]), ViewStatus.FOUND, corners=found[1]), nothing[2])
    hand, page = Hand(window, qtbot), window.page
    window.session.begin(Document(Project(views=views, size=(640, 480))))
    hand.choose_image(paths[0].name)
    page.tools[0].trigger()
    for k in (0, 2):
        hand.wait(lambda path=paths[k]: page.shown_path == str(path))
        hand.wait(lambda: page.canvas.tool is not None)
        assert page.tools[0].isChecked() and page.marker.roi_bar.isVisible()
        for point in outermost(found[k]):
            hand.click(point)
        hand.wait(page.marker.roi_bar.accept.isEnabled)
        hand.key(Qt.Key.Key_Return)
    assert all(view.usable for view in window.session.project.views)
    assert page.canvas.tool is None and not page.tools[0].isChecked()
    assert window.session.image == str(paths[2])


def test_what_is_to_be_clicked_is_called_as_in_the_set_up(window: MainWindow, qtbot: QtBot) -> None:
    path = find_resource("sample") / "view01.png"
    hand, page = Hand(window, qtbot), window.page
    for pattern, name in ((KINDS["aprilgrid"], "Corners"), (KINDS["circles"], "Circles")):
        views = (View(str(path), ViewStatus.NO_BOARD, "too dark"),)
        window.session.begin(Document(Project(views=views, size=(640, 480), pattern=pattern)))
        hand.wait(lambda: page.shown_path == str(path))
        page.tools[0].trigger()
        bar = page.marker.roi_bar
        assert bar.counted.text() == window.board.counted.text() == name
        assert f"the four outermost {name.lower()}, going" in bar.words.text()
        page.marker.leave()


def test_an_excluded_image_is_not_offered_to_be_marked(window: MainWindow, qtbot: QtBot) -> None:
    paths = [find_resource("sample") / f"view0{k}.png" for k in (1, 2, 3)]
    corners = find_corners(read_image(paths[0]).grey)
    first, excluded, last = (View(str(p), ViewStatus.NO_BOARD, "too dark") for p in paths)
    views = (first, replace(excluded, enabled=False), last)
    hand, page = Hand(window, qtbot), window.page
    window.session.begin(Document(Project(views=views, size=(640, 480))))
    hand.choose_image(paths[0].name)
    page.tools[0].trigger()
    for point in outermost(corners):
        hand.click(point)
    hand.wait(page.marker.roi_bar.accept.isEnabled)
    hand.key(Qt.Key.Key_Return)
    assert window.session.image == str(paths[2])
    hand.wait(lambda: page.shown_path == str(paths[2]))
    hand.wait(lambda: page.canvas.tool is not None)
    page.marker.leave()


def test_all_boards_by_hand_from_the_first_click_to_the_camera(
    window: MainWindow, qtbot: QtBot
) -> None:
    paths = sorted(find_resource("sample").glob("*.png"))[:5]
    found = [find_corners(read_image(path).grey) for path in paths]
    hand, page, session = Hand(window, qtbot), window.page, window.session
    session.begin(Document(Project(by_hand=True)))
    window.files.open_paths(list(map(str, paths)))
    qtbot.waitUntil(lambda: not session.jobs.running)
    assert {view.status for view in session.project.views} == {ViewStatus.WAITING}
    hand.choose_image(paths[0].name)
    window.show_failure(CalibrationError("No board is marked.", "Mark it."))
    page.tools[0].trigger()
    assert window.banner.isHidden(), "it would cover corners"
    for path, corners in zip(paths[:4], found, strict=False):
        hand.wait(lambda path=path: page.shown_path == str(path))
        hand.wait(lambda: page.canvas.tool is not None)
        for point in outermost(corners):
            hand.click(point)
        hand.wait(page.marker.roi_bar.accept.isEnabled)
        hand.key(Qt.Key.Key_Return)
    assert session.image == str(paths[4])
    hand.wait(lambda: page.canvas.tool is not None)
    hand.key(Qt.Key.Key_Escape)
    hand.key(Qt.Key.Key_F9)
    hand.wait(lambda: session.result is not None)
    assert session.result is not None and len(session.result.used) == 4
    assert session.project.views[4].status is ViewStatus.WAITING, "nobody asked for it"
    window.detector.search_again([str(paths[4])])
    hand.wait(lambda: session.project.views[4].usable)
    hand.wait(lambda: not session.jobs.running)


def test_calibrating_without_a_marked_board_says_that_it_must_be_marked(
    window: MainWindow, qtbot: QtBot
) -> None:
    paths = sorted(find_resource("sample").glob("*.png"))[:2]
    window.session.begin(Document(Project(by_hand=True)))
    window.files.open_paths(list(map(str, paths)))
    qtbot.waitUntil(lambda: not window.session.jobs.running)
    qtbot.mouseClick(window.calibrate, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(window.banner.isVisible)
    assert "Mark the four outermost corners" in window.banner.text.text()
    window.show_setup()
    box = window.board.by_hand
    assert box.text().replace("&", "") in window.banner.text.text()


def test_enter_goes_on_to_images_with_corners_where_all_are_marked(
    window: MainWindow, qtbot: QtBot
) -> None:
    paths = sorted(find_resource("sample").glob("*.png"))[:3]
    found = [find_corners(read_image(path).grey) for path in paths]
    views = [
        View(str(path), ViewStatus.FOUND, corners=corners)
        for path, corners in zip(paths, found, strict=True)
    ]
    marked = replace(views[1], roi=outermost(found[1]))
    project = Project(views=(views[0], marked, views[2]), size=(640, 480))
    hand, page = Hand(window, qtbot), window.page
    window.session.begin(Document(project))
    window.show_setup()
    box = window.board.by_hand
    qtbot.mouseClick(box, Qt.MouseButton.LeftButton, pos=QPoint(8, box.height() // 2))
    assert window.session.project.by_hand
    hand.choose_image(paths[0].name)
    page.tools[0].trigger()
    for point in outermost(found[0]):
        hand.click(point)
    hand.wait(page.marker.roi_bar.accept.isEnabled)
    hand.key(Qt.Key.Key_Return)
    assert window.session.image == str(paths[2]), "the second one has been marked"
    hand.wait(lambda: page.canvas.tool is not None)
    page.marker.leave()


def test_a_photograph_that_was_held_otherwise_is_marked_in_the_frame_of_the_others(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    paths = []
    for k, orientation in ((1, 1), (2, 6)):  # level, upright
        exif = Pillow.Exif()
        exif[0x010F], exif[0x0112] = "Maker", orientation
        paths.append(tmp_path / f"view{k}.png")
        Pillow.open(find_resource("sample") / f"view0{k}.png").save(paths[-1], exif=exif)
    hand, page, session = Hand(window, qtbot), window.page, window.session
    session.begin(Document(Project(by_hand=True)))
    window.files.open_paths(list(map(str, paths)))
    qtbot.waitUntil(lambda: not session.jobs.running)
    hand.choose_image(paths[0].name)
    page.tools[0].trigger()
    for path in paths:
        hand.wait(lambda path=path: page.shown_path == str(path))
        hand.wait(lambda: page.canvas.tool is not None)
        for point in outermost(find_corners(read_image(path, 1).grey)):
            hand.click(point)
        hand.wait(page.marker.roi_bar.accept.isEnabled)
        hand.key(Qt.Key.Key_Return)
    assert [view.orientation for view in session.project.usable] == [1, 1]
    page.marker.leave()


def test_an_image_of_another_size_is_not_marked(window: MainWindow, qtbot: QtBot) -> None:
    path = find_resource("sample") / "view01.png"
    hand, page = Hand(window, qtbot), window.page
    corners = find_corners(read_image(path).grey)
    views = View(str(path)), View("other.png", ViewStatus.FOUND, corners=corners)
    window.session.begin(Document(Project(views=views, size=(800, 600), by_hand=True)))
    hand.choose_image(path.name)
    page.tools[0].trigger()
    for point in outermost(corners):
        hand.click(point)
    hand.wait(page.marker.roi_bar.accept.isEnabled)
    hand.key(Qt.Key.Key_Return)
    assert "640 × 480 pixels, the others 800 × 600" in window.banner.text.text()
    assert not window.session.project.views[0].usable
    page.marker.leave()


def test_places_outside_of_the_image_have_no_coordinates(window: MainWindow, qtbot: QtBot) -> None:
    path = find_resource("sample") / "view01.png"
    hand, page = Hand(window, qtbot), window.page
    window.session.begin(Document(Project(views=(View(str(path)),), by_hand=True)))
    hand.choose_image(path.name)
    page.canvas.hovered.emit(639.4, 479.4)
    assert page.caption.text().split("\n")[1].startswith("u 639.40  v 479.40 px   grey ")
    page.canvas.hovered.emit(639.6, 479.4)
    assert page.caption.text() == "view01.png — not searched"
