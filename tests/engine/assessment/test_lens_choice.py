"""The choice of a lens model: right lenses, wrong ones, and ones that nothing determines."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.lens_choice import (
    SIMPLEST_MODEL,
    LensChoice,
    choose_lens,
    choose_lens_stepwise,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError, Cancelled
from tests.engine.random_lenses import problem
from tests.engine.scenes import VGA, barrel, scene

FISHEYE = Camera(VGA, [190, 191, 322, 236, -0.03, 0.004, -0.001, 0], "kannala-brandt")
FEW = ("lucchese", "brown-conrady-4", "ucm", "kannala-brandt", "kannala-brandt-decentering")


@pytest.fixture(scope="module")
def fisheye() -> LensChoice:
    views = scene(FISHEYE, 10).noisy(0.1, np.random.default_rng(1))
    return choose_lens(views, VGA, FEW, folds=3)


def test_a_fisheye_gets_its_model(fisheye: LensChoice) -> None:
    assert fisheye.model == "kannala-brandt"
    assert fisheye.reference == "kannala-brandt-decentering"
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
    assert fisheye.differences["ucm"] > fisheye.tolerance


def test_models_far_from_the_corners_are_not_asked_about_unseen_views(
    fisheye: LensChoice,
) -> None:
    trial = fisheye.trials["brown-conrady-4"]
    assert trial.validation is None
    assert trial.held_out == np.inf
    assert "brown-conrady-4" not in fisheye.adequate


def test_a_mild_lens_keeps_the_papers_model_after_few_trials() -> None:
    views = scene(barrel(), 8).noisy(0.1, np.random.default_rng(2))
    told: list[tuple[int, int]] = []
    choice = choose_lens_stepwise(views, VGA, 4, lambda done, total: told.append((done, total)))
    assert choice.model == SIMPLEST_MODEL
    assert len(choice.trials) + len(choice.refused) < 6
    assert told[0] == (0, told[0][1])
    assert [done for done, _ in told] == sorted(done for done, _ in told)


def test_coefficients_that_are_known_together_only_are_named() -> None:
    """A double sphere of a unified lens has a coefficient too many."""
    camera = Camera(VGA, [300, 300, 320, 240, 0.6], "ucm")
    views = scene(camera, 6).noisy(0.02, np.random.default_rng(3))
    choice = choose_lens(views, VGA, ("ucm", "double-sphere"), folds=3)
    assert choice.model == "ucm"
    sphere = choice.trials.get("double-sphere")
    assert sphere is None or sphere.exchangeable in ((), (("xi", "alpha"),))


def test_coefficients_that_the_views_leave_open_are_held() -> None:
    """Numerator and denominator of a rational model do alike in five views of 68 degrees."""
    made = problem(11, "rational")
    choice = choose_lens(made.views, made.scene.size, ("lucchese", "rational"), folds=3)
    trial = choice.trials["rational"]
    assert trial.fixed
    assert set(trial.fixed) <= set(trial.calibration.fixed)
    assert not trial.calibration.undetermined


def test_too_few_views_are_refused() -> None:
    views = scene(barrel(), 2).views
    with pytest.raises(CalibrationError, match="2 views are too few"):
        choose_lens(views, VGA)


def test_it_can_be_cancelled() -> None:
    def cancel(_done: int, _total: int) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        choose_lens(scene(barrel(), 4).views, VGA, progress=cancel)
