"""Located corners to a result."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.calibrating.calibration import calibrate_views, recall_lens_choice, shorten_names
from calibgui.app.calibrating.settings import (
    DEFAULT_MODEL,
    MODEL_CHOICES,
    Settings,
    check_settings,
    get_own_model,
    list_parameters,
)
from calibgui.app.photographs.detection import find_views
from calibgui.app.system.resources import find_resource, find_sample_square
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.arrays import Array
from calibgui.engine.assessment.choices import lens_choice
from calibgui.engine.assessment.residuals.residual_checks import check_residuals
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import DEFAULT_METHOD, Cost, Iteration, Status
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import pixels_from_rays
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.features.corners import Corners
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.report.tables import list_unused_views
from tests.app import examples
from tests.engine import scenes
from tests.photographs import BOARD, CAMERA, draw_poses


def corner_set() -> CornerSet:
    scene = scenes.seen(CAMERA, draw_poses(), BOARD)
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
    result = calibrate_views(replace(found, views=views), Settings(fixed={"k2": None, "k3": 0.0}))
    assert result.views == views
    assert len(result.calibration.poses) == len(found.views) - 1
    assert result.calibration.fixed == ("k2", "k3", "p3")


@pytest.mark.parametrize("count", [1, 8])
def test_a_camera_that_is_held_whole_is_refused(count: int) -> None:
    found = corner_set()
    views = replace(found, views=found.views[:count])
    held = dict(zip(("fx", "fy", "cx", "cy"), CAMERA.params.tolist(), strict=False))
    with pytest.raises(CalibrationError, match=r"\(fx, fy, cx, cy\), which leaves nothing"):
        calibrate_views(views, Settings(model="pinhole", fixed=held))


def test_a_view_of_one_corner_stays_out_of_the_solve() -> None:
    found = corner_set()
    one = Corners((7, 8), np.array([(2, 3)]), np.full((1, 2), 99.0), np.full((1, 2), 99.0))
    views = (View("one.png", ViewStatus.FOUND, corners=one), *found.views)
    result = calibrate_views(replace(found, views=views), Settings(fixed={"k2": None, "k3": 0.0}))
    assert result.views == views
    assert len(result.calibration.poses) == len(found.views)
    assert "one.png: The few corners found" in list_unused_views(result.views)
    with pytest.raises(CalibrationError, match="None of the images"):
        calibrate_views(replace(found, views=views[:1]))


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


@pytest.mark.parametrize(
    "cov", [np.zeros((2, 2)), -np.eye(2), np.diag([1.0, np.nan]), np.diag([1.0, 1e-15])], ids=str
)
def test_a_view_without_usable_covariances_is_left_out_by_name(cov: Array) -> None:
    """It does not end the job, which the engine itself does."""
    views = []
    for view in noisy().views:
        points = view.points
        assert points is not None
        weights = np.broadcast_to(0.05**2 * np.eye(2), (len(points.uv), 2, 2))
        views.append(replace(view, points=points._replace(cov=weights.copy())))
    spoilt = views[3].points
    assert spoilt is not None and spoilt.cov is not None
    spoilt.cov[5:7] = cov
    result = calibrate_views(CornerSet(CAMERA.size, tuple(views)))
    assert [view.image for view in result.views if not view.usable] == ["3.png"]
    assert result.views[3].reason.startswith("Left out: 2 of 42 corners would count with")
    others = CornerSet(CAMERA.size, (*views[:3], *views[4:]))
    expected = calibrate_views(others).calibration.camera.params
    np.testing.assert_array_equal(result.calibration.camera.params, expected)
    if np.linalg.eigvalsh(np.nan_to_num(cov)).min() <= 0:
        with pytest.raises(CalibrationError, match=r"^3\.png h(as|olds) a corner"):
            calibrate(
                [view.observation(None) for view in views],
                CAMERA.size,
                names=[view.image for view in views],
            )
    alone = CornerSet(CAMERA.size, (views[3],))
    with pytest.raises(CalibrationError, match="No view is left"):
        calibrate_views(alone)


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
    assert shorten_names([View("a/1.png"), View("b/2.png")]) == ["1.png", "2.png"]
    assert shorten_names([View("a/1.png"), View("b/1.png")]) == ["a/1.png", "b/1.png"]


def noisy(board_shape: Array | None = None) -> CornerSet:
    """Twelve views with 0.05 px of noise, of a board with deviations (n, 3) mm."""
    rng = np.random.default_rng(4)
    views = []
    for k, pose in enumerate(draw_poses() + draw_poses()[:4]):
        xy = BOARD.points()
        point = np.column_stack([xy, np.zeros(len(xy))]) + (
            0 if board_shape is None else board_shape
        )
        seen = point @ rotation_from_vector(pose.rvec).T + pose.tvec
        uv = pixels_from_rays(seen, CAMERA) + rng.normal(0, 0.05, xy.shape)
        views.append(View(f"{k}.png", ViewStatus.FOUND, points=Observation(uv, xy)))
    return CornerSet(CAMERA.size, tuple(views))


def test_outliers_are_left_out_by_name() -> None:
    spoilt = noisy()
    views = list(spoilt.views)
    for k, change in ((1, lambda uv: uv + np.eye(len(uv), 2, -4) * 30), (5, lambda uv: uv[::-1])):
        points = views[k].points
        assert points is not None
        views[k] = replace(views[k], points=Observation(change(points.uv), points.xy))
    mirrored = views[7].points
    assert mirrored is not None
    flipped = mirrored.uv.reshape(BOARD.rows, BOARD.cols, 2)[:, ::-1].reshape(-1, 2)
    views[7] = replace(views[7], points=Observation(flipped, mirrored.xy))
    result = calibrate_views(replace(spoilt, views=tuple(views)), Settings(robust=True))
    assert [view.image for view in result.views if not view.usable] == ["7.png"]
    assert "mirrored" in result.views[7].reason
    kept = result.views[1].points
    assert kept is not None and len(kept.uv) == len(BOARD.points()) - 2
    assert result.calibration.settings.outliers == 2 + len(BOARD.points())
    first, second, third = result.calibration.warnings
    assert [first.split()[0], second.split()[0]] == ["1.png", "7.png"]
    assert third.startswith("The board is upside down in 5.png, as its corners are numbered.")


def test_views_are_weighed_by_their_noise() -> None:
    corners = noisy()
    poor = corners.views[3].points
    assert poor is not None
    blurred = poor.uv + np.random.default_rng(7).normal(0, 0.5, poor.uv.shape)
    views = list(corners.views)
    views[3] = replace(views[3], points=Observation(blurred, poor.xy))
    spoilt = replace(corners, views=tuple(views))
    alike, weighed = (calibrate_views(spoilt, Settings(weigh_views=w)) for w in (False, True))
    assert (weighed.calibration.sigma[:4] < 0.7 * alike.calibration.sigma[:4]).all()
    assert "median view, most in 3.png" in weighed.calibration.warnings[0]
    assert (alike.calibration.settings.weigh_views, alike.calibration.settings.robust) == (
        False,
        False,
    )
    assert weighed.calibration.settings.weigh_views
    # What is kept of the views is what they were weighed with: solved again it gives the same.
    again = calibrate(weighed.observations(), spoilt.size)
    np.testing.assert_allclose(
        again.camera.params[:4], weighed.calibration.camera.params[:4], atol=1e-3
    )
    with pytest.raises(CalibrationError, match="alike"):
        calibrate_views(spoilt, Settings(Cost.REFERENCE, weigh_views=True))


def test_of_few_views_none_is_left_out_or_weighed_and_that_is_kept() -> None:
    corners = noisy()
    one = replace(corners, views=corners.views[:1])
    found = calibrate_views(one, Settings(robust=True, weigh_views=True)).calibration
    assert found.diagnosis is not None
    assert (found.settings.robust, found.settings.weigh_views) == (False, False)


def test_the_best_plate_is_chosen_and_said() -> None:
    bow = 0.004 * (BOARD.points()[:, 0] - BOARD.points()[:, 0].mean()) ** 2
    bent = np.column_stack([np.zeros((len(bow), 2)), bow / 5])
    result = calibrate_views(noisy(bent), Settings(board_shape=None))
    assert result.calibration.board_shape is not None
    assert "unseen views" in result.calibration.warnings[0]
    assert calibrate_views(noisy(), Settings(board_shape=None)).calibration.board_shape is None


def test_no_plate_is_chosen_for_a_lens_that_is_not_followed() -> None:
    result = calibrate_views(noisy(), Settings(board_shape=None, model="pinhole"))
    assert result.calibration.board_shape is None
    assert result.calibration.lens_error > 0
    assert "The lens comes first" in result.calibration.warnings[0]


@pytest.mark.slow
@pytest.mark.usefixtures("search_here")
def test_what_is_left_of_the_sample_looks_like_noise() -> None:
    """Its photographs are rendered: nothing is wrong with board, camera or lens."""
    images = sorted(find_resource("sample").glob("*.png"))
    found = find_views(images).corner_set(find_sample_square(images))
    result = calibrate_views(found)
    report = check_residuals(result.calibration, result.observations())
    assert report.passed, report.cause


def test_the_comparison_of_plates_can_be_stopped_or_cancelled() -> None:
    """The best so far is then a camera with the board as drawn."""
    told: list[Iteration] = []

    def stop(iteration: Iteration) -> bool:
        told.append(iteration)
        return len(told) < 8

    result = calibrate_views(noisy(), Settings(board_shape=None), stop)
    assert result.calibration.status is Status.STOPPED
    assert result.calibration.board_shape is None
    assert "was stopped" in result.calibration.warnings[0]
    assert len(told) < 12

    def cancel(_: Iteration) -> bool:
        raise Cancelled

    with pytest.raises(Cancelled):
        calibrate_views(noisy(), Settings(board_shape=None), cancel)


@pytest.fixture
def few_lenses(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the choice of a lens model have few to choose from, which is quick."""
    monkeypatch.setattr(lens_choice, "_FIRST_CANDIDATES", ("lucchese", "brown-conrady"))
    monkeypatch.setattr(lens_choice, "_NEXT_CANDIDATES", ("division", "kannala-brandt"))


