"""Do the residuals look like noise? If not, what is wrong, and with what.

Standard deviations hold if the corners' errors are independent, equal in all directions and
views, and Gaussian. Each of these is tested, and so is each usual cause of the contrary by what
it would explain (``patterns.py``); what views share before what each has of its own, and last
what can look like almost anything,

squares     the board's squares are not as wide as high, or askew
bow         the board is bowed
lens        a smooth displacement of the image that all views share
focus       a focal length of each view's own
bending     a curved board, each view's own
rows        a steady motion while the rows are read, each view's own
lines       a shift along the rows that wanders from row to row, each view's own
board       corners of the board that are not where they should be

and then

shape       kurtosis of the residuals over their view's sigma
views       Bartlett's test of the views' variances, chi^2(K - 1)
neighbours  correlation of the residuals of neighbouring corners, SD 1 / sqrt(2 pairs)
directions  covariance C of the residuals is isotropic: -n ln(4 det C / tr^2 C) ~ chi^2(2)

By chance each fails at most once in a thousand sound calibrations, and any of them once in
ninety. Several fail together, because a bent board also moves neighbours alike and looks a little
like a lens. The cause is the first that explains nearly as much as any does.

Many corners show what does no harm, too. A displacement that corners share moves the camera however
small it is; but least squares stays unbiased, and its standard deviations right on average, where
views are not equally noisy or tails are heavier than a Gaussian's. Those two fail only where there
is something to gain: by weighing the views, or by leaving out corners that are far off.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, freeze
from calibgui.engine.assessment import systematic_errors
from calibgui.engine.assessment.residual_statistics import summarise
from calibgui.engine.assessment.systematic_errors import Fitted
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.observations import Observation, Observations, pitch, view_names
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.errors import Progress

_CHANCE = 1e-3
_NEARLY = 0.7
"""Of what the best pattern explains, from which a simpler one is the cause."""
_GAIN = 1.1
"""By which standard deviations must shrink for weighing the views to be worth it."""
_OUTLIER = 4.5
"""Length, in sigma, that one good corner in 25,000 has."""

_INFLATED = 1.5
"""Of a view's rms over what its median says, from which a few corners are taken to cause it."""

_PATTERNS: tuple[tuple[str, Callable[[Fitted], systematic_errors.Explained], str], ...] = (
    (
        "squares",
        partial(systematic_errors.by_board_shape, model=BoardShapeModel.AFFINE),
        "The board's squares are not as wide as high, or askew: measure its sides over many "
        "squares, or estimate the plate (affine).",
    ),
    (
        "bow",
        partial(systematic_errors.by_board_shape, model=BoardShapeModel.BOW),
        "The board is bowed: mount it on something stiff, or estimate the plate (bow).",
    ),
    (
        "lens",
        systematic_errors.by_lens,
        "The lens model does not follow this lens: free the coefficients that are held, or use "
        "another model.",
    ),
    (
        "focus",
        systematic_errors.by_focus,
        "The focal length differs between the views: switch autofocus and stabilisation off, and "
        "do not touch zoom and focus.",
    ),
    (
        "bending",
        systematic_errors.by_bending,
        "The board bends from view to view, as paper in the hand does: mount it on something "
        "stiff.",
    ),
    (
        "rows",
        systematic_errors.by_rows,
        "Camera or board moved while a rolling shutter read the rows: put both on a stand, or "
        "expose all rows at once.",
    ),
    (
        "lines",
        systematic_errors.by_lines,
        "The image's rows are shifted sideways against each other: an analogue camera's lines do "
        "not start evenly, or the camera trembled while a rolling shutter read them. Many views "
        "average it; a digital or steady camera avoids it.",
    ),
    (
        "board",
        partial(systematic_errors.by_board_shape, model=BoardShapeModel.FREE),
        "The board is not flat or not printed true: mount it on glass, or estimate the plate "
        "(free).",
    ),
)
_OUTLIERS = (
    "A few corners are much farther off than the others: look for misplaced ones, or leave "
    "outliers out."
)
_ROUNDED = "The errors have sharp limits, as if corners had been rounded: use subpixel corners."
_BLUR = (
    "Some views are less sharp than others: motion blur, defocus or bad light. Weight the views "
    "by their noise, or take these again."
)
_SMOOTH = "Something smooth is left in the views that no pattern above names."
_DIRECTION = (
    "The corners scatter more along one direction: motion blur along it, or an interlaced or "
    "resampled image."
)


@dataclass(frozen=True, slots=True)
class Check:
    """One property of noise."""

    name: str
    passed: bool
    finding: str
    """What was found, in figures."""
    advice: str
    """What failing it means, and what to do about it."""
    share: float = 0.0
    """Of the squared residuals that its cause explains, where it tests one."""


@dataclass(frozen=True, eq=False, slots=True)
class NoiseReport:
    """Whether the residuals look like noise, and what they look like instead."""

    checks: tuple[Check, ...]
    """In the order of the module's description."""
    view_sigma: Array
    """(K,) standard deviation of a residual coordinate in each view, px; of a median corner
    where corners are weighted."""

    def __post_init__(self) -> None:
        freeze(self, "view_sigma")

    @property
    def passed(self) -> bool:
        """Whether all checks are passed."""
        return all(check.passed for check in self.checks)

    @property
    def cause(self) -> Check | None:
        """What to see to first; None if all checks are passed."""
        failed = [check for check in self.checks if not check.passed]
        most = max((check.share for check in failed), default=0.0)
        return next((check for check in failed if check.share >= _NEARLY * most), None)


