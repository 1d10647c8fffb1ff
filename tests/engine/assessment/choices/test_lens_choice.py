"""The choice of a lens model: right lenses, wrong ones, and ones that nothing determines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from calibgui.engine.assessment.choices.cross_validation import resect_views
from calibgui.engine.assessment.choices.lens_choice import (
    SIMPLEST_MODEL,
    LensChoice,
    _Attempt,
    _list_dispensable,
    _prefer_determined,
    _recommend,
    choose_lens,
    choose_lens_stepwise,
)
from calibgui.engine.assessment.choices.lens_trial import LensTrial
from calibgui.engine.calibration.leave_one_out import LeftOut
from calibgui.engine.calibration.result import Iteration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError, Cancelled
from tests.engine.random_lenses import problem
from tests.engine.scenes import VGA, barrel, brown, example, scene

FISHEYE = Camera(VGA, [190, 191, 322, 236, -0.03, 0.004, -0.001, 0], "kannala-brandt")
FEW = ("lucchese", "brown-conrady-4", "ucm", "kannala-brandt", "kannala-brandt-decentering")


@pytest.fixture(scope="module")
def fisheye() -> LensChoice:
    views = scene(FISHEYE, 10).noisy(0.1, np.random.default_rng(1))
    return choose_lens(views, VGA, FEW)


def test_a_model_that_the_views_leave_open_is_not_solved_to_its_end() -> None:
    """Boards that face the camera leave numerator and denominator a valley to creep along."""
    views = scene(brown(), 8, seed=2, tilt=(0.0, 1.5)).noisy(0.005, np.random.default_rng(0))
    iterations = 0

    def count(_: Iteration) -> bool:
        nonlocal iterations
        iterations += 1
        return True

    choice = choose_lens(views, VGA, ("brown-conrady", "rational"), report=count)
    assert choice.model == "brown-conrady"
    assert choice.trials["rational"].fixed.keys() == {"k4", "k6"}
    assert iterations < 300


def test_a_fisheye_gets_its_model(fisheye: LensChoice) -> None:
    assert fisheye.model == "kannala-brandt"
    assert set(fisheye.errors) == {"kannala-brandt", "kannala-brandt-decentering"}
    assert fisheye.chosen.held_out == pytest.approx(0.1 * np.sqrt(2), rel=0.08)


def test_the_figures_of_a_candidate_are_those_of_the_lens(fisheye: LensChoice) -> None:
    trial = fisheye.chosen
    theta = np.arange(0, 2, 1e-4)
    k = FISHEYE.coefficients
    radius = theta * (1 + k[0] * theta**2 + k[1] * theta**4 + k[2] * theta**6)
    w, h = VGA
    across = np.interp(np.array([322.5, w - 322.5]) / 190, radius, theta).sum()
    down = np.interp(np.array([236.5, h - 236.5]) / 191, radius, theta).sum()
    # The image's left and right edges lie beyond the corners.
    np.testing.assert_allclose(trial.field_of_view[:2], [across, down], atol=0.1)
    n = 2 * 10 * 108
    residuals = np.concatenate([view.image for view in trial.calibration.residuals])
    assert trial.parameters == 8
    assert trial.bic == pytest.approx(n * np.log(np.mean(residuals**2)) + 8 * np.log(n))
    assert 0.85 < trial.valid_share < 1.0  # it folds in the image's corners,
    assert np.isnan(trial.field_of_view[2])  # whose rays are therefore not known
    assert fisheye.differences["kannala-brandt"] == 0.0
    assert fisheye.differences["ucm"] > 0.1


def test_models_far_from_the_corners_are_not_asked_about_unseen_views(
    fisheye: LensChoice,
) -> None:
    trial = fisheye.trials["brown-conrady-4"]
    assert trial.validation is None
    assert trial.held_out == np.inf
    assert "brown-conrady-4" not in fisheye.errors


def test_models_that_are_not_sound_are_asked_only_if_none_is(fisheye: LensChoice) -> None:
    views = scene(FISHEYE, 10).noisy(0.1, np.random.default_rng(1))
    folding = "kannala-brandt-decentering"
    fold = replace(fisheye.trials[folding], is_valid_at_corners=False, validation=None)
    others = {"kannala-brandt": replace(fisheye.trials["kannala-brandt"], validation=None)}
    for sound in ({}, others):
        attempt = _Attempt(views, VGA, None, {})
        attempt.trials = {folding: fold, **sound}
        attempt.try_lenses((folding, *sound))
        assert (attempt.trials[folding].validation is None) == bool(sound)
        assert all(attempt.trials[model].validation for model in sound)


def test_a_mild_lens_keeps_the_papers_model_after_few_trials() -> None:
    views = scene(barrel(), 8).noisy(0.1, np.random.default_rng(2))
    told: list[tuple[int, int]] = []
    choice = choose_lens_stepwise(views, VGA, lambda done, total: told.append((done, total)))
    assert choice.model == SIMPLEST_MODEL
    assert len(choice.trials) + len(choice.refused) < 6
    assert told[0] == (0, told[0][1])
    assert [done for done, _ in told] == sorted(done for done, _ in told)


def test_the_papers_model_is_enough_where_views_or_models_agree() -> None:
    views = scene(barrel(), 6).noisy(0.1, np.random.default_rng(2))
    attempt = _Attempt(views, VGA, None, {})
    attempt.try_lenses((SIMPLEST_MODEL, "kannala-brandt"))
    paper, other = attempt.trials[SIMPLEST_MODEL], attempt.trials["kannala-brandt"]
    assert paper.calibration.overdispersion == 0 and attempt.is_paper_enough()
    doubtful = replace(paper.calibration, overdispersion=2.0)
    attempt.trials[SIMPLEST_MODEL] = replace(paper, calibration=doubtful)
    for ratio, is_enough in ((0.98, False), (0.995, True), (1.005, True), (1.02, False)):
        held_out = paper.held_out * ratio
        attempt.trials[other.model] = replace(other, validation=predict(held_out, other))
        assert attempt.is_paper_enough() == is_enough, ratio
    del attempt.trials[other.model]
    assert not attempt.is_paper_enough(), "nothing is compared"


def test_coefficients_that_are_known_together_only_are_named() -> None:
    """A double sphere of a unified lens has a coefficient too many."""
    camera = Camera(VGA, [300, 300, 320, 240, 0.6], "ucm")
    views = scene(camera, 6).noisy(0.02, np.random.default_rng(3))
    choice = choose_lens(views, VGA, ("ucm", "double-sphere"))
    assert choice.model == "ucm"
    sphere = choice.trials.get("double-sphere")
    assert sphere is None or sphere.exchangeable in ((), (("xi", "alpha"),))


def test_coefficients_that_the_views_leave_open_are_held() -> None:
    """Numerator and denominator of a rational model do alike in five views of 68 degrees."""
    made = problem(11, "rational")
    choice = choose_lens(made.views, made.scene.size, ("lucchese", "rational"))
    trial = choice.trials["rational"]
    assert trial.fixed
    assert set(trial.fixed) <= set(trial.calibration.fixed)
    assert not trial.calibration.undetermined


def test_a_lens_with_open_coefficients_has_to_predict_better(fisheye: LensChoice) -> None:
    determined = fisheye.trials["kannala-brandt"]
    other = replace(fisheye.trials["kannala-brandt-decentering"], fixed={"k4": 0.0})
    assert other.left_open == ("k4",)
    for gain, kept in ((0.009, [determined]), (0.02, [determined, other])):
        better = replace(other, validation=predict(determined.held_out / (1 + gain), determined))
        kept_models = [t.model for t in _prefer_determined([determined, better])]
        assert kept_models == [trial.model for trial in kept]


def test_coefficients_that_are_spared_count_as_determined(fisheye: LensChoice) -> None:
    """So does the paper's model, whatever the views leave open of it."""
    whole = fisheye.trials["kannala-brandt-decentering"]
    spared = replace(whole, fixed={"k4": 0.0}, fuller=whole)
    assert spared.left_open == ()
    paper = replace(fisheye.trials[SIMPLEST_MODEL], fixed={"k3": 0.0})
    assert paper.left_open == ("k3",)
    near = replace(paper, validation=predict(spared.held_out, whole))
    assert _prefer_determined([spared, near]) == [spared, near]


