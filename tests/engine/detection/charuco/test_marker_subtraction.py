"""Corners beside markers that are blurred into their edges."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.camera.camera import Camera
from calibgui.engine.corner_fit.x_corner_fit import fit_x_corners
from calibgui.engine.detection.charuco import marker_subtraction
from calibgui.engine.detection.charuco.marker_subtraction import Marks, remove_marks
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.features.lattice import Lattice
from tests.engine.conftest import Scene

PATTERN = Charuco("DICT_4X4_50", 0.75, False)
LENS = Camera((400, 300), [380.0, 380.0, 200.0, 150.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
SCENE = Scene(Board(5, 7, 26.0, PATTERN), LENS, (0.3, 0.2, 0.2), 280.0)


def test_corners_beside_blurred_markers_are_in_their_places() -> None:
    """Where markers are removed but twice they are 0.15 px off."""
    corners = find_corners(SCENE.image(3.7), (5, 7), pattern=PATTERN)
    assert len(corners) >= 30 and corners.cov is not None
    error = SCENE.error(corners)
    assert np.sqrt(np.mean(error**2)) < 0.08
    square = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error)
    assert square.mean() / 2 < 4.0


def test_markers_between_corners_that_cross_over_are_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """They would be drawn over millions of pixels."""
    squares = np.indices((5, 5)).sum(axis=0) % 2
    image = (40 + 160 * np.kron(squares, np.ones((30, 30)))).astype(np.uint8)
    uv = np.stack(np.meshgrid(np.arange(1, 5), np.arange(1, 5)), axis=-1) * 30.0 - 0.5
    fit = fit_x_corners(image, Lattice(uv, dark=True))
    fit.uv[[5, 6]] = fit.uv[[6, 5]] + [[0.0, 9.0], [0.0, -7.0]]
    marks = Marks(np.argwhere(squares == 1) - 1, np.ones((12, 6, 6), np.bool_), 0.1)
    extents: list[float] = []

    def measure(_: Array, at: Array, *__: Array) -> None:
        extents.append(float(np.ptp(at, axis=1).max()))

    monkeypatch.setattr(marker_subtraction, "add_blurred_cells", measure)
    remove_marks(image, Lattice(uv, dark=True), fit, marks)
    assert extents and max(extents) < 100
