"""Located corners to a result."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.app.calibration import calibrate_views, short_names
from calibgui.engine import CalibrationError, Cancelled, Iteration, Observation, View, ViewStatus
from calibgui.formats.corners_json import CornerSet
from tests.engine import scenes
from tests.photographs import BOARD, CAMERA, poses


def corner_set() -> CornerSet:
    scene = scenes.seen(CAMERA, poses(), BOARD)
    views = [
        View(f"a/{k}.png", ViewStatus.FOUND, points=Observation(view.uv, view.xy))
        for k, view in enumerate(scene.views)
    ]
    return CornerSet(CAMERA.size, tuple(views))


def test_unusable_views_stay_in_the_result_but_out_of_the_solve() -> None:
    found = corner_set()
    blank = View("a/blank.png", ViewStatus.NO_BOARD, "No checkerboard was found.")
    switched_off = replace(found.views[2], enabled=False)
    views = (blank, *found.views[:2], switched_off, *found.views[3:])
    result = calibrate_views(replace(found, views=views), fix=("k2", "k3"))
    assert result.views == views
    assert len(result.calibration.poses) == len(found.views) - 1
    assert result.calibration.fixed == ("k2", "k3", "p3")


def test_errors_name_the_image() -> None:
    found = corner_set()
    points = found.views[3].points
    assert points is not None
    uv = np.array(points.uv)
    uv[5] = np.nan
    views = list(found.views)
    views[3] = replace(views[3], points=Observation(uv, points.xy))
    with pytest.raises(CalibrationError, match=r"^3\.png holds a corner"):
        calibrate_views(replace(found, views=tuple(views)))


def test_no_usable_view_is_an_error() -> None:
    blank = View("a.png", ViewStatus.NO_BOARD, "No checkerboard was found.")
    with pytest.raises(CalibrationError, match="None of the images"):
        calibrate_views(CornerSet((320, 240), (blank,)))


def test_a_report_can_cancel() -> None:
    def report(_: Iteration) -> bool:
        raise Cancelled

    with pytest.raises(Cancelled):
        calibrate_views(corner_set(), report=report)


def test_names_are_short_where_that_is_enough() -> None:
    assert short_names([View("a/1.png"), View("b/2.png")]) == ["1.png", "2.png"]
    assert short_names([View("a/1.png"), View("b/1.png")]) == ["a/1.png", "b/1.png"]
