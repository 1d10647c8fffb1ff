"""The choice of a lens model: all candidates on the same views, and the one to be trusted.

Every candidate is calibrated from all views; those that are sound, or all if none is, are asked
what they say of each view without it (``calibration/leave_one_out.py``). Neither a low residual nor
an information criterion chooses well: a model with numerator and denominator lowers the residuals
by nonsense, and with thousands of corners the Bayesian criterion pays for two parameters that gain
a tenth of a thousandth of a pixel on unseen views. The choice is made so:

1. A candidate is sound if the views determine its parameters and if its map is one-to-one where
   corners were seen. One with coefficients that had to be held, as the views leave them open, has
   more than the lens shows: fewer views of the same camera leave others open, and which of them to
   hold was seen from the views that its error is measured on. It counts only if no candidate that
   is determined as it is predicts alike.
2. It is adequate if the best sound candidate does not predict unseen views better beyond chance
   and 1 % (``board_shape_choice.predicts_better``), or by so little that nobody sees it. If some
   adequate candidate is one-to-one over the whole image, and the lens fills it, the others must be.
3. Models that predict alike go on otherwise where no corner was seen, and those with many
   coefficients go anywhere. So what counts is the error of a pixel over the picture: with h the
   error on unseen views, h0 that of the best candidate, and s the standard deviation of a pixel,
   which includes what the lens model misses (``changes/camera_uncertainty.py``),

       e^2 = h^2 - h0^2 + mean s^2.

   The recommendation is the simplest adequate candidate whose e no other one makes smaller by more
   than a fifth: what a remedy has to gain to be carried out.

All but the first candidate begin at what the best one before them sees, unless they cannot see so:
to find a start from corners alone takes longer than most of the solves.

Of a model with coefficients that the views leave open, such as the numerator and denominator of the
rational one, those of the highest powers are held at 0 one by one until the others are determined.

The paper's model counts as the simplest, and as determined; the others follow by their number of
free parameters.

A coefficient that is not told from 0 does harm where few views extrapolate: what noise makes of it
grows with a power of the radius. Of the recommended model, the coefficient of the highest power,
and those that make a lens asymmetric, all of them together, are therefore held at 0 (backward
elimination), the more harmful first, if they lie within two of their own sigmas of 0 and unseen
views are predicted better by more than 1 % without them. For less than that they stay: the gain
would be chance, and the standard deviations of the others would no longer allow for them. With its
new figures the recommendation is made again, until it stands.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment.changes.camera_uncertainty import estimate_camera_uncertainty
from calibgui.engine.assessment.changes.comparison import compare_cameras
from calibgui.engine.assessment.choices.board_shape_choice import (
    MIN_RELATIVE_GAIN,
    predicts_better,
)
from calibgui.engine.assessment.choices.lens_trial import LensTrial, assess_trial
from calibgui.engine.assessment.finding import MIN_GAIN_TO_ACT
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.leave_one_out import leave_views_out
from calibgui.engine.calibration.methods import find_method
from calibgui.engine.calibration.methods.method import Method, start_from_other_model
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import DEFAULT_METHOD, Calibration, Iteration, Report
from calibgui.engine.camera.models import find_model
from calibgui.engine.errors import CalibrationError, Progress

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
_NEXT_CANDIDATES = ("rational", "thin-prism", "eucm", "kannala-brandt")
"""Lens models that follow what the first do not. In none of eight sets of photographs, among them
fisheyes and a wide action camera, did another candidate predict unseen views better by 1 %."""
_MIN_VIEWS = 3
"""Number of views below which no view can be spared for a comparison."""
_MAX_UNSEEN_PX = 0.02
"""Error that a candidate adds to those on unseen views, px, up to which nobody sees a difference:
of real photographs, whose errors are 0.1 px and more, not 2 %, which is all that
``tests/benchmarks/unseen_views.py`` allows. With none the sample's 14 views, whose corners are good
to 0.005 px, got a thin prism for OpenCV, whose worst pixel is known to 41 px, for 0.002 px."""
_MAX_RESIDUAL_RATIO = 1.5
"""Residuals over those of the best candidate, above which unseen views need not be asked."""
_MAX_ITERATIONS, _LAST_ITERATIONS, _MIN_DESCENT = 25, 10, 2e-3
"""Number of iterations from which a solve stagnates if in the last ones its cost fell by less than
this part of it. Of 24 random lenses (``tests/benchmarks/lens_choice.py``, seeds from 5000) none got
another model, nor other coefficients, than with solves to their end."""
_MIN_TOLD = 2.0
"""Ratio of a coefficient to its sigma from which on it is told from 0."""
_MAX_FILLING_DIAGONAL = np.deg2rad(160.0)
"""Diagonal field of view up to which a lens is taken to fill the image; the image circle of wider
ones mostly ends inside it, and what a model does beyond is nobody's concern."""


