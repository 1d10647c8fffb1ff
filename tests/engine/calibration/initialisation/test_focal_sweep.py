"""A start where the closed form has none."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.initialisation import closed_form, focal_sweep
from calibgui.engine.calibration.initialisation.stage_one import register_views
from calibgui.engine.calibration.initialisation.start import check_facing, convert_to_paper_frame
from calibgui.engine.calibration.observations import (
    REFERENCE_PITCH,
    Observations,
    measure_pitch,
    name_views,
    pack_observations,
)
from tests.engine.random_problems import outcome, problem
from tests.engine.scenes import Scene

OPEN = np.full(4, np.nan)


def failing() -> tuple[Scene, Observations, Array, float]:
    """Three noisy views through a long lens, and the lens that Stage I makes of them."""
    made, views = problem(2093)
    observations = pack_observations(views)
    scale = REFERENCE_PITCH / measure_pitch(observations)
    facing = check_facing(observations, name_views(3))
    first = register_views(*convert_to_paper_frame(observations, scale, made.size, facing))
    return made, observations, *closed_form.estimate_centre_and_k1(first, made.size)


def test_the_closed_form_fails_and_the_ladder_does_not() -> None:
    made, observations, centre, k1 = failing()
    M = closed_form.fit_homographies(observations, centre, k1)
    assert closed_form.estimate_focal_lengths(M, made.size) is None
    f, centre, k1 = focal_sweep.sweep_focal_lengths(observations, centre, k1, made.size, OPEN)
    np.testing.assert_allclose(f, made.camera.focal, rtol=0.05)
    np.testing.assert_allclose(centre, made.camera.centre, atol=0.02 * made.size[0])
    assert k1 == pytest.approx(made.camera.params[4] / made.camera.focal[0] ** 2, rel=0.2)


def test_what_is_known_is_kept() -> None:
    made, observations, centre, k1 = failing()
    known = np.array([7000.0, np.nan, np.nan, 600.0])
    f, found, _ = focal_sweep.sweep_focal_lengths(
        observations, np.array([centre[0], 600.0]), k1, made.size, known
    )
    assert f[0] == 7000.0
    assert found[1] == 600.0
    assert f[1] == pytest.approx(made.camera.focal[1], rel=0.05)


def test_the_calibration_reaches_the_minimum_from_there() -> None:
    found = outcome(2093)
    assert found.reached, found.words
