"""result.json: a calibration with everything needed to use, judge and repeat it.

Reader: `read_result`, and any JSON reader; described by resources/schema/result-1.schema.json.
Pixels are in the array frame (0-based, integer at pixel centres, v down; OpenCV's), lengths
millimetres, angles radians; `paper` is in the paper's centred frame, y up, and pixel units.
A standard deviation is one sigma: 0 for a parameter that was held, null for one that the
data do not determine. Where `status` is partial, `diagnosis` lists the assumptions, and every
standard deviation includes their errors. Unused views have null poses.
`covariance.matrix` and a view's `pose_covariance` (of rvec, tvec) complete the standard deviations.
`sensor_mode` is there if the file is for another stream of the camera than the images of the
calibration: u' = factor u + offset, in images of `size` px. All else is as it was calibrated, and
the version is 2, as who misses the mode would take the wrong camera; without it the version is 1.
Cannot hold: the images; settings other than JSON's types.

Files of older versions lack coefficients that their lens models have by now and hold by default.

A change that old programs could misread takes a new version: raise `VERSION`, write a schema
beside the old one, and turn the old record into the new one in `read_result`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import numpy as np

from calibgui.dataset import LENS_TYPES, UNKNOWN_HARDWARE, Hardware, Result, find_orientation
from calibgui.dataset.acceptance import list_broken_limits
from calibgui.dataset.judging import judge_result
from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.boards import BoardShape, BoardShapeModel
from calibgui.engine.calibration import (
    METHODS,
    Calibration,
    CalibrationSettings,
    Cost,
    Iteration,
    Status,
    Undetermined,
    is_held,
    make_paper_table,
)
from calibgui.engine.camera import (
    MODELS,
    Camera,
    Lucchese,
    SensorMode,
    find_model,
    list_parameter_names,
    resolve_model_id,
)
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import PAPER_NAMES
from calibgui.formats.board_shape_json import decode_board_shape, decode_prior, encode_board_shape
from calibgui.formats.diagnosis_json import decode_diagnosis, encode_diagnosis
from calibgui.formats.estimates_json import (
    decode_pose,
    decode_pose_covariance,
    decode_residuals,
    decode_stage_one,
    encode_estimates,
    encode_no_estimate,
    encode_stage_one,
)
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.json_document import check_format, parse_json, read_json, write_json
from calibgui.formats.limits_toml import decode_limits, encode_limits
from calibgui.formats.node import Node
from calibgui.formats.pattern_json import decode_board, encode_board
from calibgui.formats.verdict_json import encode_verdict
from calibgui.formats.views_json import decode_circle, decode_views, encode_view

FORMAT = "calibgui-result"
VERSION = 2

_ITERATION_KEYS = ("index", "cost", "rms", "gradient", "step", "damping", "seconds")


def write_result(result: Result, path: str | os.PathLike[str]) -> None:
    """Write result.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write_json(path, encode_result_with_findings(result))


def encode_result_with_findings(result: Result) -> dict[str, Any]:
    """Return the content of result.json, with the verdict, what is wrong and whether limits hold.

    All three follow from the rest, which takes its time; they are not read back. A camera that is
    known from a file is not judged.
    """
    content = encode_result(result)
    if is_held(result.calibration):
        return content
    content |= encode_verdict(judge_result(result), result)
    if result.limits is not None:
        reasons = list_broken_limits(result, result.limits)
        content["acceptance"] = {"passed": not reasons, "reasons": reasons}
    return content


