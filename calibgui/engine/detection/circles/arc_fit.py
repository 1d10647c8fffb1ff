"""Centres of circles of which parts of the edge are seen undisturbed.

The edge of a shadow that crosses a circle, a glare or a scratch changes the light within its image,
and no ellipse in even light describes that. Along a short way across the circle's edge the light
is mostly even all the same. With the grey levels I(t) from the ink at -w to the paper at w, the
edge lies at

    t = -w + int (I - paper) / (ink - paper) dt,

whatever the blur, if it is symmetric. The others tell how large the ellipse is and how it lies, so
that its shift d and one growth g, for what ink and blur do alike all around, follow from t = n.d +
g, n the normals. Ways on which something else begins disagree with most and are left out; how far
the rest scatter tells the covariance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.detection.circles.thresholds import CIRCLE_THRESHOLDS
from calibgui.engine.images.sampling import sample_image

_WAYS = 72
"""Number of ways across the edge."""
_SECTORS = 8
"""Number of sectors, each left out once to see how far it draws the centre: what disturbs ways
disturbs those beside them alike."""
_SECTOR = np.arange(_WAYS) * _SECTORS // _WAYS
"""(ways,) sector of each."""
_SAMPLES = 33
"""Number of samples along each of them."""
_ENDS = 4
"""Number of samples at either end that show ink, or paper."""
_REACH_BLURS, _REACH_PIXELS = 2.5, 1.0
"""w: blurs, and px besides."""
_MAX_REACH = 0.45
"""Greatest w over the shorter semi-axis of the ellipse, and over the gap to its neighbours."""
_ROUNDS = 6
"""Number of times that ways that disagree are told from the rest."""
_MAX_OFF = 3.0
"""Distance from the fit, times the contrast, at which a way counts as disturbed, standard
deviations."""
_SIGMA_OF_MAD = 1.4826
"""Standard deviation of what is normally distributed over its median absolute deviation."""


class ArcFit(NamedTuple):
    """Ellipses whose shift was found, n of them."""

    uv: Array
    """(n, 2) their centres, px."""
    covariance: Array
    """(n, 2, 2) px^2."""
    is_told: BoolArray
    """(n,) True if enough of the edge is seen, on all sides."""


def fit_arcs(
    image: GreyImage, uv: Array, spread: Array, gap: Array, blur: float, *, are_bright: bool
) -> ArcFit:
    """Find the centres of ellipses of known shape.

    Args:
        image: (h, w) grey levels.
        uv: (n, 2) where they are expected, px.
        spread: (n, 2, 2) px^2, radius^2 J J^T for the image J of a unit of the board.
        gap: (n,) the distance to the next discs' edges, px.
        blur: of the image there, px.
        are_bright: True if the discs are brighter than the paper.
    """
    centre, covariance = uv.copy(), np.full((len(uv), 2, 2), np.nan)
    is_told = np.zeros(len(uv), dtype=bool)
    angle = 2 * np.pi * np.arange(_WAYS) / _WAYS
    around = np.stack([np.cos(angle), np.sin(angle)])
    for i, (S, between) in enumerate(zip(spread, gap, strict=True)):
        L = np.linalg.cholesky(S)
        normal = np.linalg.solve(L.T, around).T
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        shorter = float(np.sqrt(np.linalg.eigvalsh(S)[0]))
        w = min(_REACH_BLURS * blur + _REACH_PIXELS, _MAX_REACH * min(shorter, between))
        t = np.linspace(-w, w, _SAMPLES)
        for _ in range(2):
            at = (centre[i] + (L @ around).T)[:, None] + t[:, None] * normal[:, None]
            fit = _fit_shift(sample_image(image, at), normal, w, are_bright=are_bright)
            if fit is None or np.hypot(*fit[0][:2]) > w:
                is_told[i] = False
                break
            (du, dv, growth), covariance[i] = fit
            centre[i] += [du, dv]
            most = CIRCLE_THRESHOLDS.min_mark_radius_difference / 2 * shorter
            is_told[i] = abs(growth) < most
    return ArcFit(centre, covariance, is_told)


def _fit_shift(
    levels: Array, normal: Array, w: float, *, are_bright: bool
) -> tuple[Array, Array] | None:
    """Fit shift and growth (3,) px to grey levels (k, m) along ways with `normal` (k, 2) from -w to
    w px, with the covariance (2, 2) px^2 of the shift; None if too few ways agree."""
    ink, paper = levels[:, :_ENDS].mean(axis=1), levels[:, -_ENDS:].mean(axis=1)
    contrast = (ink - paper) if are_bright else (paper - ink)
    is_seen = contrast > CIRCLE_THRESHOLDS.min_arc_contrast * max(float(contrast.max()), 1.0)
    share = (levels - paper[:, None]) / np.where(is_seen, ink - paper, 1.0)[:, None]
    edge = 2 * w * (share.mean(axis=1) - 0.5)
    # The error of an edge is the noise over its contrast.
    A = contrast[:, None] * np.column_stack([normal, np.ones(len(normal))])
    b = contrast * edge
    kept = is_seen & (abs(edge) < w)
    for _ in range(_ROUNDS):
        if np.count_nonzero(kept) < CIRCLE_THRESHOLDS.min_arc_share * len(normal):
            return None
        fit = np.linalg.lstsq(A[kept], b[kept])[0]
        off = abs(b - A @ fit)
        sigma = _SIGMA_OF_MAD * np.median(off[kept])
        before, kept = kept, is_seen & (off < _MAX_OFF * sigma)
        if (kept == before).all():
            break
    others = [kept & (_SECTOR != sector) for sector in np.unique(_SECTOR[kept])]
    shifts = np.array([np.linalg.lstsq(A[each], b[each])[0][:2] for each in others]) - fit[:2]
    variance = np.sum(off[kept] ** 2) / max(np.count_nonzero(kept) - 3, 1)
    of_shift = variance * np.linalg.inv(A[kept].T @ A[kept])[:2, :2]
    return fit, of_shift + (1 - 1 / len(others)) * shifts.T @ shifts
