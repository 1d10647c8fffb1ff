"""The start of Stage II from checked views: the side they face, one camera and all poses.

Stage I (``stage_one.py``) works in the paper's y-up frame on the reference plane; this module
brings the corners there, and joins Stage I, the closed form and, where that fails, the focal sweep
into the first state of the joint registration.

Stage I corrects each view by one coefficient, n = d (1 + k1 r^2). The polynomial models take it as
their first coefficient (``PlaneLens.closed_form_factor``). Any other model is fitted to the rays
that it gives (``Lens.fit_to_rays`` or ``lens_fit.py``), or, where the start so made misses the
corners by more than 0.3 % of the image's width, to those of a camera of the unified model that
needs no Stage I (``unified_camera_search.py``). Models of several minima are started from several
values of the coefficient along which these lie (``Lens.valley``, ``multistart.py``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation import closed_form, focal_sweep
from calibgui.engine.calibration.initialisation.lens_fit import fit_lens
from calibgui.engine.calibration.initialisation.multistart import descend_along
from calibgui.engine.calibration.initialisation.stage_one import StageOneRegistration
from calibgui.engine.calibration.initialisation.unified_camera_search import (
    measure_miss,
    search_unified_camera,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import PINHOLE, find_model, list_parameter_names
from calibgui.engine.camera.plane import PlaneLens
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import frames
from calibgui.engine.geometry.planar_pose import poses_from_homographies

_CENTRE = ((0, "cx"), (1, "cy"))
_MAX_CORNERS = 500
"""Number of corners, spread evenly over all, that the coefficients of a start are fitted to."""
_MAX_START_MISS = 0.003
"""Root mean squared miss of the corners at the start, in image widths, from which another start is
tried."""


def check_facing(observations: Observations, names: Sequence[str]) -> float:
    """Return the side of the board that all views show, see `find_facing`.

    Args:
        observations: the views.
        names: names of the views for messages.

    Raises:
        CalibrationError: if some views show the board mirrored against the others.
    """
    sign = find_facing(observations)
    if not (sign == sign[0]).all():
        minority = sign != (1.0 if sign.sum() >= 0 else -1.0)
        listed = ", ".join(names[k] for k in np.flatnonzero(minority).tolist())
        raise CalibrationError(
            f"The board is mirrored against the other views in {listed}.",
            "Number their corners in the same turning sense, or undo the image's mirroring.",
        )
    return float(sign[0])


def convert_to_paper_frame(
    observations: Observations, scale: float, size: Size, facing: float
) -> tuple[Array, Array, Array]:
    """Return the arguments of Stage I: measured corners, reference corners x', y' and mask.

    Args:
        observations: the views.
        scale: reference px per mm.
        size: of the images, px.
        facing: the side of the board that all views show, from `check_facing`.

    Returns:
        (K, N, 2) corners in the paper's frame, (K, N, 2) the same on the reference image,
        from the board's centre and y up, (K, N) mask.
    """
    sign = np.full(len(observations.uv), facing)
    return (
        frames.paper_from_array(observations.uv, size),
        compute_reference_points(observations, scale, sign),
        observations.mask,
    )


def compute_reference_points(observations: Observations, scale: float, sign: Array) -> Array:
    """Return corners (K, N, 2) on the reference image: from the board's centre, y up, reference px.

    Args:
        observations: the views.
        scale: reference px per mm.
        sign: (K,) direction of the board's Y in each view, see `find_facing`.
    """
    # Padding repeats a corner and moves no limit.
    x, y = observations.xy[..., 0], observations.xy[..., 1]
    right, up = x - (x.min() + x.max()) / 2, (y.min() + y.max()) / 2 - y
    return np.stack([scale * right, (scale * sign)[:, None] * up], axis=-1)


class _ClosedForm(NamedTuple):
    """Stage I and the closed form together: a camera with one coefficient, and all poses."""

    f: Array
    """(2,) focal lengths, px."""
    centre: Array
    """(2,) principal point, array frame, px."""
    k1: float
    """The correction's coefficient in units of fx."""
    R: Array
    """(K, 3, 3) rotations."""
    T: Array
    """(K, 3) translations, mm."""