def encode_result(result: Result) -> dict[str, Any]:
    """Return what a result is read from."""
    calibration = result.calibration
    names = calibration.camera.names
    summary = summarise_residuals(calibration.residuals)
    return {
        "format": FORMAT,
        "version": 1 if result.mode is None else VERSION,
        "status": calibration.status,
        "camera": {
            "model": calibration.camera.model,
            "size": calibration.camera.size,
            "params": dict(zip(names, calibration.camera.params, strict=True)),
            "sigma": dict(zip(names, calibration.sigma, strict=True)),
            "sigma_by_noise": dict(zip(names, calibration.sigma_by_noise, strict=True)),
            "fixed": calibration.fixed,
        }
        | ({} if calibration.camera.circle is None else {"circle": calibration.camera.circle}),
        **({} if result.mode is None else {"sensor_mode": encode_mode(result.mode)}),
        "paper": _encode_paper_parameters(calibration),
        "residuals": {
            "rms_px": summary.rms,
            "sigma_x_px": summary.sigma_x,
            "sigma_y_px": summary.sigma_y,
            "median_view_sigma_x_px": summary.median_sigma_x,
            "median_view_sigma_y_px": summary.median_sigma_y,
            "reference_mean_px": summary.reference_mean,
            "reference_sd_px": summary.reference_sd,
            "count": summary.count,
            "noise": calibration.noise,
            "model_error_px": calibration.model_error,
            "reference_px_per_mm": calibration.reference_scale,
        },
        "undetermined": [{"name": u.name, "reason": u.reason} for u in calibration.undetermined],
        "diagnosis": encode_diagnosis(calibration.diagnosis),
        "warnings": (*result.improvements, *calibration.warnings),
        "covariance": {
            "parameters": names,
            "matrix": calibration.covariance,
            "matrix_by_noise": calibration.noise_covariance,
        },
        "settings": calibration.settings.encode(),
        "versions": result.versions,
        "lengths_confirmed": result.lengths_confirmed,
        **({} if result.limits is None else {"limits": encode_limits(result.limits)}),
        **_encode_hardware(result.hardware),
        "inputs_sha256": calibration.digest,
        "target": None if result.board is None else encode_board(result.board),
        "plate": None
        if calibration.board_shape is None
        else encode_board_shape(calibration.board_shape),
        "plate_doubt_mm": calibration.board_shape_error,
        "lens_error_px": calibration.lens_error,
        "view_scatter": calibration.overdispersion,
        "stage_one": encode_stage_one(result),
        "history": [{k: getattr(i, k) for k in _ITERATION_KEYS} for i in calibration.history],
        "solve_seconds": calibration.seconds,
        "views": _encode_views(result),
    }


def _encode_hardware(hardware: Hardware) -> dict[str, Any]:
    """Return the member on the camera and the lens that were stated; none if none were."""
    stated = {name: value for name, value in asdict(hardware).items() if value is not None}
    return {"hardware": stated} if stated else {}


def _decode_hardware(node: Node | None) -> Hardware:
    """Return the camera and the lens that were stated."""
    if node is None:
        return UNKNOWN_HARDWARE
    stated: dict[str, Any] = {
        field.name: value.text()
        for field in fields(Hardware)
        if field.name not in ("crop", "type") and (value := node.get(field.name)) is not None
    }
    if (crop := node.get("crop")) is not None and not crop.number() > 0:
        crop.fail("a number above 0")
    kind = node.get("type")
    return Hardware(
        **stated,
        crop=None if crop is None else crop.number(),
        type=None if kind is None else kind.choice(LENS_TYPES),
    )


def encode_mode(mode: SensorMode) -> dict[str, Any]:
    """Return the JSON object of a sensor mode."""
    return {"size": mode.size, "factor": mode.factor, "offset_px": mode.offset}


def _decode_mode(node: Node | None, full: Size) -> SensorMode | None:
    """Return the mode of the stream that a result is for; None if there is none."""
    if node is None:
        return None
    numbers = node["factor"].numbers(2), node["offset_px"].numbers(2)
    if not numbers[0].all():
        node["factor"].fail("two numbers other than 0")
    return SensorMode(full, node["size"].image_size(), *numbers)


def _encode_paper_parameters(calibration: Calibration) -> dict[str, Any] | None:
    """Return the ten intrinsics of Table 2; None for a lens model that has others."""
    if not isinstance(find_model(calibration.camera.model), Lucchese):
        return None
    values, sigma, printed = (
        dict(zip(PAPER_NAMES, column, strict=True)) for column in make_paper_table(calibration)
    )
    return values | {"sigma": sigma, "sd_as_printed": printed}


def _encode_views(result: Result) -> list[dict[str, Any]]:
    estimates = iter(encode_estimates(result))
    return [
        encode_view(view, result.board)
        | (next(estimates) if view.usable else encode_no_estimate(view))
        for view in result.views
    ]


def read_result(path: str | os.PathLike[str]) -> Result:
    """Read result.json.

    Raises:
        CalibrationError: if the file cannot be read, is of another format or a newer version,
            or something in it is wrong; the message names the place.
    """
    node = read_json(path)
    if node.get("format") is None and node.get("views") is not None:
        raise CalibrationError(
            f"{node.file} holds corners, but no calibration.",
            "Calibrate them first: `calibgui calibrate`.",
        )
    remedy = "Name a result: `calibgui calibrate -o` writes it."
    check_format(node, FORMAT, VERSION, "the result of a calibration", remedy)
    return decode_result(node)


