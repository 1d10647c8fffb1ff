"""One camera for all views in closed form: from Stage I to the start of Stage II.

Stage I gives xp, yp, k1 once per view, each poorly determined in some views. Their weighted
medians, weights the reciprocal standard deviations, serve all views. With the lens so
corrected, the homography M = [m1 m2 m3] from the board (mm) to the corrected image measured
from the principal point satisfies M ~ diag(fx, fy, 1) [r1 r2 T], and r1.r2 = 0, |r1| = |r2|
are linear in 1/fx^2 and 1/fy^2:

    m11 m12 / fx^2 + m21 m22 / fy^2 + m31 m32 = 0
    (m11^2 - m12^2) / fx^2 + (m21^2 - m22^2) / fy^2 + (m31^2 - m32^2) = 0.

These are Zhang's (2000) constraints with the principal point known. They say for all views
together what eq. 25-28 say for one; solved jointly, views that are nearly fronto-parallel simply
weigh nothing. Where noise still makes a solution impossible, ``focal_sweep.py`` finds one. The
poses follow from the homographies (``geometry.planar_pose``).
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation.stage_one import StageOneRegistration
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.geometry import frames, homography

_MIN_FOCAL, _MAX_FOCAL = 0.3, 6.0
"""Limits of the focal length, in image widths, beyond which it is taken for an effect of noise."""
_MAX_ASPECT = 2.5
"""Limit of fy/fx and of its reciprocal, beyond which they are taken for an effect of noise."""
_MAX_CENTRE_OFFSET = 0.25
"""Distance of the principal point from the array's centre, in image sizes along either axis, beyond
which the array's centre is taken instead."""


def estimate_centre_and_k1(stage_one: StageOneRegistration, size: Size) -> tuple[Array, float]:
    """Estimate the principal point (2,), array frame, px, and k1, px^-2, for all views together.

    Args:
        stage_one: Stage I of the views.
        size: width and height of the images, px.
    """
    x, y, k1 = (
        _compute_weighted_median(values, spread)
        for values, spread in zip(
            [*stage_one.centre.T, stage_one.k1], stage_one.spread.T, strict=True
        )
    )
    centre = np.array([x, y])
    # Too little perspective can throw the centre anywhere; the array's centre is better then.
    if not (np.abs(centre) < _MAX_CENTRE_OFFSET * np.array(size)).all():
        centre = np.zeros(2)
    return frames.array_from_paper(centre, size), k1


def fit_homographies(observations: Observations, centre: Array, k1: float) -> Array:
    """Fit M (K, 3, 3), from the board to the corrected image measured from the principal point.

    Args:
        observations: the views.
        centre: (2,) principal point, array frame, px.
        k1: first coefficient of the correction, px^-2.
    """
    x, y = observations.uv[..., 0] - centre[0], observations.uv[..., 1] - centre[1]
    stretch = 1 + k1 * (x * x + y * y)
    corrected = np.stack([x * stretch, y * stretch], axis=-1)
    return homography.fit_homography(observations.xy, corrected, observations.mask)


def _compute_weighted_median(values: Array, spread: Array) -> float:
    """Return the median of `values`, weights the reciprocals of `spread`; 0 if none is valid."""
    good = np.isfinite(values) & np.isfinite(spread) & (spread >= 0)
    if not good.any():
        return 0.0
    values, weights = (
        values[good],
        1 / np.maximum(spread[good], 1e-12 * np.abs(values[good]).max() + 1e-300),
    )
    order = np.argsort(values)
    cumulative = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(cumulative, cumulative[-1] / 2)])


def estimate_focal_lengths(M: Array, size: Size) -> Array | None:
    """Estimate fx, fy (2,), px, from the orthogonality of r1 and r2 in all views.

    Args:
        M: (K, 3, 3) as from `fit_homographies`.
        size: width and height of the images, px.

    Returns:
        None if the least-squares solution is not real, or beyond belief.
    """
    # Bring all views to one scale: |m1| |m2| in units of the image width.
    unit = M / np.array([size[0], size[0], 1.0])[:, None]
    norm = np.sqrt(np.linalg.norm(unit[:, :, 0], axis=1) * np.linalg.norm(unit[:, :, 1], axis=1))
    (a1, a2), (b1, b2), (c1, c2) = ((unit / norm[:, None, None])[:, i, :2].T for i in range(3))
    A = np.concatenate(
        [np.stack([a1 * a2, b1 * b2], axis=1), np.stack([a1**2 - a2**2, b1**2 - b2**2], axis=1)]
    )
    rhs = -np.concatenate([c1 * c2, c1**2 - c2**2])
    inverse_squares = np.linalg.lstsq(A, rhs, rcond=None)[0]
    if not ((inverse_squares > _MAX_FOCAL**-2) & (inverse_squares < _MIN_FOCAL**-2)).all():
        return None
    f = size[0] / np.sqrt(inverse_squares)
    return f if 1 / _MAX_ASPECT < f[1] / f[0] < _MAX_ASPECT else None
