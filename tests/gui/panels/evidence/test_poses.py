"""The boards in space: what is drawn, turned and clicked."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.geometry import rotations
from calibgui.gui.panels.evidence.poses import PosesPanel
from calibgui.gui.panels.evidence.scene_view import _FADED, mix_outline
from calibgui.gui.widgets import theme
from calibgui.report.scene3d import (
    Observer,
    PolygonKind,
    SceneCentre,
    build_scene,
    draw_scene,
    fit_zoom,
)
from tests.gui.panels.conftest import Shown, drag


def test_a_board_picks_its_view(shown: Shown[PosesPanel], result: Result, qtbot: QtBot) -> None:
    panel = shown(PosesPanel, result)
    polygons = build_scene(result, SceneCentre.CAMERA)
    drawn = draw_scene(polygons, fit_zoom(polygons, Observer()))
    front = [d for d in drawn if d.polygon.view >= 0][-1]
    at = panel.space.to_widget(front.points.mean(axis=0, keepdims=True))[0].toPoint()
    with qtbot.waitSignal(panel.picked) as signal:
        qtbot.mouseClick(panel.space, Qt.MouseButton.LeftButton, pos=at)
    assert result.views[signal.args[0]] is result.used[front.polygon.view]


def luminance(colour: QColor) -> float:
    """Relative luminance of WCAG 2."""
    rgb = np.array(colour.getRgbF()[:3])
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize("scheme", [theme.Scheme.LIGHT, theme.Scheme.DARK])
def test_the_farthest_outline_of_any_view_shows_on_the_ground(
    qapp: QApplication, scheme: theme.Scheme
) -> None:
    theme.apply(qapp, scheme)
    try:
        ground = luminance(QColor(theme.current().base))
        for view in range(64):
            outline = luminance(mix_outline(theme.view_colour(view), _FADED))
            dark, bright = sorted((ground, outline))
            assert (bright + 0.05) / (dark + 0.05) > 1.9, view
    finally:
        theme.apply(qapp, theme.Scheme.LIGHT)


def test_the_scene_covers_its_place_at_one_and_a_half_times_the_scale(
    shown: Shown[PosesPanel], result: Result
) -> None:
    space = shown(PosesPanel, result).space
    space.resize(301, 201)
    picture = QImage(452, 302, QImage.Format.Format_RGB32)
    picture.setDevicePixelRatio(1.5)
    picture.fill(Qt.GlobalColor.black)
    space.render(picture)
    edge = [picture.pixelColor(451, y).name() for y in range(302)]
    edge += [picture.pixelColor(x, 301).name() for x in range(452)]
    assert set(edge) == {theme.LIGHT.base}


def test_the_sentence_on_lengths_has_the_room_below_to_itself(
    shown: Shown[PosesPanel], result: Result
) -> None:
    panel = shown(PosesPanel, result)
    space = panel.space
    numbers = [str(k) for k in range(len(result.used))]
    sentence = "Lengths hold if squares are 30 mm. " * 4
    space.resize(300, 200)
    scene = build_scene(result, SceneCentre.CAMERA)
    colours = [theme.view_colour(k) for k in range(len(numbers))]
    space.show_scene(scene, numbers, colours, "")
    whole = space.grab().toImage()
    space.show_scene(scene, numbers, colours, sentence)
    room = space._find_room_below()
    assert room.height() > 2 * space.fontMetrics().height(), "it is longer than a line"
    assert room.bottom() == space.rect().bottom()
    assert space.grab().toImage() != whole
    boxes = space.numbers_shown.values()
    assert boxes and all(box.bottom() <= room.top() for box in boxes)
    far = space._keep_inside(QRectF(0, 500, 20, 10))
    assert far.bottom() <= room.top()


def test_a_click_beside_the_boards_picks_nothing(
    shown: Shown[PosesPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(PosesPanel, result)
    with qtbot.assertNotEmitted(panel.picked, wait=20):
        qtbot.mouseClick(panel.space, Qt.MouseButton.LeftButton, pos=QPoint(3, 3))


def test_dragging_turns_and_does_not_pick(
    shown: Shown[PosesPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(PosesPanel, result)
    middle = panel.space.rect().center()
    before = panel.space.observer
    with qtbot.assertNotEmitted(panel.picked, wait=20):
        drag(qtbot, panel.space, middle, middle + QPoint(50, 25))
    after = panel.space.observer
    assert after.azimuth < before.azimuth and after.elevation > before.elevation
    qtbot.mouseClick(panel.home, Qt.MouseButton.LeftButton)
    assert (
        panel.space.observer
        == before
        == fit_zoom(build_scene(result, SceneCentre.CAMERA), Observer())
    )


def test_keys_turn_and_zoom(shown: Shown[PosesPanel], result: Result, qtbot: QtBot) -> None:
    panel = shown(PosesPanel, result)
    before = panel.space.observer
    panel.space.setFocus()
    qtbot.keyClick(panel.space, Qt.Key.Key_Left)
    assert panel.space.observer.azimuth > before.azimuth
    qtbot.keyClicks(panel.space, "+")
    assert panel.space.observer.zoom > before.zoom
    qtbot.keyClicks(panel.space, "-")
    assert np.isclose(panel.space.observer.zoom, before.zoom)


def test_the_wheel_zooms(shown: Shown[PosesPanel], result: Result) -> None:
    panel = shown(PosesPanel, result)
    at = QPointF(panel.space.rect().center())
    no = Qt.KeyboardModifier.NoModifier
    wheel = QWheelEvent(
        at, panel.space.mapToGlobal(at), QPoint(), QPoint(0, 120), Qt.MouseButton.NoButton, no,
        Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    before = panel.space.observer
    QApplication.sendEvent(panel.space, wheel)
    assert panel.space.observer.zoom > before.zoom


def test_what_is_drawn_is_the_scene(shown: Shown[PosesPanel], result: Result, qtbot: QtBot) -> None:
    panel = shown(PosesPanel, result)
    panel.centre.setFocus()
    qtbot.keyClick(panel.centre, Qt.Key.Key_Down)
    drawn = panel.space._drawn
    assert {d.polygon.view for d in drawn if d.polygon.kind is PolygonKind.CAMERA} == set(range(9))
    polygons = build_scene(result, SceneCentre.BOARD)
    expected = draw_scene(polygons, fit_zoom(polygons, Observer()))
    for one, other in zip(drawn, expected, strict=True):
        np.testing.assert_array_equal(one.points, other.points)


def test_every_board_has_its_number(shown: Shown[PosesPanel], result: Result) -> None:
    panel = shown(PosesPanel, result)
    panel.grab()
    # The second image has no board, and a name without a number: places are counted.
    assert list(panel.space._numbers) == ["1", *map(str, range(3, 11))]
    places = list(panel.space.numbers_shown.values())
    assert len(places) >= 7
    assert not any(a.intersects(b) for k, a in enumerate(places) for b in places[:k])
    assert all(panel.space.rect().contains(place.toAlignedRect()) for place in places)


def test_numbers_leave_the_axes_theirs(shown: Shown[PosesPanel], result: Result) -> None:
    space = shown(PosesPanel, result).space
    for turn in np.linspace(0, 2 * np.pi, 24):
        space.look_from(Observer().turned(turn, 0.0))
        space.grab()
        places = [*space.numbers_shown.values()]
        on_axes = [number.place for number in space.axis_numbers]
        assert places and on_axes
        assert not any(a.intersects(b) for a in places for b in on_axes)


def test_the_cursor_announces_and_describes_a_board(
    shown: Shown[PosesPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(PosesPanel, result)
    front = [d for d in panel.space._drawn if d.polygon.view >= 0][-1]
    at = panel.space.to_widget(front.points.mean(axis=0, keepdims=True))[0].toPoint()
    with qtbot.waitSignal(panel.hovered) as signal:
        qtbot.mouseMove(panel.space, at)
    assert result.views[signal.args[0]] is result.used[front.polygon.view]
    assert panel.words.text().startswith(result.used[front.polygon.view].image)
    with qtbot.waitSignal(panel.hovered) as signal:
        qtbot.mouseMove(panel.space, QPoint(2, 2))
    assert signal.args == [-1]
    assert panel.words.text().startswith("9 views, ")


def test_a_view_pointed_at_elsewhere_is_filled(shown: Shown[PosesPanel], result: Result) -> None:
    panel = shown(PosesPanel, result)
    before = panel.space.grab().toImage()
    with_none = panel.words.text()
    panel.hover(4)
    assert panel.space.grab().toImage() != before
    assert panel.words.text().startswith("view4.png: ")
    panel.hover(1)  # an image without a board
    assert panel.space.grab().toImage() == before
    assert panel.words.text() == with_none


def test_only_the_selected_board_is_filled(shown: Shown[PosesPanel], result: Result) -> None:
    panel = shown(PosesPanel, result)
    alone = max(panel.space._drawn, key=lambda d: (d.polygon.view >= 0, np.ptp(d.points)))
    at = panel.space.to_widget(alone.points[:3].mean(axis=0, keepdims=True))[0].toPoint()
    ratio = panel.space.devicePixelRatio()
    base = panel.space.grab().toImage().pixelColor(at * ratio)
    panel.space.select(alone.polygon.view)
    filled = panel.space.grab().toImage().pixelColor(at * ratio)
    assert filled != base


def test_words_and_highlight_follow_the_selection(shown: Shown[PosesPanel], result: Result) -> None:
    panel = shown(PosesPanel, result)
    assert panel.words.text().startswith("9 views, ")
    before = panel.space.grab().toImage()
    panel.select(4)
    assert panel.space.grab().toImage() != before
    pose = result.calibration.poses[3]
    tilt = np.rad2deg(np.arccos(abs(rotations.rotation_from_vector(pose.rvec)[2, 2])))
    assert panel.words.text().startswith("view4.png: ")
    assert f"tilted by {tilt:.0f}°" in panel.words.text()
