"""The start of Stage II from checked views: the side they face, one camera and all poses.

Stage I (``stage_one.py``) works in the paper's y-up frame on the reference plane; this module
brings the corners there, and joins Stage I, the closed form and, where that fails, the focal sweep
into the first state of the joint registration.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation import closed_form, focal_sweep
from calibgui.engine.calibration.initialisation.stage_one import StageOneRegistration
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.camera.model import Lens
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import frames
from calibgui.engine.geometry.planar_pose import poses_from_homographies

_CENTRE = ((0, "cx"), (1, "cy"))
_MAX_CORNERS = 500
"""Number of corners, spread evenly over all, that the start's one coefficient is fitted to."""


def convert_to_paper_frame(
    observations: Observations, scale: float, size: Size, names: Sequence[str]
) -> tuple[Array, Array, Array]:
    """Return the arguments of Stage I: measured corners, reference corners x', y' and mask.

    Args:
        observations: the views.
        scale: reference px per mm.
        size: of the images, px.
        names: of the views, for messages.

    Returns:
        (K, N, 2) corners in the paper's frame, (K, N, 2) the same on the reference image,
        from the board's centre and y up, (K, N) mask.

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
    centre = np.array([x.min() + x.max(), y.min() + y.max()]) / 2
    up = np.stack([np.ones_like(sign), -sign], axis=1)
    return (observations.xy - centre) * (scale * up[:, None])


def initialise_stage_two(
    observations: Observations,
    first: StageOneRegistration,
    size: Size,
    lens: Lens,
    names: tuple[str, ...],
    held: Mapping[str, float | None],
) -> tuple[State, dict[str, float]]:
    """Return the closed-form start of Stage II, and the held parameters with their values.

    Args:
        observations: the views.
        first: Stage I of the views.
        size: width and height of the images, px.
        lens: the lens model.
        names: names of the camera's parameters.
        held: names to hold, with a value or None for the default.
    """
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
    params = np.concatenate(
        [f, centre, _fit_first_coefficient(lens, (observations.uv - centre) / f, k1 * f[0] ** 2)]
    )
    values: dict[str, float] = {}
    for i, name in enumerate(names):
        if name in held:
            value = held[name]
            values[name] = float(params[i] if i < 4 else 0.0) if value is None else float(value)
            params[i] = values[name]
    return State(params, R, T), values


def find_facing(observations: Observations) -> Array:
    """Return (K,) +1 if the board's Y runs down in the image as v does, -1 if it runs up."""
    weight = observations.mask[:, None] / observations.mask.sum(axis=1)[:, None, None]
    board, image = observations.xy[..., :2], observations.uv
    moments = np.swapaxes(board * np.swapaxes(weight, 1, 2), 1, 2) @ image
    covariance = moments - np.swapaxes(weight @ board, 1, 2) * (weight @ image)
    # A camera turns all triangles of corners alike, and by Cauchy and Binet's formula the
    # determinant is the sum over all of them of the product of both areas.
    return np.asarray(np.sign(np.linalg.det(covariance)))


def _fit_first_coefficient(lens: Lens, d: Array, k1: float) -> Array:
    """Return coefficients of any lens model that approximate the correction n = d (1 + k1 r2).

    To first order in the coefficients, correct(d, k) = d + (d correct / dk) k; the first
    coefficient alone is fitted, which for the paper's model is k1 itself.
    """
    d = d.reshape(-1, 2)
    d = d[:: max(1, len(d) // _MAX_CORNERS)]
    radial = np.sum(d**2, axis=1, keepdims=True) * d
    k = np.zeros(len(lens.names))
    slope = lens.correct(d, k).by_coefficients[..., 0]
    k[0] = k1 * np.sum(slope * radial) / np.sum(slope**2)
    return k
