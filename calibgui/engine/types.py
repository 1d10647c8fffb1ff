"""The records that the engine takes and returns.

All are frozen; their arrays are read-only, C-contiguous float64 (or int64 where said).
Unless a field says otherwise lengths on the plate are millimetres, angles radians and
image coordinates pixels in the array frame (``frames.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.engine.targets.pattern import CHECKERBOARD, Pattern

Array = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]

Size = tuple[int, int]
"""Width and height of an image, pixels."""

Board = tuple[int, int]
"""Rows and columns of a target's points: inner corners of a checkerboard, circles of a grid."""


def frozen(values: npt.ArrayLike) -> Array:
    """A read-only float64 copy of `values`."""
    array = np.array(values, dtype=np.float64, order="C")
    array.flags.writeable = False
    return array


def frozen_int(values: npt.ArrayLike) -> IntArray:
    """A read-only int64 copy of `values`."""
    array = np.array(values, dtype=np.int64, order="C")
    array.flags.writeable = False
    return array


@dataclass(frozen=True, slots=True)
class Target:
    """A flat target: by default a checkerboard with rows x cols inner corners (the paper's M x N).

    Plate frame: origin at point (0, 0), X along a row (increasing column), Y down the
    rows, both in mm, so that an upright board seen from its front has R close to identity.
    """

    rows: int
    cols: int
    square: float
    """The pattern's pitch, mm: the side of a square (the paper's D_o)."""
    pattern: Pattern = CHECKERBOARD
    """What is printed, and how it is found."""

    @property
    def board(self) -> Board:
        """Rows and columns."""
        return self.rows, self.cols

    def points(self, grid: npt.ArrayLike | None = None) -> Array:
        """(n, 2) plate coordinates, mm, of points (n, 2) = (row, column); all by default."""
        if grid is None:
            grid = np.indices(self.board).reshape(2, -1).T
        return self.pattern.places(np.asarray(grid, dtype=np.float64)) * self.square


class Ambiguity(StrEnum):
    """Turns of the board that its pattern does not tell apart."""

    NONE = "none"
    HALF_TURN = "180"
    QUARTER_TURN = "90"


class Rejection(NamedTuple):
    """A corner that was seen but is not trusted."""

    u: float
    v: float
    reason: str


class OtherBoard(NamedTuple):
    """A board seen in an image beside the wanted one."""

    shape: tuple[int, int]
    """Rows and columns of inner corners seen."""
    outline: Array
    """(4, 2) its outermost corners, px."""


@dataclass(frozen=True, eq=False, slots=True)
class Corners:
    """The points located in one image (X-junctions or circles), with their places on the board."""

    shape: Board
    """Rows and columns of the board's points (M, N)."""
    grid: IntArray
    """(n, 2) row and column of each corner."""
    uv: Array
    """(n, 2) refined positions, px."""
    estimate: Array
    """(n, 2) first estimates (Harris), px: the paper's red marks."""
    cov: Array | None = None
    """(n, 2, 2) covariance of uv, px^2, where the method delivers one."""
    ambiguity: Ambiguity = Ambiguity.NONE
    roi: Array | None = None
    """(4, 2) region of interest that was searched, px: the board's outline."""
    method: str = "saddle"
    relative: bool = False
    """Whether a partly seen board's rows or columns could be counted otherwise."""
    blur: Array | None = None
    """(n,) standard deviation of the edges' blur, pixel included, px."""
    contrast: Array | None = None
    """(n,) bright minus dark, grey levels."""
    residual: Array | None = None
    """(n,) root mean square of the grey levels that the fit leaves unexplained."""
    rejected: tuple[Rejection, ...] = ()
    others: tuple[OtherBoard, ...] = ()
    """Further boards in the image."""
    pattern: Pattern = CHECKERBOARD
    """What they are of, with all that the image tells of it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "grid", frozen_int(self.grid))
        for name in ("uv", "estimate", "cov", "roi", "blur", "contrast", "residual"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, frozen(value))

    def __len__(self) -> int:
        return len(self.uv)

    @property
    def complete(self) -> bool:
        """Whether every corner of the board was located."""
        return len(self) == self.shape[0] * self.shape[1]


class Observation(NamedTuple):
    """What one view contributes to a calibration. A plain tuple (uv, xy) serves as well."""

    uv: Array
    """(n, 2) measured corners, px."""
    xy: Array
    """(n, 2) the same corners on the plate, mm."""
    cov: Array | None = None
    """(n, 2, 2) covariance of uv up to a common factor, px^2; equal and isotropic if None."""


class ViewStatus(StrEnum):
    """What is known of one image."""

    WAITING = "waiting"
    """Not searched yet."""
    FOUND = "found"
    NO_BOARD = "no-board"
    UNREADABLE = "unreadable"
    WRONG_SIZE = "wrong-size"


@dataclass(frozen=True, eq=False, slots=True)
class View:
    """One image of a project, with its corners or the reason why there are none."""

    image: str
    """Path or name of the image."""
    status: ViewStatus = ViewStatus.WAITING
    reason: str = ""
    """Why the image cannot be used, and the remedy; empty if it can."""
    note: str = ""
    """How its corners came about, where that is worth knowing."""
    corners: Corners | None = None
    """Corners found on a target of known layout."""
    points: Observation | None = None
    """Corners with their plate points, where they came from elsewhere (a corners file)."""
    roi: Array | None = None
    """(4, 2) region of interest given by the user, px."""
    enabled: bool = True
    """Whether the user wants it in the calibration."""

    @property
    def usable(self) -> bool:
        """Whether the view takes part in a calibration."""
        return self.enabled and self.status is ViewStatus.FOUND

    def observation(self, target: Target | None) -> Observation:
        """What the view contributes to a calibration, on `target` (needed for found corners)."""
        if self.points is not None:
            return self.points
        if self.corners is None or target is None:
            raise ValueError(f"{self.image} has no corners on a known target")
        return Observation(self.corners.uv, target.points(self.corners.grid), self.corners.cov)


@dataclass(frozen=True, eq=False, slots=True)
class Pose:
    """cam_from_plate: X_cam = R X_plate + tvec, with R = exp(rvec)."""

    rvec: Array
    """(3,) rotation vector, rad."""
    tvec: Array
    """(3,) translation, mm."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "rvec", frozen(self.rvec))
        object.__setattr__(self, "tvec", frozen(self.tvec))


