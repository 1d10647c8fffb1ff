"""The verdict agrees with the truth of rendered sets, and what it promises comes true."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from calibgui.engine.assessment import action_trials
from calibgui.engine.assessment import verdict as verdict_module
from calibgui.engine.assessment.action import Action, ActionKind
from calibgui.engine.assessment.action_trials import try_action
from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.finding import Cause, Finding
from calibgui.engine.assessment.verdict import (
    MAX_GOOD_PX,
    Grade,
    PixelError,
    Verdict,
    _grade,
    judge_calibration,
)
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration, DegenerateError, Status
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.image_circle import ImageCircle
from calibgui.engine.errors import CalibrationError, Cancelled
from tests.engine.scenes import BOARD, VGA, barrel, scene, scene_in_the_middle
from tests.faults import sets
from tests.faults.causes import FAULTS
from tests.faults.sets import FaultySet

CLEAN = scene(barrel(), 10, seed=3).noisy(0.1, np.random.default_rng(1))


@pytest.fixture(autouse=True)
def rendered_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sets are the same whether real ones are present or not."""
    monkeypatch.setattr(sets, "_REAL_SETS", ())


def inject(name: str, seed: int) -> FaultySet:
    return FAULTS[name].inject(np.random.default_rng(seed))


def measure_covered(truth: Camera, camera: Camera, views: list[Observation]) -> float:
    """The true error of pixels where there are corners, rms."""
    return compare_cameras(truth, camera, views=views).rms


def judge(views: list[Observation], **settings: object) -> tuple[Calibration, Verdict]:
    found = calibrate(views, VGA, **settings)  # type: ignore[arg-type]
    return found, judge_calibration(found, views)


def test_a_clean_set_is_good_and_its_error_is_that_of_the_truth() -> None:
    calibration, verdict = judge(CLEAN)
    assert (verdict.grade, verdict.findings, verdict.times_better) == (Grade.GOOD, (), 1.0)
    error = verdict.error
    assert error.centre < error.edge < error.worst < 0.5
    assert error.covered < error.worst_covered < error.worst
    true = measure_covered(barrel(), calibration.camera, CLEAN)
    assert true / 3 < error.covered < 3 * true
    # 30 mm squares that appear as large as the pixels' length at the boards' distance says.
    apart = np.linalg.norm(np.diff(CLEAN[0].uv[:2], axis=0)) * verdict.mm_per_pixel
    assert apart == pytest.approx(30.0, rel=0.4)


@pytest.mark.parametrize(
    ("sigma", "grade", "causes"), [(0.1, Grade.GOOD, []), (0.2, Grade.GOOD, [Cause.BLUR])]
)
def test_unequal_noise_is_told_where_sharper_photographs_would_help(
    sigma: float, grade: Grade, causes: list[Cause]
) -> None:
    """Every other view has 2.5 times the noise, so that weights bring little."""
    rng = np.random.default_rng(1)
    drawn = scene(barrel(), 12, seed=3)
    sharp, blurred = drawn.noisy(sigma, rng), drawn.noisy(2.5 * sigma, rng)
    _, verdict = judge([(blurred if k % 2 else sharp)[k] for k in range(12)])
    assert (verdict.grade, [finding.cause for finding in verdict.findings]) == (grade, causes)
    for finding in verdict.findings:
        assert finding.action is None and finding.remedy.startswith("Take these again, sharp")
        assert "sharp" not in finding.message, "a board that is far away does the same"


@pytest.mark.parametrize(("worst", "known"), [(3.0, "known to 3.0 px"), (27e3, "not known")])
def test_an_error_of_thousands_of_pixels_is_no_number(worst: float, known: str) -> None:
    """A rational lens that is open beyond the corners may image their neighbours anywhere."""
    calibration = calibrate(CLEAN, VGA)
    error = PixelError(0.02, worst, worst, 0.02, 0.02, 0.03)
    _, reason = _grade(calibration, error, [])
    assert f"known to 0.030 px. Beyond them it is {known}:" in reason


@pytest.mark.parametrize(("count", "grade"), [(2, Grade.NOT_USABLE), (4, Grade.USABLE)])
def test_few_views_are_never_good_however_small_their_noise(count: int, grade: Grade) -> None:
    views = scene(barrel(), 10, seed=3).noisy(0.001, np.random.default_rng(1))[:count]
    _, verdict = judge(views)
    assert verdict.error.median < 1.0
    assert verdict.grade is grade
    assert f"{count} views are too few" in verdict.reason
    assert verdict.findings or "take 5 or more" in verdict.reason


