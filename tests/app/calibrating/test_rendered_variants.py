"""Kinds of photographs that people have reported, each in rendered variants, from file to verdict.

They are small, as what is asked of them does not depend on their size.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.calibrating.best_camera import calibrate_best
from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.dataset import Result, ViewStatus
from calibgui.dataset.judging import judge_result
from calibgui.engine.arrays import GreyImage
from calibgui.engine.assessment import Grade
from calibgui.engine.boards import Board
from calibgui.engine.camera import Camera, ImageCircle
from calibgui.engine.images import undistort_image, write_image
from calibgui.engine.images.rendering import render_view
from calibgui.report.summary import describe_unequal_pixels
from tests.engine import scenes

SIZE = (320, 240)
SETTINGS = Settings(model="brown-conrady", improve=True, once=True)
"""Nothing of the lens is chosen, which takes most of the time; what does not belong is left out."""
ASPECTS = (1.33, 2.0, 0.5, 834 / 910)


def search(folder: Path, images: Iterator[GreyImage], board: Board, stated: bool) -> Detection:
    for k, image in enumerate(images):
        write_image(folder / f"v{k:02d}.png", image)
    return find_views(sorted(folder.iterdir()), board.grid_size if stated else None)


def calibrate(detection: Detection, board: Board) -> Result:
    *_, last = calibrate_best(detection.corner_set(board.square), SETTINGS)
    return last.result


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(len(ASPECTS)))
def test_pixels_that_are_not_square(seed: int, tmp_path: Path) -> None:
    rng, board, aspect = np.random.default_rng([seed, 52]), Board(6, 9, 25.0), ASPECTS[seed]
    fx = 330 / max(aspect, 1.0)
    centre = np.array(SIZE) / 2 + rng.uniform(-6, 6, 2)
    lens = [-0.12 + rng.uniform(-0.05, 0.05), 0.03, 0.0, 0.0, 0.0]
    truth = Camera(SIZE, [fx, fx * aspect, *centre, *lens, 0.0], "brown-conrady")
    poses = (scenes.looking(truth, rng, fill=(0.45, 0.65), board=board) for _ in count())
    images = (render_view(truth, next(poses), board, blur=0.6, noise=1.5, seed=k) for k in range(7))
    result = calibrate(search(tmp_path, images, board, stated=False), board)
    calibration = result.calibration
    assert len(result.used) == 7
    off = (calibration.camera.params[:4] - truth.params[:4]) / calibration.sigma[:4]
    assert np.abs(off).max() < 5
    np.testing.assert_allclose(calibration.camera.params[:2], truth.params[:2], rtol=3e-3)
    said = describe_unequal_pixels(calibration, judge_result(result).findings)
    assert "The pixels are not square" in said and "--square-pixels" in said
    made = undistort_image(np.zeros(SIZE[::-1], np.uint8), calibration.camera, square_pixels=True)
    assert made.matrix[0, 0] == pytest.approx(made.matrix[1, 1])


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_a_circle_of_light_on_black(seed: int, tmp_path: Path) -> None:
    rng, board = np.random.default_rng([seed, 53]), Board(8, 11, 3.0)
    f, k1 = rng.uniform(240, 300), rng.uniform(-0.4, -0.25)
    centre = np.array(SIZE) / 2 + rng.uniform(-3, 3, 2)
    truth = Camera(SIZE, [f, f * 1.004, *centre, k1, 0.12, 0, 0, 0, 0], "brown-conrady")
    circle = ImageCircle(*(np.array(SIZE) / 2 + rng.uniform(-8, 8, 2)), rng.uniform(100, 112))
    lit = circle.contains(np.stack(np.meshgrid(*map(np.arange, SIZE)), axis=-1))

    def photograph(k: int) -> GreyImage:
        pose = scenes.looking(truth, rng, fill=(0.4, 0.72), board=board)
        image = render_view(truth, pose, board, blur=0.7, noise=2.0, seed=k)
        dark = np.clip(8 + 2 * rng.standard_normal(image.shape), 0, 255)
        return np.where(lit, image, dark).astype(np.uint8)

    detection = search(tmp_path, map(photograph, range(8)), board, stated=True)
    assert all("number of" not in view.reason for view in detection.views)
    assert sum(view.status is ViewStatus.FOUND for view in detection.views) >= 6
    result = calibrate(detection, board)
    camera = result.calibration.camera
    assert camera.circle is not None
    np.testing.assert_allclose(camera.circle, circle, atol=2.5)
    off = (camera.params[:4] - truth.params[:4]) / result.calibration.sigma[:4]
    assert np.abs(off).max() < 5
    verdict = judge_result(result)
    assert verdict.grade in (Grade.GOOD, Grade.USABLE)
    assert verdict.error.worst < 3  # of the black corners it would be tens of pixels
    advice = " ".join([verdict.reason, *(finding.remedy for finding in verdict.findings)])
    assert "image's edge" not in advice
    shown = undistort_image(np.full(SIZE[::-1], 200, np.uint8), camera, "no-border").image
    assert shown.min() > 100
