"""Whether stated covariances are those of the errors that are made."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import chi2

from calibgui.engine.arrays import Array


def check_honest(errors: Array, covariances: Array) -> None:
    """Check that stated covariances (draws, n, n) are those of errors (draws, n).

    In units of a root of their covariance the errors are independent standard normal numbers: their
    mean square, which tells of variances, correlations and biases alike, differs from 1 by more
    than 4 of its deviations once in 16,000 times, and that of each parameter alone once in 3,000.
    """
    draws, n = errors.shape
    scale = np.sqrt(np.mean(np.diagonal(covariances, axis1=1, axis2=2), axis=0))
    roots = np.linalg.cholesky(covariances / np.outer(scale, scale))
    whitened = np.linalg.solve(roots, (errors / scale)[..., None])
    assert np.mean(whitened**2) == pytest.approx(1, abs=4 * np.sqrt(2 / (draws * n)))
    squares = np.mean((errors / scale) ** 2, axis=0) * draws
    least, most = chi2.ppf([1 / 6000, 1 - 1 / 6000], draws)
    assert ((squares > least) & (squares < most)).all(), squares / draws
