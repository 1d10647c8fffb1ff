"""Tests whether the residuals look like noise, and which cause explains them if they do not.

Standard deviations hold if the corners' errors are independent, equal in all directions and
views, and Gaussian. Each of these is tested, and so is each usual cause of the contrary by what
it would explain: first the causes that all views share (``calibration/score_tests.py``), then those
that each view has of its own (``systematic_errors.py``), and last the one that can look like almost
anything,

squares     the board's squares are not as wide as high, or askew
bow         the board is bowed or twisted
lens        a smooth displacement of the image that all views share
focus       a focal length of each view's own
centre      a principal point of each view's own
bending     a curved board, each view's own
rows        a steady motion while the rows are read, each view's own, or as in a warped image
lines       a shift along the rows that wanders from row to row, each view's own
smooth      any smooth displacement of the image, each view's own
board       corners of the board that are not where they should be

and then

shape       kurtosis of the residuals over their view's sigma (Anscombe and Glynn 1983)
views       test of the views' variances (Bartlett 1937), chi^2(K - 1)
neighbours  correlation of the residuals of neighbouring corners, SD 1 / sqrt(2 pairs)
directions  covariance C of the residuals is isotropic: -n ln(4 det C / tr^2 C) ~ chi^2(2)

By chance each test fails at most once in a thousand sound calibrations, and any of them once in
seventy. Several fail together, because a bent board also moves neighbours alike and looks a little
like a lens. Which of them is the cause is chosen in ``causes/cause_choice.py``.

Many corners reveal harmless deviations, too. A displacement that corners share moves the camera
however small it is; but least squares stays unbiased, and its standard deviations right on
average, where views are not equally noisy or tails are heavier than a Gaussian's. These two tests
fail only where there is something to gain: by weighing the views, or by leaving out corners that
are far off.

Corners that have covariances are tested by what they say of each. Those that are far off but no
farther than they are uncertain pass, and are counted.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray
from calibgui.engine.assessment.residuals.cause_fits import (
    CauseFit,
    fit_board,
    fit_nothing,
    fit_own_cause,
)
from calibgui.engine.assessment.residuals.residual_causes import CAUSES, Family, list_tests
from calibgui.engine.assessment.residuals.residual_statistics import (
    compute_kurtosis_chance,
    summarise_residuals,
)
from calibgui.engine.assessment.residuals.systematic_errors import (
    make_cubic_displacements,
    prepare_fit,
    take_open_steps,
    weigh_views,
)
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.observations import (
    Observation,
    Observations,
    measure_pitch,
    name_views,
)
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.calibration.score_tests import LENS, LinearisedFit, SharedCauses
from calibgui.engine.errors import Progress

_MAX_FALSE_ALARM_RATE = 1e-3
"""Probability under noise below which a test fails."""
_MIN_GAIN_OF_WEIGHING = 1.1
"""Ratio by which standard deviations must shrink for weighing the views to be worth it."""
_MAX_LENGTH_IN_SIGMA = 4.5
"""Length of a residual, in sigma, that one good corner in 25,000 exceeds."""
FAR_OFF = 5.0
"""Length of a residual, in sigma of all, beyond which people take a corner for an outlier."""
_MAX_RMS_OVER_MEDIAN = 1.5
"""A view's rms over that from its median, above which few corners are taken to raise it."""

_EXPLAINING = [*list_tests(Family.BOARD, Family.LENS, Family.OF_VIEW), "lines"]
"""Tests of causes that explain what they do, and do not merely follow it."""
_ADVICE_ON_OUTLIERS = (
    "A few corners are much farther off than the others: look for misplaced ones, or leave "
    "outliers out."
)
_ADVICE_ON_ROUNDING = (
    "The errors have sharp limits, as if corners had been rounded: use subpixel corners."
)
_ADVICE_ON_BLUR = (
    "Some views are less sharp than others: motion blur, defocus, bad light or a small board. "
    "Weight the views by their noise, or take these again."
)
_ADVICE_ON_NEIGHBOURS = "Something smooth is left in the views that no cause above explains."
_ADVICE_ON_DIRECTION = (
    "The corners scatter more along one direction: motion blur along it, or an interlaced or "
    "resampled image."
)


@dataclass(frozen=True, slots=True)
class NoiseCheck:
    """Result of one test of the residuals."""

    name: str
    """Name of the test, as in the module's description."""
    passed: bool
    """True if the residuals have this property of noise."""
    finding: str
    """The figures that were found."""
    advice: str
    """Meaning of a failure, and its remedy."""
    share: float = 0.0
    """Share of the squared residuals that the cause explains, where the test is of one."""
    probability: float = 1.0
    """Probability that noise explains as much, where the test is of a cause."""
    criterion: float = np.inf
    """Akaike's criterion of the cause, where the test is of one (``cause_fits.py``); 0 of none."""


