"""Residual statistics, and histograms with fitted densities (figures 10 to 12 and 16).

A residual with independent Gaussian components of equal standard deviation s has a Rayleigh
distributed length e, with density (e / s^2) exp(-e^2 / 2 s^2), mean s sqrt(pi / 2) and
maximum-likelihood estimate s^2 = mean(e^2) / 2.

A corner beyond the fold of a forward lens model has an image, but no place on the board: its
residual there is NaN, and left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.calibration.result import Calibration, ViewResiduals

_BINS = 50
"""Number of bins of a histogram."""
_REACH = 6.0
"""Standard deviations up to which a histogram extends, by the median size: a single bad corner
would make one bar of all others."""
_NORMAL_MEDIAN = 0.6745
"""Median size of a Gaussian component, in standard deviations."""
_RAYLEIGH_MEDIAN = 1.1774
"""Median length of a Gaussian vector, in standard deviations of a component."""


@dataclass(frozen=True, slots=True)
class ResidualSummary:
    """Statistics of the residuals of a calibration.

    None of them measures the error of the camera: more parameters lower them all.
    """

    rms: float
    """Root mean square length in the image, px."""
    sigma_x: float
    """Standard deviation of the image residual along u, px, over all corners."""
    sigma_y: float
    """Standard deviation of the image residual along v, px, over all corners."""
    median_sigma_x: float
    """Median over the views of their standard deviation along u, px."""
    median_sigma_y: float
    """Median over the views of their standard deviation along v, px."""
    reference_mean: float
    """Mean of the length e' on the reference plane, reference px; NaN if no corner has one."""
    reference_sd: float
    """Standard deviation of it, reference px; NaN likewise."""
    count: int
    """Number of corners."""

    @property
    def sigma(self) -> float:
        """Return the standard deviation of a coordinate of the image residual, px."""
        return float(np.hypot(self.sigma_x, self.sigma_y) / np.sqrt(2))


def summarise_residuals(residuals: Sequence[ViewResiduals]) -> ResidualSummary:
    """Compute the statistics of all views' residuals together.

    Example:
        >>> import numpy as np
        >>> from calibgui.engine.assessment import summarise_residuals
        >>> from calibgui.engine.calibration import ViewResiduals
        >>> off = np.array([[0.3, 0.0], [-0.3, 0.0], [0.0, 0.4], [0.0, -0.4]])
        >>> summary = summarise_residuals([ViewResiduals(image=off, reference=2 * off)])
        >>> print(f"{summary.rms:.3f} px rms, {summary.sigma_x:.3f} px along u")
        0.354 px rms, 0.212 px along u
    """
    image = np.concatenate([view.image for view in residuals])
    across, down = np.ascontiguousarray(image.T)  # sums along rows are 15 times as fast
    length = np.hypot(*np.concatenate([view.reference for view in residuals]).T)
    known = length[np.isfinite(length)]
    typical = np.median(_measure_sigma(image, [len(view.image) for view in residuals]), axis=0)
    return ResidualSummary(
        rms=float(np.sqrt(np.mean(across**2 + down**2))),
        sigma_x=float(across.std()),
        sigma_y=float(down.std()),
        median_sigma_x=float(typical[0]),
        median_sigma_y=float(typical[1]),
        reference_mean=float(known.mean()) if known.size else np.nan,
        reference_sd=float(known.std()) if known.size else np.nan,
        count=len(image),
    )


def _measure_sigma(residual: Array, counts: Sequence[int]) -> Array:
    """Measure the standard deviation (K, 2) of residuals (n, 2) of views of so many corners."""
    corners = np.array(counts, dtype=np.int64)[:, None]
    begins = np.cumsum(corners) - corners[:, 0]
    mean = np.add.reduceat(residual, begins) / corners
    off = residual - np.repeat(mean, counts, axis=0)
    return np.sqrt(np.add.reduceat(off**2, begins) / corners)


