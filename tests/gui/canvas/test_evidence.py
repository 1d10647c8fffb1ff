"""The layers of the whole calibration hold the engine's numbers, and are computed when shown."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot
from scipy.interpolate import RegularGridInterpolator

from calibgui.dataset import Result
from calibgui.engine.camera import compute_displacement
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from calibgui.gui.canvas.layers import Drawing, Layer
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.picture import make_qimage
from calibgui.gui.window.main_window import MainWindow

LEFT = Qt.MouseButton.LeftButton


def show(window: MainWindow, qtbot: QtBot, layer: Layer) -> Drawing:
    """Click a layer's eye, and wait for what it shows."""
    window.inspector.show_image_page()
    eye = window.page.layer_list.eyes[layer]
    qtbot.mouseClick(eye, LEFT)
    assert eye.isChecked() and window.page.layers[layer].isChecked()
    qtbot.waitUntil(lambda: layer in window.page.evidence.drawings, timeout=60_000)
    return window.page.evidence.drawings[layer]


def result_of(window: MainWindow) -> Result:
    result = window.session.result
    assert result is not None
    return result


def levels_of(drawing: Drawing) -> list[float]:
    return [float("".join(c for c in text if c in "0123456789.")) for _, text in drawing.labels]


def test_nothing_is_computed_until_it_is_shown(full: MainWindow) -> None:
    assert full.page.evidence.drawings == {}


def test_distortion_lines_are_where_the_displacement_is_as_they_say(
    full: MainWindow, qtbot: QtBot
) -> None:
    drawing = show(full, qtbot, Layer.DISTORTION)
    camera = result_of(full).calibration.camera
    levels = np.array(levels_of(drawing))
    assert len(levels) > 2
    for line in drawing.lines:
        length = compute_displacement(line, camera).length
        level = levels[np.abs(levels - np.median(length)).argmin()]
        np.testing.assert_allclose(length, level, atol=0.02 * levels.max())
    for places, text in drawing.labels:
        lengths = compute_displacement(places, camera).length
        np.testing.assert_allclose(lengths, float(text.removesuffix(" px")), rtol=0.05)


def test_displacement_arrows_are_magnified_as_they_say(full: MainWindow, qtbot: QtBot) -> None:
    drawing = show(full, qtbot, Layer.DISPLACEMENT)
    camera = result_of(full).calibration.camera
    at = np.array([line[0] for line in drawing.lines])
    vector = np.array([line[1] - line[0] for line in drawing.lines])
    displacement = compute_displacement(at, camera)
    ((places, text),) = drawing.labels
    caption = full.page.caption.geometry()
    assert caption.bottom() < full.page.canvas.to_screen(places)[0, 1], "its name hides it"
    scale = float(text.split("×")[1].split(",")[0])
    np.testing.assert_allclose(vector, scale * displacement.vector, rtol=0.06, atol=1e-6)
    assert f"at most {format_two_digits(displacement.length.max())} px at the arrows" in text


def test_uncertainty_lines_are_where_it_is_as_they_say(full: MainWindow, qtbot: QtBot) -> None:
    drawing = show(full, qtbot, Layer.UNCERTAINTY)
    result = result_of(full)
    found = estimate_projection_uncertainty(result.calibration, result.observations())
    at = RegularGridInterpolator(  # lines may end beyond the last pixel by rounding
        (found.v, found.u), found.worst_direction, bounds_error=False, fill_value=None
    )
    levels = np.array(levels_of(drawing))
    for line in drawing.lines:
        sigma = at(line[:, ::-1])
        level = levels[np.abs(levels - np.median(sigma)).argmin()]
        np.testing.assert_allclose(sigma, level, rtol=0.1)


def test_coverage_has_every_corner_in_the_colour_of_its_view(
    full: MainWindow, qtbot: QtBot
) -> None:
    drawing = show(full, qtbot, Layer.COVERAGE)
    assert len(drawing.dots) == 6
    for k, (uv, colour) in enumerate(drawing.dots):
        np.testing.assert_array_equal(uv, result_of(full).observations()[k].uv)
        assert colour == theme.view_colour(k)


@pytest.mark.slow
def test_the_next_view_is_outlined(full: MainWindow, qtbot: QtBot) -> None:
    drawing = show(full, qtbot, Layer.NEXT_VIEW)
    ((corners, _),) = drawing.dots
    assert len(corners) == 42
    low, high = corners.min(axis=0), corners.max(axis=0)
    np.testing.assert_allclose(drawing.lines[0].min(axis=0), low)
    np.testing.assert_allclose(drawing.lines[0].max(axis=0), high)


def grab(window: MainWindow) -> QImage:
    return window.page.canvas.viewport().grab().toImage()


def test_a_layer_lies_over_images_of_its_camera_only_and_fades(
    full: MainWindow, qtbot: QtBot
) -> None:
    canvas = full.page.canvas
    canvas.show_image([make_qimage(np.full((150, 200), 90, np.uint8))])
    plain = grab(full)
    show(full, qtbot, Layer.COVERAGE)
    drawn = grab(full)
    assert drawn != plain
    slider = full.page.layer_list.opacities[Layer.COVERAGE]
    qtbot.mouseClick(slider, LEFT, pos=QPoint(4, slider.height() // 2))
    assert slider.value() < 100
    assert grab(full) not in (plain, drawn)
    canvas.show_image([make_qimage(np.full((100, 200), 90, np.uint8))])
    with_other = grab(full)
    canvas.set_layer(Layer.COVERAGE, shown=False)
    assert grab(full) == with_other


def test_another_result_has_its_own(full: MainWindow, qtbot: QtBot) -> None:
    before = show(full, qtbot, Layer.COVERAGE)
    full.session.show_result("Calibration 1")
    qtbot.waitUntil(
        lambda: full.page.evidence.drawings.get(Layer.COVERAGE, before) is not before,
        timeout=30_000,
    )