def read_result_camera(source: CameraText) -> ImportedCamera:
    """Read the camera of a result.json, with its covariance. Raises as `read_result`."""
    node = parse_json(source.text, source.file)
    check_format(node, FORMAT, VERSION, "the result of a calibration")
    result = decode_result(node)
    calibration = result.calibration
    camera, covariance = calibration.camera, calibration.covariance
    if result.mode is not None:
        covariance = result.mode.adapt_covariance(covariance, camera.model)
        camera = result.mode.adapt_camera(camera)
    source.choose_size(camera.size)
    diagnosis = calibration.diagnosis
    notes = () if diagnosis is None else (f"A partial calibration. {diagnosis.message}",)
    return ImportedCamera(
        camera,
        EXPORTER.title,
        covariance,
        notes,
        mode=result.mode,
        orientation=find_orientation(result.used),
    )


def decode_result(node: Node) -> Result:
    """Return the result in the content of a result.json. Raises as `read_result`."""
    board = decode_board(node.get("target"))
    views = decode_views(node["views"], board)
    used = [n for n, view in zip(node["views"].items(), views, strict=True) if view.usable]
    if not used:
        node["views"].fail("a list with usable views")
    calibration = _decode_calibration(node, used)
    return Result(
        calibration,
        views,
        board,
        {name: version.text() for name, version in node["versions"].members().items()},
        confirmed.flag() if (confirmed := node.get("lengths_confirmed")) else True,
        limits=decode_limits(node.get("limits")),
        mode=_decode_mode(node.get("sensor_mode"), calibration.camera.size),
        hardware=_decode_hardware(node.get("hardware")),
    )


def decode_model(node: Node) -> str:
    """Return the id of a lens model; an older file may have an older one."""
    try:
        return resolve_model_id(node.text())
    except CalibrationError:
        node.choice(tuple(MODELS))  # names the place, and the choices
        raise


def _decode_calibration(node: Node, used: list[Node]) -> Calibration:
    """Decode a calibration; `used` are the nodes of the views that it was made from."""
    camera = node["camera"]
    model = decode_model(camera["model"])
    names = list_parameter_names(model)
    added = _find_added_coefficients(camera["params"], model)
    residuals = node["residuals"]
    return Calibration(
        camera=decode_camera(camera, model, added),
        sigma=_decode_by_name(camera["sigma"], names, added),
        covariance=_decode_covariance(node["covariance"]["matrix"], names, added),
        noise_covariance=_decode_noise_covariance(node, names, added),
        poses=tuple(map(decode_pose, used)),
        pose_covariances=np.stack(list(map(decode_pose_covariance, used))),
        residuals=tuple(map(decode_residuals, used)),
        noise=residuals["noise"].number(nullable=True),
        model_error=error.number() if (error := residuals.get("model_error_px")) else 0.0,
        reference_scale=residuals["reference_px_per_mm"].number(),
        stage_one=tuple(map(decode_stage_one, node["stage_one"].items(len(used)))),
        history=tuple(map(_decode_iteration, node["history"].items())),
        status=Status(node["status"].choice(list(Status))),
        cost=Cost(node["settings"]["cost"].choice(list(Cost))),
        fixed=(*(n.choice(names) for n in camera["fixed"].items()), *added),
        undetermined=tuple(
            Undetermined(n["name"].choice(names), n["reason"].text())
            for n in node["undetermined"].items()
        ),
        diagnosis=decode_diagnosis(node.get("diagnosis")),
        board_shape=_decode_board_shape(node.get("plate")),
        board_shape_error=doubt.number() if (doubt := node.get("plate_doubt_mm")) else 0.0,
        lens_error=missed.number() if (missed := node.get("lens_error_px")) else 0.0,
        overdispersion=scatter.number() if (scatter := node.get("view_scatter")) else 0.0,
        warnings=tuple(n.text() for n in node["warnings"].items()),
        settings=_decode_settings(node["settings"], added),
        digest=node["inputs_sha256"].text(),
        seconds=_decode_seconds(node.get("solve_seconds")),
    )


def _decode_seconds(node: Node | None) -> float:
    """Return the time of the solve, s; NaN in results that do not hold it."""
    return float("nan") if node is None else node.number(nullable=True)


def _decode_settings(node: Node, added: Mapping[str, float]) -> CalibrationSettings:
    held = {name: value.number() for name, value in node["fixed"].members().items()}
    stated = {
        field: read(value)
        for name, (field, read) in _SETTING_READERS.items()
        if (value := node.get(name)) is not None
    }
    known = {"fixed", *_SETTING_READERS}
    others = {name: value for name, value in node.value.items() if name not in known}
    return CalibrationSettings(fixed=held | dict(added), **stated, others=others)