@dataclass(frozen=True, eq=False, slots=True)
class LensChoice:
    """All candidates, and the lens model that is recommended."""

    trials: dict[str, LensTrial]
    """The candidates that could be calibrated, by their ids."""
    refused: dict[str, str]
    """Reasons why the others could not."""
    model: str
    """The recommended model."""
    errors: dict[str, float]
    """Errors e of a pixel over the picture, px, of the models that predict unseen views as well as
    any, the simplest first."""
    differences: dict[str, float]
    """Largest difference of each model's map from the recommended one's where corners were seen,
    px; NaN where the two cannot be compared."""

    @property
    def chosen(self) -> LensTrial:
        """The recommended candidate."""
        return self.trials[self.model]


def choose_lens(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    candidates: Sequence[str] = CANDIDATES,
    progress: Progress | None = None,
    **settings: Any,
) -> LensChoice:
    """Try lens models on unseen views and recommend one.

    Args:
        views, size, settings: as for ``calibrate``, without `model` and `free`; `fix` is a mapping
            of parameters that all models have.
        candidates: ids of the models to try.
        progress: a function that is told how many steps are done, and of how many.

    Raises:
        CalibrationError: if there are fewer than three views, or no candidate can be calibrated.
        Cancelled: from `progress`.
    """
    attempt = _Attempt(views, size, progress, settings)
    attempt.try_lenses(candidates)
    return attempt.recommend()


def choose_lens_stepwise(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    progress: Progress | None = None,
    **settings: Any,
) -> LensChoice:
    """Recommend the paper's model if few others show that it is enough, else choose from more.

    It is enough if the views agree with each other to their corners' noise, or if one of the few
    predicts unseen views as it does: what formulas of different kinds say alike, they have from the
    lens. Where they say different things, and the views as well, yet another may follow it.

    Args, raises: as for `choose_lens`, without `candidates`.
    """
    attempt = _Attempt(views, size, progress, settings)
    attempt.try_lenses(_FIRST_CANDIDATES)
    if attempt.is_paper_enough() and (choice := attempt.recommend()).model == SIMPLEST_MODEL:
        return choice
    attempt.try_lenses(_NEXT_CANDIDATES)
    return attempt.recommend()


