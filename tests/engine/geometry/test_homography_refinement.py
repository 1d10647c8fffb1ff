"""Homographies of least squared distances, against SciPy's minimum."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import pack_observations
from calibgui.engine.geometry.homography import apply_homography
from calibgui.engine.geometry.homography_refinement import fit_closest_homography
from tests.engine.scenes import BOARD, VGA, brown, looking, seen


def fit_linearly(xy: Array, uv: Array) -> Array:
    """The direct linear transformation with a last entry of 1."""
    x, zero = np.column_stack([xy, np.ones(len(xy))]), np.zeros((len(xy), 3))
    left = np.vstack([np.hstack([x, zero]), np.hstack([zero, x])])
    right = np.vstack([-uv[:, :1] * xy, -uv[:, 1:] * xy])
    return np.asarray(np.linalg.lstsq(np.hstack([left, right]), uv.T.ravel(), rcond=None)[0])


@pytest.mark.parametrize("unit", [1.0, VGA[0]])
def test_distances_are_the_least_there_are(unit: float) -> None:
    """A lens bends the images, so that the linear homography is another one."""
    camera, rng = brown(), np.random.default_rng(3)
    poses = [looking(camera, rng, fill=(0.9, 1.3)) for _ in range(3)]
    observations = pack_observations(seen(camera, poses, partial=True).noisy(0.5, rng))
    assert not observations.mask.all()
    H = fit_closest_homography(observations.xy, observations.uv / unit, observations.mask)
    for k in range(3):
        corners = observations.corners_of(k)
        xy, uv = observations.xy[k, corners], observations.uv[k, corners] / unit

        def miss(h: Array, xy: Array = xy, uv: Array = uv) -> Array:
            return np.ravel(apply_homography(np.append(h, 1.0).reshape(3, 3), xy) - uv)

        start = H[k].ravel()[:8]
        best = scipy.optimize.least_squares(miss, start, x_scale=np.abs(start), xtol=1e-15)
        ours = np.sum(miss(start) ** 2)
        assert ours <= 2 * best.cost * (1 + 1e-9)
        assert ours < np.sum(miss(fit_linearly(xy, uv)) ** 2)


def test_an_exact_homography_is_found() -> None:
    H = np.array([[0.8, -0.3, 120.0], [0.25, 0.9, 80.0], [4e-4, -3e-4, 1.0]])
    xy = BOARD.points()[None]
    found = fit_closest_homography(xy, apply_homography(H, xy), np.ones(xy.shape[:2]))
    np.testing.assert_allclose(found[0], H, rtol=1e-9, atol=1e-12)