AUTO = Settings(model=None)


@pytest.mark.usefixtures("few_lenses")
def test_the_papers_lens_model_is_kept_where_it_is_enough() -> None:
    progress: list[tuple[int, int]] = []
    result = calibrate_views(noisy(), AUTO, progress=lambda *at: progress.append(at))
    calibration = result.calibration
    assert calibration.camera.model == calibration.settings.model == "lucchese"
    assert calibration.warnings[0] == calibration.settings.model_reason
    assert calibration.warnings[0].startswith("The paper's model (Lucchese) is kept: it predicts")
    assert progress == [(0, 4), (1, 4), (2, 4), (3, 4), (4, 5), (1, 1)]
    by_name = calibrate_views(noisy(), Settings()).calibration
    np.testing.assert_array_equal(calibration.camera.params, by_name.camera.params)
    assert by_name.settings.model_reason is None
    assert recall_lens_choice(result) == ("lucchese", calibration.warnings[0], {})


def fisheye() -> CornerSet:
    """Six views with 0.1 px of noise, far off the axis of a fisheye lens."""
    rng = np.random.default_rng(1)
    lens = Camera((640, 480), [235, 234, 318, 243, -0.05, 4e-3, -3e-3, 4e-4], "kannala-brandt")
    poses = [scenes.looking(lens, rng, fill=(0.8, 2.0)) for _ in range(6)]
    views = scenes.seen(lens, poses, partial=True).noisy(0.1, rng)
    found = [View(f"{k}.png", ViewStatus.FOUND, points=view) for k, view in enumerate(views)]
    return CornerSet(lens.size, tuple(found))