@dataclass(frozen=True, eq=False, slots=True)
class Histogram:
    """A normalised histogram with the density fitted to the same values."""

    edges: Array
    """(B + 1,) edges of the bins."""
    density: Array
    """(B,) frequency density; its area is the share of the values that are not outside."""
    mean: float
    """Mean of the values."""
    sd: float
    """Standard deviation of the values."""
    scale: float
    """Parameter s of the fitted density, for a Gaussian its standard deviation."""
    is_rayleigh: bool
    """True if the fitted density is Rayleigh's (of lengths), false if Gaussian (of components)."""
    outside: int = 0
    """Number of values beyond the outermost edges."""

    def __post_init__(self) -> None:
        freeze(self, "edges", "density")

    def evaluate_density(self, x: Array) -> Array:
        """Return the fitted density (n,) at `x`."""
        s = self.scale
        if self.is_rayleigh:
            return np.where(x > 0, x / s**2 * np.exp(-0.5 * (x / s) ** 2), 0.0)
        return np.exp(-0.5 * ((x - self.mean) / s) ** 2) / (s * np.sqrt(2 * np.pi))


def make_component_histogram(values: Array) -> Histogram:
    """Make the histogram of one residual component with a Gaussian (figures 11a and 11b).

    Its range is symmetric about 0.
    """
    values = values[np.isfinite(values)]
    limit = _limit_histogram(np.abs(values), _NORMAL_MEDIAN)
    edges, density, outside = _count_values(values, -limit, limit)
    sd = float(values.std())
    return Histogram(edges, density, float(values.mean()), sd, sd, False, outside)


def make_length_histogram(values: Array) -> Histogram:
    """Make the histogram of residual lengths with a Rayleigh density (figure 11c)."""
    values = values[np.isfinite(values)]
    edges, density, outside = _count_values(values, 0.0, _limit_histogram(values, _RAYLEIGH_MEDIAN))
    scale = float(np.sqrt(np.mean(values**2) / 2))
    return Histogram(
        edges, density, float(values.mean()), float(values.std()), scale, True, outside
    )


def _limit_histogram(sizes: Array, median: float) -> float:
    """Return the largest of `sizes` (n,), or where outliers begin, if that is less.

    Args:
        sizes: absolute values or lengths.
        median: theirs if they are of Gaussian noise, in its standard deviations.
    """
    largest = float(sizes.max(initial=1e-12))
    usual = _REACH / median * float(np.median(sizes)) if sizes.size else 0.0
    return min(largest, usual) if usual > 0 else largest


def _count_values(values: Array, low: float, high: float) -> tuple[Array, Array, int]:
    """Return edges (B + 1,) and densities (B,) of bins, and how many values lie in none."""
    counts, edges = np.histogram(values, bins=_BINS, range=(low, high))
    density = counts / np.diff(edges) / max(len(values), 1)
    return edges, density, len(values) - int(counts.sum())


def stack_residuals(calibration: Calibration, on_reference: bool) -> Array:
    """Return the residuals (n, 2) of all views, in reference px or image px."""
    return np.concatenate(
        [view.reference if on_reference else view.image for view in calibration.residuals]
    )


def compute_kurtosis_chance(values: Array) -> float:
    """Return the chance that as many Gaussian values as these (n,) have a fourth moment farther
    from that of a Gaussian, either way (Anscombe and Glynn, Biometrika 70, 1983, 227-234).

    ``scipy.stats.kurtosistest`` says the same. To import that package takes longer than to judge a
    calibration, and nothing else that calibrates needs it.
    """
    n, off = values.size, values - values.mean()
    kurtosis = float(np.mean(off**4) / np.mean(off**2) ** 2)
    variance = 24.0 * n * (n - 2) * (n - 3) / ((n + 1) ** 2 * (n + 3) * (n + 5))
    standardised = (kurtosis - 3.0 * (n - 1) / (n + 1)) / np.sqrt(variance)
    skewness = 6.0 * (n * n - 5 * n + 2) / ((n + 7) * (n + 9))
    skewness *= np.sqrt(6.0 * (n + 3) * (n + 5) / (n * (n - 2) * (n - 3)))
    a = 6 + 8 / skewness * (2 / skewness + np.sqrt(1 + 4 / skewness**2))
    root = np.cbrt((1 - 2 / a) / (1 + standardised * np.sqrt(2 / (a - 4))))
    z = (1 - 2 / (9 * a) - root) / np.sqrt(2 / (9 * a))
    return float(2 * scipy.special.ndtr(-abs(z)))
