"""The whole calibration: Stage I, closed-form start, Stage II, uncertainty, diagnosis."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from calibgui.engine import closed_form, cosines, frames, homography, uncertainty
from calibgui.engine.degeneracy import diagnose
from calibgui.engine.errors import CalibrationError, DegenerateError
from calibgui.engine.lens import MODELS, Lens
from calibgui.engine.levenberg_marquardt import Solution, minimise
from calibgui.engine.observations import REFERENCE_PITCH, Observations, pack, pitch, view_names
from calibgui.engine.problem import stage_two
from calibgui.engine.stage_one import Prealignment, prealign
from calibgui.engine.stage_two import State, predicted_corners, reference_residual
from calibgui.engine.types import (
    Array,
    Calibration,
    Camera,
    Cost,
    IntArray,
    Observation,
    Pose,
    Report,
    Size,
    StageOne,
    ViewResiduals,
)

HELD = {"lucchese": ("p3",)}
"""Coefficients held at 0 unless freed: p3 multiplies p1 and p2 and is rarely determined."""


def parameter_names(model: str) -> tuple[str, ...]:
    """Names of a camera's parameters, in the order of ``Camera.params``."""
    return ("fx", "fy", "cx", "cy", *MODELS[model].names)


def calibrate(
    views: Sequence[Observation | tuple[Array, Array]],
    size: Size,
    *,
    cost: Cost | str = Cost.IMAGE,
    fix: Mapping[str, float | None] | Iterable[str] = (),
    free: Iterable[str] = (),
    model: str = "lucchese",
    report: Report | None = None,
    max_iterations: int = 100,
    names: Sequence[str] | None = None,
) -> Calibration:
    """Calibrate a camera from views of a flat target.

    Args:
        views: per view the measured corners uv (n, 2) px in the array frame, the same
            corners on the plate xy (n, 2) mm, and optionally their covariances (n, 2, 2).
            Views may show different parts of the target.
        size: width and height of the images, px.
        cost: what Stage II minimises, see `Cost`. `Cost.PAPER` is the printed method: the
            literal reference grid, radius in pixels and p3 free.
        fix: intrinsics to hold, with their values; without a value (or None) coefficients
            are held at 0, the centre at the array's and focal lengths at the closed form.
        free: intrinsics to estimate that are held by default (p3).
        model: the lens, a key of ``lens.MODELS``.
        report: told of each iteration of Stage II; returning False stops it.
        max_iterations: of Stage II.
        names: of the views, for messages; numbers by default.

    Raises:
        CalibrationError: for views that cannot be used, naming them.
        DegenerateError: if the views do not determine the camera, with what to photograph.
        Cancelled: from `report`.
    """
    cost = Cost(cost)
    if cost is Cost.PAPER:
        model = "lucchese-pixels"
    parameters = parameter_names(model)
    held = _held(fix, free, model, parameters)
    names = names or view_names(len(views))
    observations = pack(views, names)
    _check_size(observations, size, names)
    target_pitch = pitch(np.concatenate([xy for _, xy, *_ in views]))
    scale = REFERENCE_PITCH / target_pitch

    if len(views) < 2:
        raise DegenerateError(
            "One view does not determine a camera.",
            "Add at least two more views with the board tilted in different directions.",
        )
    first = prealign(*_in_paper_frame(observations, scale, size, names))
    start, values = _start(observations, first, size, MODELS[model], parameters, held)
    free_indices = np.flatnonzero([name not in held for name in parameters])
    solution = minimise(
        stage_two(observations, model, cost, scale, free_indices),
        start,
        free_indices,
        observations.count,
        float(np.sum(observations.uv**2)),
        report,
        max_iterations,
    )
    diagnose(solution, tuple(parameters[i] for i in free_indices))
    return _assembled(
        solution,
        observations,
        first,
        Camera(size, solution.state.params, model),
        cost,
        scale,
        free_indices,
        {"cost": str(cost), "model": model, "fixed": values, "max_iterations": max_iterations},
    )


def _held(
    fix: Mapping[str, float | None] | Iterable[str],
    free: Iterable[str],
    model: str,
    names: tuple[str, ...],
) -> dict[str, float | None]:
    """Names of the held parameters, with the values asked for."""
    asked = dict(fix) if isinstance(fix, Mapping) else dict.fromkeys(fix)
    freed = set(free)
    for name in [*asked, *freed]:
        if name not in names:
            raise CalibrationError(
                f"The lens model {model!r} has no parameter {name!r}.",
                f"Choose from {', '.join(names)}.",
            )
    if both := freed & asked.keys():
        raise CalibrationError(
            f"{', '.join(sorted(both))} cannot be both held and freed.", "Name it once."
        )
    default = dict.fromkeys(name for name in HELD.get(model, ()) if name not in freed)
    return default | asked


def _check_size(observations: Observations, size: Size, names: Sequence[str]) -> None:
    margin = 0.5 * max(size)
    outside = (observations.uv < -margin) | (observations.uv > np.array(size) + margin)
    if outside.any():
        k = int(np.flatnonzero(outside.any(axis=(1, 2)))[0])
        raise CalibrationError(
            f"{names[k]} has corners far outside an image of {size[0]} x {size[1]} pixels.",
            "Check the image size, given as width, height.",
        )


def _facing(observations: Observations) -> Array:
    """(K,) +1 where the plate's Y runs down in the image as v does, -1 where it runs up."""
    H = homography.dlt(observations.xy, observations.uv, observations.mask)
    point = np.concatenate([observations.xy[:, 0], np.ones((len(H), 1))], axis=1)
    depth = np.einsum("ki,ki->k", H[:, 2], point)
    # The orientation of a homography at a point is det H / depth^3.
    return np.asarray(np.sign(np.linalg.det(H) * depth))