@dataclass(frozen=True, eq=False, slots=True)
class Camera:
    """Intrinsics in the array frame: a lens model's name and its parameters.

    `params` holds fx, fy, cx, cy (px) and the model's dimensionless coefficients, in the
    order of `names`.
    """

    size: Size
    params: Array
    model: str = "lucchese"

    def __post_init__(self) -> None:
        object.__setattr__(self, "params", frozen(self.params))

    @property
    def focal(self) -> Array:
        """(2,) fx, fy, px."""
        return self.params[0:2]

    @property
    def centre(self) -> Array:
        """(2,) cx, cy, px."""
        return self.params[2:4]

    @property
    def coefficients(self) -> Array:
        """The lens coefficients, dimensionless."""
        return self.params[4:]

    @property
    def matrix(self) -> Array:
        """(3, 3) the camera matrix K."""
        fx, fy, cx, cy = self.params[:4]
        return np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])


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
        object.__setattr__(self, "backward", frozen(self.backward))


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
    """Length of the step over the length of the unknowns, scaled."""
    damping: float
    seconds: float
    """Since the start of the solve."""


Report = Callable[[Iteration], bool]
"""Told of each iteration: False stops and keeps the best so far; raising Cancelled discards."""

Progress = Callable[[int, int], None]
"""Told how many parts of the work are done, of how many; may raise ``Cancelled``."""


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


class PlateModel(StrEnum):
    """How the target may deviate from its nominal shape."""

    NOMINAL = "nominal"
    AFFINE = "affine"
    BOW = "bow"
    FREE = "free"


@dataclass(frozen=True, slots=True)
class Prior:
    """What is known of a plate beforehand: standard deviations of its corners' places, mm."""

    in_plane: float
    """Accuracy of the print."""
    out_of_plane: float
    """Flatness."""


@dataclass(frozen=True, eq=False, slots=True)
class Plate:
    """A target with its corners where they were found to be."""

    model: PlateModel
    nominal: Array
    """(n, 2) places by the drawing, mm."""
    deviation: Array
    """(n, 3) from there, mm, without net motion, turn or scale."""
    sigma: Array
    """(n, 3) one standard deviation, mm; 0 where not estimated."""

    def __post_init__(self) -> None:
        for name in ("nominal", "deviation", "sigma"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    @property
    def rms(self) -> float:
        """Root mean square length of the deviations, mm."""
        return float(np.sqrt(np.mean(np.sum(self.deviation**2, axis=1))))


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
        object.__setattr__(self, "image", frozen(self.image))
        object.__setattr__(self, "reference", frozen(self.reference))

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
    plate: Plate | None = None
    """The target's shape, where it was estimated or held."""
    plate_doubt: float = 0.0
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
        for name in ("sigma", "covariance", "sigma_by_noise", "pose_covariances"):
            object.__setattr__(self, name, frozen(getattr(self, name)))
