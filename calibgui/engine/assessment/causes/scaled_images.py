"""Images that were scaled, so that the corners' errors repeat from pixel to pixel.

Webcams make most of their sizes from fewer or more pixels than they write, and so do programs. Rows
that are left out, repeated or mixed displace an edge by where it lies between them, and this
repeats with the period of the scale: every 1.6 rows where 576 are made of 360. No lens, board or
motion does that. It leaves noise in the corners, which the same camera does not have in another
size.

The residuals r along an axis, at the places u where corners should be, are looked through for a
period, at frequencies f in cycles per pixel. Of noise the power

    P(f) = |sum r exp(-2 pi i f u)|^2 / sum r^2

has an exponential distribution of mean 1 (Schuster 1898), so that among M independent frequencies
it exceeds ln(M / p) with probability p. Of 14 cameras in real image sets it was at most 12 in ten,
and 21 to 141 in four: those of two webcam pairs, with the same period in both of a pair. In images
that were rendered and scaled by 0.67 to 2.25 it was 23 to 194 down all of 15 sets and 11 to 152
across 10, in 5 of them below what is taken for noise, and at most 9 along axes that had not been
scaled.

A period of exactly 2 pixels is that of an interlaced image or a raw one, too. What is less than a
pixel, or many, is not looked for: a bias of the corner finder, and the squares of a small board.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.causes.case import Case
from calibgui.engine.assessment.finding import (
    MIN_HARM_PX,
    Cause,
    Finding,
    describe_harm,
)

_MIN_FREQUENCY, _MAX_FREQUENCY = 0.15, 0.95
"""Frequencies that are looked through, cycles per pixel."""
_BINS_PER_PIXEL, _LENGTHS = 16, 4
"""Bins that a pixel is divided into for the transform, and lengths of the image that it takes, so
that no period falls between two frequencies."""
_MAX_FALSE_ALARM_RATE = 1e-5
"""Probability under noise with which a period is found along an axis."""
_HARMONICS = 3
"""Number of multiples of the frequency that are counted as its own."""
_DIRECTIONS = ("across", "down")
"""Words for the axes of the image."""


class _Period(NamedTuple):
    """A period of the corners' errors along an axis of the image."""

    axis: int
    """The axis, 0 or 1."""
    length: float
    """Length of the period, px."""
    share: float
    """Share of all squared residuals that repeat with it."""

    def is_double(self, size: int) -> bool:
        """Return whether the period cannot be told from 2 px over an image of `size` px."""
        return abs(1 / self.length - 0.5) < 1 / size


def find_scaling(case: Case, explained: float) -> Finding | None:
    """Find out whether the images were scaled; None if not, or if it does no harm.

    Args:
        case: a calibration with the image cost.
        explained: the share of the squared residuals that other causes explain; where it is larger
            they are what is wrong.
    """
    residual = np.concatenate([view.image for view in case.calibration.residuals])
    # The error depends on where a corner is, not on where it is found.
    uv = np.concatenate([view.uv for view in case.views]) - residual
    size = case.calibration.camera.size
    found = [_find_period(uv, residual, axis, size[axis]) for axis in (0, 1)]
    periods = [period for period in found if period is not None]
    share = sum(period.share for period in periods)
    harm = case.measure_noise(share)
    if share <= explained or harm < MIN_HARM_PX:
        return None
    is_double = all(period.is_double(size[period.axis]) for period in periods)
    repeating = " and ".join(
        f"{100 * period.share:.0f} % repeat every {period.length:.4g} px "
        f"{_DIRECTIONS[period.axis]} the image"
        for period in periods
    )
    return Finding(
        Cause.SCALED_IMAGES,
        "The images are interlaced or raw, or were scaled to twice or half their size."
        if is_double
        else "The images were scaled, by the camera or a program.",
        f"Of the squared residuals of {case.describe_rms()} {repeating}, in all views alike; "
        f"{describe_harm(harm)}.",
        "Photograph in another size, best the largest that the camera has, and use the images as "
        "it writes them.",
        harm,
    )


def _find_period(uv: Array, residual: Array, axis: int, size: int) -> _Period | None:
    """Find the period of residuals (n, 2) px along an axis of an image of `size` px; None if there
    is none."""
    u, r = uv[:, axis], residual[:, axis]
    bins, length = np.rint(_BINS_PER_PIXEL * (u + 0.5)).astype(np.int64), _LENGTHS * size
    inside = (bins >= 0) & (bins < _BINS_PER_PIXEL * size)
    binned = np.bincount(bins[inside], r[inside], minlength=_BINS_PER_PIXEL * length)
    first, last = (round(f * length) for f in (_MIN_FREQUENCY, _MAX_FREQUENCY))
    power = np.abs(np.fft.rfft(binned)[first:last]) ** 2 / np.sum(r**2)
    k = int(np.argmax(power))
    if not power[k] >= np.log((last - first) / _LENGTHS / _MAX_FALSE_ALARM_RATE):
        return None
    frequency = (first + k) / length
    phase = 2 * np.pi * frequency * u[:, None] * np.arange(1, _HARMONICS + 1)
    waves = np.column_stack([np.cos(phase), np.sin(phase)])
    repeating = waves @ np.linalg.lstsq(waves, r, rcond=None)[0]
    return _Period(axis, 1 / frequency, float(np.sum(repeating**2) / np.sum(residual**2)))
