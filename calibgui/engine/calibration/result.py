"""What a solve reports on its way, and what it results in.

The failures that the engine names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, freeze
from calibgui.engine.boards.shape import BoardShape
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose


@dataclass(frozen=True, eq=False, slots=True)
class StageOne:
    """One view's result of Stage I (paper 4.2, a row of Table 1) and of the cosines' equation.

    Centre and k1 are the paper's: pixels, centred frame, y up. Quantities that the view
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
    """Residual on the reference plane, reference px."""
    backward: Array
    """(3, 3) backward homography, reference plane to corrected image (eq. 17), paper's frame."""
    converged: bool

    def __post_init__(self) -> None:
        freeze(self, "backward")


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
    """Since the start of the solve."""


Report = Callable[[Iteration], bool]
"""Told of each iteration: False stops and keeps the best so far; raising Cancelled discards."""


class Status(StrEnum):
    """How a solve ended."""

    CONVERGED = "converged"
    PARTIAL = "partial"
    """Converged, with quantities assumed that the views do not determine (`Diagnosis`)."""
    MAX_ITERATIONS = "max-iterations"
    STOPPED = "stopped"


class Cost(StrEnum):
    """What Stage II minimises."""

    IMAGE = "image"
    """Reprojection error in the image (the default)."""
    REFERENCE = "reference"
    """Registration error on the virtual reference image (eq. 41), isotropic plate."""
    PAPER = "paper"
    """Eq. 41 to the letter: the same reference grid in px along x and y, radius in pixels."""


@dataclass(frozen=True, slots=True)
class Undetermined:
    """A parameter that the data do not determine, and why."""

    name: str
    reason: str


class Degeneracy(StrEnum):
    """Kinds of sets of views that do not determine a camera."""

    ONE_VIEW = "one-view"
    COPIES = "copies"
    """The same corners in every view."""
    PARALLEL_TO_SENSOR = "parallel-to-sensor"
    ONE_PLACE = "one-place"
    """The board at one place in one orientation, at most turned about its normal."""
    ONE_ORIENTATION = "one-orientation"
    ONE_SPOT = "one-spot"
    """All corners in a small part of the image."""
    TOO_LITTLE = "too-little"
    """Views that differ, but too few or by too little."""


@dataclass(frozen=True, slots=True)
class Assumed:
    """A quantity that the views do not determine, and what is taken for it."""

    name: str
    """Of a parameter, or "fy/fx". With fx assumed, fy follows it, and so do the coefficients."""
    value: float
    doubt: float
    """One standard deviation of what the value may be off by."""


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """Why views do not determine the camera, and what was made of them."""

    kind: Degeneracy
    message: str
    hint: str
    """What to photograph."""
    assumed: tuple[Assumed, ...] = ()


@dataclass(frozen=True, eq=False, slots=True)
class ViewResiduals:
    """What the calibration leaves unexplained in one view."""

    image: Array
    """(n, 2) measured minus predicted corner, px, array frame."""
    reference: Array
    """(n, 2) Dx', Dy' of eq. 38 on the reference plane, reference px."""

    def __post_init__(self) -> None:
        freeze(self, "image", "reference")

    @property
    def rms(self) -> float:
        """Root mean square length of the residual in the image, px."""
        return float(np.sqrt(np.mean(np.sum(self.image**2, axis=1))))


@dataclass(frozen=True, eq=False, slots=True)
class Calibration:
    """A calibrated camera, the views' poses and everything needed to judge them."""

    camera: Camera
    sigma: Array
    """One standard deviation of each of `camera.params`; 0 where held, NaN where undetermined."""
    covariance: Array
    """Covariance of `camera.params`."""
    sigma_by_noise: Array
    """`sigma` as the corners' noise alone would make it, if it were independent from corner to
    corner and board and lens were as modelled."""
    poses: tuple[Pose, ...]
    pose_covariances: Array
    """(K, 6, 6) covariance of (rvec, tvec) of each view, rad and mm."""
    residuals: tuple[ViewResiduals, ...]
    noise: float
    """Estimated standard deviation of one residual coordinate, in the cost's px; of the median
    corner where corners are weighted."""
    model_error: float
    """What the models of plate and lens add to the corners' covariances, px along each axis
    (``weighting.py``); 0 where corners have none."""
    reference_scale: float
    """Reference px per mm on the plate."""
    stage_one: tuple[StageOne, ...]
    history: tuple[Iteration, ...]
    status: Status
    cost: Cost
    fixed: tuple[str, ...]
    """Names of the intrinsics that were held."""
    undetermined: tuple[Undetermined, ...] = ()
    diagnosis: Diagnosis | None = None
    """Of views that do not determine the camera (`Status.PARTIAL`); every uncertainty then includes
    what the assumptions may be off by."""
    board_shape: BoardShape | None = None
    """The target's shape, where it was estimated or held."""
    board_shape_error: float = 0.0
    """By how much, mm rms, the corners of a nominal plate seem to be off, if the residuals say
    so; the uncertainties then include what this does to the camera."""
    view_scatter: float = 0.0
    """How many times as much the views disagree about the camera as the corners' noise explains
    (``view_scatter.py``), if that is beyond chance; the uncertainties then include it. 0
    otherwise."""
    warnings: tuple[str, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    digest: str = ""
    """SHA-256 of the observations and settings that this answers."""

    def __post_init__(self) -> None:
        freeze(self, "sigma", "covariance", "sigma_by_noise", "pose_covariances")


class DegenerateError(CalibrationError):
    """The views do not determine the camera, whatever their accuracy.

    Args:
        message: the cause.
        hint: what to photograph.
        partial: what they do determine, with the rest assumed (``Calibration.diagnosis``); None
            if that is nothing.
    """

    def __init__(self, message: str, hint: str, partial: Calibration | None = None) -> None:
        super().__init__(message, hint)
        self.partial = partial