def _decode_count(node: Node) -> int:
    if (count := node.integer()) < 0:
        node.fail("a number from 0 on")
    return count


_SETTING_READERS: Mapping[str, tuple[str, Callable[[Node], Any]]] = {
    "cost": ("cost", lambda node: Cost(node.choice(list(Cost)))),
    "model": ("model", decode_model),
    "method": ("method", lambda node: node.choice(list(METHODS))),
    "max_iterations": ("max_iterations", _decode_count),
    "plate": ("board_shape", lambda node: BoardShapeModel(node.choice(list(BoardShapeModel)))),
    "plate_held": ("is_board_shape_held", Node.flag),
    "prior_mm": ("prior", decode_prior),
    "model_reason": ("model_reason", Node.text),
    "robust": ("robust", Node.flag),
    "outliers": ("outliers", _decode_count),
    "weigh_views": ("weigh_views", Node.flag),
}
"""Settings of a calibration and the functions that read them, by their names in the file."""


def _decode_board_shape(node: Node | None) -> BoardShape | None:
    """Return the board's shape; None for a nominal one and in old results, which have no shape."""
    return None if node is None or node.value is None else decode_board_shape(node)


def _find_added_coefficients(params: Node, model: str) -> dict[str, float]:
    """Return the held coefficients that the file lacks, with the values at which they are held."""
    lens, stored = find_model(model), params.members()
    values = zip(lens.names, lens.defaults, strict=True)
    return {name: v for name, v in values if name in lens.held and name not in stored}


def decode_camera(node: Node, model: str, added: Mapping[str, float]) -> Camera:
    """Return the camera in an object; coefficients that it lacks have the values `added`."""
    params = node["params"]
    for name in ("fx", "fy"):
        if not params[name].number() > 0:
            params[name].fail("a focal length above 0")
    names = list_parameter_names(model)
    values = [added[name] if name in added else params[name].number() for name in names]
    circle = decode_circle(node.get("circle"))
    return Camera(node["size"].image_size(), np.array(values), model, circle)


def _decode_by_name(node: Node, names: Sequence[str], added: Mapping[str, float]) -> Array:
    """Return standard deviations in the order of `names`: 0 for coefficients that were added."""
    return np.array([0.0 if n in added else node[n].number(nullable=True) for n in names])


def _decode_covariance(node: Node, names: Sequence[str], added: Mapping[str, float]) -> Array:
    """Return the covariance (P, P) of all parameters: 0 for coefficients that were added."""
    stored = np.array([i for i, name in enumerate(names) if name not in added])
    covariance = np.zeros((len(names), len(names)))
    covariance[np.ix_(stored, stored)] = node.covariances(len(stored), len(stored), nullable=True)
    return covariance


def _decode_noise_covariance(node: Node, names: Sequence[str], added: Mapping[str, float]) -> Array:
    """Return the covariance (P, P) by noise alone.

    Older results hold its diagonal only, and have the correlations of the whole covariance.
    """
    matrix = node["covariance"].get("matrix_by_noise")
    if matrix is not None:
        return _decode_covariance(matrix, names, added)
    camera, whole = node["camera"], _decode_covariance(node["covariance"]["matrix"], names, added)
    sigma = _decode_by_name(camera.get("sigma_by_noise") or camera["sigma"], names, added)
    reported = np.sqrt(np.diag(whole))
    shrink = np.divide(sigma, reported, out=np.ones_like(sigma), where=reported > 0)
    return np.asarray(whole * np.outer(shrink, shrink))


def _decode_iteration(node: Node) -> Iteration:
    return Iteration(node["index"].integer(), *(node[k].number() for k in _ITERATION_KEYS[1:]))


def _export(result: Result, path: Path) -> ExportReport:
    write_result(result, path)
    return ExportReport(path, "All of the calibration: it can be solved again.")


EXPORTER = Exporter(
    name="result",
    title="Result as JSON",
    suffixes=(".json",),
    models=tuple(MODELS),
    readers="calibgui, any reader of JSON",
    keeps="all of the calibration: it can be solved again",
    loses="nothing",
    write=_export,
    partial=True,
    needs_corners=True,
)
IMPORTER = Importer(EXPORTER.title, re.compile(rf'"format"\s*:\s*"{FORMAT}"'), read_result_camera)
