"""The comparison of methods of calibration on the same corners.

Every method of ``calibration.methods`` calibrates from all views, and is cross-validated
as in ``cross_validation.py``: only the poses of views that it has not seen are fitted. Methods that
know no lengths (``plumb_line.py``) are judged by how straight they make the board's rows and
columns in views that they have not seen.

What is compared has one frame for all: pixels of the array frame, rays, and one standard deviation
as a calibration by each method states it. Coefficients of different lens models mean different
things; what does not is how far a corner at a given distance from the principal point is moved by
the distortion (`measure_radial_shift`), and the displacement of one camera's pixels against
another's (``comparison.py``).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, Size, freeze
from calibgui.engine.assessment.changes.comparison import (
    CameraDifference,
    compare_cameras,
    find_covered_pixels,
)
from calibgui.engine.assessment.choices.cross_validation import (
    DEFAULT_FOLDS,
    compute_rms,
    resect_views,
)
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import METHODS
from calibgui.engine.calibration.methods.dlt import DLT, make_dlt
from calibgui.engine.calibration.methods.method import Description, Method
from calibgui.engine.calibration.methods.plumb_line import (
    LINE_METHODS,
    LineMethod,
    PlumbLine,
    compare_with_camera,
    measure_straightness,
)
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import (
    DEFAULT_METHOD,
    Calibration,
    Cost,
    Iteration,
    ViewResiduals,
)
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.errors import CalibrationError, Cancelled, Progress
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.uncertainty.projection_uncertainty import make_map_grid

AS_PRINTED = "lucchese-printed"
"""Name in a comparison of the paper's method as it is printed, with its own cost and lens."""
_PRINTED_LABEL = "Lucchese, as printed"
_PRINTED_TITLE = "Lucchese, with the cost and the lens as printed"
_PRINTED_LIMITS = "It minimises distances on the reference plane, where far views weigh more."
_STOPPED = "The comparison was stopped before it was tried."
"""Why a method gave nothing that was not tried any more."""
_TURNS = np.linspace(0, 2 * np.pi, 72, endpoint=False)
_DIRECTIONS = np.stack([np.cos(_TURNS), np.sin(_TURNS)], axis=1)
"""(72, 2) directions around the centre."""
_STEP_SIGMAS = 0.01
"""Step of central differences, in standard deviations of the parameter."""


@dataclass(frozen=True, eq=False, slots=True)
class Distortion:
    """Shift along the radius that the distortion causes at the outermost corner."""

    radius: float
    """Distance from the centre of distortion at which the shift is stated, px."""
    shift: float
    """Measured minus ideal distance from the centre there, px; negative for barrels."""
    sigma: float
    """Standard deviation of `shift` by the corners' noise, px."""


@dataclass(frozen=True, eq=False, slots=True)
class MethodTrial:
    """The result of a method that calibrates a camera from the views."""

    name: str
    """Name of the method in the comparison."""
    method: Description
    """Title, source and limits of the method."""
    settings: Mapping[str, Any]
    """Arguments of ``calibrate`` that repeat the calibration."""
    calibration: Calibration
    """The calibration from all views."""
    held_out: float
    """RMS length of the residuals of unseen views, px; NaN if the method fails without some of the
    views."""
    distortion: Distortion
    """Shift of the outermost corners."""
    difference: CameraDifference | None
    """Difference of the method's camera from the chosen one over the image; None if they have too
    little in common."""
    remarks: tuple[str, ...]
    """Sentences on the result."""

    @property
    def rms(self) -> float:
        """RMS length of the residuals, px."""
        return compute_rms(self.calibration.residuals)


