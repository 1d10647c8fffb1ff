"""The choice of a lens model: all candidates on the same views, and the one to be trusted.

Every candidate is calibrated from all views, and cross-validated (``cross_validation.py``). Neither
a low residual nor an information criterion chooses well: a model with numerator and denominator
lowers the residuals by nonsense, and with thousands of corners the Bayesian criterion pays for two
parameters that gain a tenth of a thousandth of a pixel on unseen views. The choice is made so:

1. A candidate is sound if the views determine its parameters and if its map is one-to-one where
   corners were seen.
2. It is adequate if no sound candidate predicts unseen views better by more than 1 %; of the
   paper's model, which others are taken in place of only where the views demand it, also beyond
   chance. If some adequate candidate is one-to-one over the whole image, and the lens fills it, the
   others must be.
3. The richest of the adequate candidates is the reference: what a lens model can leave
   unexplained, it leaves least. The recommendation is the simplest adequate candidate whose map
   differs from the reference's by less than the uncertainty of projection, root mean square over
   the region that the corners cover. The difference is that of ``comparison.py``, what a rotation
   of the camera makes up for left out; the uncertainty is the larger of the two models'.

Of a model with coefficients that the views leave open, such as the numerator and denominator of the
rational one, those of the highest powers are held at 0 one by one until the others are determined.

The paper's model counts as the simplest; the others follow by their number of free parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment.comparison import compare_cameras, find_covered_pixels
from calibgui.engine.assessment.cross_validation import (
    DEFAULT_FOLDS,
    CrossValidation,
    cross_validate,
    predicts_better,
)
from calibgui.engine.assessment.residual_statistics import summarise_residuals
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.problem import find_free_parameters
from calibgui.engine.calibration.refinement.covariances import compute_correlations
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.validity import find_valid_pixels, measure_angles
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.projection_uncertainty import estimate_projection_uncertainty

SIMPLEST_MODEL = "lucchese"
"""Lens model that is recommended wherever it is as good as any: the paper's."""
CANDIDATES = (
    SIMPLEST_MODEL,
    "brown-conrady-4",
    "brown-conrady",
    "rational",
    "thin-prism",
    "ucm",
    "eucm",
    "double-sphere",
    "division",
    "kannala-brandt",
    "kannala-brandt-decentering",
    "mei",
    "scaramuzza",
)
"""Lens models that are compared, in the order in which people list them."""
_FIRST_CANDIDATES = (SIMPLEST_MODEL, "brown-conrady", "kannala-brandt-decentering")
"""Lens models that are enough to see whether the paper's follows a lens."""
_MIN_VIEWS = 3
"""Number of views below which no view can be spared for a comparison."""
_MAX_LOSS = 0.01
"""Error on unseen views beyond that of the best candidate, relative to it, that is no loss."""
_MAX_RESIDUAL_RATIO = 1.5
"""Residuals over those of the best candidate, above which unseen views need not be asked."""
_MIN_STRONG_CORRELATION = 0.98
"""Correlation from which on two coefficients are exchangeable."""
_MAX_FILLING_DIAGONAL = np.deg2rad(160.0)
"""Diagonal field of view up to which a lens is taken to fill the image; the image circle of wider
ones mostly ends inside it, and what a model does beyond is nobody's concern."""
_GRID_SAMPLES = 41
"""Number of pixels along either side of the image at which a map is examined."""


