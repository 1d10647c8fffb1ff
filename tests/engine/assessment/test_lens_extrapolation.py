"""How far another lens model goes elsewhere, against the truth of scenes."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.assessment.changes.comparison import compare_cameras, find_covered_pixels
from calibgui.engine.assessment.lens_extrapolation import map_disagreement
from calibgui.engine.assessment.verdict import judge_calibration
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.projection_uncertainty import (
    estimate_projection_uncertainty,
    make_map_grid,
)
from tests.engine.scenes import VGA, example, looking, seen

TRUE = {
    "eucm": Camera(VGA, [650, 652, 303, 243, 0.6, 1.1], "eucm"),
    "kannala-brandt-decentering": example("kannala-brandt-decentering"),
    "brown-conrady": Camera(
        VGA, [650, 652, 303, 243, -0.25, 0.12, 3e-4, -5e-4, -0.03, 0], "brown-conrady"
    ),
}


def photograph(
    truth: Camera, seed: int, fill: tuple[float, float] = (0.6, 0.9)
) -> list[Observation]:
    """Twelve views that leave the image's corners out."""
    rng = np.random.default_rng(seed)
    poses = [looking(truth, rng, fill=fill) for _ in range(12)]
    return seen(truth, poses, partial=True).noisy(0.012, rng)


@pytest.mark.parametrize("seed", [5, 6])
@pytest.mark.parametrize(
    ("lens", "model", "alone"),
    [
        ("eucm", "brown-conrady", 2.0),
        ("kannala-brandt-decentering", "brown-conrady", 2.0),
        ("brown-conrady", "lucchese", 0.0),
    ],
)
def test_the_largest_error_is_stated(lens: str, model: str, alone: float, seed: int) -> None:
    """Where the standard deviation alone is exceeded by that many times."""
    truth = TRUE[lens]
    views = photograph(truth, seed)
    result = calibrate(views, VGA, model=model)
    error = np.nanmax(compare_cameras(truth, result.camera, views=views).length)
    sigma = estimate_projection_uncertainty(result, views).worst_direction
    assert error > alone * np.nanmax(sigma)
    stated = np.nanmax(np.hypot(sigma, map_disagreement(result, views)))
    assert error < 1.6 * stated
    assert stated < 40 * error


def test_the_verdict_states_it() -> None:
    views = photograph(TRUE["eucm"], 5)
    result = calibrate(views, VGA, model="brown-conrady")
    assert judge_calibration(result, views).error.worst > map_disagreement(result, views).max()


def test_nothing_counts_where_corners_are() -> None:
    views = photograph(TRUE["eucm"], 5)
    apart = map_disagreement(calibrate(views, VGA, model="brown-conrady"), views)
    covered = find_covered_pixels(make_mesh(*make_map_grid(VGA)), views)
    assert apart[~covered].max() > 0.3
    assert not apart[covered].any()


def test_a_model_that_does_not_follow_the_lens_tells_nothing() -> None:
    """Corners that are ten times better show that the paper's model is not this lens's."""
    truth = TRUE["brown-conrady"]
    rng = np.random.default_rng(6)
    poses = [looking(truth, rng, fill=(0.7, 0.9)) for _ in range(12)]
    views = seen(truth, poses, partial=True).noisy(0.001, rng)
    assert not map_disagreement(calibrate(views, VGA, model="brown-conrady"), views).any()
    assert map_disagreement(calibrate(views, VGA, model="lucchese"), views).any()


def test_splines_and_the_papers_cost_have_no_other_kind() -> None:
    views = photograph(TRUE["brown-conrady"], 5)

    def is_silent(result: Calibration) -> bool:
        return not map_disagreement(result, views).any()

    assert is_silent(calibrate(views, VGA, cost=Cost.PAPER))
    assert is_silent(calibrate(views, VGA, model="splined-stereographic"))
    assert not is_silent(calibrate(views, VGA))
