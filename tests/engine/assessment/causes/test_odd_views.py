"""Photographs that do not belong to the others are named, and nobody else is."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.action import ActionKind
from calibgui.engine.assessment.causes import odd_views
from calibgui.engine.assessment.causes.case import prepare_case
from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.causes.odd_views import OddViews, find_odd_views, turn_view
from calibgui.engine.assessment.causes.rival_lens import Rival
from calibgui.engine.assessment.finding import Cause
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from tests.engine.scenes import BOARD, VGA, barrel, scene

OFF_CENTRE = Camera(VGA, np.add(barrel().params, [0, 0, -16, 8, 0, 0, 0, 0, 0, 0]))
ENDS = float(BOARD.points()[:, 0].min() + BOARD.points()[:, 0].max())


def make_views(count: int, seed: int = 4, noise: float = 0.1) -> list[Observation]:
    return scene(OFF_CENTRE, count, seed=seed).noisy(noise, np.random.default_rng(seed))


@pytest.mark.parametrize(
    ("count", "turned", "turn", "how"),
    [
        (9, (8,), (-1, -1), "upside down"),
        (14, (2, 5), (-1, -1), "upside down"),
        (9, (2, 4, 6), (-1, -1), "upside down"),  # they hide each other
        (9, (3,), (-1, 1), "mirrored left to right"),
        (9, (0,), (-1, 1), "mirrored left to right"),
        (10, (4, 7), (-1, 1), "mirrored left to right"),
        (10, (9,), (1, -1), "mirrored top to bottom"),
        (12, (1, 6, 8), (1, -1), "mirrored top to bottom"),
        (8, (0,), (-1, -1), "upside down"),
        (20, (3, 11), (-1, -1), "upside down"),
        (12, (0, 7), (1, -1), "mirrored top to bottom"),
    ],
)
def test_turned_photographs_are_named_before_any_cause(
    count: int, turned: tuple[int, ...], turn: tuple[int, int], how: str
) -> None:
    views = make_views(count)
    for k in turned:
        views[k] = turn_view(views[k], turn, VGA, ENDS)
    names = [f"{k}.png" for k in range(count)]
    (finding,) = list_findings(calibrate(views, VGA), views, names)
    assert finding.cause is Cause.MIXED_VIEWS and finding.views == turned
    assert how in finding.message and all(names[k] in finding.message for k in turned)
    assert finding.action is not None and finding.action.kind is ActionKind.LEAVE_OUT_VIEWS


@pytest.mark.parametrize(("turn", "how"), [((-1, -1), "upside down"), ((1, -1), "top to bottom")])
def test_turned_photographs_are_named_where_the_boards_shape_is_free(
    turn: tuple[int, int], how: str
) -> None:
    """The shape takes up a part of what a turned view leaves."""
    views = make_views(9, seed=4, noise=0.03)
    views[8] = turn_view(views[8], turn, VGA, ENDS)
    calibration = calibrate(views, VGA, board_shape="free")
    found = find_odd_views(prepare_case(calibration, views, [str(k) for k in range(9)]))
    assert found.turned is not None
    assert found.turned.views == (8,)
    assert how in found.turned.how


def test_a_view_of_another_zoom_is_a_stranger() -> None:
    views, c = make_views(12), OFF_CENTRE.centre
    views[6] = views[6]._replace(uv=c + 0.8 * (views[6].uv - c))
    names = [str(k) for k in range(len(views))]
    found = find_odd_views(prepare_case(calibrate(views, VGA), views, names))
    assert found.turned is None and found.strangers is not None
    assert found.strangers.views == (6,)
    assert found.strangers.others.noise == pytest.approx(0.1, rel=0.1)


def test_rows_read_in_motion_make_no_view_turned() -> None:
    rng = np.random.default_rng(0)
    views = [
        view._replace(uv=view.uv + np.outer(view.uv[:, 1] / VGA[1] - 0.5, rng.normal(0, 5, 2)))
        for view in make_views(16)
    ]
    names = [str(k) for k in range(len(views))]
    assert find_odd_views(prepare_case(calibrate(views, VGA), views, names)) == OddViews()


def test_no_view_is_turned_that_suits_another_lens_as_it_is() -> None:
    """Turning views back takes a part of what a lens leaves that its model does not follow."""
    views = make_views(9)
    views[8] = turn_view(views[8], (-1, -1), VGA, ENDS)
    case = prepare_case(calibrate(views, VGA), views, [str(k) for k in range(9)])
    for share, is_turned in ((0.0, True), (0.9999, False)):
        case.__dict__["rival"] = Rival(share, 1.0)
        assert (find_odd_views(case).turned is not None) == is_turned


def test_a_view_weighs_alike_in_every_reading() -> None:
    """One of large covariances does not suit the others better because it is read by itself."""
    views = [
        view._replace(cov=np.tile((0.1 * (1 + (k == 6))) ** 2 * np.eye(2), (len(view.uv), 1, 1)))
        for k, view in enumerate(make_views(8))
    ]
    case = prepare_case(calibrate(views, VGA), views, [str(k) for k in range(8)])
    by_itself, with_others = odd_views._Readings(case), odd_views._Readings(case)
    by_itself._read(np.arange(8) == 6)
    with_others._read(np.ones(8, dtype=bool))
    np.testing.assert_allclose(by_itself.forms[:, 6], with_others.forms[:, 6], rtol=1e-6)


def test_a_turned_view_is_the_same_once_it_is_turned_back() -> None:
    (view,) = make_views(1)
    for turn in ((-1, -1), (-1, 1), (1, -1)):
        back = turn_view(turn_view(view, turn, VGA, ENDS), turn, VGA, ENDS)
        np.testing.assert_allclose(back.uv, view.uv)
        np.testing.assert_allclose(back.xy, view.xy)


@pytest.mark.parametrize("seed", range(6))
def test_none_of_clean_photographs_is_named(seed: int) -> None:
    views = make_views(10, seed, 0.2)
    assert list_findings(calibrate(views, VGA), views) == ()