def initialise_stage_two(
    observations: Observations,
    first: StageOneRegistration,
    size: Size,
    model: str,
    held: Mapping[str, float | None],
) -> State:
    """Return the start of Stage II.

    Args:
        observations: the views.
        first: Stage I of the views.
        size: width and height of the images, px.
        model: the lens model, a key of ``camera.models.MODELS``.
        held: names to hold, with a value or None for the default.

    Raises:
        StartError: if no start is found.
    """
    lens = find_model(model)
    try:
        closed_form = _solve_closed_form(observations, first, size, held)
    except (StartError, np.linalg.LinAlgError):  # no lens of one coefficient sees the board so
        closed_form = None
    if closed_form and isinstance(lens, PlaneLens) and lens.closed_form_factor is not None:
        f, centre, k1, R, T = closed_form
        k = np.array(lens.defaults)
        k[:1] = lens.closed_form_factor * k1
        return State(np.concatenate([f, centre, k]), R, T)
    return _start_any_lens(observations, closed_form, size, model, held)


def start_from_camera(
    observations: Observations,
    camera: Camera,
    R: Array,
    T: Array,
    model: str,
    held: Mapping[str, float | None],
) -> State | None:
    """Return the start of a lens model that sees the corners as a camera of another model does.

    Args:
        observations: the views.
        camera: a camera that follows their corners.
        R, T: (K, 3, 3) and (K, 3) poses of the views under it.
        model, held: as for `initialise_stage_two`.

    Returns:
        None if the camera misses the corners, or the model cannot see them so.
    """
    seen = find_model(camera.model).project(np.array([0.0, 0.0, 1.0]), camera.params[4:])
    scale = seen.by_ray[0, 0]
    pinhole = State(camera.params[:4] * [scale, scale, 1.0, 1.0], R, T)
    observed = _ObservedRays(rays_from_pixels(observations.uv, camera), pinhole)
    try:
        state = _descend_valley(observations, observed, camera.size, model, held) or _fit_to_rays(
            observations, observed, model, held
        )
    except (StartError, np.linalg.LinAlgError):
        return None
    miss = measure_miss(observations, state, find_model(model), camera.size)
    return state if miss <= _MAX_START_MISS * camera.size[0] else None


def _solve_closed_form(
    observations: Observations,
    first: StageOneRegistration,
    size: Size,
    held: Mapping[str, float | None],
) -> _ClosedForm:
    """Join Stage I of all views into one camera and all poses."""
    centre, k1 = closed_form.estimate_centre_and_k1(first, size)
    array_centre = frames.centre_of_array(size)
    for i, name in _CENTRE:
        if name in held:
            value = held[name]
            centre[i] = array_centre[i] if value is None else value
    f = np.array([held.get(name) or np.nan for name in ("fx", "fy")], dtype=np.float64)
    M = closed_form.fit_homographies(observations, centre, k1)
    if np.isnan(f).any():
        found = closed_form.estimate_focal_lengths(M, size)
        if found is None:
            known = np.append(f, [centre[i] if name in held else np.nan for i, name in _CENTRE])
            found, centre, k1 = focal_sweep.sweep_focal_lengths(
                observations, centre, k1, size, known
            )
            M = closed_form.fit_homographies(observations, centre, k1)
        f = np.where(np.isnan(f), found, f)
    R, T = poses_from_homographies(M, f, observations.xy[:, 0])
    return _ClosedForm(f, centre, k1 * f[0] ** 2, R, T)


def _start_any_lens(
    observations: Observations,
    closed_form: _ClosedForm | None,
    size: Size,
    model: str,
    held: Mapping[str, float | None],
) -> State:
    """Return the start of a model that the closed form does not give: of a few, the best."""
    lens = find_model(model)
    candidates = (
        [] if closed_form is None else [_compute_closed_form_rays(observations, closed_form)]
    )
    starts = [_fit_to_rays(observations, observed, model, held) for observed in candidates]
    misses = [measure_miss(observations, start, lens, size) for start in starts]
    if not misses or misses[0] > _MAX_START_MISS * size[0]:
        known = np.array([_find_known(held, name, size) for name in PINHOLE])
        unified = search_unified_camera(observations, size, known)
        rays = rays_from_pixels(observations.uv, Camera(size, unified.params, "ucm"))
        candidates.append(_ObservedRays(rays, unified._replace(params=unified.params[:4])))
        starts.append(_fit_to_rays(observations, candidates[-1], model, held))
        misses.append(measure_miss(observations, starts[-1], lens, size))
    best = int(np.argmin(misses))
    return _descend_valley(observations, candidates[best], size, model, held) or starts[best]


