"""Dots, markers and tags beside corners, as a camera blurs them, taken out of an image.

Place, size, colour and blur of dots and tags are known once the corners are, so that they can be
computed and subtracted: what is blurred then does not draw the corners of small squares aside.

What is printed is summed over cells k. A cell is a Gaussian g as wide as the blur of the board's
edges, which contains the pixel, and its own spread together:

    change(u, v) = sum over k of height area_k g(u - u_k) g(v - v_k).
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, GreyImage

_REACH = 3.0
"""Distance from the cells up to which their blur is computed, standard deviations."""


def add_blurred_cells(change: Array, at: Array, areas: Array, height: Array, blur: Array) -> None:
    """Add groups of cells, blurred, to `change` (h, w).

    Args:
        change: (h, w) grey levels.
        at: (n, k, 2) the middles of the k cells of each group, px.
        areas: (n, k) of the cells, px^2.
        height: (n,) grey levels to add inside.
        blur: (n,) standard deviation, px.
    """
    # A point stands for a cell, which has a spread of its own.
    spread = np.sqrt(blur[:, None] ** 2 + areas / 12)
    centre = at.mean(axis=1)
    half = int(np.ceil(np.abs(at - centre[:, None]).max() + _REACH * blur.max()))
    first = np.rint(centre).astype(np.int64) - half
    pixel = np.arange(2 * half + 1)
    columns, rows = (
        np.exp(
            -0.5 * ((first[:, i, None, None] + pixel - at[..., i, None]) / spread[..., None]) ** 2
        )
        for i in (0, 1)
    )
    weight = height[:, None] * areas / (2 * np.pi * spread**2)
    tiles = np.swapaxes(rows, 1, 2) @ (weight[..., None] * columns)
    h, w = change.shape
    for (u, v), tile in zip(first.tolist(), tiles, strict=True):
        top, left = max(-v, 0), max(-u, 0)
        part = tile[top : max(h - v, 0), left : max(w - u, 0)]
        change[v + top : v + top + part.shape[0], u + left : u + left + part.shape[1]] += part


def subtract_change(image: GreyImage, change: Array) -> GreyImage:
    """Return an image (h, w) less `change` (h, w), of the same type."""
    changed = np.flatnonzero(change.any(axis=1))
    rows = slice(changed[0], changed[-1] + 1) if len(changed) else slice(0)
    part = image[rows] - change[rows]
    np.rint(part, out=part).clip(0, np.iinfo(image.dtype).max, out=part)
    cleaned = image.copy()
    cleaned[rows] = part
    return cleaned
