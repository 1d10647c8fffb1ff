"""The rays of pixels are told in words for a terminal of 80 columns."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.uncertainty import BoardPoints, PixelRays
from calibgui.report.numbers import format_with_sigma
from calibgui.report.tables import align_columns

_MAX_LISTED = 30
"""Number of pixels, at most, that are printed."""


def explain_lack(rays: PixelRays, on_plane: BoardPoints | None) -> list[str]:
    """Return for each pixel why it has no ray or point; empty where it has."""
    reasons = np.where(
        np.isfinite(rays.rays).all(axis=1), "", "the lens model has no ray of its own there"
    ).astype(object)
    reasons[~rays.is_in_image] = "outside of the image"
    if on_plane is not None:
        is_missed = np.isnan(on_plane.points).any(axis=1) & (reasons == "")
        reasons[is_missed] = "it does not look at the plane"
    return [str(reason) for reason in reasons]


def tabulate_rays(
    uv: Array, rays: PixelRays, on_plane: BoardPoints | None, reasons: Sequence[str]
) -> str:
    """Tabulate the first pixels with what they look at."""
    shown = range(min(len(uv), _MAX_LISTED))
    rows = [["u, px", "v, px", *(["X, mm", "Y, mm"] if on_plane else ["ray", "", "", "±, deg"])]]
    for k in shown:
        cells = [f"{value:.2f}" for value in uv[k]]
        if reasons[k]:
            cells += ["-"] * (len(rows[0]) - 2)
        elif on_plane is not None:
            spread = np.sqrt(np.diag(on_plane.covariance[k]))
            cells += map(format_with_sigma, on_plane.points[k].tolist(), spread.tolist())
        else:
            cells += [f"{value:.6f}" for value in rays.rays[k]]
            cells.append(f"{np.degrees(rays.sigma[k]):.2g}" if rays.sigma[k] > 0 else "")
        rows.append(cells)
    more = len(uv) - len(shown)
    return align_columns(rows) + (f"\n  and {more:,} more" if more else "")