class _Attempt:
    """Lens models tried on the same views; what was tried before is not tried again."""

    def __init__(
        self,
        views: Sequence[Observation | tuple[Array, Array]],
        size: Size,
        progress: Progress | None,
        settings: dict[str, Any],
    ) -> None:
        """Take the arguments of `choose_lens`."""
        if len(views) < _MIN_VIEWS:
            raise CalibrationError(
                f"{len(views)} views are too few to compare lens models: none can be left out.",
                "Add views, or name the lens model.",
            )
        self.views, self.size = [Observation(*view) for view in views], size
        self.settings = {name: value for name, value in settings.items() if name != "fix"}
        self.held: dict[str, float | None] = dict(settings.get("fix", {}))
        self.trials: dict[str, LensTrial] = {}
        self.refused: dict[str, str] = {}
        self.reduced: set[str] = set()
        """Models whose coefficients were tried one by one."""
        self.progress = progress
        self.done = self.total = 0

    def try_lenses(self, candidates: Sequence[str]) -> None:
        """Calibrate the candidates, and ask those that follow the corners of unseen views.

        One that is not sound counts only if none is, and takes long: the views leave it a valley.
        """
        self.done, self.total = 0, 2 * len(candidates)
        for model in candidates:
            self._advance()
            if model not in self.trials and model not in self.refused:
                self._calibrate(model)
        for model in sorted(candidates, key=lambda model: not self._is_sound(model)):
            self._advance()
            trial = self.trials.get(model)
            if trial is not None and trial.validation is None and self._is_close(trial):
                others = (t for t in self.trials.values() if t.validation is not None)
                if self._is_sound(model) or not any(other.is_sound for other in others):
                    self._validate(model)

    def _advance(self) -> None:
        """Tell that one more step begins."""
        if self.progress is not None:
            self.progress(self.done, self.total)
        self.done += 1

    def _calibrate(self, model: str) -> None:
        """Calibrate a candidate, with the coefficients that the views leave open held at 0."""
        fixed: dict[str, float] = {}
        has_powers = _find_highest(model, find_model(model).names) is not None
        try:
            while True:
                watch = _StagnationStop(self.settings.get("report"))
                trial = self._try(model, fixed, **({"report": watch} if has_powers else {}))
                name = _find_open_coefficient(trial.calibration)
                if name is None and watch.has_stagnated and self._is_close(trial):
                    trial = self._try(model, fixed)
                    name = _find_open_coefficient(trial.calibration)
                if name is None:
                    break
                fixed = {**fixed, name: 0.0}
        except CalibrationError as error:
            self.refused[model] = error.message
            return
        self.trials[model] = trial

    def _validate(self, model: str) -> None:
        """Ask a candidate what it says of unseen views."""
        try:
            self.trials[model] = self._predict(self.trials[model])
        except CalibrationError as error:
            self.refused[model] = error.message
            del self.trials[model]

    def _try(self, model: str, fixed: dict[str, float], **other: Any) -> LensTrial:
        """Calibrate a lens model with some of its coefficients held, and `other` settings."""
        how = {"fix": self.held | fixed, "method": self._start_from_best(), **other}
        calibration = calibrate(self.views, self.size, model=model, **(self.settings | how))
        return assess_trial(calibration, fixed, self.views)

    def _start_from_best(self) -> Method:
        """Return the method, which begins at what the model sees that follows the corners best."""
        method = find_method(self.settings.get("method", DEFAULT_METHOD))
        best = min(self.trials.values(), key=lambda trial: trial.rms, default=None)
        return method if best is None else start_from_other_model(method, best.calibration)

    def _predict(self, trial: LensTrial) -> LensTrial:
        """Return a trial with its error on unseen views."""
        return replace(trial, validation=leave_views_out(trial.calibration, self.views))

    def is_paper_enough(self) -> bool:
        """Return whether the paper's model leaves no doubt that it follows the lens."""
        trials = (t for t in self.trials.values() if t.is_sound and t.validation is not None)
        others = {trial.model: trial for trial in trials}
        paper = others.pop(SIMPLEST_MODEL, None)
        if paper is None or not others:
            return False
        if paper.calibration.overdispersion == 0 and paper.calibration.lens_error == 0:
            return True
        ratios = [trial.held_out / paper.held_out for trial in others.values()]
        return bool(np.min(np.abs(np.log(ratios))) <= MIN_RELATIVE_GAIN)

    def _is_sound(self, model: str) -> bool:
        """Return whether a model could be calibrated, and is sound."""
        return model in self.trials and self.trials[model].is_sound

    def _is_close(self, trial: LensTrial) -> bool:
        """Return whether a trial's residuals are of the size of the best one's so far."""
        least = min((other.rms for other in self.trials.values()), default=np.inf)
        return trial.rms <= _MAX_RESIDUAL_RATIO * least

    def recommend(self) -> LensChoice:
        """Recommend one of the models, without the coefficients that harm its predictions."""
        while True:
            choice = _recommend(self.trials, self.refused, self.views)
            if choice.model in self.reduced:
                return choice
            self.reduced.add(choice.model)
            self.trials[choice.model] = self._reduce(choice.chosen)

    def _reduce(self, whole: LensTrial) -> LensTrial:
        """Hold coefficients at 0 as long as unseen views are predicted better without them."""
        best = whole
        while True:
            nested = [self._try_without(best, names) for names in _list_dispensable(best)]
            sound = [trial for trial in nested if trial is not None and trial.is_sound]
            least = min(sound, key=lambda trial: trial.held_out, default=best)
            if best.held_out <= (1 + MIN_RELATIVE_GAIN) * least.held_out:
                return best
            best = replace(least, fuller=whole)

    def _try_without(self, trial: LensTrial, names: Sequence[str]) -> LensTrial | None:
        """Try a lens model with further coefficients held at 0; None if that fails."""
        self.total += 1
        self._advance()
        try:
            return self._predict(self._try(trial.model, trial.fixed | dict.fromkeys(names, 0.0)))
        except CalibrationError:
            return None


class _StagnationStop:
    """A report of a solve that ends it once its cost has nearly stopped to fall.

    Coefficients that the views leave open make a valley along which a solve creeps through hundreds
    of iterations and several detours, only for them to be held at 0 afterwards.
    """

    def __init__(self, report: Report | None) -> None:
        """Take the report that is told of every iteration."""
        self._report = report
        self._costs: list[float] = []
        self.has_stagnated = False
        """True if the solve was ended."""

    def __call__(self, iteration: Iteration) -> bool:
        """Hand an iteration on, and return whether to go on."""
        if self._report is not None and not self._report(iteration):
            return False
        self._costs.append(iteration.cost)
        if iteration.index >= _MAX_ITERATIONS:
            before, now = self._costs[-_LAST_ITERATIONS], self._costs[-1]
            self.has_stagnated = 0 <= before - now < _MIN_DESCENT * now
        return not self.has_stagnated


def _find_open_coefficient(calibration: Calibration) -> str | None:
    """Find the coefficient of the highest power of those that the views leave open, if any."""
    return _find_highest(calibration.camera.model, [u.name for u in calibration.undetermined])


