"""Is the calibration as good as it says? Its error on views that it has not seen.

k-fold cross-validation: the views are dealt into k folds, like cards (view i into fold i mod k,
because neighbouring photographs resemble each other). The camera, and the plate where it is
estimated, are calibrated from all but one fold; of the views in that fold only the poses are
fitted. The root mean square of those residuals is the held-out error. A camera or plate with
more parameters than the views can carry lowers the training error but raises the held-out one.
Between plate models the comparison is paired: view by view, by the logarithm of the ratio of
the held-out errors, and a richer plate is taken only if the mean exceeds twice its standard
error and 1 %.

Bootstrap: K views drawn from the K with replacement, calibrated, many times. The scatter of
the estimates is a standard deviation that does not assume the corners' errors to be
independent within a view; where it exceeds the reported one, they are not. An error that all
views share, as the plate's, does not scatter. The variance of K draws from K is (K - 1) / K of
the true one.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size, freeze
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.observations import Observation, pack
from calibgui.engine.calibration.problem import as_drawn, measured
from calibgui.engine.calibration.refinement.resection import posed, solved
from calibgui.engine.calibration.result import Calibration, Cost, ViewResiduals
from calibgui.engine.calibration.result_assembly import residuals
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError

FOLDS = 5
_SIGNIFICANT = 2.0
_WORTHWHILE = 0.01


@dataclass(frozen=True, eq=False, slots=True)
class Fold:
    """A calibration without some of the views, and its error on them."""

    views: IntArray
    """(h,) indices of the held-out views."""
    training: float
    """RMS length of the residuals of the other views, px."""
    held_out: float
    """RMS length of the residuals of the held-out views, px."""
    camera: Camera
    """Calibrated without them."""
    board_shape: BoardShape | None
    """Estimated without them, or given."""


@dataclass(frozen=True, eq=False, slots=True)
class CrossValidation:
    """The folds and what they say together."""

    folds: tuple[Fold, ...]
    by_view: Array
    """(K,) RMS length of every view's residuals when it was held out, px."""
    training: float
    """RMS length over all folds, px."""
    held_out: float
    """RMS length over all folds, px."""

    def __post_init__(self) -> None:
        freeze(self, "by_view")


def cross_validate(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    folds: int = FOLDS,
    **settings: Any,
) -> CrossValidation:
    """Calibrate `folds` times without some of the views, and try the camera on these.

    Args:
        views: as for ``calibrate``.
        size: of the images, px.
        folds: into which the views are dealt; as many as views leaves one out each time.
        settings: of ``calibrate``; `names` are not used, and `report` is told of the iterations
            of every fold: it may raise ``Cancelled``, but has to return True.

    Raises:
        CalibrationError: if there are fewer folds than 2 or more than views, or a calibration
            fails without the views of its fold.
    """
    if not 2 <= folds <= len(views):
        raise CalibrationError(
            f"{len(views)} views cannot be dealt into {folds} folds.",
            "Use at least 2 folds and at most one a view.",
        )
    seen = [Observation(*view) for view in views]
    settings = {name: settings[name] for name in settings.keys() - {"names"}}
    done: list[Fold] = []
    trained: list[ViewResiduals] = []
    by_view: list[ViewResiduals | None] = [None] * len(seen)
    for fold in range(folds):
        out = np.arange(fold, len(seen), folds)
        kept = [view for k, view in enumerate(seen) if k % folds != fold]
        result = calibrate(kept, size, **settings)
        held_out = resected(result, [seen[k] for k in out])
        for k, residual in zip(out, held_out, strict=True):
            by_view[k] = residual
        trained += result.residuals
        done.append(
            Fold(out, _rms(result.residuals), _rms(held_out), result.camera, result.board_shape)
        )
    complete = [residual for residual in by_view if residual is not None]
    return CrossValidation(
        folds=tuple(done),
        by_view=np.array([residual.rms for residual in complete]),
        training=_rms(trained),
        held_out=_rms(complete),
    )


def resected(calibration: Calibration, views: Sequence[Observation]) -> tuple[ViewResiduals, ...]:
    """Residuals of views that a calibration has not seen, with only their poses fitted.

    Args:
        calibration: whose camera and plate are held.
        views: of the same plate.

    Raises:
        CalibrationError: for views that cannot be used, or do not fit the camera or the plate.
    """
    observations = measured(calibration, views)
    start = posed(calibration.camera, pack(views))
    how = calibration.camera.model, calibration.cost, calibration.reference_scale
    return residuals(solved(start, observations, *how), observations, *how)


def _rms(residuals: Sequence[ViewResiduals]) -> float:
    """Root mean square length of the residuals of views together, px."""
    image = np.concatenate([view.image for view in residuals])
    return float(np.sqrt(np.mean(np.sum(image**2, axis=1))))