def examine(
    calibration: Calibration,
    views: Sequence[Observation],
    names: Sequence[str] | None = None,
    progress: Progress | None = None,
) -> NoiseReport:
    """Examine the residuals of a calibration, in the image.

    Args:
        calibration: with any cost.
        views: that it was made from.
        names: of the views, for messages; numbers by default.
        progress: told of each pattern that is looked for.

    Raises:
        Cancelled: from `progress`.
    """
    names = names or view_names(len(views))
    fit = systematic_errors.fitted(calibration, views)
    r = fit.linear(slice(0, len(views))).residual
    sigma = view_sigma(r, fit)
    relative = r / sigma[:, None, None]
    seen = fit.observations.mask > 0
    even, rms = fit.weighted(sigma), summarise(calibration.residuals).rms
    checks = []
    for done, (name, test, advice) in enumerate(_PATTERNS):
        if progress is not None:
            progress(done, len(_PATTERNS))
        checks.append(_pattern(name, test(even), rms, advice))
    return NoiseReport(
        (
            *checks,
            _shape(r, sigma, seen),
            _views(sigma, _freedom(fit), names),
            _neighbours(relative, fit.observations),
            _directions(r[seen]),
        ),
        sigma,
    )


def _freedom(fit: Fitted) -> Array:
    """(K,) degrees of freedom: 2 n of each view, less its pose and its share of the camera."""
    n = fit.observations.mask.sum(axis=1)
    return np.asarray(np.maximum(2 * n - 6 - len(fit.free) * n / n.sum(), 1.0))


def view_sigma(residual: Array, fit: Fitted) -> Array:
    """(K,) standard deviation of a residual coordinate (K, N, 2) of each view."""
    return np.asarray(np.sqrt(np.sum(residual**2, axis=(1, 2)) / _freedom(fit)))


def _pattern(name: str, found: systematic_errors.Explained, rms: float, advice: str) -> Check:
    passed = found.probability >= _CHANCE
    finding = "nothing" if passed else f"{np.sqrt(found.share) * rms:.2g} px rms"
    return Check(name, passed, finding, advice, 0.0 if passed else found.share)


def _shape(residual: Array, sigma: Array, seen: BoolArray) -> Check:
    """Gaussian or not, from residuals (K, N, 2) where seen (K, N) over those of their view (K,)."""
    relative = (residual / sigma[:, None, None])[seen]
    excess = float(np.mean(relative**4) / np.mean(relative**2) ** 2 - 3)
    square = np.sum(residual**2, axis=-1)
    # The median's square is 2 ln 2 sigma^2, which outliers do not move as they do a view's rms.
    median = np.nanmedian(np.where(seen, square, np.nan), axis=1) / (2 * np.log(2))
    over = square / np.minimum(sigma**2, _INFLATED**2 * median)[:, None]
    far = seen & (over > _OUTLIER**2 * np.median(over[seen]) / (2 * np.log(2)))
    harmless = excess > 0 and not far.any()
    passed = harmless or bool(scipy.stats.kurtosistest(relative.ravel()).pvalue >= _CHANCE)
    return Check(
        "shape",
        passed,
        f"excess kurtosis {excess:+.2f}",
        _OUTLIERS if excess > 0 else _ROUNDED,
        0.0 if passed else float(square[far].sum() / square[seen].sum()),
    )


def _views(sigma: Array, freedom: Array, names: Sequence[str]) -> Check:
    """Whether standard deviations (K,) with so many degrees of freedom (K,) differ to any use."""
    total, K = freedom.sum(), len(sigma)
    if K == 1:
        return Check("views", True, "only one", _BLUR, 0.0)
    bartlett = total * np.log(np.sum(freedom * sigma**2) / total)
    bartlett -= np.sum(freedom * np.log(sigma**2))
    bartlett /= 1 + (np.sum(1 / freedom) - 1 / total) / (3 * (K - 1))
    share = freedom / total
    gain = np.sqrt(np.sum(share * sigma**2) * np.sum(share / sigma**2))
    passed = bool(gain < _GAIN or bartlett < scipy.special.chdtri(K - 1, _CHANCE))
    finding = f"sigma {sigma.min():.2g} to {sigma.max():.2g} px"
    if not passed:
        order = np.argsort(sigma)[::-1][:5].tolist()
        loud = [k for k in order if sigma[k] > 1.5 * np.median(sigma)] or order[:1]
        finding += ", most in " + ", ".join(names[k] for k in loud)
    excess = 1 - np.median(sigma) ** 2 * total / np.sum(freedom * sigma**2)
    return Check("views", passed, finding, _BLUR, 0.0 if passed else max(float(excess), 0.0))


def _neighbours(relative: Array, observations: Observations) -> Check:
    reach = 1.1 * pitch(observations)
    products, pairs = 0.0, 0
    for k in range(len(relative)):
        places = observations.view(k)
        tree = scipy.spatial.cKDTree(observations.xy[k, places, :2])
        near = tree.query_pairs(reach, output_type="ndarray")
        r = relative[k, places]
        products += float(np.sum(r[near[:, 0]] * r[near[:, 1]]))
        pairs += len(near)
    correlation = products / max(2 * pairs, 1)
    passed = bool(correlation * np.sqrt(2 * pairs) < -scipy.special.ndtri(_CHANCE))
    return Check("neighbours", passed, f"correlation {correlation:+.2f}", _SMOOTH)


def _directions(residual: Array) -> Check:
    C = residual.T @ residual / len(residual)
    values, vectors = np.linalg.eigh(C)
    sphericity = -len(residual) * np.log(4 * np.linalg.det(C) / np.trace(C) ** 2)
    passed = bool(sphericity < scipy.special.chdtri(2, _CHANCE))
    low, high = np.sqrt(values)
    finding = f"sigma {low:.2g} to {high:.2g} px"
    if not passed:
        angle = np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1])) % 180
        finding += f", largest {angle:.0f} deg from the rows"
    return Check("directions", passed, finding, _DIRECTION)
