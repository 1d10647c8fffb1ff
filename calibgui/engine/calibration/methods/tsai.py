"""Tsai's method (1987) with a coplanar target: the radial alignment constraint.

A lens whose distortion is radial moves an image point along the line through the centre. Its
direction from there, (Xd, Yd), is therefore that of the point (x, y) of the camera frame, whatever
the focal length, the distortion and the distance. That is the radial alignment constraint (RAC);
it turns each view into a rotation and two coordinates of its translation, and only then come focal
length, distortion and distance. In the paper's letters, with (xw, yw, 0) on the board, Xd = u - cx
and Yd = v - cy in px,

    x = r1 xw + r2 yw + Tx,    y = r4 xw + r5 yw + Ty,    z = r7 xw + r8 yw + Tz,
    Xd (1 + kappa1 r^2) = f x / z,    Yd (1 + kappa1 r^2) = f y / z,    r^2 = Xd^2 + Yd^2

the last two of which are the equations of the camera. kappa1 acts on the measured point, as k1 of
our lens model `lucchese` does, which is in units of f: k1 = kappa1 f^2. The centre is the middle of
the image. The image's scale sx is taken for 1, that is fy = fx: one plane cannot tell it, and the
paper has it known beforehand as well.

**Stage 1.** Xd y = Yd x divided by Ty is linear in five unknowns:

    [Yd xw, Yd yw, Yd, -Xd xw, -Xd yw] (r1', r2', Tx', r4', r5') = Xd,    r1' = r1 / Ty, ...

The first two rows of R have length 1 and are orthogonal, (1 - r1^2 - r2^2)(1 - r4^2 - r5^2) =
(r1 r4 + r2 r5)^2, which is quadratic in Ty^2. With Sr = r1'^2 + r2'^2 + r4'^2 + r5'^2 and
D = r1' r5' - r4' r2'

    Ty^2 = [Sr - sqrt(Sr^2 - 4 D^2)] / (2 D^2) = 2 / [Sr + sqrt(Sr^2 - 4 D^2)],

in the paper's form on the left. That on the right loses no digits, and holds as well where a row or
column of r1', r2', r4', r5' vanishes and D with it, which is a case of its own in the paper. As Sr
>= 2 |D|, the root is always real, and as Ty^2 is the lesser of two solutions, no row of R is longer
than 1. Ty has the sign that puts a corner far from the centre on its own side of it. Then

    r3 = sqrt(1 - r1^2 - r2^2),    r6 = -sgn(r1 r4 + r2 r5) sqrt(1 - r4^2 - r5^2),

and the third row is the cross product of the two. Ty must not be 0: the paper advises to put the
board's origin away from the middle row of the image, and we move it to the corner that is farthest
from that row, and back.

**Stage 2.** Without distortion these equations are linear in f and Tz, with w = r7 xw + r8 yw:

    x f - Xd Tz = w Xd,    y f - Yd Tz = w Yd.

The paper uses the second line only, because it does not trust sx; with sx known both count. If f is
negative, the signs of r3, r6, r7, r8 are the other ones, which changes those of f and Tz. From
there they themselves are solved for f, Tz and kappa1 by least squares in the corrected image.

**All views.** The paper has one view; each view k here gives f_k and kappa1_k. With J_k the
derivatives of its residuals by (f, kappa1), less what a motion of the board can do of them,
J_k^T J_k is what the view knows of the two, and the one camera for all views is

    (f, kappa1) = [sum J_k^T J_k]^-1 sum J_k^T J_k (f_k, kappa1_k).

A view that is parallel to the sensor knows nothing of f, since f and Tz do the same to it; what
noise makes of its f does not count. Tsai asks for a tilt of 30 degrees at least. The poses are
solved again with that camera. This is the method `tsai-closed-form`; the method `tsai` refines it
over all views, with fx, fy, cx, cy, kappa1 and the poses free.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.methods.method import (
    Initialisation,
    Method,
    Problem,
    hold_parameters,
    keep_start,
    refine_by_bundle_adjustment,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.resection import estimate_poses
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.plane import plane_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import frames
from calibgui.engine.geometry.rotations import make_cross_matrix

_SOURCE = (
    "R. Y. Tsai, A versatile camera calibration technique for high-accuracy 3D machine vision "
    "metrology using off-the-shelf TV cameras and lenses, IEEE Journal of Robotics and Automation "
    "RA-3 (1987) 323-344"
)
_MIN_TILT = np.deg2rad(7.0)
"""Tilt against the sensor below which a view does not count: of none at all, 1 px of noise makes up
to 7 degrees."""
_MIN_CORNERS = 6
"""Number of corners of a view, more than the five unknowns of stage 1."""
_HELD_COEFFICIENTS = ("k2", "k3", "p1", "p2", "p3")
"""Coefficients of the lens model that the paper does not have."""
_TIED = ("fy", "cx", "cy", *_HELD_COEFFICIENTS)
"""Parameters that the closed form does not estimate."""


class ViewEstimate(NamedTuple):
    """The result of both stages for one view."""

    f: float
    """Focal length, px; NaN if the view has none."""
    kappa1: float
    """Coefficient of the distortion, px^-2."""
    R: Array
    """(3, 3) rotation."""
    T: Array
    """(3,) translation, mm."""

    @property
    def tilt(self) -> float:
        """Angle between board and sensor, rad."""
        return float(np.arccos(min(1.0, abs(self.R[2, 2]))))

    @property
    def counts(self) -> bool:
        """True if the view can tell a focal length."""
        return bool(np.isfinite(self.f)) and self.tilt >= _MIN_TILT


def estimate_views(observations: Observations, centre: Array) -> list[ViewEstimate]:
    """Run both stages on every view by itself.

    Args:
        observations: the views.
        centre: (2,) principal point, array frame, px.
    """
    return [
        estimate_view(
            observations.xy[k, corners := observations.corners_of(k), :2],
            observations.uv[k, corners] - centre,
        )
        for k in range(len(observations.uv))
    ]


def estimate_view(xyw: Array, XYd: Array) -> ViewEstimate:
    """Run both stages on one view.

    Args:
        xyw: (n, 2) corners on the board, mm.
        XYd: (n, 2) measured corners from the principal point, px.

    Returns:
        An estimate whose f is NaN if the view has too few corners or no positive f and Tz.
    """
    if len(xyw) < _MIN_CORNERS:
        return ViewEstimate(np.nan, np.nan, np.eye(3), np.full(3, np.nan))
    origin = xyw[np.argmax(np.abs(XYd[:, 1]))]
    R, Tx, Ty = solve_stage_one(xyw - origin, XYd)
    f, Tz, kappa1, R = _solve_stage_two(R, Tx, Ty, xyw - origin, XYd)
    return ViewEstimate(f, kappa1, R, np.array([Tx, Ty, Tz]) - R[:, :2] @ origin)


def solve_stage_one(xyw: Array, XYd: Array) -> tuple[Array, float, float]:
    """Solve the radial alignment constraint for R (3, 3), Tx and Ty, mm (stage 1).

    Args:
        xyw: (n, 2) corners on the board, mm, from an origin whose Ty is not 0.
        XYd: (n, 2) measured corners from the principal point, px.
    """
    (xw, yw), (Xd, Yd) = xyw.T, XYd.T
    A = np.stack([Yd * xw, Yd * yw, Yd, -Xd * xw, -Xd * yw], axis=1)
    size = np.maximum(np.linalg.norm(A, axis=0), np.finfo(float).tiny)
    r1, r2, Tx, r4, r5 = np.linalg.lstsq(A / size, Xd, rcond=None)[0] / size
    Sr, D = r1**2 + r2**2 + r4**2 + r5**2, r1 * r5 - r4 * r2
    Ty = np.sqrt(2 / (Sr + np.sqrt(max(Sr**2 - 4 * D**2, 0.0))))
    far = np.argmax(Xd**2 + Yd**2)
    x = r1 * xw[far] + r2 * yw[far] + Tx
    y = r4 * xw[far] + r5 * yw[far] + 1.0
    if x * Xd[far] + y * Yd[far] < 0:
        Ty = -Ty
    first, second = np.array([r1, r2]) * Ty, np.array([r4, r5]) * Ty
    r3 = np.sqrt(max(1 - first @ first, 0.0))
    r6 = np.sqrt(max(1 - second @ second, 0.0)) * (-1.0 if first @ second > 0 else 1.0)
    rows = np.array([[*first, r3], [*second, r6]])
    return np.vstack([rows, np.cross(*rows)]), float(Tx * Ty), float(Ty)


def _solve_stage_two(
    R: Array, Tx: float, Ty: float, xyw: Array, XYd: Array
) -> tuple[float, float, float, Array]:
    """Solve for f px, Tz mm and kappa1 px^-2, and return these with R of the right signs."""
    xy = xyw @ R[:2, :2].T + [Tx, Ty]
    w = xyw @ R[2, :2]
    unit = float(np.abs(XYd).max())
    d = XYd / unit
    A = np.stack([xy.ravel(), -d.ravel()], axis=1)
    f, Tz = np.linalg.lstsq(A, (w[:, None] * d).ravel(), rcond=None)[0].tolist()
    if f < 0:
        f, Tz, w = -f, -Tz, -w
        R = R * np.array([[1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]])
    f, Tz, kappa1 = _solve_with_distortion(xy, w, d, np.array([f, Tz, 0.0]))
    if not (f > 0 and (w + Tz > 0).all()):
        f = np.nan
    return f * unit, Tz, kappa1 / unit**2, R


def _solve_with_distortion(xy: Array, w: Array, d: Array, start: Array) -> tuple[float, ...]:
    """Solve for f, Tz and kappa1 by least squares, from the start (3,); NaN without one.

    The residuals have no value at a start that puts a corner into the plane of the camera.
    """
    square = np.sum(d**2, axis=1, keepdims=True)
    unit = np.maximum(np.abs(start), [1.0, np.abs(xy).max(), 1.0])

    def compute_residuals(scaled: Array) -> Array:
        f, Tz, kappa1 = scaled * unit
        return np.asarray(d * (1 + kappa1 * square) - f * xy / (w + Tz)[:, None]).ravel()

    def differentiate(scaled: Array) -> Array:
        f, Tz, _ = scaled * unit
        z = (w + Tz)[:, None]
        columns = [-xy / z, f * xy / z**2, d * square]
        return np.stack([column.ravel() for column in columns], axis=1) * unit

    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if not np.isfinite(compute_residuals(start / unit)).all():
            return np.nan, np.nan, np.nan
        found = scipy.optimize.least_squares(
            compute_residuals,
            start / unit,
            differentiate,
            method="lm",
            ftol=1e-15,
            xtol=1e-15,
            gtol=1e-15,
        )
    f, Tz, kappa1 = (found.x * unit).tolist()
    return f, Tz, kappa1


def _measure_information(view: ViewEstimate, f: float, xyw: Array, XYd: Array) -> Array:
    """Return (2, 2) what a view knows of f (as its logarithm) and kappa1, its pose unknown.

    Args:
        view: the estimate of the view.
        f: the focal length to measure it at, px, the same for all views; Tz changes with it.
        xyw: (n, 2) corners on the board, mm.
        XYd: (n, 2) measured corners from the principal point, px.
    """
    T = view.T * [1.0, 1.0, f / view.f]
    turned = xyw @ view.R[:, :2].T
    n, by_point = plane_from_rays(turned + T)
    by_motion = np.concatenate(
        [-make_cross_matrix(turned), np.broadcast_to(np.eye(3), (len(n), 3, 3))], axis=2
    )
    by_pose = -f * by_point @ by_motion
    by_camera = np.stack([-f * n, np.sum(XYd**2, axis=1, keepdims=True) * XYd], axis=2)
    by_pose = by_pose.reshape(-1, 6)
    Q = np.linalg.qr(by_pose / np.linalg.norm(by_pose, axis=0))[0]
    J = by_camera.reshape(-1, 2)
    J = J - Q @ (Q.T @ J)
    return np.asarray(J.T @ J)


def combine_views(
    views: list[ViewEstimate],
    observations: Observations,
    centre: Array,
    known: float | None = None,
) -> tuple[float, float]:
    """Combine the views' estimates into one f, px, and one kappa1, px^-2.

    Args:
        views: estimate of each view.
        observations: the views.
        centre: (2,) principal point, array frame, px.
        known: the focal length where it is known, px.

    Raises:
        StartError: if no view tells a focal length.
    """
    counted = [k for k, view in enumerate(views) if view.counts]
    if not counted:
        raise StartError(
            "The board is parallel to the sensor in all views, and Tsai's method finds no focal "
            "length from such.",
            "Add views with the board tilted by 30 degrees or more.",
        )
    median = float(np.median([views[k].f for k in counted]))
    total, weighted = np.zeros((2, 2)), np.zeros(2)
    for k in counted:
        corners = observations.corners_of(k)
        information = _measure_information(
            views[k], median, observations.xy[k, corners, :2], observations.uv[k, corners] - centre
        )
        total += information
        weighted += information @ [views[k].f / median, views[k].kappa1]
    if known is not None:
        kappa1 = (weighted[1] - total[1, 0] * known / median) / total[1, 1]
        return known, float(kappa1)
    size = 1 / np.sqrt(np.diag(total))
    ratio, kappa1 = size * np.linalg.solve(total * size * size[:, None], weighted * size)
    return float(ratio * median), float(kappa1)


def describe_scatter(views: list[ViewEstimate]) -> str:
    """Say how far the focal lengths of the single views scatter, and how many have none."""
    f = [view.f for view in views if view.counts]
    if len(f) < 2:
        return f"{len(f)} of {len(views)} views tells a focal length by itself."
    return (
        f"By themselves {len(f)} of {len(views)} views give focal lengths from {min(f):.5g} to "
        f"{max(f):.5g} px, with a standard deviation of {np.std(f, ddof=1):.2g} px."
    )


def _find_centre(problem: Problem, held: Mapping[str, float | None]) -> Array:
    """Return the middle of the image, or the held coordinates of the centre."""
    wanted = [held.get(name) for name in ("cx", "cy")]
    return np.array(
        [
            middle if value is None else value
            for middle, value in zip(frames.centre_of_array(problem.size), wanted, strict=True)
        ]
    )


def _start_from_radial_alignment(problem: Problem) -> Initialisation:
    """Make one camera from both stages of all views, with a remark on their scatter."""
    observations, held = problem.observations, problem.held
    centre = _find_centre(problem, held)
    views = estimate_views(observations, centre)
    f, kappa1 = combine_views(views, observations, centre, held.get("fx"))
    lens = find_model(problem.model)
    params = np.concatenate([[f, f], centre, [kappa1 * f**2], lens.defaults[1:]])
    nothing = np.empty((0, 3, 3)), np.empty((0, 3))
    camera = hold_parameters(State(params, *nothing), problem.model, held, {})
    poses = estimate_poses(Camera(problem.size, camera.state.params, problem.model), observations)
    if not np.isfinite(poses.R).all():
        raise StartError(
            "The lens that Tsai's method finds does not see all corners.",
            "Leave out views that are hard to see, or choose another method.",
        )
    return Initialisation(poses, camera.held, (describe_scatter(views),))


def initialise_from_radial_alignment(problem: Problem) -> Initialisation:
    """Make one camera as a start, on whose views nothing is remarked.

    Raises:
        StartError: if no view tells a focal length.
    """
    return _start_from_radial_alignment(problem)._replace(remarks=())


def _initialise_closed_form(problem: Problem) -> Initialisation:
    """Make one camera whose fy is fx and whose centre is held.

    A value that is wanted for fy does not count: it follows fx, which may be held.

    Raises:
        CalibrationError: if a parameter is to be estimated that the closed form does not give.
        StartError: if no view tells a focal length.
    """
    freed = [name for name in _TIED if name not in problem.held]
    if freed:
        raise CalibrationError(
            f"The method 'tsai-closed-form' cannot estimate {', '.join(freed)}.",
            "Use the method 'tsai', which refines its result.",
        )
    held = {name: value for name, value in problem.held.items() if name != "fy"}
    found = _start_from_radial_alignment(replace(problem, held=held))
    return found._replace(held={**found.held, "fy": float(found.state.params[1])})


TSAI_CLOSED_FORM = Method(
    name="tsai-closed-form",
    label="Tsai, closed form",
    title="Tsai: radial alignment constraint, closed form",
    source=_SOURCE,
    limits="It takes square pixels and a centre in the middle of the image, which a flat board "
    "cannot tell it, and needs views tilted by 30 degrees or more.",
    lens_models=("lucchese",),
    initialise=_initialise_closed_form,
    refine=keep_start,
    held=_TIED,
    is_minimum=False,
)
"""Both stages of every view, and one camera for all views."""
TSAI = replace(
    TSAI_CLOSED_FORM,
    name="tsai",
    label="Tsai",
    title="Tsai: radial alignment constraint, then all parameters",
    limits="Its lens has one radial coefficient, and its start needs views tilted by 30 degrees or "
    "more.",
    initialise=initialise_from_radial_alignment,
    refine=refine_by_bundle_adjustment,
    held=_HELD_COEFFICIENTS,
    is_minimum=True,
)
"""The closed form, refined over all views."""
