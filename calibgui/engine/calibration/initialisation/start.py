"""From checked views to the start of Stage II: facing, Stage I, one camera, all poses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from calibgui.engine.arrays import Array, Size
from calibgui.engine.calibration.initialisation import closed_form, focal_sweep
from calibgui.engine.calibration.initialisation.stage_one import Prealignment
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.residuals import State
from calibgui.engine.camera.model import Lens
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import frames

_CENTRE = ((0, "cx"), (1, "cy"))
_SAMPLED = 500
"""Corners that are enough to fit one coefficient to."""


def in_paper_frame(
    observations: Observations, scale: float, size: Size, names: Sequence[str]
) -> tuple[Array, Array, Array]:
    """What Stage I registers: measured corners, reference corners x', y' and mask.

    Args:
        observations: the views.
        scale: reference px per mm.
        size: of the images, px.
        names: of the views, for messages.

    Returns:
        (K, N, 2) corners in the paper's frame, (K, N, 2) the same on the reference image,
        from the plate's centre and y up, (K, N) mask.

    Raises:
        CalibrationError: if some views show the board mirrored against the others.
    """
    sign = facing(observations)
    if not (sign == sign[0]).all():
        minority = sign != (1.0 if sign.sum() >= 0 else -1.0)
        listed = ", ".join(names[k] for k in np.flatnonzero(minority).tolist())
        raise CalibrationError(
            f"The board is mirrored against the other views in {listed}.",
            "Number their corners in the same turning sense, or undo the image's mirroring.",
        )
    return (
        frames.paper_from_array(observations.uv, size),
        reference_points(observations, scale, sign),
        observations.mask,
    )


def reference_points(observations: Observations, scale: float, sign: Array) -> Array:
    """(K, N, 2) corners on the reference image: from the plate's centre, y up, reference px.

    Args:
        observations: the views.
        scale: reference px per mm.
        sign: (K,) which way each view's plate faces, see `facing`.
    """
    # Padding repeats a corner and moves no limit.
    x, y = observations.xy[..., 0], observations.xy[..., 1]
    centre = np.array([x.min() + x.max(), y.min() + y.max()]) / 2
    up = np.stack([np.ones_like(sign), -sign], axis=1)
    return (observations.xy - centre) * (scale * up[:, None])


def start_of_stage_two(
    observations: Observations,
    first: Prealignment,
    size: Size,
    lens: Lens,
    names: tuple[str, ...],
    held: Mapping[str, float | None],
) -> tuple[State, dict[str, float]]:
    """The closed-form start of Stage II, and the held parameters with their values.

    Args:
        observations: the views.
        first: their Stage I.
        size: of the images, px.
        lens: the lens model.
        names: of the camera's parameters.
        held: names to hold, with a value or None for the default.
    """
    centre, k1 = closed_form.initial_lens(first, size)
    array_centre = frames.centre_of_array(size)
    for i, name in _CENTRE:
        if name in held:
            value = held[name]
            centre[i] = array_centre[i] if value is None else value
    f = np.array([held.get(name) or np.nan for name in ("fx", "fy")], dtype=np.float64)
    M = closed_form.homographies(observations, centre, k1)
    if np.isnan(f).any():
        found = closed_form.focal_lengths(M, size)
        if found is None:
            known = np.append(f, [centre[i] if name in held else np.nan for i, name in _CENTRE])
            found, centre, k1 = focal_sweep.climbed(observations, centre, k1, size, known)
            M = closed_form.homographies(observations, centre, k1)
        f = np.where(np.isnan(f), found, f)
    R, T = closed_form.poses(M, f, observations)
    params = np.concatenate(
        [f, centre, _coefficients(lens, (observations.uv - centre) / f, k1 * f[0] ** 2)]
    )
    values: dict[str, float] = {}
    for i, name in enumerate(names):
        if name in held:
            value = held[name]
            values[name] = float(params[i] if i < 4 else 0.0) if value is None else float(value)
            params[i] = values[name]
    return State(params, R, T), values


def facing(observations: Observations) -> Array:
    """(K,) +1 where the plate's Y runs down in the image as v does, -1 where it runs up."""
    weight = observations.mask[:, None] / observations.mask.sum(axis=1)[:, None, None]
    board_shape, image = observations.xy[..., :2], observations.uv
    moments = np.swapaxes(board_shape * np.swapaxes(weight, 1, 2), 1, 2) @ image
    covariance = moments - np.swapaxes(weight @ board_shape, 1, 2) * (weight @ image)
    # A camera turns all triangles of corners alike, and by Cauchy and Binet's formula the
    # determinant is the sum over all of them of the product of both areas.
    return np.asarray(np.sign(np.linalg.det(covariance)))


def _coefficients(lens: Lens, d: Array, k1: float) -> Array:
    """Coefficients of any lens model that approximate the correction n = d (1 + k1 r2).

    To first order in the coefficients, correct(d, k) = d + (d correct / dk) k; the first
    coefficient alone is fitted, which for the paper's model is k1 itself.
    """
    d = d.reshape(-1, 2)
    d = d[:: max(1, len(d) // _SAMPLED)]
    radial = np.sum(d**2, axis=1, keepdims=True) * d
    k = np.zeros(len(lens.names))
    slope = lens.correct(d, k).by_coefficients[..., 0]
    k[0] = k1 * np.sum(slope * radial) / np.sum(slope**2)
    return k
