"""The results of a calibration, what it reports on its way, and its failure.

All are frozen records of read-only arrays. `Calibration` is the whole result; `Iteration` is what a
`Report` is called with during a solve; `DegenerateError` says that the views do not determine the
camera, and carries what they do determine.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property
from typing import Any, overload

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose


@dataclass(frozen=True, eq=False, slots=True)
class StageOne:
    """The result of Stage I (paper 4.2, a row of Table 1) and of the cosines' equation for a view.

    Centre and k1 are in the paper's units: pixels, centred frame, y up. Quantities that the view
    does not determine (aspect and focal lengths near fronto-parallel) are NaN.
    """

    xp: float
    yp: float
    k1: float
    aspect: float
    """fy / fx, the root of the cosines' equation (eq. 27)."""
    fx: float
    fy: float
    iterations: int
    rms: float
    """Root mean square length of the residual on the reference plane, reference px."""
    backward: Array
    """(3, 3) backward homography, reference plane to corrected image (eq. 17), paper's frame."""
    converged: bool

    def __post_init__(self) -> None:
        freeze(self, "backward")


@dataclass(frozen=True, eq=False)
class StageOneTable(Sequence[StageOne]):
    """The paper's Table 1, computed when somebody first reads a row: a calibration needs none."""

    tabulate: Callable[[], tuple[StageOne, ...]]
    """Function that returns all rows."""

    @cached_property
    def _rows(self) -> tuple[StageOne, ...]:
        return self.tabulate()

    @overload
    def __getitem__(self, index: int) -> StageOne: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[StageOne, ...]: ...
    def __getitem__(self, index: int | slice) -> StageOne | tuple[StageOne, ...]:
        return self._rows[index]

    def __len__(self) -> int:
        return len(self._rows)


@dataclass(frozen=True, slots=True)
class Iteration:
    """One accepted step of Levenberg-Marquardt."""

    index: int
    cost: float
    """Sum of squared (whitened) residuals: px^2, reference px^2 or dimensionless."""
    rms: float
    """Root mean square length of the 2-D residual, in the residual's unit."""
    gradient: float
    """Largest entry of the gradient with respect to the scaled unknowns."""
    step: float
    """Length of the step, unknowns scaled to a unit diagonal of J^T J, in the residual's unit."""
    damping: float
    seconds: float
    """Time since the start of the solve, s."""


Report = Callable[[Iteration], bool]
"""A function that is called with each iteration. It returns False to stop the solve and keep the
best state so far, and raises `Cancelled` to discard it."""


class Status(StrEnum):
    """The ways in which a solve can end."""

    CONVERGED = "converged"
    PARTIAL = "partial"
    """The solve converged, with assumptions for what the views leave open (`Diagnosis`)."""
    MAX_ITERATIONS = "max-iterations"
    STOPPED = "stopped"


class Cost(StrEnum):
    """The cost that the refinement minimises."""

    IMAGE = "image"
    """Reprojection error in the image (the default)."""
    REFERENCE = "reference"
    """Registration error on the virtual reference image (eq. 41), with squares of equal sides."""
    PAPER = "paper"
    """Registration error by eq. 41 to the letter: a reference grid equal in px along x and y, and
    the radius of the lens model in pixels."""


@dataclass(frozen=True, slots=True)
class Undetermined:
    """A parameter that the data do not determine, and the reason."""

    name: str
    reason: str


class Degeneracy(StrEnum):
    """The kinds of views that do not determine a camera."""

    ONE_VIEW = "one-view"
    COPIES = "copies"
    """All views hold the same corners."""
    PARALLEL_TO_SENSOR = "parallel-to-sensor"
    ONE_PLACE = "one-place"
    """All views show the board at one place in one orientation, at most turned about its normal."""
    ONE_ORIENTATION = "one-orientation"
    ONE_SPOT = "one-spot"
    """All corners lie in a small part of the image."""
    TOO_LITTLE = "too-little"
    """The views differ, but are too few or differ by too little."""


