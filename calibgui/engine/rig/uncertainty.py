"""The covariances of a rig's parameters tell how far it is to be trusted.

Corners' noise alone gives sigma^2 S^-1 (``calibration/refinement/covariances.py``), with the
board's pose at every instant eliminated. It holds if the errors of an instant's corners are
independent, which they are not where two photographs were not taken at the same moment, or the
board bends in the hand: all corners of the instant then pull together. How much the instants
disagree is measured as that of one camera's views is (``calibration/overdispersion.py``), and the
covariance clustered by instants takes the place of the noise's where it is larger.

An error that all instants share, such as that of the side of a square, is not in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import slice_views
from calibgui.engine.calibration.overdispersion import measure_disagreement, reduce_products
from calibgui.engine.calibration.refinement.covariances import measure_precision
from calibgui.engine.calibration.refinement.levenberg_marquardt import Solution
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.camera.models import list_parameter_names
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig.joint_solve import RigProblem, compute_instant_products

_POSE_NAMES = ("pose", "pose", "pose", "place", "place", "place", "offset in time")


class RigCovariance(NamedTuple):
    """The covariances of a rig."""

    covariance: Array
    """(n, n) of all parameters, in the order of the layout."""
    noise_covariance: Array
    """(n, n) the same from the corners' noise alone."""
    noise: float
    """Standard deviation of one coordinate of a residual, px."""
    disagreement: float
    """See ``Rig.disagreement``."""


def estimate_rig_covariance(
    problem: RigProblem, solution: Solution, names: Sequence[str]
) -> RigCovariance:
    """Estimate the covariances of a rig.

    Args:
        problem, solution: the joint solve.
        names: names of the cameras, for messages.

    Raises:
        CalibrationError: if the views leave a parameter open; the message names it.
    """
    unknown = _name_unknowns(problem, names)
    tolerated = np.full(len(unknown), np.inf)
    precision = measure_precision(solution.normal, unknown, problem.corners, tolerated)
    if precision.undetermined:
        listed = ", ".join(dict.fromkeys(each.name for each in precision.undetermined))
        raise CalibrationError(
            f"The views leave open: {listed}.",
            "Give each camera as an earlier calibration has it and hold it, or take pictures with "
            "the board tilted in different directions.",
        )
    R, h = _reduce_instants(problem, solution.state)
    freedom = 2 * problem.corners - len(unknown) - 6 * problem.count
    added, ratio = measure_disagreement(R, h, precision.shared, precision.variance, freedom)
    return RigCovariance(
        _spread(problem, precision.shared + added),
        _spread(problem, precision.shared),
        float(np.sqrt(precision.variance)),
        ratio,
    )


def _reduce_instants(problem: RigProblem, state: State) -> tuple[Array, Array]:
    """Compute the information (N, n, n) and the pull (N, n) of each instant on the shared unknowns,
    the board's pose eliminated."""
    n = len(problem.free)
    R, h = np.empty((problem.count, n, n)), np.empty((problem.count, n))
    for part in slice_views(problem.count):
        products = compute_instant_products(problem, state, np.arange(part.start, part.stop))
        R[part], h[part], _ = reduce_products(products, n)
    return R, h


def _name_unknowns(problem: RigProblem, names: Sequence[str]) -> tuple[str, ...]:
    """Name the unknowns that instants share, as "fx of left"."""
    named: list[str] = []
    for name, camera in zip(names, problem.cameras, strict=True):
        own = list_parameter_names(camera.model)
        named += [f"{own[i]} of {name}" for i in camera.free]
        named += [f"{_POSE_NAMES[i]} of {name}" for i in camera.unknown]
    return tuple(named)


def _spread(problem: RigProblem, covariance: Array) -> Array:
    """Return a covariance of the unknowns among all parameters of the layout, 0 for held ones."""
    whole = np.zeros((problem.layout.size, problem.layout.size))
    whole[np.ix_(problem.free, problem.free)] = covariance
    return whole
