"""The ray and the place on the board are said of the pixel under the cursor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.camera import project_points
from calibgui.engine.images import Image
from calibgui.gui.canvas.world_reading import describe_world
from calibgui.gui.window.main_window import MainWindow
from tests.app.examples import CAMERA


@pytest.mark.parametrize("is_confirmed", [False, True])
def test_a_pixel_of_the_board_is_where_it_lies(full: MainWindow, is_confirmed: bool) -> None:
    assert full.session.result is not None
    result = replace(full.session.result, lengths_confirmed=is_confirmed)
    calibration, view = result.calibration, result.used[1]
    (uv,) = project_points(np.array([[42.5, 71.25]]), calibration.camera, calibration.poses[1])
    text = describe_world(result, view.image, CAMERA.size, (uv[0], uv[1]))
    assert "board X 42.50, Y 71.25 mm" in text
    assert ("if squares are 30 mm" in text) is not is_confirmed
    fx, fy, cx, cy = calibration.camera.params[:4]
    centre = describe_world(result, "new.png", CAMERA.size, (cx, cy))
    assert centre.replace("left", "right").replace("up", "down") == "ray 0.00° right, 0.00° down"
    left = describe_world(result, "new.png", CAMERA.size, (cx - 20, cy - 10))
    assert "left" in left and "up" in left
    # The lens of this camera bends rays so near to its axis by less than a tenth of a degree.
    angle = float(left.split("°")[0].removeprefix("ray "))
    assert angle == pytest.approx(np.degrees(np.arctan(20 / fx)), abs=0.1) and fy > 0
    assert describe_world(result, view.image, (640, 480), (uv[0], uv[1])) == ""


def test_it_stands_below_the_name_of_the_image(full: MainWindow) -> None:
    page = full.page
    session = full.session
    session.select(session.project.views[0].image)
    pixels = np.full(CAMERA.size[::-1], 90, np.uint8)
    page._image = Image(pixels, page._session.image)
    page.canvas.hovered.emit(80.0, 70.0)
    _, first, second = page.caption.text().split("\n")
    assert "u 80.00" in first and second.startswith("ray ") and "board X" in second
    page.canvas.hovered.emit(np.nan, np.nan)
    assert "\n" not in page.caption.text()