def _find_highest(model: str, names: Sequence[str]) -> str | None:
    """Find the coefficient of the highest power among parameters of a lens model, if any."""
    lens = find_model(model)
    powers = dict(zip(lens.names, lens.powers, strict=True))
    coefficients = [name for name in lens.names if name in names and powers[name] > 0]
    return max(reversed(coefficients), key=powers.__getitem__, default=None)


def _list_dispensable(trial: LensTrial) -> list[tuple[str, ...]]:
    """List what a lens model may do without next, as far as the views do not tell it from 0.

    It is the coefficient of the highest power, and all that make the lens asymmetric together.
    """
    calibration = trial.calibration
    camera, lens = calibration.camera, find_model(trial.model)
    free = [name for name in lens.names if name not in calibration.fixed]
    asymmetric = tuple(name for name in free if name in lens.asymmetric)
    highest = _find_highest(trial.model, [name for name in free if name not in asymmetric])
    near = np.abs(camera.params) < _MIN_TOLD * calibration.sigma
    not_told = {name for name, is_near in zip(camera.names, near.tolist(), strict=True) if is_near}
    groups = [asymmetric, () if highest is None else (highest,)]
    return [group for group in groups if group and not_told.issuperset(group)]


def _recommend(
    trials: dict[str, LensTrial],
    refused: dict[str, str],
    views: Sequence[Observation],
) -> LensChoice:
    """Recommend one of the trials."""
    if all(trial.validation is None for trial in trials.values()):
        raise CalibrationError(
            "No lens model can be calibrated from these views. " + next(iter(refused.values()), ""),
            "Check the corners and the board, and add views in different directions.",
        )
    order = sorted(trials.values(), key=lambda t: (t.model != SIMPLEST_MODEL, t.parameters))
    validated = [trial for trial in order if trial.validation is not None]
    usable = [trial for trial in validated if trial.is_sound] or validated
    sound = _prefer_determined(usable)
    best = min(sound, key=lambda trial: trial.held_out)
    adequate = [trial for trial in sound if _predicts_as_well(trial, best)]
    if _does_lens_fill_image(adequate):
        adequate = [trial for trial in adequate if trial.valid_share == 1.0]
    errors = {trial.model: _measure_error(trial, adequate, views) for trial in adequate}
    least = MIN_GAIN_TO_ACT * min(errors.values())
    chosen = next(trial for trial in adequate if errors[trial.model] <= least)
    differences = {trial.model: _compare(chosen, trial, views) for trial in order}
    return LensChoice(trials, refused, chosen.model, errors, differences)


def _prefer_determined(sound: list[LensTrial]) -> list[LensTrial]:
    """Leave out candidates with open coefficients, unless unseen views demand them, or it is the
    paper's."""
    determined = [t for t in sound if t.model == SIMPLEST_MODEL or not t.left_open]
    best = min(sound, key=lambda trial: trial.held_out)
    return determined if any(_predicts_as_well(trial, best) for trial in determined) else sound


def _predicts_as_well(trial: LensTrial, best: LensTrial) -> bool:
    """Return whether the best candidate does not predict unseen views better than another, or so
    little that nobody sees it."""
    assert trial.validation is not None and best.validation is not None
    if trial.held_out**2 - best.held_out**2 <= _MAX_UNSEEN_PX**2:
        return True
    return not predicts_better(best.validation.by_view, trial.validation.by_view)


def _does_lens_fill_image(trials: Sequence[LensTrial]) -> bool:
    """Return whether a lens fills the image to its corners, by the best of the candidates whose map
    is one-to-one over all of it; False if there is none."""
    whole = [trial for trial in trials if trial.valid_share == 1.0]
    best = min(whole, key=lambda trial: trial.held_out, default=None)
    return best is not None and bool(best.field_of_view[2] < _MAX_FILLING_DIAGONAL)


def _measure_error(
    trial: LensTrial, others: Sequence[LensTrial], views: Sequence[Observation]
) -> float:
    """Measure the error e of a pixel over the picture, px, beside others that predict alike."""
    missed = trial.held_out**2 - min(other.held_out for other in others) ** 2
    sigma = estimate_camera_uncertainty(trial.calibration, views).worst_direction
    known = sigma[np.isfinite(sigma)]  # a lens may image nothing in the corners
    return float(np.sqrt(missed + np.mean(known**2))) if known.size else np.inf


def _compare(a: LensTrial, b: LensTrial, views: Sequence[Observation]) -> float:
    """Return the largest difference of two maps where corners were seen, px; NaN if unknown."""
    if a is b:
        return 0.0
    try:
        return compare_cameras(a.calibration.camera, b.calibration.camera, views=views).worst
    except CalibrationError:
        return np.nan
