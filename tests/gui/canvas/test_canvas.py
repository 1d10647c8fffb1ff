"""The canvas: where things are, on any zoom, and that they can be seen."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from calibgui.engine.arrays import Array
from calibgui.engine.features.corners import Corners
from calibgui.gui.canvas import layers
from calibgui.gui.canvas.canvas import Canvas
from calibgui.gui.canvas.layers import Layer, Marks
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.picture import make_qimage

SIZE = (320, 240)
CORNERS = Corners(
    (3, 4),
    np.indices((3, 4)).reshape(2, -1).T,
    [(60.0 + 50 * n, 50.0 + 60 * m) for m in range(3) for n in range(4)],
    [(61.0 + 50 * n, 51.0 + 60 * m) for m in range(3) for n in range(4)],
)


@pytest.fixture
def canvas(qtbot: QtBot) -> Canvas:
    canvas = Canvas()
    qtbot.addWidget(canvas)
    canvas.resize(640, 480)
    canvas.show_image([make_qimage(np.full(SIZE[::-1], 128, np.uint8))])
    canvas.show()
    qtbot.waitExposed(canvas)
    return canvas


def under(canvas: Canvas, at: QPoint | QPointF) -> Array:
    return canvas.to_image(np.array([[at.x(), at.y()]]))[0]


def wheel(canvas: Canvas, at: QPoint, notches: int) -> None:
    event = QWheelEvent(
        QPointF(at),
        QPointF(canvas.viewport().mapToGlobal(at)),
        QPoint(),
        QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(canvas.viewport(), event)


def test_pixel_centres_are_integers(canvas: Canvas) -> None:
    """The whole image fits: its outer edges are at -0.5 and width - 0.5."""
    ends = canvas.to_screen(np.array([(-0.5, -0.5), (SIZE[0] - 0.5, SIZE[1] - 0.5)]))
    np.testing.assert_allclose(ends, [(0, 0), (640, 480)], atol=1.0)
    uv = np.random.default_rng(0).uniform(0, 240, (5, 2))
    np.testing.assert_allclose(canvas.to_image(canvas.to_screen(uv)), uv, atol=1e-9)


def test_a_drawn_pixel_is_where_the_coordinates_say(canvas: Canvas) -> None:
    pixels = np.zeros(SIZE[::-1], np.uint8)
    pixels[100, 200] = 255
    canvas.show_image([make_qimage(pixels)])
    canvas.zoom_at(8, QPoint(320, 240))
    canvas.show_place(np.array([200.0, 100.0]))
    at = canvas.to_screen(np.array([[200.0, 100.0]]))[0]
    image = canvas.grab().toImage()
    assert image.pixelColor(round(at[0]), round(at[1])).lightness() == 255
    half = canvas.zoom / 2
    assert image.pixelColor(round(at[0] + half + 2), round(at[1])).lightness() == 0
    assert image.pixelColor(round(at[0] + half - 2), round(at[1])).lightness() == 255


def test_the_wheel_zooms_to_the_cursor(canvas: Canvas) -> None:
    at = QPoint(500, 100)
    before, zoom = under(canvas, at), canvas.zoom
    for notches in (3, 2, -4):
        wheel(canvas, at, notches)
        np.testing.assert_allclose(under(canvas, at), before, atol=1.0 / canvas.zoom + 0.01)
    assert canvas.zoom > zoom
    wheel(canvas, at, 100)
    assert canvas.zoom == 64
    wheel(canvas, at, -100)
    assert canvas.zoom <= zoom


def test_fit_one_to_one_and_following_the_window(canvas: Canvas, qtbot: QtBot) -> None:
    assert canvas.zoom == pytest.approx(2.0)
    canvas.actual_size()
    assert canvas.zoom * canvas.devicePixelRatioF() == pytest.approx(1.0)
    canvas.resize(320, 240)
    qtbot.waitUntil(lambda: canvas.viewport().width() == 320)
    assert canvas.zoom == pytest.approx(1.0), "a zoom of the user's stays"
    canvas.fit()
    canvas.resize(640, 480)
    qtbot.waitUntil(lambda: canvas.zoom == pytest.approx(2.0))


def test_dragging_pans_and_a_click_picks(canvas: Canvas, qtbot: QtBot) -> None:
    canvas.show_marks(Marks(CORNERS))
    canvas.zoom_at(2, QPoint(320, 240))
    start, end = QPoint(300, 200), QPoint(340, 250)
    before = under(canvas, start)
    qtbot.mousePress(canvas.viewport(), Qt.MouseButton.LeftButton, pos=start)
    qtbot.mouseMove(canvas.viewport(), end)
    with qtbot.assertNotEmitted(canvas.picked):
        qtbot.mouseRelease(canvas.viewport(), Qt.MouseButton.LeftButton, pos=end)
    np.testing.assert_allclose(under(canvas, end), before, atol=0.6)
    at = QPointF(*canvas.to_screen(CORNERS.uv[5:6])[0]).toPoint()
    with qtbot.waitSignal(canvas.picked) as picked:
        qtbot.mouseClick(canvas.viewport(), Qt.MouseButton.LeftButton, pos=at + QPoint(3, -3))
    assert picked.args == [5]


def test_arrow_keys_step_and_the_cursor_is_announced(canvas: Canvas, qtbot: QtBot) -> None:
    steps: list[int] = []
    canvas.stepped.connect(steps.append)
    for key in (Qt.Key.Key_Right, Qt.Key.Key_Left, Qt.Key.Key_Down, Qt.Key.Key_Up):
        qtbot.keyClick(canvas, key)
    assert steps == [1, -1, 1, -1]
    with qtbot.waitSignal(canvas.hovered) as hovered:
        qtbot.mouseMove(canvas.viewport(), QPoint(100, 100))
    np.testing.assert_allclose(hovered.args, under(canvas, QPoint(100, 100)))


def colours_near(canvas: Canvas, uv: Array, reach: int = 8) -> list[QColor]:
    at = canvas.to_screen(uv[None])[0].round().astype(int)
    image = canvas.grab().toImage()
    return [
        image.pixelColor(int(at[0]) + i, int(at[1]) + j)
        for i in range(-reach, reach + 1)
        for j in range(-reach, reach + 1)
    ]


def nearest(colours: list[QColor], to: QColor) -> int:
    return min(
        abs(c.red() - to.red()) + abs(c.green() - to.green()) + abs(c.blue() - to.blue())
        for c in colours
    )


@pytest.mark.parametrize("grey", [0, 255])
def test_marks_and_their_halo_show_on_black_and_on_white(canvas: Canvas, grey: int) -> None:
    canvas.show_image([make_qimage(np.full(SIZE[::-1], grey, np.uint8))])
    canvas.show_marks(Marks(CORNERS))
    canvas.shown = {Layer.CORNERS}
    colours = colours_near(canvas, CORNERS.uv[5])
    assert nearest(colours, theme.REFINED) < 90
    if grey == 255:
        assert min(c.lightness() for c in colours) < 140, "no halo"


@pytest.mark.parametrize(
    ("layer", "colour", "at"),
    [
        (Layer.REGION, theme.REGION, (110.0, 40.0)),
        (Layer.ESTIMATES, theme.ESTIMATE, (161.0, 111.0)),
        (Layer.CORNERS, theme.REFINED, (160.0, 110.0)),
        (Layer.ORDER, theme.PATH, (135.0, 110.0)),
        (Layer.REPROJECTION, theme.REPROJECTED, (159.0, 110.0)),
        (Layer.RESIDUALS, theme.RESIDUAL, (169.0, 110.0)),
    ],
)
def test_each_layer_can_be_shown_and_hidden(
    canvas: Canvas, layer: Layer, colour: QColor, at: tuple[float, float]
) -> None:
    region = np.array([(40.0, 40.0), (230.0, 40.0), (230.0, 190.0), (40.0, 190.0)])
    canvas.set_residual_scale(20)
    canvas.show_marks(Marks(CORNERS, region, CORNERS.uv, CORNERS.uv - [1.0, 0.0]))
    for shown in (True, False):
        for other in Layer:
            canvas.set_layer(other, shown=shown and other is layer)
        found = nearest(colours_near(canvas, np.array(at), 12), colour) < 160
        assert found is shown


def test_a_residual_is_drawn_as_many_times_as_long_as_asked(canvas: Canvas) -> None:
    drawn: list[Array] = []

    def arrows(_: object, start: Array, end: Array, __: object) -> None:
        drawn.append((end - start) / canvas.zoom)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(layers, "draw_arrows", arrows)
        canvas.shown = {Layer.RESIDUALS}
        canvas.set_residual_scale(30)
        canvas.show_marks(Marks(CORNERS, None, CORNERS.uv, CORNERS.uv - [0.2, -0.1]))
        canvas.grab()
    np.testing.assert_allclose(drawn[-1], np.tile([6.0, -3.0], (12, 1)), atol=1e-9)


@pytest.mark.usefixtures("qapp")
@pytest.mark.parametrize(
    ("u", "v", "is_whole"),
    [(60, 40, True), (195, 40, True), (60, 96, True), (199, 99, True), (-40, 40, False)],
)
def test_a_label_is_whole_where_its_place_is_in_sight(u: float, v: float, is_whole: bool) -> None:
    def count_painted(u: float, v: float) -> int:
        picture = QImage(300, 200, QImage.Format.Format_Grayscale8)
        picture.fill(255)
        painter = QPainter(picture)
        painter.setClipRect(0, 0, 200, 100)
        layers.draw_label(painter, np.array([u, v]), "20 px", theme.PATH)
        painter.end()
        grey = np.frombuffer(picture.constBits(), np.uint8).reshape(200, -1)[:100, :200]
        return int((grey < 255).sum())

    whole = count_painted(20.0, 20.0)
    assert whole > 200
    assert (abs(count_painted(u, v) - whole) < 0.02 * whole) is is_whole