@dataclass(frozen=True, eq=False, slots=True)
class LensTrial:
    """A lens model tried on the views."""

    calibration: Calibration
    """Calibration from all views."""
    fixed: dict[str, float]
    """Coefficients that were held at 0 because the views leave them open."""
    validation: CrossValidation | None
    """Its error on unseen views; None if its residuals rule it out without."""
    bic: float
    """Bayesian information criterion, less for a better model: n ln(r^T r / n) + P ln n."""
    largest_angle: float
    """Largest angle off the axis at which a corner was seen, rad; NaN if one has no ray."""
    field_of_view: Array
    """(3,) horizontal, vertical and diagonal angle that the image spans, rad; NaN if undefined."""
    is_valid_at_corners: bool
    """True if the map is one-to-one within the circle, about the centre, through all corners."""
    valid_share: float
    """Share of the image where the map is one-to-one."""
    exchangeable: tuple[tuple[str, str], ...]
    """Pairs of coefficients of which the views determine only a combination."""

    @property
    def model(self) -> str:
        """Id of the lens model."""
        return self.calibration.camera.model

    @property
    def rms(self) -> float:
        """RMS length of the residuals of all views, px."""
        return _measure_rms(self.calibration)

    @property
    def parameters(self) -> int:
        """Number of estimated parameters of the camera."""
        return len(find_free_parameters(self.calibration))

    @property
    def is_sound(self) -> bool:
        """True if all parameters are determined, and the map is one-to-one at the corners."""
        return self.is_valid_at_corners and not self.calibration.undetermined

    @property
    def held_out(self) -> float:
        """RMS length of the residuals of unseen views, px; infinite if they were not asked."""
        return np.inf if self.validation is None else self.validation.held_out


@dataclass(frozen=True, eq=False, slots=True)
class LensChoice:
    """All candidates, and the lens model that is recommended."""

    trials: dict[str, LensTrial]
    """The candidates that could be calibrated, by their ids."""
    refused: dict[str, str]
    """Reasons why the others could not."""
    model: str
    """The recommended model."""
    reference: str
    """The richest adequate model, which it was compared with."""
    adequate: tuple[str, ...]
    """Models that predict unseen views as well as any, the simplest first."""
    differences: dict[str, float]
    """Largest difference of each model's map from the recommended one's where corners were seen,
    px; NaN where the two cannot be compared."""
    tolerance: float
    """Uncertainty of projection that the recommended model was allowed to differ by, px."""

    @property
    def chosen(self) -> LensTrial:
        """The recommended candidate."""
        return self.trials[self.model]


def choose_lens(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    candidates: Sequence[str] = CANDIDATES,
    folds: int = DEFAULT_FOLDS,
    progress: Progress | None = None,
    **settings: Any,
) -> LensChoice:
    """Try lens models on unseen views and recommend one.

    Args:
        views, size, settings: as for ``calibrate``, without `model` and `free`; `fix` is a mapping
            of parameters that all models have.
        candidates: ids of the models to try.
        folds: number of folds of the cross-validation, at most one a view.
        progress: a function that is told how many models are done, and of how many.

    Raises:
        CalibrationError: if there are fewer than three views, or no candidate can be calibrated.
        Cancelled: from `progress`.
    """
    attempt = _Attempt([Observation(*view) for view in views], size, folds, settings)
    attempt.try_lenses(candidates, progress)
    return attempt.recommend()


def choose_lens_stepwise(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    folds: int = DEFAULT_FOLDS,
    progress: Progress | None = None,
    **settings: Any,
) -> LensChoice:
    """Recommend the paper's model if few others show that it is enough, else choose from all.

    Args, raises: as for `choose_lens`, without `candidates`.
    """
    attempt = _Attempt([Observation(*view) for view in views], size, folds, settings)
    attempt.try_lenses(_FIRST_CANDIDATES, progress)
    if len(attempt.validations) > 1 and (choice := attempt.recommend()).model == SIMPLEST_MODEL:
        return choice
    attempt.try_lenses(CANDIDATES, progress)
    return attempt.recommend()


