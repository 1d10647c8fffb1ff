"""Zhang's method: a closed form from homographies, then maximum likelihood.

Z. Zhang, A flexible new technique for camera calibration, IEEE Transactions on Pattern Analysis and
Machine Intelligence 22 (2000) 1330-1334, and Technical Report MSR-TR-98-71, Microsoft Research
(1998). In his symbols a point (X, Y) of the board is imaged at (u, v) by

    s [u v 1]^T = A [r1 r2 t] [X Y 1]^T,      A = [alpha gamma u0; 0 beta v0; 0 0 1]       (eq. 2)

without distortion. Our words for it: alpha = fx, beta = fy, (u0, v0) = (cx, cy), gamma = fx skew,
and [r1 r2 t] is the pose. With (x, y) = (Xc / Zc, Yc / Zc) and r^2 = x^2 + y^2, the lens moves the
ideal pixel (u, v) to

    u + (u - u0) (k1 r^2 + k2 r^4),      v + (v - v0) (k1 r^2 + k2 r^4).                (eq. 11, 12)

As (u - u0, v - v0) = (alpha x + gamma y, beta y), this is A applied to (x, y) times
1 + k1 r^2 + k2 r^4: the lens model "brown-conrady-4" with p1 = p2 = 0, and the same k1 and k2.

**Closed form** (3.1). The homography of a view is H = [h1 h2 h3] ~ A [r1 r2 t]. It is the one of
least squared distances in the image (his appendix A; ``geometry/homography_refinement.py``). As r1
and r2 are orthogonal and of one length, with

    B = A^-T A^-1 = [B11 B12 B13; B12 B22 B23; B13 B23 B33]                                (eq. 5)

    h1^T B h2 = 0,      h1^T B h1 = h2^T B h2.                                          (eq. 3, 4)

In b = (B11, B12, B22, B13, B23, B33) (eq. 6) both are linear: hi^T B hj = vij^T b (eq. 7) with

    vij = (hi1 hj1, hi1 hj2 + hi2 hj1, hi2 hj2, hi3 hj1 + hi1 hj3, hi3 hj2 + hi2 hj3, hi3 hj3),

so that v12^T b = 0 and (v11 - v22)^T b = 0 (eq. 8) in all views make V b = 0 (eq. 9). He takes the
right singular vector of V to the least singular value, which makes |V b| least for |b| = 1. In
pixels, all entries of b but B33 are below 1e-2, so that this says little else than B33 = 1, but the
columns of V differ by the square of the image's width, which costs digits. Here B33 is 1, and image
coordinates are divided by the width, which then changes nothing but rounding errors. For
homographies of unit last entry the least-squares solution (by SVD) has all digits of his table 1:
877.16, 876.80, 301.04, 220.41 and gamma 0.1752 from the five views of his data. It is B up to a
scale lambda, and

    v0 = (B12 B13 - B11 B23) / (B11 B22 - B12^2)
    lambda = B33 - (B13^2 + v0 (B12 B13 - B11 B23)) / B11
    alpha = sqrt(lambda / B11)
    beta = sqrt(lambda B11 / (B11 B22 - B12^2))
    gamma = -B12 alpha^2 beta / lambda
    u0 = gamma v0 / beta - B13 alpha^2 / lambda                                      (appendix B)

follow from eq. 5, if B is positive definite. Two views leave gamma open, for which he takes 0, so
that B12 = 0. One view leaves the centre open too, for which he takes the image's; counted from
there, B13 = B23 = 0. The poses are

    r1 = A^-1 h1 / |A^-1 h1|,      r2 = A^-1 h2 / |A^-1 h1|,      t = A^-1 h3 / |A^-1 h1|

with the rotation closest to [r1 r2 r1 x r2] (appendix C; ``geometry.planar_pose``, which takes the
geometric mean of |A^-1 h1| and |A^-1 h2|, equal but for noise). It minimises no error in the image,
and its lens is ideal.

**Maximum likelihood** (3.3) minimises the distances of all corners from their predictions, over A,
the poses, k1 and k2 (eq. 14), from the closed form with k1 = k2 = 0.

**Alternation** (3.3) first minimises the same without distortion (eq. 10). Then k = (k1, k2)
follows from all corners by linear least squares: with (u, v) ideal and (u', v') measured,

    [(u - u0) r^2  (u - u0) r^4]       [u' - u]
    [(v - v0) r^2  (v - v0) r^4]  k =  [v' - v],      D k = d,      k = (D^T D)^-1 D^T d;  (eq. 13)

A and the poses are refined by eq. 10 with this k, and so on in turns until convergence, which is at
the minimum that maximum likelihood finds (``alternation.py``). He found it slow, and it is.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, IntArray
from calibgui.engine.calibration.methods.alternation import (
    refine_by_alternation,
    remark_unfinished_alternation,
)
from calibgui.engine.calibration.methods.method import (
    Initialisation,
    Method,
    Problem,
    check_ideal_lens,
    hold_parameters,
    keep_start,
    refine_by_bundle_adjustment,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement import residuals
from calibgui.engine.calibration.refinement.levenberg_marquardt import StartError
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.models import list_parameter_names
from calibgui.engine.geometry import frames
from calibgui.engine.geometry.homography import apply_homography
from calibgui.engine.geometry.homography_refinement import fit_closest_homography
from calibgui.engine.geometry.planar_pose import poses_from_homographies

_MODEL = "brown-conrady-4"
_K1, _SKEW = list_parameter_names(_MODEL).index("k1"), list_parameter_names(_MODEL).index("skew")
_DISTORTION = ("k1", "k2", "p1", "p2")


def solve_for_intrinsics(H: Array, unknown: BoolArray) -> Array | None:
    """Solve V b = 0 for A (3, 3) (eq. 5-9, appendix B).

    Args:
        H: (K, 3, 3) homographies from the board to the image, of unit last entry; they should lead
            to coordinates of the order of 1.
        unknown: (5,) false for those of B11, B12, B22, B13, B23 that are 0.

    Returns:
        None if B is not positive definite, so that no camera makes these homographies.
    """
    h1, h2, _ = np.moveaxis(H, 2, 0)
    V = np.concatenate([_multiply_out(h1, h2), _multiply_out(h1, h1) - _multiply_out(h2, h2)])
    b = np.zeros(5)
    b[unknown] = np.linalg.lstsq(V[:, :5][:, unknown], -V[:, 5], rcond=None)[0]
    (B11, B12, B22, B13, B23), B33 = b, 1.0
    minor = B11 * B22 - B12**2
    if not (B11 > 0 and minor > 0):
        return None
    v0 = (B12 * B13 - B11 * B23) / minor
    scale_of_b = B33 - (B13**2 + v0 * (B12 * B13 - B11 * B23)) / B11  # lambda
    if not scale_of_b > 0:
        return None
    alpha, beta = np.sqrt(scale_of_b / B11), np.sqrt(scale_of_b * B11 / minor)
    gamma = -B12 * alpha**2 * beta / scale_of_b
    u0 = gamma * v0 / beta - B13 * alpha**2 / scale_of_b
    return np.array([[alpha, gamma, u0], [0.0, beta, v0], [0.0, 0.0, 1.0]])


def _multiply_out(hi: Array, hj: Array) -> Array:
    """Return vij (K, 6), for which hi^T B hj = vij^T b (eq. 7)."""
    (i1, i2, i3), (j1, j2, j3) = hi.T, hj.T
    return np.stack(
        [i1 * j1, i1 * j2 + i2 * j1, i2 * j2, i3 * j1 + i1 * j3, i3 * j2 + i2 * j3, i3 * j3], axis=1
    )


def initialise_in_closed_form(problem: Problem) -> Initialisation:
    """Make camera and poses in closed form (3.1), with an ideal lens.

    A skew that is held makes gamma = 0 a constraint of the closed form; every other parameter that
    is held takes its value afterwards, and the poses are those under it.

    Raises:
        StartError: if no camera makes the views' homographies.
    """
    views, width = len(problem.observations.uv), problem.size[0]
    held = {**dict.fromkeys(_list_parameters_left_open(views)), **problem.held}
    cx, cy = frames.centre_of_array(problem.size).tolist()
    origin = np.zeros(2) if views > 1 else np.array([cx, cy])
    N = np.array([[1, 0, -origin[0]], [0, 1, -origin[1]], [0, 0, width]]) / width
    image = apply_homography(N, problem.observations.uv)
    H = fit_closest_homography(problem.observations.xy, image, problem.observations.mask)
    A = solve_for_intrinsics(H, np.array([True, "skew" not in held, True, views > 1, views > 1]))
    if A is None:
        raise StartError(
            "Zhang's closed form finds no camera: its matrix B is not positive definite.",
            "Add views with the board tilted by 20 to 45 degrees in different directions, or "
            "choose the method 'lucchese', which starts from views that are nearly parallel.",
        )
    alpha, gamma, u0, _, beta, v0 = (np.linalg.inv(N) @ A)[:2].ravel()
    params = np.array([alpha, beta, u0, v0, 0.0, 0.0, 0.0, 0.0, gamma / alpha])
    defaults = {"cx": cx, "cy": cy, "skew": 0.0}
    pending = State(params, np.zeros((0, 3, 3)), np.zeros((0, 3)))  # held values move the poses
    values = hold_parameters(pending, problem.model, held, defaults).held
    G = np.linalg.inv(N @ _make_matrix(params)) @ H
    R, T = poses_from_homographies(G, np.ones(2), problem.observations.xy[:, 0])
    return Initialisation(State(params, R, T), values)


def _list_parameters_left_open(views: int) -> tuple[str, ...]:
    """Return the names of the parameters that so many views leave open (3.1)."""
    return {1: ("skew", "cx", "cy"), 2: ("skew",)}.get(views, ())


def _make_matrix(params: Array) -> Array:
    """Return A (3, 3) of a camera's parameters."""
    fx, fy, cx, cy = params[:4]
    return np.array([[fx, fx * params[_SKEW], cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])


def _initialise_ideal_lens(problem: Problem) -> Initialisation:
    """Make camera and poses in closed form, and refuse a lens that is not ideal.

    Raises:
        CalibrationError: if a coefficient of the distortion is to be estimated, or is not 0.
        StartError: as `initialise_in_closed_form`.
    """
    check_ideal_lens(problem, "Zhang's closed form", _DISTORTION)
    return initialise_in_closed_form(problem)


def estimate_radial_terms(state: State, observations: Observations, terms: IntArray) -> State:
    """Estimate k1 and k2 by linear least squares under the camera and poses of a state (eq. 13).

    Args:
        state: camera and poses.
        observations: the views.
        terms: indices of those of k1 and k2 that are estimated; the others keep their values.
    """
    A, params = _make_matrix(state.params), state.params.copy()
    point = residuals.place_points(state, observations.xy)[1]
    xy = point[..., :2] / point[..., 2:]
    ideal = xy @ A[:2, :2].T  # (u - u0, v - v0)
    r2 = np.sum(xy**2, axis=-1, keepdims=True)
    seen = observations.mask > 0
    D = np.stack([ideal * r2, ideal * r2**2], axis=-1)[seen].reshape(-1, 2)
    # What the current k leaves, so that decentering, where it is free, stays accounted for.
    miss = residuals.compute_misses(state, observations, _MODEL, Cost.IMAGE)
    params[terms] += np.linalg.lstsq(D[:, terms - _K1], miss[seen].ravel(), rcond=None)[0]
    return state._replace(params=params)


def _list_remarks(calibration: Calibration) -> tuple[str, ...]:
    """Return gamma in pixels as he prints it, and what few views left open."""
    params = calibration.camera.params
    remarks = []
    if "skew" not in calibration.fixed:
        by_params = np.zeros(len(params))
        by_params[[0, _SKEW]] = params[_SKEW], params[0]
        sigma = np.sqrt(by_params @ calibration.covariance @ by_params)
        remarks.append(
            f"In Zhang's terms the skew is gamma = fx skew = {params[0] * params[_SKEW]:.4g} px "
            f"± {sigma:.2g} px."
        )
    views = len(calibration.poses)
    if lost := _list_parameters_left_open(views):
        remarks.append(
            f"{'One view leaves' if views == 1 else 'Two views leave'} {', '.join(lost)} open: "
            "Zhang takes 0 for the skew, and for the centre that of the image."
        )
    return tuple(remarks)


def _list_remarks_on_alternation(calibration: Calibration) -> tuple[str, ...]:
    """Return the same, and whether the turns had not come to their end."""
    return (*_list_remarks(calibration), *remark_unfinished_alternation(calibration))


ZHANG = Method(
    name="zhang",
    label="Zhang",
    title="Zhang: maximum likelihood with skew and two radial terms",
    source="Z. Zhang, A flexible new technique for camera calibration, IEEE Transactions on "
    "Pattern Analysis and Machine Intelligence 22 (2000) 1330-1334",
    limits="It has no decentering, takes all corners as equally good, and needs three views to "
    "tell the skew.",
    lens_models=(_MODEL,),
    initialise=initialise_in_closed_form,
    refine=refine_by_bundle_adjustment,
    held=("p1", "p2"),
    list_remarks=_list_remarks,
)
"""Complete maximum likelihood (eq. 14)."""
ZHANG_CLOSED_FORM = replace(
    ZHANG,
    name="zhang-closed-form",
    label="Zhang, closed form",
    title="Zhang: the closed form alone",
    limits="It has no distortion, so that a real lens shifts all of its values, minimises no error "
    "in the image, and needs three views to tell the skew.",
    initialise=_initialise_ideal_lens,
    refine=keep_start,
    held=_DISTORTION,
    is_minimum=False,
)
"""The closed form (3.1)."""
ZHANG_ALTERNATION = replace(
    ZHANG,
    name="zhang-alternation",
    label="Zhang, in turns",
    title="Zhang: camera and radial terms in turns",
    limits="It comes to the minimum of the method 'zhang' slowly, and needs three views to tell "
    "the skew.",
    refine=partial(refine_by_alternation, estimate_radial_terms, ("k1", "k2")),
    list_remarks=_list_remarks_on_alternation,
)
"""The alternation (3.3)."""
