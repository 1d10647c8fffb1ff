"""The coefficients of a board's deviations, and the variances that they are drawn from.

Their prior is q ~ N(0, s^2), with one variance for each kind of deviation (``uncertainty.py``). It
gives way to the data, by expectation-maximisation (Dempster, Laird and Rubin 1977) with the prior
on s^2 as an inverse gamma density of few degrees of freedom nu (Gelman et al., Bayesian Data
Analysis, 2.6): with A = sum of the squares of a kind's m expected coefficients, their variances
included,

    s^2 <- (nu s0^2 + A) / (nu + m) = s0^2 + (A - m s0^2) / (nu + m),

which stays at s0^2 where the views say nothing of the coefficients, and is what they say where they
say much; with nu infinite it is s0^2. Few coefficients that are determined draw the variance of the
others down slowly, by a tenth of the way in a step: Anderson's (1965) mixing of the last steps, in
the logarithms of sigma^2 / s^2, leads to the end. A step factorises a matrix of the coefficients
alone, and most of that is tridiagonal (`Information`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.board_shape.deviations import ROUGH
from calibgui.engine.kernels import with_kernel

_MAX_ITERATIONS = 50
"""Number of steps of expectation-maximisation, at most."""
_MAX_CHANGE = 1e-4
"""Relative change of every variance by a step below which they have settled."""
_MAX_MIXING = 3.0
"""Change of a variance's logarithm by mixing, at most: changes that are nearly alike lead far."""
_MIN_RATIO = 1e-6
"""Ratio of the singular values of changes by steps below which rounding errors tell them apart."""
_ROUNDING = 1e-12
"""Stiffness, relative to the information of the views, that rounding errors leave meaningful."""


class Coefficients(NamedTuple):
    """Estimates of the coefficients q of the deviations from the views, given q's variances."""

    q: Array
    """(Q,) expected coefficients, mm."""
    root: Array
    """(Q, Q) R, where sigma^2 R R^T is their covariance."""
    sigma2: float
    """Variance of one residual coordinate."""
    variances: Array
    """(3,) variances of the coefficients of each kind, mm^2."""


class Noise(NamedTuple):
    """The figures that the variance of a residual coordinate is estimated from."""

    cost: float
    """Sum of the squared residuals for the board as it is drawn, px^2."""
    freedom: float
    """Number of residual coordinates, less that of the unknowns of camera and poses."""
    otherwise: float
    """Variance where no coordinates are left to estimate it from, px^2."""


class VariancePrior(NamedTuple):
    """The prior on the variances of the coefficients."""

    expected: Array
    """(3,) variances of a coefficient of each kind that are expected, mm^2."""
    freedom: float
    """Degrees of freedom nu; infinite if the variances are known and not learnt from the views."""


def estimate_coefficients(
    S: Array, right: Array, kind: IntArray, prior: VariancePrior, noise: Noise
) -> Coefficients:
    """Estimate the coefficients of the deviations together with their variances.

    Args:
        S: (Q, Q) information of the views on them.
        right: (Q,) gradient of half the cost by them, at 0.
        kind: (Q,) kinds of the deviations.
        prior: the prior on the variances.
        noise: what is known of the residuals.
    """
    least = _ROUNDING * float(S.diagonal().max(initial=0.0))
    logarithms, sigma2 = find_stiffness(
        tridiagonalise_rough(S, right, kind),
        prior,
        noise,
        least,
        (_MAX_ITERATIONS, _MAX_CHANGE, _MAX_MIXING, _MIN_RATIO),
    )
    stiffened, stiffness = S.copy(), np.exp(logarithms)
    stiffened.flat[:: len(S) + 1] += stiffness[kind]
    factor, _ = scipy.linalg.lapack.dpotrf(stiffened.T, overwrite_a=True)
    root, _ = scipy.linalg.lapack.dtrtri(factor, overwrite_c=True)
    return Coefficients(-root @ (right @ root), root, sigma2, sigma2 / stiffness)


def estimate_sigma2(noise: Noise, gained: float, known: float) -> float:
    """Estimate the variance of one residual coordinate.

    Args:
        noise: what is known of the residuals.
        gained: decrease of the cost by the coefficients.
        known: number of coefficients that the views determine.
    """
    left = noise.freedom - known
    sigma2 = (noise.cost - gained) / left if left > 0 else 0.0
    return sigma2 if sigma2 > 0 else noise.otherwise


class Information(NamedTuple):
    """Information of the views on m rough and s other coefficients, the rough ones' axes turned.

    All rough coefficients have one variance, and so the prior does not notice a turn that makes
    the views' information on them tridiagonal. Then a step factorises in O(m) what is stiffened,
    and the others' information, less what goes with the rough ones, is small.
    """

    kind: IntArray
    """(s,) kinds of the other coefficients."""
    others: Array
    """(s + 1, s + 1) information on these, and in the last row and column the gradient."""
    beside: Array
    """(m, s + 1) information between the rough and the other ones, and last the gradient."""
    rough: tuple[Array, Array]
    """(m,) entries on the diagonal of the information on the rough ones, (m - 1,) beside it."""