class _Attempt:
    """Lens models tried on the same views; what was tried before is not tried again."""

    def __init__(
        self, views: Sequence[Observation], size: Size, folds: int, settings: dict[str, Any]
    ) -> None:
        """Take the views, and the arguments of ``cross_validate``."""
        if len(views) < _MIN_VIEWS:
            raise CalibrationError(
                f"{len(views)} views are too few to compare lens models: none can be left out.",
                "Add views, or name the lens model.",
            )
        self.views, self.size = views, size
        self.settings = {name: value for name, value in settings.items() if name != "fix"}
        self.held: dict[str, float | None] = dict(settings.get("fix", {}))
        self.folds = min(folds, len(views))
        self.calibrations: dict[str, Calibration] = {}
        self.fixed: dict[str, dict[str, float]] = {}
        self.validations: dict[str, CrossValidation] = {}
        self.refused: dict[str, str] = {}

    def try_lenses(self, candidates: Sequence[str], progress: Progress | None) -> None:
        """Calibrate the candidates, and cross-validate those that follow the corners."""
        done, total = 0, 2 * len(candidates)

        def advance() -> None:
            nonlocal done
            if progress is not None:
                progress(done, total)
            done += 1

        for model in candidates:
            advance()
            if model not in self.calibrations and model not in self.refused:
                self._calibrate(model)
        for model in candidates:
            advance()
            if self._is_close(model) and model not in self.validations:
                self._validate(model)

    def _calibrate(self, model: str) -> None:
        """Calibrate a candidate, with the coefficients that the views leave open held at 0."""
        fixed: dict[str, float] = {}
        try:
            while True:
                fix = self.held | fixed
                calibration = calibrate(
                    self.views, self.size, model=model, fix=fix, **self.settings
                )
                name = _find_open_coefficient(calibration)
                if name is None:
                    break
                fixed[name] = 0.0
        except CalibrationError as error:
            self.refused[model] = error.message
            return
        self.calibrations[model], self.fixed[model] = calibration, fixed

    def _validate(self, model: str) -> None:
        try:
            self.validations[model] = cross_validate(
                self.views,
                self.size,
                self.folds,
                model=model,
                fix=self.held | self.fixed[model],
                **self.settings,
            )
        except CalibrationError as error:
            self.refused[model] = error.message
            del self.calibrations[model]

    def _is_close(self, model: str) -> bool:
        """Return whether a model's residuals are of the size of the best one's."""
        if model not in self.calibrations:
            return False
        least = min(map(_measure_rms, self.calibrations.values()))
        return _measure_rms(self.calibrations[model]) <= _MAX_RESIDUAL_RATIO * least

    def recommend(self) -> LensChoice:
        """Recommend one of the models."""
        trials = {
            model: _assess(calibration, self.fixed[model], self.validations.get(model), self.views)
            for model, calibration in self.calibrations.items()
        }
        return _recommend(trials, self.refused, self.views)


def _find_open_coefficient(calibration: Calibration) -> str | None:
    """Find the coefficient of the highest power of those that the views leave open, if any."""
    lens = find_model(calibration.camera.model)
    powers = dict(zip(lens.names, lens.powers, strict=True))
    names = [u.name for u in calibration.undetermined if powers.get(u.name, 0) > 0]
    return max(reversed(names), key=powers.__getitem__, default=None)


def _measure_rms(calibration: Calibration) -> float:
    """Measure the root mean square length of the residuals, px."""
    return summarise_residuals(calibration.residuals).rms


def _assess(
    calibration: Calibration,
    fixed: dict[str, float],
    validation: CrossValidation | None,
    views: Sequence[Observation],
) -> LensTrial:
    """Assess a calibration as a candidate."""
    camera = calibration.camera
    residuals = np.concatenate([view.image for view in calibration.residuals])
    n, P = residuals.size, len(find_free_parameters(calibration))
    w, h = camera.size
    seen = np.concatenate([view.uv for view in views])
    radius = np.linalg.norm(seen - camera.centre, axis=1).max()
    grid = make_mesh(np.linspace(0, w - 1, _GRID_SAMPLES), np.linspace(0, h - 1, _GRID_SAMPLES))
    is_valid = find_valid_pixels(grid, camera)
    is_within = np.linalg.norm(grid - camera.centre, axis=-1) <= radius
    return LensTrial(
        calibration,
        fixed,
        validation,
        bic=float(n * np.log(np.sum(residuals**2) / n) + P * np.log(n)),
        largest_angle=float(measure_angles(seen, camera).max()),
        field_of_view=_measure_field_of_view(calibration),
        is_valid_at_corners=bool(
            is_valid[is_within].all() and find_valid_pixels(seen, camera).all()
        ),
        valid_share=float(is_valid.mean()),
        exchangeable=_find_exchangeable(calibration),
    )


def _measure_field_of_view(calibration: Calibration) -> Array:
    """Measure the horizontal, vertical and diagonal field of view (3,), rad."""
    camera = calibration.camera
    w, h = camera.size
    u, v = camera.centre
    ends = np.array(
        [
            [[-0.5, v], [w - 0.5, v]],
            [[u, -0.5], [u, h - 0.5]],
            [[-0.5, -0.5], [w - 0.5, h - 0.5]],
        ]
    )
    angles = measure_angles(ends, camera)
    return np.asarray(np.where(find_valid_pixels(ends, camera), angles, np.nan).sum(axis=1))