@dataclass(frozen=True, slots=True)
class Assumption:
    """A quantity that the views do not determine, and the value that is taken for it."""

    name: str
    """Name of a parameter, or "fy/fx". If fx is assumed, fy and the coefficients follow it."""
    value: float
    sigma: float
    """Standard deviation of the error that the value may have."""


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """The reason why views do not determine the camera, and the assumptions made instead."""

    kind: Degeneracy
    message: str
    hint: str
    """Advice on what to photograph."""
    assumptions: tuple[Assumption, ...] = ()


@dataclass(frozen=True, eq=False, slots=True)
class ViewResiduals:
    """The residuals of one view."""

    image: Array
    """(n, 2) measured minus predicted corner, px, array frame."""
    reference: Array
    """(n, 2) Dx', Dy' of eq. 38 on the reference plane, reference px."""

    def __post_init__(self) -> None:
        freeze(self, "image", "reference")

    @property
    def rms(self) -> float:
        """Root mean square length of the residual in the image, px."""
        return float(np.sqrt(np.vdot(self.image, self.image) / len(self.image)))


DEFAULT_METHOD = "lucchese"
"""Name of the method that `calibrate` uses unless told otherwise."""


@dataclass(frozen=True, slots=True)
class CalibrationSettings:
    """The settings of a calibration; None for those that it does not state, as in old results."""

    cost: Cost = Cost.IMAGE
    model: str | None = None
    """The lens model."""
    fixed: Mapping[str, float] = field(default_factory=dict)
    """Values of the intrinsics that were held."""
    max_iterations: int | None = None
    board_shape: BoardShapeModel | None = None
    """The model of the board's shape."""
    is_board_shape_held: bool | None = None
    """True if the board's shape was given, and not estimated."""
    prior: BoardShapePrior | None = None
    """What was known beforehand of the board's deviations from its drawing."""
    method: str = DEFAULT_METHOD
    model_reason: str | None = None
    """Why the lens model was chosen, where that was done automatically."""
    robust: bool | None = None
    """True if outliers were to be left out."""
    weigh_views: bool | None = None
    """True if views were to be weighed by their noise."""
    outliers: int | None = None
    """Number of corners that were left out as outliers, where they were to be."""
    others: Mapping[str, Any] = field(default_factory=dict)
    """What a file states besides."""

    def encode(self) -> dict[str, Any]:
        """Return what is stated, by the names that result files and digests have for it."""
        prior = None if self.prior is None else [self.prior.in_plane, self.prior.out_of_plane]
        held = self.is_board_shape_held
        named = {
            "cost": self.cost.value,
            "model": self.model,
            "fixed": dict(self.fixed),
            "max_iterations": self.max_iterations,
            "plate": None if self.board_shape is None else self.board_shape.value,
            "plate_held": held,
            "prior_mm": prior,
            "method": None if self.method == DEFAULT_METHOD else self.method,
            "model_reason": self.model_reason,
            "robust": self.robust,
            "weigh_views": self.weigh_views,
            "outliers": self.outliers,
        }
        stated = {
            name: value
            for name, value in named.items()
            if value is not None or (name == "prior_mm" and held is not None)  # may be null
        }
        return {**stated, **self.others}