@with_kernel("deviation_variances", "find_stiffness")
def find_stiffness(
    information: Information,
    prior: VariancePrior,
    noise: Noise,
    least: float,
    limits: tuple[int, float, float, float],
) -> tuple[Array, float]:
    """Find the stiffness sigma^2 / s^2 of each kind at which expectation-maximisation settles.

    Args:
        information: what the views tell of the coefficients.
        prior: the prior on the variances.
        noise: what is known of the residuals.
        least: smallest stiffness that rounding errors leave meaningful.
        limits: number of steps; relative change of every variance that has settled; change of a
            variance's logarithm by mixing, at most; ratio of singular values below which changes
            count as alike.

    Returns:
        The logarithms (3,) of the stiffness, and the variance of one residual coordinate there.
    """
    expected, nu = prior
    counts = np.bincount(information.kind, minlength=3)
    counts[ROUGH] += len(information.beside)

    def take_step(logarithms: Array) -> tuple[Array, float]:
        stiffness = np.exp(logarithms)
        squares, inverses, gained = solve_stiffened(information, stiffness)
        sigma2 = estimate_sigma2(noise, gained, float(counts.sum() - stiffness @ inverses))
        found = squares + sigma2 * inverses
        variances = expected + (found - counts * expected) / (nu + counts)
        return np.log(np.fmax(sigma2 / variances, least)), sigma2

    start = np.log(np.fmax(estimate_sigma2(noise, 0.0, 0.0) / expected, least))
    return _mix_steps(take_step, start, *limits)


def solve_stiffened(information: Information, stiffness: Array) -> tuple[Array, Array, float]:
    """Solve for the coefficients, and invert what is known of them.

    Args:
        information: what the views tell of the coefficients.
        stiffness: (3,) sigma^2 / s^2 of each kind.

    Returns:
        By kind the sum (3,) of the squares of the coefficients, and that (3,) of the entries on the
        diagonal of the inverse of the stiffened information; the decrease of the cost.
    """
    kind, others, beside, (diagonal, next_to_it) = information
    tridiagonal = np.diag(diagonal + stiffness[ROUGH])
    tridiagonal += np.diag(next_to_it, 1) + np.diag(next_to_it, -1)
    inverse_of_rough = np.linalg.inv(tridiagonal)
    followed = inverse_of_rough @ beside
    left = others - beside.T @ followed
    inverse = np.linalg.inv(left[:-1, :-1] + np.diag(stiffness[kind]))
    q = -inverse @ left[:-1, -1]
    rough = -followed @ np.append(q, 1.0)
    squares, inverses = (
        np.asarray(np.bincount(kind, x, 3), np.float64) for x in (q * q, inverse.diagonal())
    )
    squares[ROUGH] += rough @ rough
    inverses[ROUGH] += np.trace(inverse_of_rough)
    inverses[ROUGH] += np.sum((followed[:, :-1] @ inverse) * followed[:, :-1])
    return squares, inverses, -float(others[-1, :-1] @ q + beside[:, -1] @ rough)


def tridiagonalise_rough(S: Array, right: Array, kind: IntArray) -> Information:
    """Turn the axes of the rough coefficients so that the information on them is tridiagonal.

    Args:
        S: (Q, Q) information of the views on the coefficients.
        right: (Q,) gradient of half the cost by them, at 0.
        kind: (Q,) kinds of the deviations. Of rough ones there are none, or three and more.
    """
    turned, others = np.flatnonzero(kind == ROUGH), np.flatnonzero(kind != ROUGH)
    rows = S[turned]
    beside, rough = np.column_stack([rows[:, others], right[turned]]), (np.zeros(0), np.zeros(0))
    if turned.size:
        lapack = scipy.linalg.lapack
        reflected, *chain, shares, _ = lapack.dsytrd(rows[:, turned].T, lower=True)
        rough = chain[0], chain[1]
        # The first axis stays. The workspace: LAPACK asks for 64 numbers a column at most.
        space = 64 * beside.shape[1]
        beside[1:] = lapack.dormqr("L", "T", reflected[1:, :-1], shares, beside[1:], space)[0]
    whole = np.zeros((len(others) + 1, len(others) + 1))
    whole[:-1, :-1] = S[np.ix_(others, others)]
    whole[-1, :-1] = whole[:-1, -1] = right[others]
    return Information(kind[others], whole, beside, rough)


def _mix_steps(
    take_step: Callable[[Array], tuple[Array, float]],
    x: Array,
    max_steps: int,
    max_change: float,
    max_mixing: float,
    min_ratio: float,
) -> tuple[Array, float]:
    """Return the fixed point of a step, and what a step finds there, by Anderson's mixing of the
    last steps.

    Args:
        take_step: a function from a point (m,) to the next one and what it finds.
        x: (m,) the point to start from.
        max_steps, max_change, max_mixing, min_ratio: see `find_stiffness`.
    """
    points: list[Array] = []
    changes: list[Array] = []
    for _ in range(max_steps):
        before = x
        after, found = take_step(before)
        points, changes = [*points[-len(x) :], x], [*changes[-len(x) :], after - x]
        if np.abs(changes[-1]).max() < max_change:
            break
        x = after
        if len(points) > 1:
            by_point, by_change = (a[1:] - a[:-1] for a in map(np.array, (points, changes)))
            weights = changes[-1] @ np.linalg.pinv(by_change, rcond=min_ratio)
            x = after - np.clip(weights @ (by_point + by_change), -max_mixing, max_mixing)
    return before, found