def _find_exchangeable(calibration: Calibration) -> tuple[tuple[str, str], ...]:
    """Find pairs of coefficients of which the views determine only a combination.

    Consecutive coefficients of a polynomial are always correlated, and do no harm; those that shape
    the projection as a whole are not.
    """
    lens, names = find_model(calibration.camera.model), calibration.camera.names
    shaping = [4 + i for i, power in enumerate(lens.powers) if power == 0]
    matrix = compute_correlations(calibration.covariance)
    return tuple(
        (names[i], names[j])
        for a, i in enumerate(shaping)
        for j in shaping[a + 1 :]
        if abs(matrix[i, j]) > _MIN_STRONG_CORRELATION
    )


def _recommend(
    trials: dict[str, LensTrial], refused: dict[str, str], views: Sequence[Observation]
) -> LensChoice:
    """Recommend one of the trials."""
    if all(trial.validation is None for trial in trials.values()):
        raise CalibrationError(
            "No lens model can be calibrated from these views. " + next(iter(refused.values()), ""),
            "Check the corners and the board, and add views in different directions.",
        )
    order = sorted(trials.values(), key=lambda t: (t.model != SIMPLEST_MODEL, t.parameters))
    validated = [trial for trial in order if trial.validation is not None]
    sound = [trial for trial in validated if trial.is_sound] or validated
    best = min(sound, key=lambda trial: trial.held_out)
    adequate = [trial for trial in sound if _predicts_as_well(trial, best)]
    adequate = [trial for trial in adequate if _fills_image(trial)] or adequate
    reference = max(adequate, key=lambda t: (t.parameters, -t.held_out))
    chosen, tolerance = reference, 0.0
    for trial in adequate:
        tolerance = _measure_tolerance(trial, reference, views)
        if trial is reference or _compare(trial, reference, views)[0] <= tolerance:
            chosen = trial
            break
    differences = {trial.model: _compare(chosen, trial, views)[1] for trial in order}
    return LensChoice(
        trials,
        refused,
        chosen.model,
        reference.model,
        tuple(trial.model for trial in adequate),
        differences,
        tolerance,
    )


def _predicts_as_well(trial: LensTrial, best: LensTrial) -> bool:
    """Return whether a candidate predicts unseen views as well as the best one."""
    if trial.held_out <= (1 + _MAX_LOSS) * best.held_out:
        return True
    if trial.model != SIMPLEST_MODEL or trial.validation is None or best.validation is None:
        return False
    return not predicts_better(best.validation.by_view, trial.validation.by_view)


def _fills_image(trial: LensTrial) -> bool:
    """Return whether a map is one-to-one over an image that the lens fills to its corners."""
    return trial.valid_share == 1.0 and bool(trial.field_of_view[2] < _MAX_FILLING_DIAGONAL)


def _compare(a: LensTrial, b: LensTrial, views: Sequence[Observation]) -> tuple[float, float]:
    """Return the rms and the largest difference of two maps where corners were seen, px."""
    if a is b:
        return 0.0, 0.0
    try:
        difference = compare_cameras(a.calibration.camera, b.calibration.camera, views=views)
    except CalibrationError:
        return np.inf, np.nan
    return difference.rms, difference.worst


def _measure_tolerance(a: LensTrial, b: LensTrial, views: Sequence[Observation]) -> float:
    """Measure the larger uncertainty of projection of two models where corners were seen, px."""
    return max(_measure_uncertainty(trial, views) for trial in (a, b))


def _measure_uncertainty(trial: LensTrial, views: Sequence[Observation]) -> float:
    """Measure the rms length of the error of projection where corners were seen, px."""
    uncertainty = estimate_projection_uncertainty(trial.calibration, views)
    covered = find_covered_pixels(make_mesh(uncertainty.u, uncertainty.v), views)
    variance = np.trace(uncertainty.covariance, axis1=-2, axis2=-1)[covered]
    return float(np.sqrt(np.nanmean(variance)))