@dataclass(frozen=True, eq=False, slots=True)
class NoiseReport:
    """Results of all tests of the residuals."""

    checks: tuple[NoiseCheck, ...]
    """Results in the order of the module's description."""
    far_corners: int = 0
    """Number of corners whose residuals exceed `FAR_OFF` sigma of all, but not what their own
    uncertainty explains."""
    far_views: int = 0
    """Number of views that have any of them."""

    @property
    def passed(self) -> bool:
        """True if all tests are passed."""
        return all(check.passed for check in self.checks)


def find_largest_share(checks: Iterable[NoiseCheck]) -> float:
    """Return the largest share of the squared residuals that any cause explains, but for noise."""
    return max((check.share for check in checks if check.name in _EXPLAINING), default=0.0)


def check_residuals(
    calibration: Calibration,
    views: Sequence[Observation],
    names: Sequence[str] | None = None,
    progress: Progress | None = None,
) -> NoiseReport:
    """Test the residuals of a calibration, in the image, for the properties of noise.

    Args:
        calibration: calibration with any cost.
        views: the views that it was made from.
        names: names of the views, for messages; numbers by default.
        progress: function that is called for each cause that is tested.

    Raises:
        Cancelled: if `progress` raises it.
    """
    names = names or name_views(len(views))
    fit = prepare_fit(calibration, views)
    r = fit.linearise(slice(0, len(views))).residual
    sigma = estimate_view_sigma(r, fit)
    relative = r / sigma[:, None, None]
    seen = fit.observations.mask > 0
    weighed = weigh_views(fit, sigma)
    shared = SharedCauses(weighed, [c.adds for c in CAUSES if isinstance(c.adds, str)])
    causes = tuple(_check_causes(calibration, weighed, shared, progress))
    return NoiseReport(
        (
            *causes,
            _check_shape(r, sigma, seen),
            _check_views(sigma, _count_degrees_of_freedom(fit), names),
            _check_neighbours(relative, fit.observations),
            _check_directions(r[seen]),
        ),
        *_count_far_corners(calibration, relative, fit.observations),
    )


def _count_far_corners(
    calibration: Calibration, relative: Array, observations: Observations
) -> tuple[int, int]:
    """Count corners that are far off in the image but not by residuals `relative` (K, N, 2), and
    the views that have any."""
    limit = FAR_OFF * summarise_residuals(calibration.residuals).rms / np.sqrt(2)
    counts: list[int] = []
    for k, view in enumerate(calibration.residuals):
        own = np.linalg.norm(relative[k, observations.corners_of(k)], axis=1)
        far = np.linalg.norm(view.image, axis=1) > limit
        counts.append(int(np.count_nonzero(far & (own <= _MAX_LENGTH_IN_SIGMA))))
    return sum(counts), sum(n > 0 for n in counts)


def _count_degrees_of_freedom(fit: LinearisedFit) -> Array:
    """Count degrees of freedom (K,): 2 n a view, less its pose and its share of the camera."""
    n = fit.observations.mask.sum(axis=1)
    return np.asarray(np.maximum(2 * n - 6 - len(fit.free) * n / n.sum(), 1.0))


def estimate_view_sigma(residual: Array, fit: LinearisedFit) -> Array:
    """Estimate the standard deviation (K,) of a coordinate of each view's residuals (K, N, 2)."""
    return np.asarray(np.sqrt(np.sum(residual**2, axis=(1, 2)) / _count_degrees_of_freedom(fit)))


def _check_causes(
    calibration: Calibration,
    fit: LinearisedFit,
    shared: SharedCauses,
    progress: Progress | None,
) -> Iterator[NoiseCheck]:
    """Test what each cause explains of the residuals, of equally noisy views, against noise."""
    rms, freedom = summarise_residuals(calibration.residuals).rms, fit.degrees_of_freedom
    without, steps = fit_nothing(fit), take_open_steps(fit)
    squares = fit_board(fit, BoardShapeModel.AFFINE)

    def lower(adds: str) -> CauseFit:
        return without.lower(*shared.reduce_cost(adds))

    def compute_criterion(found: CauseFit) -> float:
        return found.compute_akaike(without, freedom, steps.dispersion)

    causes, after, left = list(CAUSES), [], 1.0
    if calibration.lens_error > 0 and compute_criterion(lower(LENS)) < compute_criterion(squares):
        causes.sort(key=lambda cause: cause.adds != LENS)
        after, left = [LENS], 1 - shared.reduce_cost(LENS)[0] / shared.cost
    for done, cause in enumerate(causes):
        if progress is not None:
            progress(done, len(causes))
        share = 1.0
        if isinstance(cause.adds, str):
            before = [] if cause.adds == LENS else after
            fitted, share = lower(cause.adds), left if before else 1.0
            found = shared.explain(cause.adds, *before)
            if cause.adds == BoardShapeModel.AFFINE:
                fitted, found = squares, found if before else squares.judge(without, freedom)
            agree = shared.do_views_agree(cause.adds, *before)
        elif cause.family is Family.OPEN:
            fitted = steps.smooth if cause.adds is make_cubic_displacements else steps.lines
            agree = True
            found = fitted.judge(CauseFit(shared.cost, 0), freedom)
        else:
            fitted, agree = fit_own_cause(fit, cause.adds), True
            found = fitted.judge(without, freedom)
        share *= found.share
        passed = found.probability >= _MAX_FALSE_ALARM_RATE or not agree
        finding = "nothing" if passed else f"{np.sqrt(share) * rms:.2g} px rms"
        yield NoiseCheck(
            cause.name,
            passed,
            finding,
            cause.advice,
            0.0 if passed else share,
            found.probability,
            compute_criterion(fitted),
        )


