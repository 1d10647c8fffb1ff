"""Profiles across edges, compiled: what ``corners.profiles`` takes from their samples."""

from __future__ import annotations

import numpy as np

from calibgui.engine.kernels.common import bilinear, compiled
from calibgui.engine.opencv import Image
from calibgui.engine.types import Array


@compiled
def _sample(image, uv, along, across, s, o):  # type: ignore[no-untyped-def]
    """The grey level s steps along an edge and o steps across it."""
    u = uv[0] + s * along[0] + o * across[0]
    return bilinear(image, u, uv[1] + s * along[1] + o * across[1])


@compiled
def _levels(image, uv, along, across, s, reach, samples, ends, first, last, total):  # type: ignore[no-untyped-def]
    step = 2 * reach / (samples - 1)
    for i in range(uv.shape[0]):
        for k in range(s.shape[0]):
            for j in range(samples):
                grey = _sample(image, uv[i], along[i], across[i], s[k], j * step - reach)
                total[i, k] += grey / 2 if j == 0 or j == samples - 1 else grey
                if j < ends:
                    first[i, k] += grey / ends
                if j >= samples - ends:
                    last[i, k] += grey / ends


@compiled
def _between(image, uv, along, across, s, middle, half, samples, first, rise, out):  # type: ignore[no-untyped-def]
    for i in range(uv.shape[0]):
        step = 2 * half[i] / (samples - 1)
        for k in range(s.shape[0]):
            for j in range(samples):
                o = middle[i, k] - half[i] + j * step
                grey = _sample(image, uv[i], along[i], across[i], s[k], o)
                out[i, k] += 0.25 < (grey - first[i, k]) / rise[i, k] < 0.75


def levels(
    image: Image,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    reach: float,
    samples: int,
    ends: int,
) -> tuple[Array, Array, Array]:
    """``profiles._levels``: (n, k) mean of the first and last `ends` of `samples` grey levels up
    to `reach` steps to both sides, and the sum of all by the trapezoidal rule."""
    first, last, total = np.zeros((3, len(uv), len(s)))
    _levels(image, uv, along, across, s, reach, samples, ends, first, last, total)
    return first, last, total


def between(
    image: Image,
    uv: Array,
    along: Array,
    across: Array,
    s: Array,
    middle: Array,
    half: Array,
    samples: int,
    first: Array,
    rise: Array,
) -> Array:
    """``profiles._between``: (n, k) how many of the `samples` from `middle` (n, k) up to `half`
    (n,) steps to both sides lie between 25 and 75 % of the `rise` (n, k) from `first` (n, k)."""
    out = np.zeros((len(uv), len(s)))
    _between(image, uv, along, across, s, middle, half, samples, first, rise, out)
    return out
