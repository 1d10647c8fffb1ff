"""Cross-validation and bootstrap: a calibration's error on views that it has not seen.

The residuals of a calibration flatter it, because it was fitted to them. In k-fold
cross-validation (Stone 1974) the views are dealt into k folds, like cards: view i into fold
i mod k, because neighbouring photographs resemble each other. The camera, and the board's shape
where it is estimated, are calibrated from all but one fold; of the views in that fold only the
poses are fitted. The root mean square of those residuals is the held-out error. Choices among
models rest on the same for each view, in closed form (``calibration/leave_one_out.py``).

The bootstrap (Efron 1979) draws K views from the K with replacement and calibrates, many times.
The scatter of the estimates is a standard deviation that does not assume the corners' errors to
be independent within a view; where it exceeds the reported one, they are not. It does not show an
error that all views share, as that of the board's shape. The variance of K draws from K is
(K - 1) / K of the true one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, IntArray, Size, freeze
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import find_method
from calibgui.engine.calibration.methods.method import Method, start_from_calibration
from calibgui.engine.calibration.observations import Observation, pack_observations
from calibgui.engine.calibration.problem import weigh_and_place
from calibgui.engine.calibration.resection import estimate_poses, refine_poses
from calibgui.engine.calibration.result import (
    DEFAULT_METHOD,
    Calibration,
    ViewResiduals,
)
from calibgui.engine.calibration.result_assembly import compute_view_residuals
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError

DEFAULT_FOLDS = 5
"""Number of folds where none is given."""


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
    """Camera calibrated without them."""
    board_shape: BoardShape | None
    """Board shape estimated without them, or given."""


@dataclass(frozen=True, eq=False, slots=True)
class CrossValidation:
    """All folds, with the errors over them together."""

    folds: tuple[Fold, ...]
    """One calibration a fold."""
    by_view: Array
    """(K,) RMS length of every view's residuals when it was held out, px."""
    lengths: Array
    """(n,) lengths of all corners' residuals when their view was held out, px."""
    training: float
    """RMS length of the residuals of the other views over all folds, px."""
    held_out: float
    """RMS length of the residuals of held-out views over all folds, px."""

    def __post_init__(self) -> None:
        freeze(self, "by_view", "lengths")


def cross_validate(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    folds: int = DEFAULT_FOLDS,
    start: Calibration | None = None,
    **settings: Any,
) -> CrossValidation:
    """Calibrate `folds` times without some of the views, and measure the error on these.

    Args:
        views: corners and board points of each view, as for ``calibrate``.
        size: width and height of the images, px.
        folds: number of folds into which the views are dealt; as many as views leaves one out
            each time.
        start: a calibration of all views with the same settings, at whose camera and poses every
            fold begins; without one it begins at a guess of its own, which takes longer.
        settings: further arguments of ``calibrate``; `names` are not used, and `report` gets the
            iterations of every fold: it may raise ``Cancelled``, but has to return True.

    Raises:
        CalibrationError: if there are fewer folds than 2 or more than views, or a calibration
            fails without the views of its fold.

    Example:
        >>> import numpy as np
        >>> from calibgui.engine.assessment import cross_validate
        >>> from calibgui.engine.boards import Board
        >>> from calibgui.engine.camera import Camera, project_points
        >>> from calibgui.engine.geometry import Pose
        >>> board = Board(6, 8, 25.0)
        >>> camera = Camera((640, 480), [600.0, 600.0, 320.0, 240.0, 0, 0, 0, 0, 0, 0])
        >>> tilts = np.random.default_rng(1).uniform(-0.5, 0.5, (6, 3))
        >>> poses = [Pose(tilt, [-90, -60, 400]) for tilt in tilts]
        >>> xy = board.points()
        >>> views = [(project_points(xy, camera, pose), xy) for pose in poses]
        >>> validation = cross_validate(views, camera.size, folds=2)
        >>> bool(validation.held_out < 1e-3)
        True
    """
    seen, method, settings = _sort_arguments(views, settings)
    methods = [
        method if start is None else start_from_calibration(method, start, kept)
        for kept, _ in _deal_views(len(seen), folds)
    ]
    return _validate(seen, _calibrate_folds(seen, size, methods, settings))


def _sort_arguments(
    views: Sequence[Observation | tuple[Array, Array]], settings: Mapping[str, Any]
) -> tuple[list[Observation], Method, dict[str, Any]]:
    """Return the views, the method, and the settings that suit some of the views as well."""
    further = {name: settings[name] for name in settings.keys() - {"names", "method"}}
    method = find_method(settings.get("method", DEFAULT_METHOD))
    return [Observation(*view) for view in views], method, further