@pytest.mark.usefixtures("few_lenses")
@pytest.mark.parametrize("model", [BoardShapeModel.BOW, pytest.param(None, marks=pytest.mark.slow)])
def test_what_a_bent_board_hides_of_the_lens_is_not_held_at_zero(
    model: BoardShapeModel | None,
) -> None:
    bow = 0.0012 * (BOARD.points()[:, 0] - BOARD.points()[:, 0].mean()) ** 2
    bent = noisy(np.column_stack([np.zeros((len(bow), 2)), bow]))
    chosen = calibrate_views(bent, replace(AUTO, board_shape=model)).calibration
    assert chosen.board_shape is not None
    assert chosen.fixed == ("p3",)


@pytest.mark.usefixtures("few_lenses")
def test_a_fisheye_lens_gets_a_model_of_its_own() -> None:
    result = calibrate_views(fisheye(), AUTO)
    assert result.calibration.camera.model == "kannala-brandt"
    assert result.calibration.warnings[0].startswith("Kannala-Brandt: it predicts")
    again = calibrate_views(fisheye(), AUTO, lens=recall_lens_choice(result))
    assert again.calibration.settings.model_reason == result.calibration.warnings[0]


@pytest.mark.usefixtures("few_lenses")
def test_outliers_do_not_decide_on_the_lens_model() -> None:
    """The reason is that of the corners that are kept."""
    spoilt = fisheye()
    points = spoilt.views[1].points
    assert points is not None
    uv = np.array(points.uv)
    uv[7] += 20.0
    view = replace(spoilt.views[1], points=Observation(uv, points.xy))
    views = (spoilt.views[0], view, *spoilt.views[2:])
    result = calibrate_views(replace(spoilt, views=views), replace(AUTO, robust=True))
    assert result.calibration.camera.model == "kannala-brandt"
    clean = float(str(result.calibration.warnings[0]).split(" px RMS")[0].split()[-1])
    assert clean < 0.2
    assert result.calibration.warnings[1].startswith("1.png loses 1 corner")