@dataclass(frozen=True, eq=False, slots=True)
class LineTrial:
    """The result of a method that knows no lengths, from the same views."""

    name: str
    """Name of the method in the comparison."""
    method: LineMethod
    """Title, source and limits of the method, and its estimate."""
    lines: PlumbLine
    """The correction of the distortion that is estimated from all views."""
    held_out: float
    """RMS distance of corners of unseen views from straight lines, px; NaN if the method fails
    without some of the views."""
    distortion: Distortion
    """Shift of the outermost corners."""
    u: Array
    """(n,) columns of the map, px."""
    v: Array
    """(m,) rows of the map, px."""
    vector: Array
    """(m, n, 2) difference of the correction from the chosen camera's, up to a homography, px."""
    region: BoolArray
    """(m, n) true where the corners cover the image and statistics of `vector` are taken."""
    remarks: tuple[str, ...]
    """Sentences on the result."""
    seconds: float
    """Time that the estimate from all views took, s."""

    def __post_init__(self) -> None:
        freeze(self, "u", "v", "vector")

    @property
    def params(self) -> Array:
        """(P,) parameters of the correction in the order of ``lines.names``."""
        return _list_params(self.lines)

    @property
    def length(self) -> Array:
        """(m, n) length of `vector`, px."""
        return np.asarray(np.linalg.norm(self.vector, axis=-1))

    @property
    def difference_rms(self) -> float:
        """Root mean square length of `vector` in the region, px."""
        return float(np.sqrt(np.nanmean(self.length[self.region] ** 2)))

    @property
    def worst(self) -> float:
        """Largest length of `vector` in the region, px."""
        return float(np.nanmax(self.length[self.region]))


@dataclass(frozen=True, eq=False, slots=True)
class MethodComparison:
    """The results of all methods from the same views."""

    chosen: Camera
    """Camera that the others are compared with."""
    methods: Mapping[str, Description]
    """All methods in their order, by their names."""
    trials: Mapping[str, MethodTrial]
    """Methods that gave a camera, by their names."""
    lines: Mapping[str, LineTrial]
    """Methods that know no lengths, by their names."""
    refused: Mapping[str, str] = field(default_factory=dict)
    """Reasons why other methods gave nothing, by their names."""


def list_compared_methods() -> dict[str, tuple[Description, dict[str, Any]]]:
    """List the methods of a comparison by name, with the arguments of ``calibrate`` of each.

    Methods without lengths have none.
    """
    default = METHODS[DEFAULT_METHOD]
    printed = replace(
        default,
        name=AS_PRINTED,
        label=_PRINTED_LABEL,
        title=_PRINTED_TITLE,
        limits=_PRINTED_LIMITS,
    )
    listed: dict[str, tuple[Description, dict[str, Any]]] = {
        default.name: (default, {"method": default.name}),
        AS_PRINTED: (printed, {"method": default.name, "cost": Cost.PAPER}),
    }
    for name, method in METHODS.items():
        listed.setdefault(name, (method, {"method": name}))
    listed[DLT.name] = (DLT, {"method": DLT})
    return listed | {name: (method, {}) for name, method in LINE_METHODS.items()}


def compare_methods(
    views: Sequence[Observation],
    size: Size,
    chosen: Camera | None = None,
    folds: int = DEFAULT_FOLDS,
    board_poses: Sequence[Pose] | None = None,
    progress: Progress | None = None,
    names: Sequence[str] | None = None,
    check: Callable[[], None] | None = None,
) -> MethodComparison:
    """Try all methods on the same views.

    Args:
        views: corners and board points of each view, as for ``calibrate``.
        size: width and height of the images, px.
        chosen: the camera to compare with; that of the default method if None.
        folds: number of folds into which the views are dealt, fewer if there are fewer views.
        board_poses: the board's poses in a frame in which the camera stood still, one a view, for
            the direct linear transformation (``calibration.methods.dlt.make_dlt``); None if they
            are not known.
        progress: a function that is told how many of how many methods are done; it may raise
            ``Cancelled``.
        names: names of the views for messages.
        check: a function that is called now and then, and raises ``Cancelled`` to end with the
            methods that have been tried by then.

    Raises:
        CalibrationError, DegenerateError: if the default method fails.
        Cancelled: from `progress`, or from `check` before the default method has been tried.
    """
    methods = list_compared_methods()
    attempt = _Attempt(
        views, size, chosen, min(folds, len(views)), board_poses, names, check or (lambda: None)
    )
    for k, (name, (method, settings)) in enumerate(methods.items()):
        if progress is not None:
            progress(k, len(methods))
        try:
            attempt.add(name, method, settings)
        except Cancelled:
            if DEFAULT_METHOD not in attempt.trials:
                raise
            attempt.refused |= dict.fromkeys(list(methods)[k:], _STOPPED)
            break
    if progress is not None:
        progress(len(methods), len(methods))
    assert attempt.chosen is not None  # the default method comes first, and raises where it fails
    described = {name: method for name, (method, _) in methods.items()}
    return MethodComparison(
        attempt.chosen, described, attempt.trials, attempt.lines, attempt.refused
    )