def predict(held_out: float, like: LensTrial) -> LeftOut:
    """Return what a trial says of unseen views, with another error."""
    assert like.validation is not None
    times = held_out / like.held_out
    lengths, by_view = times * like.validation.lengths, times * like.validation.by_view
    return replace(like.validation, lengths=lengths, by_view=by_view)


def predict_elsewhere(choice: LensChoice, camera: Camera) -> float:
    """Return the RMS distance of a camera's image of unseen views from the truth, px."""
    residuals = resect_views(choice.chosen.calibration, scene(camera, 12, seed=99).views)
    return float(np.sqrt(np.mean([np.mean(np.sum(v.image**2, axis=1)) for v in residuals])))


def test_coefficients_that_harm_predictions_are_held() -> None:
    """Four noisy views of a lens that has k1 only tell nothing of k3, and little of p1 and p2."""
    camera = Camera(VGA, [650, 650, 318, 243, 0.2, 0, 0, 0, 0, 0])
    views = scene(camera, 4, seed=0).noisy(0.4, np.random.default_rng(0))
    choice = choose_lens(views, VGA, (SIMPLEST_MODEL,))
    trial, whole = choice.chosen, choice.chosen.fuller
    assert whole is not None and not whole.fixed
    assert trial.spared == tuple(trial.fixed)
    assert trial.held_out < 0.99 * whole.held_out
    camera_of_all, sigma = whole.calibration.camera, whole.calibration.sigma
    spared = [camera_of_all.names.index(name) for name in trial.spared]
    assert np.all(np.abs(camera_of_all.params[spared]) < 2 * sigma[spared])
    assert set(trial.fixed) <= set(trial.calibration.fixed)
    reduced = predict_elsewhere(choice, camera)
    fuller = predict_elsewhere(replace(choice, trials={SIMPLEST_MODEL: whole}), camera)
    assert reduced < fuller


