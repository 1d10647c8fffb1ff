"""A camera in another lens model, without any corners: by its rays.

Where there are corners the other model is calibrated on them (``refit.py``). A camera that was read
from a file has none. Its rays are then sampled over the image, and the other model is fitted to
them,

    min over f, c, k of  sum |c + f project(b_i, k) - uv_i|^2,      b_i the ray of the pixel uv_i,

by the trust-region method of Branch, Coleman and Li (1999) as in scipy. It begins at the plainest
lens, after ``initialisation.lens_fit``, and for models of which two coefficients do nearly the same
at several values of one of them (``Lens.conversion_starts``). Nothing is rotated: a pixel keeps its
ray. ``lens_fit`` alone would not do: its normal equations lose half of the digits, which is enough
for a start, and at the edge of what a model images it ends before the minimum.

The error is measured where it was not fitted, on a finer mesh: the distance of a pixel from the
image of its ray. Only pixels at which the first model is one-to-one count. A model that cannot
see as far as the camera can follow it in part of the image only: within an angle from the axis.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array, IntArray, freeze
from calibgui.engine.calibration.initialisation.lens_fit import fit_lens
from calibgui.engine.calibration.refit import measure_displacement
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.model import Lens
from calibgui.engine.camera.models import find_model, list_parameter_names, resolve_model_id
from calibgui.engine.camera.projection import measure_axis_scale, project, rays_from_pixels
from calibgui.engine.camera.validity import find_valid_pixels, measure_angles
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.sampling import make_mesh

_FITTED_STEPS, _MEASURED_STEPS = 30, 100
"""Numbers of steps along the image's longer side of the pixels whose rays are fitted, and of those
where the error is measured."""
_STEPS_PER_CONTROL_POINT = 4
"""Number of fitted pixels along an axis for each control point of a splined model."""
_PULLS = (0.0, 1e-4, 1e-3)
"""Pulls of the coefficients towards the start that are tried, one after the other, until the model
is one-to-one: rays leave some coefficients of rich models almost open, and then poles arise."""
_TOLERANCE = 1e-12
"""Relative changes of cost, gradient and step that end the fit."""
_MAX_EVALUATIONS = 60
"""Number of evaluations of a fit at most."""
_MIN_PIXELS = 200
"""Number of sampled pixels that a region needs."""
_ANGLE_STEPS = 7
"""Number of halvings that find the angle up to which a model can follow a camera."""


@dataclass(frozen=True, eq=False, slots=True)
class Conversion:
    """A camera in another lens model, and how far it is from the original."""

    camera: Camera
    """The camera in the other model."""
    largest_error: float
    """Largest distance, px, between a pixel of the region and the image of its ray; infinite if a
    ray has none, or the model is not one-to-one there."""
    rms_error: float
    """Root mean square of that distance, px."""
    worst: Array
    """(2,) pixel of the largest error."""
    region: Array
    """(n, 2) px, convex outline of the region."""
    share: float
    """Share of the image that the region covers."""
    angle: float
    """Largest angle between a ray of the region and the axis, rad."""

    def __post_init__(self) -> None:
        freeze(self, "worst", "region")


def convert_camera(
    camera: Camera, model: str, angle: float = np.inf, zeros: Collection[str] = ()
) -> Conversion:
    """Express a camera in another lens model.

    Args:
        camera: the camera.
        model: the other lens model's id; the camera's own gives the camera itself.
        angle: largest angle from the axis of the rays that count, rad; infinite for the whole
            image.
        zeros: names of its coefficients that are to be 0.

    Raises:
        CalibrationError: if there is no such model, or hardly a pixel has such a ray.

    Examples:
        A fisheye lens of 120 degrees in the double sphere model, which follows it closely, and as a
        camera without distortion, which cannot.

        >>> import math
        >>> from calibgui.engine.calibration import convert_camera
        >>> from calibgui.engine.camera import Camera
        >>> camera = Camera((640, 480), [380, 380, 320, 240, -0.01, 0, 0, 0], "kannala-brandt")
        >>> convert_camera(camera, "double-sphere").largest_error < 0.1
        True
        >>> convert_camera(camera, "pinhole").largest_error > 50
        True
    """
    model = resolve_model_id(model)
    found = camera
    named = dict(zip(camera.names, camera.params.tolist(), strict=True))
    if model != camera.model or any(named[name] != 0 for name in zeros):
        lens = find_model(model)
        steps = _FITTED_STEPS
        if lens.control_points is not None:
            steps = max(steps, _STEPS_PER_CONTROL_POINT * max(lens.control_points))
        fitted = _sample_region(camera, steps, angle).uv
        found = _fit_model(camera, model, fitted, rays_from_pixels(fitted, camera), zeros)
    return _measure_conversion(camera, found, angle)


def find_followed_angle(camera: Camera, model: str, limit: float) -> float | None:
    """Find the largest angle from the axis up to which a model follows a camera.

    Args:
        camera: the camera.
        model: the other lens model's id.
        limit: largest error that is accepted, px.

    Returns:
        The angle, rad; None if the model does not follow the camera anywhere.
    """
    low, high = 0.0, _sample_region(camera, _FITTED_STEPS, np.inf).angle
    is_followed_anywhere = False
    for _ in range(_ANGLE_STEPS):
        middle = (low + high) / 2
        is_followed = convert_camera(camera, model, middle).largest_error <= limit
        is_followed_anywhere |= is_followed
        low, high = (middle, high) if is_followed else (low, middle)
    return low if is_followed_anywhere else None


class _Region(NamedTuple):
    """Pixels of a mesh over the image that have rays within an angle from the axis."""

    uv: Array
    """(n, 2) px."""
    angle: float
    """Largest angle of their rays, rad."""
    share: float
    """Share of the mesh that they are."""


def _sample_region(camera: Camera, steps: int, angle: float) -> _Region:
    """Sample the region by a mesh, which is finer than `steps` if the region is small.

    Raises:
        CalibrationError: if hardly a pixel of the camera has such a ray.
    """
    for finer in (1, 3, 9):
        uv = _make_image_mesh(camera, finer * steps).reshape(-1, 2)
        angles = measure_angles(uv, camera)
        inside = np.asarray(find_valid_pixels(uv, camera) & (angles <= angle))
        if inside.sum() >= _MIN_PIXELS:
            return _Region(uv[inside], float(angles[inside].max()), float(inside.mean()))
    raise CalibrationError(
        "Hardly a pixel of the camera has a ray within the region.",
        "Choose a larger region, and check that the camera's parameters are right.",
    )


def _make_image_mesh(camera: Camera, steps: int) -> Array:
    """Return pixels (m, n, 2) over the whole image, to its first and last row and column."""
    longer = max(camera.size)
    return make_mesh(*(np.linspace(0, n - 1, 1 + round(steps * n / longer)) for n in camera.size))


def _fit_model(
    camera: Camera, model: str, uv: Array, rays: Array, zeros: Collection[str]
) -> Camera:
    """Fit a model, without some coefficients, to pixels (n, 2) and their rays (n, 3)."""
    lens, names = find_model(model), list_parameter_names(model)
    scale = measure_axis_scale(camera) * np.array([1.0, camera.params[1] / camera.params[0]])
    k = lens.fit_to_rays(rays, (uv - camera.centre) / scale)
    if k is not None and not zeros:
        return Camera(camera.size, np.concatenate([scale, camera.centre, k]), model)
    free = _select_free(camera, lens, zeros)
    name, values = lens.conversion_starts or ("", (np.nan,))
    found: list[tuple[bool, float, Array]] = []
    for value in values:
        k = np.array(lens.defaults)
        if name:
            k[lens.names.index(name)] = value
        params = np.concatenate([scale, camera.centre, k])
        on_axis = lens.project(np.array([0.0, 0.0, 1.0]), k).by_ray[0, 0]
        if on_axis > 0:
            params[:2] /= on_axis
        start = fit_lens(rays, uv, params, lens, free[[names[i] != name for i in free]])
        for pull in _PULLS:
            fitted, cost = _polish(start, lens, free, rays, uv, pull)
            is_valid = bool(find_valid_pixels(uv, Camera(camera.size, fitted, model)).all())
            found.append((not is_valid, cost, fitted))
            if is_valid:
                break
    return Camera(camera.size, min(found, key=lambda ranked: ranked[:2])[2], model)


def _select_free(camera: Camera, lens: Lens, zeros: Collection[str]) -> IntArray:
    """Return the indices of the parameters to fit: all but zeros and a skew that is not there."""
    named = dict(zip(camera.names, camera.params.tolist(), strict=True))
    held = {name for name in lens.held if named.get(name, 0.0) == 0.0} | set(zeros)
    return np.flatnonzero([name not in held for name in ("fx", "fy", "cx", "cy", *lens.names)])


def _polish(
    start: Array, lens: Lens, free: IntArray, rays: Array, uv: Array, pull: float
) -> tuple[Array, float]:
    """Fit all free parameters, and return them with the sum of squares.

    Args:
        start: (P,) parameters to begin from.
        lens: the lens model.
        free: indices of the parameters that may change.
        rays: (n, 3) rays.
        uv: (n, 2) their pixels, px.
        pull: weight of what the coefficients' changes move, against what is missed.
    """
    params = start.copy()
    unseen = float(np.ptp(uv))  # what a ray without an image is off by

    def evaluate(x: Array) -> tuple[Array, Array]:
        params[free] = x
        with np.errstate(all="ignore"):
            seen = project(rays, params, lens)
        miss, by_params = seen.points - uv, seen.by_params[..., free]
        near = np.abs(miss).max(axis=-1) < unseen  # false for NaN
        good = (near & np.isfinite(by_params).all(axis=(-1, -2)))[:, None, None]
        J = np.where(good, by_params, 0.0).reshape(-1, len(free))
        r = np.where(good[..., 0], miss, unseen).ravel()
        return np.append(r, weight * (x - start[free])), np.vstack([J, np.diag(weight)])

    def compute_miss(x: Array) -> Array:
        return evaluate(x)[0]

    def compute_derivatives(x: Array) -> Array:
        return evaluate(x)[1]

    weight = np.zeros(len(free))
    if pull:
        weight = pull * np.linalg.norm(evaluate(start[free])[1], axis=0) * (free >= 4)
    lower = np.where(free < 2, 1e-3, -np.inf)
    found = scipy.optimize.least_squares(
        compute_miss,
        start[free],
        compute_derivatives,
        bounds=(lower, np.inf),
        x_scale="jac",
        ftol=_TOLERANCE,
        xtol=_TOLERANCE,
        gtol=_TOLERANCE,
        max_nfev=_MAX_EVALUATIONS,
    )
    params[free] = found.x
    return params.copy(), float(found.cost)


def _measure_conversion(camera: Camera, found: Camera, angle: float) -> Conversion:
    """Measure the error of a converted camera over a region."""
    uv, widest, share = _sample_region(camera, _MEASURED_STEPS, angle)
    with np.errstate(all="ignore"):
        error = measure_displacement(camera, found, uv)
        is_seen = np.isfinite(error) & find_valid_pixels(uv, found)
        error = np.asarray(np.where(is_seen, error, np.inf))
    worst = int(np.argmax(error))
    hull = scipy.spatial.ConvexHull(uv)
    return Conversion(
        camera=found,
        largest_error=float(error[worst]),
        rms_error=float(np.sqrt(np.mean(error**2))),
        worst=uv[worst],
        region=uv[hull.vertices],
        share=share,
        angle=widest,
    )
