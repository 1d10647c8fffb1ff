"""An action changes the setting or the views that it is about, and the calibration gets better."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings, check_settings
from calibgui.app.projects.lengths import confirm_lengths, set_square
from calibgui.app.projects.project import Project, record_result
from calibgui.app.projects.remedies import apply_action, change_settings
from calibgui.dataset import CornerSet, Result
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import Action, ActionKind, Grade
from calibgui.engine.boards import BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration import DEFAULT_METHOD, Cost
from calibgui.report.summary import describe_calibration
from calibgui.report.verdict import describe_options
from tests.app import examples


def calibrate(project: Project) -> Result:
    assert project.size is not None
    return calibrate_views(CornerSet(project.size, project.views, project.board), project.settings)


@pytest.fixture
def project(tmp_path: Path) -> Project:
    return replace(examples.calibrated(tmp_path), settings=Settings())


@pytest.mark.parametrize(
    ("action", "changed"),
    [
        (
            Action(ActionKind.ESTIMATE_BOARD_SHAPE, model="bow"),
            {"board_shape": BoardShapeModel.BOW},
        ),
        (Action(ActionKind.ESTIMATE_BOARD_SHAPE), {"board_shape": None}),
        (
            Action(ActionKind.CHOOSE_LENS_MODEL, parameters=("k3",), model="kannala-brandt"),
            {"model": "kannala-brandt", "fixed": {"cx": None, "k3": 0.0}},
        ),
        (
            Action(ActionKind.ESTIMATE_SKEW, parameters=("skew",), model="rational"),
            {"model": "rational", "fixed": {"cx": None}, "freed": ("skew",)},
        ),
        (Action(ActionKind.LEAVE_OUT_CORNERS), {"robust": True}),
        (Action(ActionKind.WEIGH_VIEWS), {"weigh_views": True}),
        (Action(ActionKind.FREE_HELD_VALUE, parameters=("cx",)), {"fixed": {"p1": None}}),
        (
            Action(ActionKind.HOLD_AT_ZERO, parameters=("k3",)),
            {"fixed": {"cx": None, "p1": None, "k3": 0.0}},
        ),
    ],
)
def test_an_action_changes_its_settings(
    project: Project, action: Action, changed: dict[str, object]
) -> None:
    settings = Settings(fixed={"cx": None, "p1": None})
    result = project.results["Calibration 1"]
    after = apply_action(replace(project, settings=settings), result, action)
    assert after.settings == replace(settings, **changed)  # type: ignore[arg-type]
    assert after.views is project.views


@pytest.mark.parametrize(
    ("settings", "model"),
    [
        (Settings(freed=("k3", "skew"), model="rational"), "rational"),
        (Settings(freed=("k3", "skew"), model=None), "rational"),
        (Settings(freed=("k3", "skew"), cost=Cost.PAPER), "lucchese"),
    ],
)
def test_a_coefficient_that_is_held_is_no_longer_free_and_the_model_has_it(
    settings: Settings, model: str
) -> None:
    """A lens model that is to be chosen becomes the one that the calibration has chosen."""
    action = Action(ActionKind.HOLD_AT_ZERO, parameters=("k3",))
    assert action.change is not None
    after = change_settings(settings, "rational", action.change)
    assert (after.fixed, after.freed, after.model) == ({"k3": 0.0}, ("skew",), model)


@pytest.mark.parametrize("kind", ActionKind)
def test_what_changes_the_calibration_has_an_option_of_the_command(
    project: Project, kind: ActionKind
) -> None:
    result = project.results["Calibration 1"]
    action = Action(kind, views=(0,), parameters=("k3",), model="free")
    if kind in (ActionKind.CHOOSE_LENS_MODEL, ActionKind.ESTIMATE_SKEW):
        action = replace(action, model="rational")
    options = describe_options(action, result)
    if action.change is None:
        assert options == ""
        return
    settings = Settings(model="rational", fixed={"k3": 1.0} if action.change.releases else {})
    assert apply_action(replace(project, settings=settings), result, action) != project
    assert options.startswith(("add --", "leave k3 out of --fix"))
    assert "--cost" not in options  # it is minimised already


@pytest.mark.parametrize("settings", [Settings(cost=Cost.PAPER), Settings(method="tsai")])
@pytest.mark.parametrize(
    "kind",
    [ActionKind.ESTIMATE_BOARD_SHAPE, ActionKind.CHOOSE_LENS_MODEL, ActionKind.WEIGH_VIEWS],
)
def test_an_action_takes_the_cost_and_the_method_that_it_needs(
    project: Project, settings: Settings, kind: ActionKind
) -> None:
    result = project.results["Calibration 1"]
    after = apply_action(replace(project, settings=settings), result, Action(kind)).settings
    assert (after.cost, after.method) == (Cost.IMAGE, DEFAULT_METHOD)
    check_settings(after)


def test_an_action_keeps_what_is_asked_besides_and_forgets_what_goes_with_the_old_model() -> None:
    settings = Settings(robust=True, weigh_views=True, prior=BoardShapePrior(0.1, 0.1))
    shape = Action(ActionKind.ESTIMATE_BOARD_SHAPE, model="bow").change
    assert shape is not None
    after = change_settings(settings, "lucchese", shape)
    assert (after.robust, after.weigh_views, after.prior) == (True, True, None)


def test_views_are_left_out(project: Project) -> None:
    result = project.results["Calibration 1"]
    after = apply_action(project, result, Action(ActionKind.LEAVE_OUT_VIEWS, (1, 3)))
    assert [v.image for v in project.usable if v not in after.usable] == [
        result.used[1].image,
        result.used[3].image,
    ]


def test_what_only_the_user_can_do_is_no_edit(project: Project) -> None:
    result = project.results["Calibration 1"]
    with pytest.raises(ValueError, match="photograph-more"):
        apply_action(project, result, Action(ActionKind.PHOTOGRAPH_MORE))


def test_a_held_value_that_is_freed_gives_a_better_verdict(project: Project) -> None:
    wrong = replace(project, settings=Settings(fixed={"fx": 180.0}))
    result = calibrate(wrong)
    before = judge_result(result)
    action = before.findings[0].action
    assert before.grade is Grade.CAN_BE_BETTER and action is not None
    after = judge_result(calibrate(apply_action(wrong, result, action)))
    assert before.error.covered / after.error.covered == pytest.approx(
        before.times_better, rel=0.05
    )


def test_lengths_are_conditional_until_they_are_confirmed(project: Project) -> None:
    open_project = replace(project, lengths_confirmed=False)
    result = project.results["Calibration 1"]
    recorded = record_result(open_project, "new", result.views, result)
    assert recorded.results["new"].condition == "if squares are 30 mm"
    told = " ".join(s.text for s in describe_calibration(recorded.results["new"]))
    assert "All lengths hold if squares are 30 mm" in told
    assert confirm_lengths(recorded).results["new"].condition == ""
    assert set_square(open_project, 25.0).lengths_confirmed
    kept = confirm_lengths(replace(recorded, square=25.0)).results["new"]
    assert kept.condition == "if squares are 30 mm"  # it is of other squares
    assert judge_result(confirm_lengths(recorded).results["new"]) is judge_result(
        recorded.results["new"]
    )