def test_coefficients_that_the_views_tell_from_0_stay() -> None:
    views = scene(barrel(), 10, seed=4).noisy(0.05, np.random.default_rng(4))
    choice = choose_lens(views, VGA, (SIMPLEST_MODEL,))
    trial, calibration = choice.chosen, choice.chosen.calibration
    assert trial.fuller is None and not trial.fixed
    away = np.abs(calibration.camera.params[[6, 7, 8]]) / calibration.sigma[[6, 7, 8]]
    assert np.round(away).tolist() == [5, 4, 8], "k3, p1 and p2 are told from 0"
    assert _list_dispensable(trial) == []
    for times, groups in ((3, [("k3",)]), (10, [("p1", "p2"), ("k3",)])):
        vaguer = replace(calibration, sigma=times * calibration.sigma)
        assert _list_dispensable(replace(trial, calibration=vaguer)) == groups


def test_too_few_views_are_refused() -> None:
    views = scene(barrel(), 2).views
    with pytest.raises(CalibrationError, match="2 views are too few"):
        choose_lens(views, VGA)


def test_it_can_be_cancelled() -> None:
    def cancel(_done: int, _total: int) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        choose_lens(scene(barrel(), 4).views, VGA, progress=cancel)


def predict_as(trial: LensTrial, held_out: float) -> LensTrial:
    """Return a trial with another error on unseen views."""
    return replace(trial, validation=predict(held_out, trial))


def test_of_those_that_predict_alike_the_best_known_is_chosen() -> None:
    """A simpler one is taken as long as no other knows pixels better by more than a fifth."""
    views = scene(example("pinhole"), 8).noisy(0.1, np.random.default_rng(2))
    attempt = _Attempt(views, VGA, None, {})
    attempt.try_lenses(("brown-conrady-4", "brown-conrady"))
    simple, rich = attempt.trials["brown-conrady-4"], attempt.trials["brown-conrady"]
    assert simple.parameters < rich.parameters
    h, few = simple.held_out, simple.model
    for unseen, sigmas, chosen in (
        (h, 1.0, few),  # as the views have it
        (h, 0.7, rich.model),  # known better by more than a fifth,
        (h, 0.9, few),  # or by less
        (0.9 * h, 40.0, rich.model),  # predicts better, so that it does not matter
        (h - 1e-4, 40.0, few),  # or better by what nobody sees
    ):
        other = predict_as(rich, unseen)
        covariance = simple.calibration.covariance
        scale = covariance[0, 0] / rich.calibration.covariance[0, 0] * sigmas**2
        calibration = replace(other.calibration, covariance=other.calibration.covariance * scale)
        trials = {few: simple, rich.model: replace(other, calibration=calibration)}
        assert _recommend(trials, {}, views).model == chosen, (unseen, sigmas)


def test_no_coefficients_are_taken_for_what_nobody_sees() -> None:
    """Corners good to 0.004 px tell Brown's model from the paper's, and more so a thin prism."""
    views = scene(barrel(), 8, seed=3).noisy(0.004, np.random.default_rng(3))
    choice = choose_lens(views, VGA, ("brown-conrady", "thin-prism"))
    brown, rich = choice.trials["brown-conrady"], choice.trials["thin-prism"]
    assert rich.held_out < 0.9 * brown.held_out < 0.02
    assert choice.model == "brown-conrady"