@pytest.mark.parametrize(
    ("count", "message"),
    [
        (10, "The lens model Pinhole does not follow this lens."),
        (4, "4 views are too few: the lens model Pinhole does not follow this lens."),
    ],
)
def test_a_recommended_lens_that_is_not_followed_takes_photographs(
    count: int, message: str
) -> None:
    lens = replace(barrel(), params=[*barrel().params[:4], 0.002, *[0.0] * 5])
    views = scene(lens, count, seed=3).noisy(0.02, np.random.default_rng(1))
    found = calibrate(views, VGA, model="pinhole")
    (offered,) = judge_calibration(found, views).findings
    assert offered.action is not None and offered.action.kind is ActionKind.CHOOSE_LENS_MODEL
    recommended = replace(found, settings=replace(found.settings, model_reason="It is the best."))
    (finding,) = judge_calibration(recommended, views).findings
    assert finding.message == message
    assert finding.remedy.startswith("No lens model that these views determine")
    assert "scaled, stitched or corrected" in finding.remedy  # which no lens model follows, too
    assert finding.action == Action(ActionKind.PHOTOGRAPH_MORE)


def test_a_poorly_known_edge_of_the_image_does_not_make_four_views_unusable() -> None:
    views = scene(barrel(), 10, seed=3).noisy(0.2, np.random.default_rng(1))[:4]
    _, verdict = judge(views)
    assert [finding.cause for finding in verdict.findings] == [Cause.FEW_VIEWS]
    assert verdict.error.median < 1.0
    assert verdict.grade is Grade.USABLE


def test_views_that_do_not_determine_the_camera_have_no_error() -> None:
    fault = inject("one-orientation", 0)
    with pytest.raises(DegenerateError) as caught:
        calibrate(fault.views, fault.size)
    partial = caught.value.partial
    assert partial is not None
    verdict = judge_calibration(partial, fault.views)
    assert verdict.grade is Grade.NOT_USABLE
    assert np.isinf(verdict.error.edge)


@pytest.mark.parametrize(
    ("name", "seed", "cause", "kind"),
    [
        ("bow", 0, Cause.BOARD_SHAPE, ActionKind.ESTIMATE_BOARD_SHAPE),
        ("wrong-square", 0, Cause.BOARD_SHAPE, ActionKind.ESTIMATE_BOARD_SHAPE),
        ("wide-lens", 0, Cause.LENS, ActionKind.CHOOSE_LENS_MODEL),
        ("row-shifted", 1, Cause.MISPLACED_CORNERS, ActionKind.LEAVE_OUT_CORNERS),
        ("held-value", 2, Cause.HELD_VALUE, ActionKind.FREE_HELD_VALUE),
    ],
)
def test_what_a_remedy_promises_comes_true(
    name: str, seed: int, cause: Cause, kind: ActionKind
) -> None:
    fault = inject(name, seed)
    found = calibrate(fault.views, fault.size, **fault.options)  # type: ignore[arg-type]
    verdict = judge_calibration(found, fault.views)
    assert verdict.grade is Grade.CAN_BE_BETTER
    first = verdict.findings[0]
    assert first.cause is cause and first.action is not None and first.action.kind is kind
    # The error that is stated is the true one.
    true = measure_covered(fault.truth, found.camera, fault.views)
    assert verdict.error.covered == pytest.approx(true, rel=0.3)
    # Once the remedy is carried out, the verdict is as much better as was said.
    trial = try_action(first.action, found, fault.views)
    assert trial is not None
    after = judge_calibration(trial.calibration, trial.views)
    gained = verdict.error.covered / after.error.covered
    assert gained == pytest.approx(verdict.times_better, rel=0.3)
    # The truth is one draw, and scatters about that: see the module's docstring.
    left = measure_covered(fault.truth, trial.calibration.camera, trial.views)
    assert true / left > verdict.times_better / 3
    assert cause not in [finding.cause for finding in after.findings]


@pytest.mark.parametrize(
    "settings", [{"cost": "paper", "fix": ["p3"]}, {"cost": "reference"}, {"method": "bouguet"}]
)
def test_a_board_is_found_and_mended_whatever_was_minimised(settings: dict[str, Any]) -> None:
    _, verdict = judge(inject("bow", 0).views, **settings)
    (finding,) = verdict.findings
    assert (verdict.grade, finding.cause) == (Grade.CAN_BE_BETTER, Cause.BOARD_SHAPE)
    assert verdict.times_better > 3


@pytest.mark.parametrize("cost", ["paper", "reference"])
def test_a_clean_set_is_good_with_every_cost(cost: str) -> None:
    _, verdict = judge(CLEAN, cost=cost, fix=["p3"])
    assert (verdict.grade, verdict.findings) == (Grade.GOOD, ())


