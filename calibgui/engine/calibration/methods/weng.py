"""Weng, Cohen and Herniou's two steps (1992): without distortion first, then turn by turn.

The paper divides the unknowns into two: m, the external and internal parameters of the camera (here
fx, fy, cx, cy and the poses), and d = (k1, g1, g2, g3, g4), the distortion. The residual is linear
in d for a given m, but not in m. Moved together from a poor start they can lead into a false
minimum, the one making up for the other; so the paper

1. finds m in closed form with d = 0,
2. and takes turns until nothing changes:
   (a) d by linear least squares with m held,
   (b) m by non-linear least squares of the residuals in the image with d held.

Its distortion joins the radial, the decentering and the thin-prism terms,

    du = (g1 + g3) u^2 + g4 u v + g1 v^2 + k1 u (u^2 + v^2),
    dv = g2 u^2 + g3 u v + (g2 + g4) v^2 + k1 v (u^2 + v^2),

with g1 = s1 + p1, g2 = s2 + p2, g3 = 2 p1, g4 = 2 p2 of the paper's p and s. With the letters of
our lens model `thin-prism`, which are OpenCV's, where p1 and p2 are the other way round,

    g1 = p2 + s1,    g2 = p1 + s3,    g3 = 2 p2,    g4 = 2 p1,

and k2, k3, k4, k5, k6, s2, s4 and the skew are 0.

Two things are not as in the paper. It puts the measured point in place of (u, v), because that is
what can be observed; the lens model takes the ideal one. Both agree to the first order of the
distortion: coefficients differ by about their own products. And its closed form wants a target with
depth, of which it takes the points in the middle of the image; a flat board in several views starts
from its homographies instead (``bouguet.py``), with all corners.

Turns (``alternation.py``) take long here, as m can do much of what d does: p1 with s3, and p2 with
s1, nearly rotate the camera and shift its centre (``thin_prism.py``). A target with depth ties down
the rotation better than flat boards do. With the centre free, hundreds to thousands of turns are
usual, and hundreds with the centre held.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.calibration.methods.alternation import (
    refine_by_alternation,
    remark_unfinished_alternation,
)
from calibgui.engine.calibration.methods.bouguet import initialise_from_vanishing_points
from calibgui.engine.calibration.methods.method import Method
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.residuals import State, build_stage_two
from calibgui.engine.calibration.result import Calibration, Cost
from calibgui.engine.camera.models import list_parameter_names

_MODEL = "thin-prism"
_LINEAR = ("k1", "k2", "k3", "p1", "p2", "s1", "s2", "s3", "s4")
"""Coefficients that the residual is linear in; the paper has k1, p1, p2, s1, s3."""
_HELD = ("k2", "k3", "k4", "k5", "k6", "s2", "s4", "skew")
"""Parameters of the lens model that the paper does not have."""


def solve_distortion(state: State, observations: Observations, linear: IntArray) -> State:
    """Solve for coefficients of the distortion under the camera and poses of a state.

    Args:
        state: camera and poses.
        observations: the views.
        linear: indices of the coefficients, in which the residual is linear: one step of Gauss and
            Newton reaches their least squares from anywhere.
    """
    normal = build_stage_two(observations, _MODEL, Cost.IMAGE, 1.0, linear)(state)
    unit = 1 / np.sqrt(np.maximum(np.diag(normal.U), np.finfo(float).tiny))
    scaled = normal.U * unit * unit[:, None]
    step = -unit * np.linalg.lstsq(scaled, unit * normal.shared, rcond=None)[0]
    return state.take_step(step, np.zeros_like(normal.pose), linear)


def make_map_to_paper() -> Array:
    """Make the matrix (4, P) that takes a camera's parameters to g1, g2, g3 and g4."""
    names = list_parameter_names(_MODEL)
    p1, p2, s1, s3 = (names.index(name) for name in ("p1", "p2", "s1", "s3"))
    g_from_params = np.zeros((4, len(names)))
    g_from_params[0, [p2, s1]] = g_from_params[1, [p1, s3]] = 1.0
    g_from_params[2, p2] = g_from_params[3, p1] = 2.0
    return g_from_params


def _list_remarks(calibration: Calibration) -> tuple[str, ...]:
    """Return g1 to g4 of the paper, and whether the turns had not come to their end."""
    g_from_params = make_map_to_paper()
    g = g_from_params @ calibration.camera.params
    sigma = np.sqrt(np.diag(g_from_params @ calibration.covariance @ g_from_params.T))
    listed = ", ".join(
        f"g{i} = {value:.3g} ± {width:.2g}"
        for i, (value, width) in enumerate(zip(g, sigma, strict=True), 1)
    )
    return (f"In the paper's coefficients: {listed}.", *remark_unfinished_alternation(calibration))


WENG = Method(
    name="weng",
    label="Weng et al.",
    title="Weng, Cohen and Herniou: distortion and all else turn by turn",
    source="J. Weng, P. Cohen, M. Herniou, Camera calibration with distortion models and accuracy "
    "evaluation, IEEE Transactions on Pattern Analysis and Machine Intelligence 14 (1992) 965-980",
    limits="It comes to the minimum slowly, and its distortion acts on the ideal point where the "
    "paper's acts on the measured one, so that coefficients differ in the second order.",
    lens_models=(_MODEL,),
    initialise=initialise_from_vanishing_points,
    refine=partial(refine_by_alternation, solve_distortion, _LINEAR, distortion_first=True),
    held=_HELD,
    list_remarks=_list_remarks,
)
"""The method."""
