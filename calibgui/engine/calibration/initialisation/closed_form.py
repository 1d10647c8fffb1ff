"""From Stage I to the start of Stage II: one camera and all poses, in closed form.

Stage I gives xp, yp, k1 once per view, each poorly determined in some views. Their weighted
medians, weights the reciprocal standard deviations, serve all views. With the lens so
corrected, the homography M = [m1 m2 m3] from the plate (mm) to the corrected image measured
from the principal point satisfies M ~ diag(fx, fy, 1) [r1 r2 T], and r1.r2 = 0, |r1| = |r2|
are linear in 1/fx^2 and 1/fy^2:

    m11 m12 / fx^2 + m21 m22 / fy^2 + m31 m32 = 0
    (m11^2 - m12^2) / fx^2 + (m21^2 - m22^2) / fy^2 + (m31^2 - m32^2) = 0.

These say for all views together what eq. 25-28 say for one; solved jointly, views that are
nearly fronto-parallel simply weigh nothing. Where noise still makes a solution impossible,
``ladder.py`` has to find one.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation.stage_one import Prealignment
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.geometry import frames, homography

_LEAST, _MOST = 0.3, 6.0
"""Focal lengths that are believed, in image widths."""


def initial_lens(stage_one: Prealignment, size: Size) -> tuple[Array, float]:
    """Principal point (2,) in the array frame, px, and k1, px^-2, for all views together."""
    x, y, k1 = (
        _weighted_median(values, spread)
        for values, spread in zip(
            [*stage_one.centre.T, stage_one.k1], stage_one.spread.T, strict=True
        )
    )
    centre = np.array([x, y])
    # Too little perspective can throw the centre anywhere; the array's centre is better then.
    if not (np.abs(centre) < 0.25 * np.array(size)).all():
        centre = np.zeros(2)
    return frames.array_from_paper(centre, size), k1


def homographies(observations: Observations, centre: Array, k1: float) -> Array:
    """(K, 3, 3) M, from the plate to the corrected image measured from the principal point.

    Args:
        observations: the views.
        centre: (2,) principal point, array frame, px.
        k1: first coefficient of the correction, px^-2.
    """
    d = observations.uv - centre
    corrected = d * (1 + k1 * np.sum(d**2, axis=-1, keepdims=True))
    return homography.fit_homography(observations.xy, corrected, observations.mask)


def _weighted_median(values: Array, spread: Array) -> float:
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


def focal_lengths(M: Array, size: Size) -> Array | None:
    """(2,) fx, fy, px, from the orthogonality of r1 and r2 in all views; None if none are real.

    Args:
        M: (K, 3, 3) as from `homographies`.
        size: of the images, px.
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
    if not ((inverse_squares > _MOST**-2) & (inverse_squares < _LEAST**-2)).all():
        return None
    f = size[0] / np.sqrt(inverse_squares)
    return f if 0.4 < f[1] / f[0] < 2.5 else None


def poses(M: Array, f: Array, observations: Observations) -> tuple[Array, Array]:
    """Rotations (K, 3, 3) and translations (K, 3) mm under known focal lengths.

    Args:
        M: (K, 3, 3) as from `homographies`.
        f: (2,) focal lengths, px.
        observations: the views.
    """
    G = M / np.array([f[0], f[1], 1.0])[:, None]
    G = (
        G
        / np.sqrt(np.linalg.norm(G[:, :, 0], axis=1) * np.linalg.norm(G[:, :, 1], axis=1))[
            :, None, None
        ]
    )
    first = np.concatenate([observations.xy[:, 0], np.ones((len(M), 1))], axis=1)
    depth = np.einsum("ki,ki->k", G[:, 2], first)
    G = G * np.sign(depth)[:, None, None]  # the plate is in front of the camera
    r3 = np.cross(G[:, :, 0], G[:, :, 1])
    # The closest rotation to [r1 r2 r3].
    U, _, Vt = np.linalg.svd(np.concatenate([G[:, :, :2], r3[:, :, None]], axis=2))
    sign = np.linalg.det(U @ Vt)
    U[:, :, 2] *= sign[:, None]
    return U @ Vt, G[:, :, 2]