@dataclass(frozen=True, eq=False, slots=True, weakref_slot=True, repr=False)
class Calibration:
    """A calibrated camera, the views' poses and everything needed to judge them."""

    camera: Camera
    sigma: Array
    """One standard deviation of each of `camera.params`; 0 where held, NaN where undetermined."""
    covariance: Array
    """Covariance of `camera.params`."""
    noise_covariance: Array
    """Covariance of `camera.params` from the corners' noise alone, as if it were independent from
    corner to corner and board and lens were as modelled."""
    poses: tuple[Pose, ...]
    pose_covariances: Array
    """(K, 6, 6) covariance of (rvec, tvec) of each view, rad and mm."""
    residuals: tuple[ViewResiduals, ...]
    noise: float
    """Estimated standard deviation of one residual coordinate, in the cost's px; of the median
    corner where corners are weighted."""
    model_error: float
    """Standard deviation that the models of board and lens add to the corners' covariances, px
    along each axis (``refinement/whitening.py``); 0 where corners have no covariances."""
    reference_scale: float
    """Scale of the virtual reference image, reference px per mm on the board."""
    stage_one: Sequence[StageOne]
    """A row of the paper's Table 1 for each view."""
    history: tuple[Iteration, ...]
    status: Status
    cost: Cost
    fixed: tuple[str, ...]
    """Names of the intrinsics that were held."""
    undetermined: tuple[Undetermined, ...] = ()
    diagnosis: Diagnosis | None = None
    """The diagnosis of views that do not determine the camera (`Status.PARTIAL`); all uncertainties
    then include the errors of the assumptions."""
    board_shape: BoardShape | None = None
    """The board's shape, where it was estimated or held."""
    board_shape_error: float = 0.0
    """Deviation of the board's corners from the drawing, mm rms, if the residuals show one that was
    not estimated; the uncertainties then include its effect. 0 otherwise. It measures what the
    residuals show, not what the camera has absorbed."""
    lens_error: float = 0.0
    """Displacement that all views share and that the lens model does not follow, px rms (2-D), if
    the residuals show one and the lens rather than the board explains it (``lens_error.py``). It is
    that with the board as drawn, also where its shape was estimated, which takes a part up. 0
    otherwise, and not tested where the residuals do not look as if the board were off. The
    uncertainties are then those of the parameters that fit best, widened by the shift that such an
    error makes of them; none is of the lens itself, whose rays are off by about this much."""
    overdispersion: float = 0.0
    """Ratio of the views' disagreement about the camera to what the corners' noise explains
    (``overdispersion.py``), if it is significant; the uncertainties then include it. 0
    otherwise."""
    warnings: tuple[str, ...] = ()
    settings: CalibrationSettings = CalibrationSettings()
    digest: str = ""
    """SHA-256 of the observations and settings of the calibration."""
    seconds: float = float("nan")
    """Time that the method's initialisation and refinement took, s, without what is examined
    afterwards; NaN if it is not known, as in older results."""

    def __post_init__(self) -> None:
        freeze(self, "sigma", "covariance", "noise_covariance", "pose_covariances")

    def __repr__(self) -> str:
        """Return the camera with its standard deviations, on few lines."""
        width, height = self.camera.size
        square = [np.sum(view.image**2, axis=1) for view in self.residuals]
        count = sum(map(len, square))
        rms = np.sqrt(sum(map(np.sum, square)) / max(count, 1))
        values = ", ".join(
            f"{name} {value:.6g} ± {sigma:.2g}"
            for name, value, sigma in zip(
                self.camera.names, self.camera.params.tolist(), self.sigma.tolist(), strict=True
            )
        )
        return (
            f"<Calibration: {self.camera.model}, {width} x {height} px, {self.status.value}\n"
            f" {values}\n RMS {rms:.3g} px of {count:,} corners in {len(self.residuals)} views>"
        )

    @property
    def sigma_by_noise(self) -> Array:
        """(P,) standard deviations of `camera.params` from the corners' noise alone."""
        return np.asarray(np.sqrt(np.diag(self.noise_covariance)))


class DegenerateError(CalibrationError):
    """The failure of views that do not determine the camera, whatever their accuracy.

    Args:
        message: the cause.
        hint: advice on what to photograph.
        partial: the calibration of what the views do determine, with assumptions for the rest
            (``Calibration.diagnosis``); None if they determine nothing.
    """

    def __init__(self, message: str, hint: str, partial: Calibration | None = None) -> None:
        super().__init__(message, hint)
        self.partial = partial