class _Attempt:
    """The trials of a comparison so far."""

    def __init__(
        self,
        views: Sequence[Observation],
        size: Size,
        chosen: Camera | None,
        folds: int,
        board_poses: Sequence[Pose] | None,
        names: Sequence[str] | None,
        check: Callable[[], None],
    ) -> None:
        self._views, self._size, self._folds = views, size, folds
        self._board_poses, self._names, self._check = board_poses, names, check
        self.chosen = chosen
        self.trials: dict[str, MethodTrial] = {}
        self.lines: dict[str, LineTrial] = {}
        self.refused: dict[str, str] = {}

    def add(self, name: str, method: Description, settings: Mapping[str, Any]) -> None:
        """Try a method; the first to be added is the default, which must not fail."""
        try:
            if isinstance(method, LineMethod):
                self.lines[name] = self._try_lines(name, method)
            else:
                self.trials[name] = self._try_camera(name, method, settings)
        except CalibrationError as error:
            if self.chosen is None or name == DEFAULT_METHOD:
                raise
            self.refused[name] = str(error)

    def _try_camera(
        self, name: str, method: Description, settings: Mapping[str, Any]
    ) -> MethodTrial:
        """Calibrate with a method; the first camera is the one that others are compared with."""
        # Without some of the views first: whatever is loaded once is then not the method's time.
        held_out, failure = self._measure_unseen_residuals(settings)
        found = self._calibrate(range(len(self._views)), settings, self._names)
        if self.chosen is None:
            self.chosen = found.camera
        difference = None
        remarks = found.warnings
        if isinstance(method, Method):
            remarks += method.list_remarks(found)
        try:
            difference = compare_cameras(self.chosen, found.camera, views=self._views)
        except CalibrationError as error:
            remarks = (*remarks, error.message)
        if failure:
            remarks = (*remarks, f"Without some of the views it fails: {failure}")
        distortion = _measure_distortion(found, self._measure_radius())
        return MethodTrial(name, method, settings, found, held_out, distortion, difference, remarks)

    def _calibrate(
        self,
        chosen: Sequence[int],
        settings: Mapping[str, Any],
        names: Sequence[str] | None = None,
    ) -> Calibration:
        """Calibrate from the views of these numbers, with the poses that are known of them."""
        if settings["method"] is DLT and self._board_poses is not None:
            settings = {"method": make_dlt([self._board_poses[k] for k in chosen])}

        def report(_: Iteration) -> bool:
            self._check()
            return True

        self._check()
        return calibrate(
            [self._views[k] for k in chosen], self._size, names=names, report=report, **settings
        )

    def _measure_unseen_residuals(self, settings: Mapping[str, Any]) -> tuple[float, str]:
        """Measure the RMS residual of unseen views with only their poses fitted, px.

        Returns:
            It, and an empty text; NaN and the reason if the method fails without some of the views.
        """
        unseen: list[ViewResiduals] = []
        try:
            for fold in range(self._folds):
                kept = [k for k in range(len(self._views)) if k % self._folds != fold]
                found = self._calibrate(kept, {**settings, "model_errors": False})
                unseen += resect_views(found, self._views[fold :: self._folds])
        except CalibrationError as error:
            return float("nan"), error.message
        return compute_rms(unseen), ""

    def _try_lines(self, name: str, method: LineMethod) -> LineTrial:
        """Straighten the rows and columns of the board, and compare with the chosen camera."""
        assert self.chosen is not None
        began = time.perf_counter()
        lines = method.estimate(self._views, self._size)
        seconds = time.perf_counter() - began
        u, v = make_map_grid(self._size)
        vector = compare_with_camera(lines, self.chosen, u, v)
        return LineTrial(
            name=name,
            method=method,
            lines=lines,
            held_out=self._measure_unseen_straightness(method),
            distortion=_measure_line_distortion(lines, self._measure_radius()),
            u=u,
            v=v,
            vector=vector,
            region=find_covered_pixels(make_mesh(u, v), self._views),
            remarks=lines.remarks,
            seconds=seconds,
        )

    def _measure_radius(self) -> float:
        """Return the distance of the outermost corner from the chosen camera's centre, px."""
        assert self.chosen is not None
        uv = np.concatenate([view.uv for view in self._views])
        return float(np.linalg.norm(uv - self.chosen.centre, axis=1).max())

    def _measure_unseen_straightness(self, method: LineMethod) -> float:
        """Return the RMS distance of unseen corners from straight lines, px; NaN if it fails."""
        squares = []
        for fold in range(self._folds):
            kept = [view for k, view in enumerate(self._views) if k % self._folds != fold]
            unseen = self._views[fold :: self._folds]
            self._check()
            try:
                rms = measure_straightness(unseen, method.estimate(kept, self._size))
            except CalibrationError:
                return float("nan")
            squares += [rms**2] * sum(len(view.uv) for view in unseen)
        return float(np.sqrt(np.mean(squares)))