@dataclass(frozen=True, eq=False, slots=True)
class BoardShapeChoice:
    """The plate model that predicts unseen views best."""

    model: BoardShapeModel
    validations: dict[BoardShapeModel, CrossValidation]
    """Of every model that the views can carry."""
    refused: dict[BoardShapeModel, str]
    """Why the others could not be tried."""
    nominal: Calibration
    chosen: Calibration
    """From all views."""

    @property
    def words(self) -> str:
        """The recommendation with its figures."""
        before = self.validations[BoardShapeModel.NOMINAL].held_out
        if self.chosen.board_shape is None:
            return (
                "Keep the nominal plate: no estimated one predicts unseen views better than "
                f"its {before:.3f} px."
            )
        after = self.validations[self.model].held_out
        move = self.chosen.camera.params - self.nominal.camera.params
        return (
            f"Your plate deviates by {self.chosen.board_shape.rms:.2f} mm rms; using the estimated "
            f"plate ({self.model}) moves fx by {move[0]:+.2g} px and the centre by "
            f"({move[2]:+.2g}, {move[3]:+.2g}) px. It lowers the error on unseen views from "
            f"{before:.3f} to {after:.3f} px, {100 * (1 - after / before):.0f} %."
        )


def choose_board_shape(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    folds: int = FOLDS,
    **settings: Any,
) -> BoardShapeChoice:
    """Try all plate models on unseen views and recommend one.

    Args:
        views, size, folds, settings: as for `cross_validate`, without `plate`.

    Raises:
        CalibrationError: as `cross_validate` with the nominal plate.
    """
    validations: dict[BoardShapeModel, CrossValidation] = {}
    refused: dict[BoardShapeModel, str] = {}
    best = BoardShapeModel.NOMINAL
    for model in BoardShapeModel:
        try:
            validations[model] = cross_validate(views, size, folds, board_shape=model, **settings)
        except CalibrationError as error:
            if model is BoardShapeModel.NOMINAL:
                raise
            refused[model] = error.message
            continue
        if model is not best and _better(validations[model].by_view, validations[best].by_view):
            best = model
    nominal = calibrate(views, size, **settings)
    chosen = (
        nominal
        if best is BoardShapeModel.NOMINAL
        else calibrate(views, size, board_shape=best, **settings)
    )
    return BoardShapeChoice(best, validations, refused, nominal, chosen)


def _better(candidate: Array, incumbent: Array) -> bool:
    """Whether errors (K,) are lower than others of the same views, beyond chance."""
    gain = np.log(incumbent / candidate)
    error = gain.std(ddof=1) / np.sqrt(len(gain))
    return bool(gain.mean() > max(_SIGNIFICANT * error, _WORTHWHILE))


@dataclass(frozen=True, eq=False, slots=True)
class Bootstrap:
    """Estimates from views drawn with replacement."""

    params: Array
    """(n, P) camera parameters of every draw that could be calibrated."""
    sigma: Array
    """(P,) their standard deviation, corrected for the number of views."""
    ratio: Array
    """(P,) to the reported one; NaN where held."""
    failed: int
    """Draws that did not determine the camera."""

    def __post_init__(self) -> None:
        freeze(self, "params", "sigma", "ratio")


def bootstrap(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    draws: int = 100,
    seed: int = 0,
    **settings: Any,
) -> Bootstrap:
    """Standard deviations from the scatter of calibrations from resampled views.

    Args:
        views, size, settings: as for `cross_validate`.
        draws: number of resampled sets.
        seed: of the draws; the same seed gives the same answer.

    Raises:
        CalibrationError: if the views themselves, or nine draws in ten, cannot be calibrated.
    """
    whole = calibrate(views, size, **settings)
    seen = [Observation(*view) for view in views]
    rng = np.random.default_rng(seed)
    settings = {name: settings[name] for name in settings.keys() - {"names", "report"}}
    if whole.board_shape is None and whole.cost is Cost.IMAGE:
        settings["board_shape"] = as_drawn(seen)
    params = []
    for _ in range(draws):
        drawn = [seen[k] for k in rng.integers(len(seen), size=len(seen)).tolist()]
        with suppress(CalibrationError):
            params.append(calibrate(drawn, size, **settings).camera.params)
    if len(params) < max(2, draws // 10):
        raise CalibrationError(
            "Resampled views do not determine the camera: too few of them carry the result.",
            "Add views with the board tilted in different directions.",
        )
    sigma = np.std(params, axis=0, ddof=1) * np.sqrt(len(seen) / (len(seen) - 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(whole.sigma > 0, sigma / whole.sigma, np.nan)
    return Bootstrap(np.array(params), sigma, ratio, draws - len(params))