def _descend_valley(
    observations: Observations,
    observed: _ObservedRays,
    size: Size,
    model: str,
    held: Mapping[str, float | None],
) -> State | None:
    """Return the lowest start along the coefficient of which a model has several minima, if any."""
    lens, names = find_model(model), list_parameter_names(model)
    if lens.valley is None or lens.valley.coefficient in held:
        return None
    along = lens.valley.coefficient
    cameras = [
        _fit_to_rays(observations, observed, model, {**held, along: value}).params
        for value in lens.valley.values
    ]
    free = np.flatnonzero([name not in held for name in names])
    return descend_along(observations, cameras, size, model, free, names.index(along))


class _ObservedRays(NamedTuple):
    """The rays of all corners, as a camera sees them that is not yet of the model wanted."""

    rays: Array
    """(K, N, 3), NaN for corners without one."""
    pinhole: State
    """fx, fy, cx, cy of a pinhole camera that has the same rays near the axis, and all poses."""


def _compute_closed_form_rays(
    observations: Observations, closed_form: _ClosedForm
) -> _ObservedRays:
    """Return the rays of a lens of one coefficient, except beyond its fold."""
    f, centre, k1, R, T = closed_form
    d = (observations.uv - centre) / f
    square = k1 * np.sum(d**2, axis=-1, keepdims=True)
    rays = np.concatenate([d * (1 + square), np.ones_like(square)], axis=-1)
    rays[1 + 3 * square[..., 0] <= 0] = np.nan
    return _ObservedRays(rays, State(np.concatenate([f, centre]), R, T))


def _fit_to_rays(
    observations: Observations,
    observed: _ObservedRays,
    model: str,
    held: Mapping[str, float | None],
) -> State:
    """Return a camera of the model that images these rays where the corners are."""
    lens, names = find_model(model), list_parameter_names(model)
    held = {**dict.fromkeys(lens.held_at_start), **held}
    rays, (pinhole, R, T) = observed
    chosen = (observations.mask > 0) & np.isfinite(rays).all(axis=-1)
    rays, uv = rays[chosen], observations.uv[chosen]
    step = max(1, len(uv) // _MAX_CORNERS)
    params = np.concatenate([pinhole, lens.defaults])
    for i, name in enumerate(names):
        value = held.get(name)
        if value is not None:
            params[i] = value
    k = lens.fit_to_rays(rays, (uv - params[2:4]) / params[:2])
    if k is not None:
        params[4:] = k
        return State(params, R, T)
    on_axis = lens.project(np.array([0.0, 0.0, 1.0]), params[4:]).by_ray[0, 0]
    for i in range(2):
        if held.get(names[i]) is None and on_axis > 0:
            params[i] /= on_axis
    free = np.flatnonzero([name not in held for name in names])
    fitted = fit_lens(rays[::step], uv[::step], params, lens, free)
    for name, least in lens.least_at_start.items():
        if name not in held and fitted[names.index(name)] < least:
            return _fit_to_rays(observations, observed, model, {**held, name: least})
    return State(fitted, R, T)


def _find_known(held: Mapping[str, float | None], name: str, size: Size) -> float:
    """Find the value at which one of fx, fy, cx, cy is held; NaN if it is not known."""
    value = held.get(name, np.nan)
    if value is None:
        value = {"cx": (size[0] - 1) / 2, "cy": (size[1] - 1) / 2}.get(name, np.nan)
    return float(value)


def find_facing(observations: Observations) -> Array:
    """Return (K,) +1 if the board's Y runs down in the image as v does, -1 if it runs up."""
    weight = observations.mask / observations.mask.sum(axis=1, keepdims=True)
    board = np.stack([weight * observations.xy[..., i] for i in range(2)], axis=1)
    middle = weight[:, None] @ observations.uv
    covariance = board @ observations.uv - board.sum(axis=2, keepdims=True) * middle
    # A camera turns all triangles of corners alike, and by Cauchy and Binet's formula the
    # determinant is the sum over all of them of the product of both areas.
    return np.asarray(np.sign(np.linalg.det(covariance)))
