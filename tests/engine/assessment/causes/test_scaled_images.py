"""Images that were scaled are told by the period of their corners' errors."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.causes.case import prepare_case
from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.causes.scaled_images import find_scaling
from calibgui.engine.assessment.finding import Cause, Finding
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.images.rendering import render_view
from tests.engine.scenes import barrel, looking
from tests.faults.sets import draw_rendered_set, photograph


def photograph_with_errors(size: float, period: float, axis: int = 1) -> list[Observation]:
    """Photograph a board whose corners are off by `size` px rms with a period, px."""
    photographed = draw_rendered_set(np.random.default_rng([2, 11]), barrel())

    def shift(_: int, uv: Array) -> Array:
        moved = uv.copy()
        moved[:, axis] += size * np.sqrt(12) * ((uv[:, axis] / period) % 1 - 0.5)
        return moved

    return photograph(photographed, shift=shift)


def find_with_errors(size: float, period: float, axis: int = 1) -> tuple[Finding, ...]:
    """List what is found in such photographs."""
    views = photograph_with_errors(size, period, axis)
    return list_findings(calibrate(views, barrel().size), views)


@pytest.mark.parametrize(("axis", "direction"), [(0, "across"), (1, "down")])
def test_errors_that_repeat_with_a_period_are_those_of_scaled_images(
    axis: int, direction: str
) -> None:
    (finding,) = find_with_errors(0.5, 1.6, axis)
    assert finding.cause is Cause.SCALED_IMAGES
    assert finding.message.startswith("The images were scaled")
    assert finding.action is None  # it does not matter where the board is held
    assert re.search(rf"repeat every 1\.(6|599)\d* px {direction} the image", finding.evidence)


def test_a_period_of_two_pixels_has_several_causes() -> None:
    (finding,) = find_with_errors(0.5, 2.0)
    assert finding.message.startswith("The images are interlaced or raw, or were scaled")


@pytest.mark.parametrize("period", [1.0, 47.0])
def test_a_bias_within_each_pixel_or_over_many_is_no_scale(period: float) -> None:
    assert Cause.SCALED_IMAGES not in [f.cause for f in find_with_errors(0.5, period)]


def test_a_period_that_explains_less_than_another_cause_is_not_named() -> None:
    views = photograph_with_errors(0.5, 1.6)
    case = prepare_case(calibrate(views, barrel().size), views, [str(k) for k in range(len(views))])
    assert find_scaling(case, explained=0.5) is not None
    assert find_scaling(case, explained=0.999) is None


def test_errors_without_a_period_are_nothing() -> None:
    assert find_with_errors(0.0, 1.6) == ()


def test_photographs_made_of_four_fifths_of_their_pixels_were_scaled() -> None:
    camera, rng = barrel(focal=520.0, size=(512, 384)), np.random.default_rng(3)
    larger = (640, 480)
    views = []
    for seed in range(10):
        board = Board(rows=7, cols=10, square=30.0)
        image = render_view(camera, looking(camera, rng), board, blur=0.3, noise=1.5, seed=seed)
        found = find_corners(cv2.resize(image, larger, interpolation=cv2.INTER_NEAREST))
        views.append(Observation(found.uv, 30.0 * found.grid[:, ::-1], found.cov))
    (finding,) = list_findings(calibrate(views, larger), views)
    assert finding.cause is Cause.SCALED_IMAGES
    assert re.search(r"repeat every (5|4\.99\d|5\.00\d) px", finding.evidence)