def _deal_views(count: int, folds: int) -> list[tuple[list[int], list[int]]]:
    """Return, for each fold, the indices of the views that are calibrated, and of those held out.

    Raises:
        CalibrationError: if there are fewer folds than 2 or more than views.
    """
    if not 2 <= folds <= count:
        raise CalibrationError(
            f"{count} views cannot be dealt into {folds} folds.",
            "Use at least 2 folds and at most one a view.",
        )
    return [
        ([k for k in range(count) if k % folds != fold], list(range(fold, count, folds)))
        for fold in range(folds)
    ]


def _calibrate_folds(
    views: Sequence[Observation],
    size: Size,
    methods: Sequence[Method],
    settings: Mapping[str, Any],
) -> list[Calibration]:
    """Calibrate without the views of each fold, by the method for it."""
    dealt = zip(_deal_views(len(views), len(methods)), methods, strict=True)
    return [
        calibrate([views[k] for k in kept], size, method=how, **settings, model_errors=False)
        for (kept, _), how in dealt
    ]


def _validate(views: Sequence[Observation], calibrations: Sequence[Calibration]) -> CrossValidation:
    """Measure the errors of the folds' calibrations on the views that they have not seen."""
    folds: list[Fold] = []
    trained: list[ViewResiduals] = []
    by_view: dict[int, ViewResiduals] = {}
    dealt = _deal_views(len(views), len(calibrations))
    for (_, out), calibration in zip(dealt, calibrations, strict=True):
        held_out = resect_views(calibration, [views[k] for k in out])
        by_view.update(zip(out, held_out, strict=True))
        trained += calibration.residuals
        folds.append(
            Fold(
                np.array(out),
                compute_rms(calibration.residuals),
                compute_rms(held_out),
                calibration.camera,
                calibration.board_shape,
            )
        )
    complete = [by_view[k] for k in range(len(views))]
    return CrossValidation(
        folds=tuple(folds),
        by_view=np.array([residual.rms for residual in complete]),
        lengths=np.concatenate([np.linalg.norm(view.image, axis=1) for view in complete]),
        training=compute_rms(trained),
        held_out=compute_rms(complete),
    )


def resect_views(
    calibration: Calibration, views: Sequence[Observation]
) -> tuple[ViewResiduals, ...]:
    """Compute the residuals of views that a calibration has not seen, with only their poses fitted.

    Args:
        calibration: calibration whose camera and board shape are held.
        views: views of the same board.

    Raises:
        CalibrationError: if views cannot be used, or do not fit the camera or the board.
    """
    drawn = pack_observations(views)
    start = estimate_poses(calibration.camera, drawn)
    observations = weigh_and_place(calibration, drawn)
    how = calibration.camera.model, calibration.cost, calibration.reference_scale
    return compute_view_residuals(refine_poses(start, observations, *how), observations, *how)


def compute_rms(residuals: Sequence[ViewResiduals]) -> float:
    """Return the root mean square length of the residuals of views together, px."""
    image = np.concatenate([view.image for view in residuals])
    return float(np.sqrt(np.mean(np.sum(image**2, axis=1))))


@dataclass(frozen=True, eq=False, slots=True)
class Bootstrap:
    """Estimates from views drawn with replacement."""

    params: Array
    """(n, P) camera parameters of every draw that could be calibrated."""
    sigma: Array
    """(P,) their standard deviation, corrected for the number of views."""
    ratio: Array
    """(P,) ratio to the reported standard deviation; NaN where the parameter is held."""
    failed: int
    """Number of draws that did not determine the camera."""

    def __post_init__(self) -> None:
        freeze(self, "params", "sigma", "ratio")


def bootstrap_views(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    draws: int = 100,
    seed: int = 0,
    **settings: Any,
) -> Bootstrap:
    """Estimate standard deviations from the scatter of calibrations from resampled views.

    Args:
        views, size, settings: as for `cross_validate`.
        draws: number of resampled sets.
        seed: seed of the draws; the same seed gives the same result.

    Raises:
        CalibrationError: if the views themselves, or nine draws in ten, cannot be calibrated.
    """
    whole = calibrate(views, size, **settings)
    seen, method, settings = _sort_arguments(views, settings | {"report": None})
    rng = np.random.default_rng(seed)
    params = []
    for _ in range(draws):
        drawn = rng.integers(len(seen), size=len(seen)).tolist()
        how, sample = start_from_calibration(method, whole, drawn), [seen[k] for k in drawn]
        with suppress(CalibrationError):
            again = calibrate(sample, size, method=how, **settings, model_errors=False)
            params.append(again.camera.params)
    if len(params) < max(2, draws // 10):
        raise CalibrationError(
            "Resampled views do not determine the camera: too few of them carry the result.",
            "Add views with the board tilted in different directions.",
        )
    sigma = np.std(params, axis=0, ddof=1) * np.sqrt(len(seen) / (len(seen) - 1))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(whole.sigma > 0, sigma / whole.sigma, np.nan)
    return Bootstrap(np.array(params), sigma, ratio, draws - len(params))