def test_where_lenses_cannot_be_compared_the_papers_is_taken() -> None:
    two = replace(noisy(), views=noisy().views[:2])
    found = calibrate_views(two, AUTO).calibration
    assert found.camera.model == "lucchese"
    assert "without a comparison. 2 views are too few" in found.settings.model_reason
    one = replace(noisy(), views=noisy().views[:1])
    assert calibrate_views(one, AUTO).calibration.diagnosis is not None


@pytest.mark.usefixtures("few_lenses")
def test_the_comparison_of_lenses_can_be_stopped_or_cancelled() -> None:
    told: list[Iteration] = []

    def stop(iteration: Iteration) -> bool:
        told.append(iteration)
        return len(told) < 8

    result = calibrate_views(noisy(), AUTO, stop)
    assert result.calibration.status is Status.STOPPED
    assert result.calibration.camera.model == "lucchese"
    assert "was stopped" in result.calibration.warnings[0]
    assert len(told) < 12

    def cancel(*_: object) -> bool:
        raise Cancelled

    for listening in ({"report": cancel}, {"progress": cancel}):
        with pytest.raises(Cancelled):
            calibrate_views(noisy(), AUTO, **listening)  # type: ignore[arg-type]


@pytest.mark.usefixtures("few_lenses")
def test_what_all_lens_models_have_can_be_held() -> None:
    held = calibrate_views(noisy(), replace(AUTO, fixed={"cx": 155.0})).calibration
    assert held.camera.params[2] == 155.0
    for wrong in (
        replace(AUTO, fixed={"k1": None}),
        replace(AUTO, freed=("p3",)),
    ):
        with pytest.raises(CalibrationError, match="chosen automatically, and not all models have"):
            check_settings(wrong)
    with pytest.raises(CalibrationError, match="combined with 'auto'"):
        check_settings(replace(AUTO, cost=Cost.PAPER))


def test_a_method_takes_its_own_lens_models_costs_boards_and_weights() -> None:
    own = Settings(method="bouguet", model=get_own_model("bouguet"))
    check_settings(own)
    assert get_own_model(DEFAULT_METHOD) == DEFAULT_MODEL
    for changes, message in (
        ({"model": "rational"}, "'bouguet' cannot estimate the lens model 'rational'"),
        ({"model": None}, "not chosen automatically for the method 'bouguet'"),
        ({"cost": Cost.REFERENCE}, "'bouguet' cannot minimise the cost 'reference'"),
        ({"board_shape": BoardShapeModel.FREE}, "'bouguet' takes the board as it is drawn"),
        ({"board_shape": None}, "'bouguet' takes the board as it is drawn"),
        ({"weigh_views": True}, "'bouguet' takes all corners as equally good"),
    ):
        with pytest.raises(CalibrationError, match=message) as told:
            check_settings(replace(own, **changes))
        assert told.value.hint


def test_splined_models_of_any_numbers_can_be_named() -> None:
    check_settings(Settings(model="splined-stereographic-12x8-100", fixed={"dx_2_5": 0.0}))
    with pytest.raises(CalibrationError, match="no parameter 'k1'") as error:
        check_settings(Settings(model="splined-stereographic-12x8-100", fixed={"k1": 0.0}))
    assert len(error.value.hint) < 300, "not all 196 names"
    for wrong in ("lucchese-pixels", "none", "splined-stereographic-2x2-100"):
        with pytest.raises(CalibrationError):
            check_settings(Settings(model=wrong))


@pytest.mark.parametrize("model", [name for name in MODEL_CHOICES if "splined" not in name])
def test_a_camera_that_is_held_whole_is_sent_to_pose(model: str, tmp_path: Path) -> None:
    """Whatever the lens model: nothing is left to calibrate, and no traceback says so."""
    project = examples.calibrated(tmp_path)
    held = dict.fromkeys(list_parameters(model), None) | {"fx": 200.0, "fy": 204.0}
    held |= {"cx": 97.0, "cy": 76.0}
    corner_set = CornerSet(examples.CAMERA.size, project.views, project.board)
    with pytest.raises(CalibrationError, match="leaves nothing to calibrate") as caught:
        calibrate_views(corner_set, Settings(model=model, fixed=held))
    assert "calibgui pose" in caught.value.hint
