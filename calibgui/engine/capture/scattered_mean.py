"""A mean of values with weights, whose standard deviation their scatter tells.

Values x_k whose variances are thought to be 1 / w_k have the mean m = sum(w x) / sum(w), whose
variance is 1 / sum(w). Where they scatter more than that, by s^2 = sum(w (x - m)^2) / (n - 1) > 1,
something that the weights do not know of changes from one to the next: the variance of the mean is
s^2 times as large (the Birge ratio; Birge 1932).
"""

from __future__ import annotations

import numpy as np

_MIN_SIGMAS = 4.0
"""Standard deviations from which a mean is told from zero: chance reaches it once in 16,000 looks.
"""


class ScatteredMean:
    """Adds up values and their weights."""

    def __init__(self) -> None:
        self._values: list[float] = []
        self._weights: list[float] = []

    def add(self, value: float, weight: float) -> None:
        """Add a value whose variance is thought to be 1 / weight."""
        self._values.append(value)
        self._weights.append(weight)

    def estimate(self) -> tuple[float, float]:
        """Return the mean and its standard deviation; NaN and infinite before the second value."""
        values, weights = np.array(self._values), np.array(self._weights)
        if len(values) < 2:
            return np.nan, np.inf
        mean = float(weights @ values / weights.sum())
        scatter = float(weights @ (values - mean) ** 2) / (len(values) - 1)
        return mean, float(np.sqrt(max(1.0, scatter) / weights.sum()))

    @property
    def is_significant(self) -> bool:
        """True if the mean is certainly not zero."""
        mean, sigma = self.estimate()
        return abs(mean) > _MIN_SIGMAS * sigma
