"""Whether stated covariances are those of the errors that are made."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import chi2

from calibgui.engine.arrays import Array


def check_honest(errors: Array, covariances: Array) -> None:
    """Check that stated covariances (draws, n, n) are those of errors (draws, n).

    In units of a root of their covariance the errors are independent standard normal numbers. Their
    mean square, which tells of variances and biases, differs from 1 by more than 4 of its
    deviations once in 16,000 times, and that of each parameter alone once in 3,000; the mean
    product of two of them, which tells of correlations, is 0.
    """
    draws, n = errors.shape
    scale = np.sqrt(np.mean(np.diagonal(covariances, axis1=1, axis2=2), axis=0))
    roots = np.linalg.cholesky(covariances / np.outer(scale, scale))
    whitened = np.linalg.solve(roots, (errors / scale)[..., None])[..., 0]
    assert np.mean(whitened**2) == pytest.approx(1, abs=4 * np.sqrt(2 / (draws * n)))
    squares = np.mean((errors / scale) ** 2, axis=0) * draws
    least, most = chi2.ppf([1 / 6000, 1 - 1 / 6000], draws)
    assert ((squares > least) & (squares < most)).all(), squares / draws
    products = (whitened.T @ whitened)[np.triu_indices(n, 1)] / np.sqrt(draws)
    assert np.mean(products**2) < 1 + 5 * np.sqrt(2 / len(products))