def _check_shape(residual: Array, sigma: Array, seen: BoolArray) -> NoiseCheck:
    """Test whether residuals (K, N, 2), where `seen`, over their view's `sigma` are Gaussian."""
    relative = (residual / sigma[:, None, None])[seen]
    excess = float(np.mean(relative**4) / np.mean(relative**2) ** 2 - 3)
    square = np.sum(residual**2, axis=-1)
    # The median's square is 2 ln 2 sigma^2, which outliers do not move as they do a view's rms.
    median = np.nanmedian(np.where(seen, square, np.nan), axis=1) / (2 * np.log(2))
    over = square / np.minimum(sigma**2, _MAX_RMS_OVER_MEDIAN**2 * median)[:, None]
    far = seen & (over > _MAX_LENGTH_IN_SIGMA**2 * np.median(over[seen]) / (2 * np.log(2)))
    harmless = excess > 0 and not far.any()
    passed = harmless or compute_kurtosis_chance(relative.ravel()) >= _MAX_FALSE_ALARM_RATE
    return NoiseCheck(
        "shape",
        passed,
        f"excess kurtosis {excess:+.2f}",
        _ADVICE_ON_OUTLIERS if excess > 0 else _ADVICE_ON_ROUNDING,
        0.0 if passed else float(square[far].sum() / square[seen].sum()),
    )


def _check_views(sigma: Array, freedom: Array, names: Sequence[str]) -> NoiseCheck:
    """Test whether the views' `sigma` (K,) with degrees of freedom (K,) differ to any use."""
    total, K = freedom.sum(), len(sigma)
    if K == 1:
        return NoiseCheck("views", True, "only one", _ADVICE_ON_BLUR, 0.0)
    bartlett = total * np.log(np.sum(freedom * sigma**2) / total)
    bartlett -= np.sum(freedom * np.log(sigma**2))
    bartlett /= 1 + (np.sum(1 / freedom) - 1 / total) / (3 * (K - 1))
    share = freedom / total
    gain = np.sqrt(np.sum(share * sigma**2) * np.sum(share / sigma**2))
    passed = bool(
        gain < _MIN_GAIN_OF_WEIGHING
        or bartlett < scipy.special.chdtri(K - 1, _MAX_FALSE_ALARM_RATE)
    )
    finding = f"sigma {sigma.min():.2g} to {sigma.max():.2g} px"
    if not passed:
        order = np.argsort(sigma)[::-1][:5].tolist()
        loud = [k for k in order if sigma[k] > 1.5 * np.median(sigma)] or order[:1]
        finding += ", most in " + ", ".join(names[k] for k in loud)
    excess = 1 - np.median(sigma) ** 2 * total / np.sum(freedom * sigma**2)
    return NoiseCheck(
        "views", passed, finding, _ADVICE_ON_BLUR, 0.0 if passed else max(float(excess), 0.0)
    )


def _check_neighbours(relative: Array, observations: Observations) -> NoiseCheck:
    """Test the correlation of residuals `relative` (K, N, 2) of neighbouring corners."""
    reach = 1.1 * measure_pitch(observations)
    products, pairs = 0.0, 0
    for k in range(len(relative)):
        places = observations.corners_of(k)
        tree = scipy.spatial.cKDTree(observations.xy[k, places, :2])
        near = tree.query_pairs(reach, output_type="ndarray")
        r = relative[k, places]
        products += float(np.sum(r[near[:, 0]] * r[near[:, 1]]))
        pairs += len(near)
    correlation = products / max(2 * pairs, 1)
    passed = bool(correlation * np.sqrt(2 * pairs) < -scipy.special.ndtri(_MAX_FALSE_ALARM_RATE))
    return NoiseCheck(
        "neighbours", passed, f"correlation {correlation:+.2f}", _ADVICE_ON_NEIGHBOURS
    )


def _check_directions(residual: Array) -> NoiseCheck:
    """Test whether residuals (n, 2) scatter alike in all directions (Mauchly 1940)."""
    C = residual.T @ residual / len(residual)
    values, vectors = np.linalg.eigh(C)
    sphericity = -len(residual) * np.log(4 * np.linalg.det(C) / np.trace(C) ** 2)
    passed = bool(sphericity < scipy.special.chdtri(2, _MAX_FALSE_ALARM_RATE))
    low, high = np.sqrt(values)
    finding = f"sigma {low:.2g} to {high:.2g} px"
    if not passed:
        angle = np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1])) % 180
        finding += f", largest {angle:.0f} deg from the rows"
    return NoiseCheck("directions", passed, finding, _ADVICE_ON_DIRECTION)
