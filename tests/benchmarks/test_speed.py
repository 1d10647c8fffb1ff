"""How long what users wait for takes: `pytest --benchmark-only`; skipped otherwise.

For the time of a change against that before: `--benchmark-save=before`, then `--benchmark-compare`.
"""

from __future__ import annotations

import numpy as np
from pytest_benchmark.fixture import BenchmarkFixture

from calibgui import engine
from tests.engine.scenes import VGA, barrel, scene


def test_calibrate_from_100_views(benchmark: BenchmarkFixture) -> None:
    views = scene(barrel(), 100, seed=1).noisy(0.1, np.random.default_rng(0))
    result = benchmark(engine.calibrate, views, VGA)
    assert result.status is engine.Status.CONVERGED


def test_find_the_corners_of_a_photograph(benchmark: BenchmarkFixture) -> None:
    made = scene(barrel(), 1, seed=1)
    image = engine.render_view(
        made.camera, made.poses[0], engine.Board(9, 12, 30.0), blur=1, noise=2
    )
    corners = benchmark(engine.find_corners, image)
    assert len(corners) == 108


def test_undistort_a_photograph_of_12_megapixels(benchmark: BenchmarkFixture) -> None:
    camera = barrel(focal=4000.0, size=(4000, 3000))
    image = np.random.default_rng(0).integers(0, 255, (3000, 4000), dtype=np.uint8)
    assert benchmark(engine.undistort_image, image, camera).valid.any()