def test_a_finding_lowers_the_grade_only_if_it_costs_more_than_its_limit() -> None:
    fault = inject("bending-board", 1)
    calibration, verdict = judge(fault.views)
    assert [finding.cause for finding in verdict.findings] == [Cause.BENDING_BOARD]
    assert verdict.error.worst_covered < MAX_GOOD_PX and verdict.grade is Grade.GOOD
    assert "bends from view to view" in verdict.reason
    assert verdict.reason.startswith("Nothing needs to be done")
    poor = replace(verdict.error, worst_covered=1.1 * MAX_GOOD_PX)
    assert _grade(calibration, poor, verdict.findings)[0] is Grade.USABLE
    assert verdict.findings[0].action == Action(ActionKind.PHOTOGRAPH_MORE)


def test_a_board_whose_shape_cannot_be_estimated_asks_for_photographs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise CalibrationError("The views do not determine the board's shape.", "Add views.")

    monkeypatch.setattr(action_trials, "choose_board_shape", refuse)
    _, verdict = judge(inject("bow", 0).views)
    assert verdict.findings[0].cause is Cause.BOARD_SHAPE
    assert verdict.findings[0].action == Action(ActionKind.PHOTOGRAPH_MORE)
    assert "stiff" in verdict.findings[0].remedy
    assert "estimate" not in verdict.findings[0].remedy
    assert verdict.grade in (Grade.GOOD, Grade.USABLE)


@pytest.fixture
def keep_drawing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Estimating a board's shape brings nothing."""

    def choose(*_: Any, nominal: Calibration, **__: Any) -> SimpleNamespace:
        return SimpleNamespace(model=BoardShapeModel.NOMINAL, chosen=nominal)

    monkeypatch.setattr(action_trials, "choose_board_shape", choose)


@pytest.mark.usefixtures("keep_drawing")
def test_a_board_that_leaves_pixels_too_poorly_known_asks_for_photographs() -> None:
    _, verdict = judge(inject("bow", 1).views)
    assert verdict.grade is Grade.NOT_USABLE
    assert [finding.cause for finding in verdict.findings] == [Cause.BOARD_SHAPE]
    assert verdict.findings[0].action == Action(ActionKind.PHOTOGRAPH_MORE)


@pytest.mark.usefixtures("keep_drawing")
def test_a_board_whose_shape_brings_nothing_is_no_finding() -> None:
    _, verdict = judge(inject("bow", 0).views)
    assert (verdict.findings, verdict.grade) == ((), Grade.USABLE)
    assert "add photographs" in verdict.reason  # the standard deviations include the doubt


def bow_views() -> list[Observation]:
    """Views of a bowed board in the middle of the image."""
    drawn, xy = scene_in_the_middle(barrel(), 12, seed=1, spread=0.15), BOARD.points()
    bow = np.column_stack([xy, 1e-4 * (xy[:, 0] - 165) ** 2])
    rng = np.random.default_rng(0)
    return [
        Observation(sets.project_corners(barrel(), pose, bow) + rng.normal(0, 0.05, xy.shape), xy)
        for pose in drawn.poses
    ]


def test_what_a_remedy_leaves_is_told_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A camera that can be made much better, and is too poorly known beyond its corners then."""
    monkeypatch.setattr(verdict_module, "MAX_USABLE_PX", 0.2)
    _, verdict = judge(bow_views())
    assert verdict.grade is Grade.CAN_BE_BETTER
    assert [finding.cause for finding in verdict.findings] == [Cause.BOARD_SHAPE, Cause.FEW_VIEWS]
    assert "Once the rest is mended, a pixel is known to 0.1" in verdict.findings[1].evidence


def test_a_remedy_of_what_is_less_harmful_leaves_the_calibration_as_it_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The board could be mended, but something without a remedy does more harm."""
    monkeypatch.setattr(verdict_module, "MAX_USABLE_PX", 0.2)
    views = bow_views()
    found = calibrate(views, VGA)
    (board,) = list_findings(found, views)
    blur = Finding(Cause.BLUR, "Blurred.", "Seen.", "Take them again.", 9.0)
    monkeypatch.setattr(verdict_module, "list_findings", lambda *_: (blur, board))
    verdict = judge_calibration(found, views)
    assert [finding.cause for finding in verdict.findings] == [Cause.BLUR, Cause.BOARD_SHAPE]
    assert verdict.findings[1].times_better > 1.5 and verdict.times_better == 1.0