def _in_paper_frame(
    observations: Observations, scale: float, size: Size, names: Sequence[str]
) -> tuple[Array, Array, Array]:
    """Measured corners, reference corners x', y' (from the plate's centre) and mask."""
    facing = _facing(observations)
    if not (facing == facing[0]).all():
        minority = facing != (1.0 if facing.sum() >= 0 else -1.0)
        listed = ", ".join(names[k] for k in np.flatnonzero(minority).tolist())
        raise CalibrationError(
            f"The board is mirrored against the other views in {listed}.",
            "Number their corners in the same turning sense, or undo the image's mirroring.",
        )
    corners = observations.xy[observations.mask > 0]
    centre = (corners.min(axis=0) + corners.max(axis=0)) / 2
    reference = (observations.xy - centre) * scale * np.array([1.0, -facing[0]])
    return frames.paper_from_array(observations.uv, size), reference, observations.mask


def _start(
    observations: Observations,
    first: Prealignment,
    size: Size,
    lens: Lens,
    names: tuple[str, ...],
    held: Mapping[str, float | None],
) -> tuple[State, dict[str, float]]:
    """The closed-form start of Stage II, and the held parameters with their values."""
    centre, k1 = closed_form.initial_lens(first, size)
    array_centre = frames.centre_of_array(size)
    for i, name in enumerate(("cx", "cy")):
        if name in held:
            value = held[name]
            centre[i] = array_centre[i] if value is None else value
    known = np.array([held.get(name) or np.nan for name in ("fx", "fy")], dtype=np.float64)
    f, R, T = closed_form.initial_poses(observations, centre, k1, size, known)
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


def _coefficients(lens: Lens, d: Array, k1: float) -> Array:
    """Coefficients of any lens model that approximate the correction n = d (1 + k1 r2).

    To first order in the coefficients, correct(d, k) = d + (d correct / dk) k; the first
    coefficient alone is fitted, which for the paper's model is k1 itself.
    """
    d = d.reshape(-1, 2)
    radial = np.sum(d**2, axis=1, keepdims=True) * d
    k = np.zeros(len(lens.names))
    slope = lens.correct(d, k).by_coefficients[..., 0]
    k[0] = k1 * np.sum(slope * radial) / np.sum(slope**2)
    return k


def _assembled(
    solution: Solution,
    observations: Observations,
    first: Prealignment,
    camera: Camera,
    cost: Cost,
    scale: float,
    free: IntArray,
    settings: Mapping[str, Any],
) -> Calibration:
    """The result with its covariances, residuals and Stage I table."""
    state, normal = solution.state, solution.normal
    K = len(state.R)
    names = parameter_names(camera.model)
    sigma2 = uncertainty.variance(normal.cost, observations.count, len(free) + 6 * K)
    shared = uncertainty.shared_covariance(normal, sigma2)
    covariance = np.zeros((len(names), len(names)))
    covariance[np.ix_(free, free)] = shared
    rvecs = np.array([frames.rotation_vector(R) for R in state.R])
    missing = uncertainty.undetermined(normal, tuple(names[i] for i in free))
    sigma = np.sqrt(np.diag(covariance))
    sigma[[names.index(u.name) for u in missing]] = np.nan
    return Calibration(
        camera=camera,
        sigma=sigma,
        covariance=covariance,
        poses=tuple(Pose(r, t) for r, t in zip(rvecs, state.T, strict=True)),
        pose_covariances=uncertainty.pose_covariances(normal, shared, rvecs, sigma2),
        residuals=_residuals(state, observations, MODELS[camera.model], cost, scale),
        noise=float(np.sqrt(sigma2)),
        reference_scale=scale,
        stage_one=_stage_one_table(first, literal=cost is Cost.PAPER),
        history=solution.history,
        status=solution.status,
        cost=cost,
        fixed=tuple(name for i, name in enumerate(names) if i not in free),
        undetermined=missing,
        settings=settings,
        digest=_digest(observations, settings),
    )


def _residuals(
    state: State, observations: Observations, lens: Lens, cost: Cost, scale: float
) -> tuple[ViewResiduals, ...]:
    """Residuals of every view in the image and on the reference plane."""
    image = observations.uv - predicted_corners(state, observations, lens, cost)
    registered = reference_residual(state, observations, lens, scale, cost is Cost.PAPER).residual
    return tuple(
        ViewResiduals(image[k, observations.view(k)], registered[k, observations.view(k)])
        for k in range(len(image))
    )


def _stage_one_table(first: Prealignment, literal: bool) -> tuple[StageOne, ...]:
    """Table 1, with what the cosines' equation says of each view."""
    rows = []
    for k, backward in enumerate(homography.inverted(first.forward)):
        view = cosines.view_geometry(backward, literal)
        rows.append(
            StageOne(
                xp=float(first.centre[k, 0]),
                yp=float(first.centre[k, 1]),
                k1=float(first.k1[k]),
                aspect=view.aspect,
                fx=view.fx,
                fy=view.fy,
                iterations=int(first.iterations[k]),
                rms=float(first.rms[k]),
                backward=backward,
                converged=bool(first.converged[k]),
            )
        )
    return tuple(rows)


def _digest(observations: Observations, settings: Mapping[str, Any]) -> str:
    """SHA-256 of what a calibration answers."""
    digest = hashlib.sha256(repr(sorted(settings.items())).encode())
    for array in (observations.uv, observations.xy, observations.mask, observations.whitening):
        if array is not None:
            digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()