def measure_radial_shift(camera: Camera, radius: float) -> float:
    """Measure how far the lens shifts points along the radius, px; the mean over all directions.

    It is the measured distance from the principal point minus that of a camera without distortion
    of the same focal lengths; negative for barrels, NaN where the lens sees 90 degrees or more.

    Args:
        camera: the camera.
        radius: measured distance from the principal point, px.
    """
    rays = rays_from_pixels(camera.centre + radius * _DIRECTIONS, camera)
    with np.errstate(divide="ignore", invalid="ignore"):
        ideal = camera.focal * rays[:, :2] / np.where(rays[:, 2:] > 0, rays[:, 2:], np.nan)
    return float(radius - np.mean(np.linalg.norm(ideal, axis=1)))


def _measure_distortion(found: Calibration, radius: float) -> Distortion:
    """Measure the shift of the outermost corners; NaN if no distortion is estimated."""
    camera = found.camera
    if set(camera.names[4:]) <= {"skew", *found.fixed}:
        return Distortion(radius, float("nan"), float("nan"))

    def shift(params: Array) -> float:
        return measure_radial_shift(Camera(camera.size, params, camera.model), radius)

    return Distortion(
        radius, shift(camera.params), _propagate(shift, camera.params, found.covariance)
    )


def _measure_line_distortion(lines: PlumbLine, radius: float) -> Distortion:
    """Measure the shift of the outermost corners by a correction that knows no lengths."""

    def shift(params: Array) -> float:
        corrected = _replace_params(lines, params)
        points = corrected.correct_points(corrected.centre + radius * _DIRECTIONS)
        return float(radius - np.mean(np.linalg.norm(points - corrected.centre, axis=1)))

    params = _list_params(lines)
    return Distortion(radius, shift(params), _propagate(shift, params, lines.covariance))


def _list_params(lines: PlumbLine) -> Array:
    """Return the parameters (P,) of a correction in the order of its names."""
    values = {"cx": lines.centre[0], "cy": lines.centre[1], "aspect": lines.aspect}
    values |= {f"k{i}": k for i, k in enumerate(lines.k, start=1)}
    return np.array([values[name] for name in lines.names])


def _replace_params(lines: PlumbLine, params: Array) -> PlumbLine:
    """Return a correction with other parameters (P,)."""
    values = dict(zip(lines.names, params.tolist(), strict=True))
    return replace(
        lines,
        centre=np.array([values["cx"], values["cy"]]),
        k=np.array([value for name, value in values.items() if name.startswith("k")]),
        aspect=values.get("aspect", lines.aspect),
    )


def _propagate(function: Callable[[Array], float], params: Array, covariance: Array) -> float:
    """Return the standard deviation of a function of parameters (P,) of covariance (P, P)."""
    sigma = np.sqrt(np.nan_to_num(np.diag(covariance)))
    slope = np.zeros(len(params))
    for i in np.flatnonzero(sigma > 0).tolist():
        step = np.zeros(len(params))
        step[i] = _STEP_SIGMAS * sigma[i]
        slope[i] = (function(params + step) - function(params - step)) / (2 * step[i])
    return float(np.sqrt(slope @ np.nan_to_num(covariance) @ slope))