def test_an_edge_that_no_photograph_shows_is_told_but_leaves_a_calibration_good() -> None:
    middle = [
        Observation(view.uv[near], view.xy[near])
        for view in CLEAN
        if (near := np.abs(view.uv - [320, 240]).max(axis=1) < 200).sum() > 20
    ]
    _, verdict = judge(middle)
    assert verdict.error.worst_covered < 0.5 < verdict.error.worst
    assert (verdict.grade, verdict.findings) == (Grade.GOOD, ())
    assert f"{verdict.error.worst:.2g} px" in verdict.reason


def test_pixels_that_the_lens_does_not_light_have_no_error() -> None:
    circle = ImageCircle(320, 240, 210)
    lit = [
        Observation(view.uv[near], view.xy[near])
        for view in CLEAN
        if (near := circle.contains(view.uv)).sum() > 20
    ]
    calibration, over_image = judge(lit)
    camera = replace(calibration.camera, circle=circle)
    within = judge_calibration(replace(calibration, camera=camera), lit).error
    assert within.worst < over_image.error.worst / 3
    assert within.edge < over_image.error.edge / 3
    assert within.covered == over_image.error.covered


@pytest.mark.parametrize("beyond_px", [3.0, 1e4])
def test_another_lens_that_fits_as_well_asks_for_corners_where_there_are_none(
    monkeypatch: pytest.MonkeyPatch, beyond_px: float
) -> None:
    views = scene_in_the_middle(barrel(), 10, seed=1, spread=0.1)
    views = views.noisy(0.005, np.random.default_rng(1))
    calibration, verdict = judge(views)
    assert verdict.findings == ()
    beyond = np.where(verdict_module._find_covered(VGA, views), 0.0, beyond_px)
    monkeypatch.setattr(verdict_module, "map_disagreement", lambda *_: beyond)
    poor = judge_calibration(calibration, views)
    assert poor.grade is Grade.NOT_USABLE
    assert poor.error.covered == verdict.error.covered
    (finding,) = poor.findings
    assert (finding.cause, poor.reason) == (Cause.FEW_VIEWS, finding.message)
    assert ("only to 3.0 px" if beyond_px < 100 else "not at all") in finding.evidence
    assert finding.action == Action(ActionKind.PHOTOGRAPH_MORE)


def test_a_solve_that_did_not_converge_is_not_usable() -> None:
    calibration, _ = judge(CLEAN)
    verdict = judge_calibration(replace(calibration, status=Status.STOPPED), CLEAN)
    assert verdict.grade is Grade.NOT_USABLE and "not finished" in verdict.reason


def test_trying_can_be_abandoned() -> None:
    fault = inject("held-value", 0)
    found = calibrate(fault.views, fault.size, **fault.options)  # type: ignore[arg-type]

    def abandon() -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        judge_calibration(found, fault.views, check=abandon)


def test_the_lens_model_is_chosen_anew_for_the_views_that_are_left() -> None:
    """So it is in the calibration that comes of it; two kinds of views may have chosen another."""
    found = calibrate(CLEAN, VGA, model="pinhole")
    action = Action(ActionKind.LEAVE_OUT_VIEWS, (0,))
    named = try_action(action, found, CLEAN)
    chosen = replace(found, settings=replace(found.settings, model_reason="It was chosen."))
    anew = try_action(action, chosen, CLEAN)
    assert named is not None and named.calibration.camera.model == "pinhole"
    assert anew is not None and anew.calibration.camera.model == "lucchese"
    assert len(anew.views) == len(CLEAN) - 1


@pytest.mark.parametrize("name", ["skew", "k3"])
def test_a_coefficient_is_held_at_zero_whether_the_model_holds_it_or_not(name: str) -> None:
    found = calibrate(CLEAN, VGA, model="brown-conrady", free=("skew",))
    trial = try_action(Action(ActionKind.HOLD_AT_ZERO, parameters=(name,)), found, CLEAN)
    index = found.camera.names.index(name)
    assert found.camera.params[index] != 0
    assert trial is not None and trial.calibration.camera.params[index] == 0


@pytest.mark.parametrize("kind", [ActionKind.CHOOSE_LENS_MODEL, ActionKind.ESTIMATE_BOARD_SHAPE])
def test_a_model_that_an_action_names_is_taken_as_it_is(kind: ActionKind) -> None:
    model = "rational" if kind is ActionKind.CHOOSE_LENS_MODEL else "bow"
    trial = try_action(Action(kind, model=model), calibrate(CLEAN, VGA), CLEAN)
    assert trial is not None and trial.action.model == model
    shape = trial.calibration.board_shape
    assert model in (trial.calibration.camera.model, shape and shape.model)
