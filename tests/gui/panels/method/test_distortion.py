"""The map of figure 8 against eq. 10 in the paper's units, written out here."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from pytestqt.qtbot import QtBot

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.geometry.frames import paper_from_intrinsics
from calibgui.gui.panels.method.distortion import DistortionPanel
from tests.gui.panels.conftest import Shown, made, place


def eq10(result: Result, uv: Array, radial: bool = True, decentering: bool = True) -> Array:
    """(d1, d2), px, paper's frame, at pixels (..., 2)."""
    camera = result.calibration.camera
    (xp, yp, k1, k2, k3, p1, p2, p3, _, _), _ = paper_from_intrinsics(camera.params, camera.size)
    dx = uv[..., 0] - (camera.size[0] - 1) / 2 - xp
    dy = (camera.size[1] - 1) / 2 - uv[..., 1] - yp
    r2 = dx**2 + dy**2
    rho = (k1 * r2 + k2 * r2**2 + k3 * r2**3) * radial
    q = (1 + p3 * r2) * decentering
    return np.stack(
        [
            dx * rho + q * (p1 * (r2 + 2 * dx**2) + 2 * p2 * dx * dy),
            dy * rho + q * (2 * p1 * dx * dy + p2 * (r2 + 2 * dy**2)),
        ],
        axis=-1,
    )


@pytest.fixture(scope="module")
def printed() -> Result:
    """With the radius in pixels, as the paper has it."""
    return made(model="lucchese-pixels")


def pixels_of(panel: DistortionPanel) -> Array:
    values = panel.plot.image.image
    rows, cols = values.shape
    u, v = (np.arange(cols) + 0.5) * 640 / cols - 0.5, (np.arange(rows) + 0.5) * 480 / rows - 0.5
    return np.stack(np.meshgrid(u, v), axis=-1)


@pytest.mark.parametrize(
    ("index", "parts"),
    [(0, {}), (1, {"decentering": False}), (2, {"radial": False})],
    ids=["complete", "radial", "decentering"],
)
def test_values_are_eq_10(
    shown: Shown[DistortionPanel],
    printed: Result,
    qtbot: QtBot,
    index: int,
    parts: dict[str, bool],
) -> None:
    panel = shown(DistortionPanel, printed)
    panel.part.setFocus()
    for _ in range(index):
        qtbot.keyClick(panel.part, Qt.Key.Key_Down)
    expected = np.linalg.norm(eq10(printed, pixels_of(panel), **parts), axis=-1)
    np.testing.assert_allclose(panel.plot.image.image, expected, atol=1e-9)
    low, high = panel.plot.bar.levels
    assert low == 0 and high == panel.plot.image.image.max()


def test_marks_and_contours(shown: Shown[DistortionPanel], result: Result) -> None:
    panel = shown(DistortionPanel, result)
    np.testing.assert_array_equal(np.ravel(panel.centre.getData()), [319.5, 239.5])
    np.testing.assert_array_equal(
        np.ravel(panel.principal.getData()), result.calibration.camera.centre
    )
    line = np.transpose(panel.contours.line.getData())
    d = panel.displacement(line[np.isfinite(line[:, 0])]).length
    levels = sorted(float(label.toPlainText()) for label in panel.contours.labels)
    assert len(levels) >= 3
    step = levels[0]
    assert np.abs(d - step * np.rint(d / step)).max() < 0.01 * levels[-1]
    at = np.array([[label.pos().x(), label.pos().y()] for label in panel.contours.labels])
    apart = np.linalg.norm(at[:, None] - at, axis=2) + 640 * np.eye(len(at))
    assert apart.min() > 60, "no label hides another"


def test_arrows_point_up_the_slope(shown: Shown[DistortionPanel], result: Result) -> None:
    panel = shown(DistortionPanel, result)
    line = np.transpose(panel._arrows.getData()).reshape(-1, 7, 2)
    start, tip = line[:, 0], line[:, 1]
    rise = panel.displacement(tip).length - panel.displacement(start).length
    length = np.linalg.norm(tip - start, axis=1)
    assert (rise[length > 1] > 0).all()


def test_mask_leaves_what_the_corners_enclose(
    shown: Shown[DistortionPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(DistortionPanel, result)
    qtbot.keyClick(panel.masked, Qt.Key.Key_Space)
    assert panel.masked.isChecked()
    uv = np.concatenate([view.uv for view in result.observations()])
    values, at = panel.plot.image.image, pixels_of(panel)
    outside = (at < uv.min(axis=0)).any(axis=-1) | (at > uv.max(axis=0)).any(axis=-1)
    assert np.isnan(values[outside]).all()
    middle = np.abs(at - uv.mean(axis=0)).sum(axis=-1).argmin()
    assert np.isfinite(values.ravel()[middle])


def test_value_under_the_cursor(
    shown: Shown[DistortionPanel], result: Result, qtbot: QtBot
) -> None:
    panel = shown(DistortionPanel, result)
    assert "at most" in panel.under_cursor.text()
    at = place(panel.plot, 600, 40)
    qtbot.mouseMove(panel.plot.viewport(), at)
    qtbot.waitUntil(lambda: panel.under_cursor.text().startswith("u "))
    box = panel.plot.box
    here = box.mapSceneToView(panel.plot.mapToScene(at))
    d = panel.displacement(np.array([here.x(), here.y()])).length
    assert f"d = {float(d):.2f} px" in panel.under_cursor.text()
    panel._hover(QPointF(1, 1))
    assert "at most" in panel.under_cursor.text()
