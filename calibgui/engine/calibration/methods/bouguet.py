"""The formulation of Bouguet's Camera Calibration Toolbox for Matlab.

Each view's homography, with the principal point in the middle of the image and no distortion,
has two orthogonal directions of equal length in its first two columns; the vanishing points of
these and of the diagonals between them give two equations in 1/fx^2 and 1/fy^2 a view
(``init_intrinsic_param.m`` of the toolbox; they are those of ``initialisation/closed_form.py``).
Then the reprojection error of all corners, which count alike, is minimised over

    u = cx + fx (xd + alpha_c yd),      v = cy + fy yd,

with Brown-Conrady's distortion k1, k2, p1, p2 of the ideal point, and k3 where it is wanted. The
toolbox counts pixels from 0 at pixel centres, as we do, and calls the columns ``kc`` = (k1, k2, p1,
p2, k3). It prints plus or minus three standard deviations, where everybody else prints one.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Size
from calibgui.engine.calibration.initialisation import closed_form, focal_sweep
from calibgui.engine.calibration.methods.method import (
    Initialisation,
    Method,
    Problem,
    hold_parameters,
    refine_by_bundle_adjustment,
)
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.models import find_model
from calibgui.engine.geometry import frames
from calibgui.engine.geometry.planar_pose import poses_from_homographies

_SOURCE = (
    "J.-Y. Bouguet, Camera Calibration Toolbox for Matlab, California Institute of Technology "
    "(1999-2015)"
)


def start_from_vanishing_points(observations: Observations, size: Size, model: str) -> State:
    """Start from focal lengths in closed form, a centre in the middle of the image, no distortion.

    Args:
        observations: the views.
        size: width and height of the images, px.
        model: the lens model, whose coefficients begin at their defaults.

    Raises:
        StartError: if no focal length explains the views.
    """
    centre, k1 = frames.centre_of_array(size), 0.0
    M = closed_form.fit_homographies(observations, centre, k1)
    f = closed_form.estimate_focal_lengths(M, size)
    if f is None:
        known = np.array([np.nan, np.nan, *centre])
        f, centre, k1 = focal_sweep.sweep_focal_lengths(observations, centre, k1, size, known)
        M = closed_form.fit_homographies(observations, centre, k1)
    R, T = poses_from_homographies(M, f, observations.xy[:, 0])
    return State(np.concatenate([f, centre, find_model(model).defaults]), R, T)


def initialise_from_vanishing_points(problem: Problem) -> Initialisation:
    """Make the toolbox's start; held parameters take their values, or those of the start."""
    start = start_from_vanishing_points(problem.observations, problem.size, problem.model)
    return hold_parameters(start, problem.model, problem.held, {})


def _list_remarks(calibration: Calibration) -> tuple[str, ...]:
    """Return what the toolbox would print after its values: three standard deviations."""
    three = 3 * calibration.sigma_by_noise
    printed = ", ".join(
        f"{name} ± {width:.3g}"
        for name, width in zip(calibration.camera.names, three, strict=True)
        if name not in calibration.fixed
    )
    return (f"The toolbox prints three standard deviations: {printed}.",)


def make_bouguet(skew: bool = False, k3: bool = False) -> Method:
    """Make the method with the toolbox's choices ``est_alpha`` and ``est_dist(5)``.

    Args:
        skew: True if the angle of the pixels' axes is estimated.
        k3: True if the radial term of the sixth power is estimated.
    """
    suffix = "-k3" * k3 + "-skew" * skew
    return Method(
        name=f"bouguet{suffix}",
        label="Bouguet" + ", k3" * k3 + ", skew" * skew,
        title="Bouguet's toolbox" + ", k3" * k3 + ", with skew" * skew,
        source=_SOURCE,
        limits="It takes all corners as equally good, and every board as flat.",
        lens_models=("brown-conrady" if k3 else "brown-conrady-4",),
        initialise=initialise_from_vanishing_points,
        refine=refine_by_bundle_adjustment,
        held=() if skew else ("skew",),
        list_remarks=_list_remarks,
    )


BOUGUET, BOUGUET_SKEW, BOUGUET_K3 = (
    make_bouguet(),
    make_bouguet(skew=True),
    make_bouguet(k3=True),
)
"""The method as the toolbox begins, with skew, and with k3."""
