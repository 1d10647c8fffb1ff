"""result.json: a calibration with everything needed to use, judge and repeat it.

Reader: `read_result`, and any JSON reader; described by resources/schema/result-1.schema.json.
Pixels are in the array frame (0-based, integer at pixel centres, v down; OpenCV's), lengths
millimetres, angles radians; `paper` is in the paper's centred frame, y up, and pixel units.
A standard deviation is one sigma: 0 for a parameter that was held, null for one that the
data do not determine. Where `status` is partial, `diagnosis` says what was assumed, and every
standard deviation includes what that may be off by. Unused views have null poses.
`covariance.matrix` and a view's `pose_covariance` (of rvec, tvec) complete the standard deviations.
Cannot hold: the images; settings other than JSON's types.

A change that old programs could misread takes a new version: raise `VERSION`, write a schema
beside the old one, and turn the old record into the new one in `read_result`.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from calibgui.dataset.result import Result
from calibgui.engine.arrays import Array
from calibgui.engine.assessment import summarise
from calibgui.engine.boards import BoardShape
from calibgui.engine.calibration import (
    Calibration,
    Cost,
    Iteration,
    Status,
    Undetermined,
    paper_table,
)
from calibgui.engine.camera import MODELS, Camera, Lucchese, parameter_names
from calibgui.engine.geometry import PAPER_NAMES
from calibgui.formats.board_shape_json import (
    board_shape_record,
    read_board_shape_record,
    read_prior,
)
from calibgui.formats.corners_json import read_size
from calibgui.formats.diagnosis_json import diagnosis_record, read_diagnosis
from calibgui.formats.estimates_json import (
    estimate_records,
    no_estimate,
    read_pose,
    read_pose_covariance,
    read_residuals,
    read_stage_one,
    stage_one_records,
)
from calibgui.formats.exporter import Exporter, ExportReport
from calibgui.formats.json_document import Node, check_format, read, write
from calibgui.formats.pattern_json import read_target, target_record
from calibgui.formats.views_json import read_views, view_record

FORMAT = "calibgui-result"
VERSION = 1

_ITERATION = ("index", "cost", "rms", "gradient", "step", "damping", "seconds")


def write_result(result: Result, path: str | os.PathLike[str]) -> None:
    """Write result.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write(path, result_record(result))


def result_record(result: Result) -> dict[str, Any]:
    """The content of result.json."""
    calibration = result.calibration
    names = calibration.camera.names
    summary = summarise(calibration.residuals)
    return {
        "format": FORMAT,
        "version": VERSION,
        "status": calibration.status,
        "camera": {
            "model": calibration.camera.model,
            "size": calibration.camera.size,
            "params": dict(zip(names, calibration.camera.params, strict=True)),
            "sigma": dict(zip(names, calibration.sigma, strict=True)),
            "sigma_by_noise": dict(zip(names, calibration.sigma_by_noise, strict=True)),
            "fixed": calibration.fixed,
        },
        "paper": _paper_record(calibration),
        "residuals": {
            "rms_px": summary.rms,
            "sigma_x_px": summary.sigma_x,
            "sigma_y_px": summary.sigma_y,
            "median_view_sigma_x_px": summary.typical_x,
            "median_view_sigma_y_px": summary.typical_y,
            "reference_mean_px": summary.reference_mean,
            "reference_sd_px": summary.reference_sd,
            "count": summary.count,
            "noise": calibration.noise,
            "model_error_px": calibration.model_error,
            "reference_px_per_mm": calibration.reference_scale,
        },
        "undetermined": [{"name": u.name, "reason": u.reason} for u in calibration.undetermined],
        "diagnosis": diagnosis_record(calibration.diagnosis),
        "warnings": calibration.warnings,
        "covariance": {"parameters": names, "matrix": calibration.covariance},
        "settings": calibration.settings,
        "versions": result.versions,
        "inputs_sha256": calibration.digest,
        "target": None if result.board is None else target_record(result.board),
        "plate": None
        if calibration.board_shape is None
        else board_shape_record(calibration.board_shape),
        "plate_doubt_mm": calibration.board_shape_error,
        "view_scatter": calibration.view_scatter,
        "stage_one": stage_one_records(result),
        "history": [{k: getattr(i, k) for k in _ITERATION} for i in calibration.history],
        "views": _view_records(result),
    }


def _paper_record(calibration: Calibration) -> dict[str, Any] | None:
    """The ten intrinsics of Table 2, or None for a lens model that has not got them."""
    if not isinstance(MODELS[calibration.camera.model], Lucchese):
        return None
    values, sigma, printed = (
        dict(zip(PAPER_NAMES, column, strict=True)) for column in paper_table(calibration)
    )
    return values | {"sigma": sigma, "sd_as_printed": printed}


def _view_records(result: Result) -> list[dict[str, Any]]:
    estimates = iter(estimate_records(result))
    return [
        view_record(view, result.board) | (next(estimates) if view.usable else no_estimate(view))
        for view in result.views
    ]


def read_result(path: str | os.PathLike[str]) -> Result:
    """Read result.json.

    Raises:
        CalibrationError: if the file cannot be read, is of another format or a newer version,
            or something in it is wrong, naming the place.
    """
    node = read(path)
    check_format(node, FORMAT, VERSION)
    return result_from(node)


def result_from(node: Node) -> Result:
    """The result in the content of a result.json. Raises as `read_result`."""
    board = read_target(node.get("target"))
    views = read_views(node["views"], board)
    used = [n for n, view in zip(node["views"].items(), views, strict=True) if view.usable]
    if not used:
        node["views"].fail("a list with usable views")
    return Result(
        _read_calibration(node, used),
        views,
        board,
        {name: version.text() for name, version in node["versions"].members().items()},
    )


def _read_calibration(node: Node, used: list[Node]) -> Calibration:
    camera = node["camera"]
    model = camera["model"].choice(list(MODELS))
    names = parameter_names(model)
    residuals = node["residuals"]
    return Calibration(
        camera=_read_camera(camera, model),
        sigma=_by_name(camera["sigma"], names),
        covariance=node["covariance"]["matrix"].numbers(len(names), len(names), nullable=True),
        sigma_by_noise=_by_name(camera.get("sigma_by_noise") or camera["sigma"], names),
        poses=tuple(map(read_pose, used)),
        pose_covariances=np.stack(list(map(read_pose_covariance, used))),
        residuals=tuple(map(read_residuals, used)),
        noise=residuals["noise"].number(nullable=True),
        model_error=error.number() if (error := residuals.get("model_error_px")) else 0.0,
        reference_scale=residuals["reference_px_per_mm"].number(),
        stage_one=tuple(map(read_stage_one, node["stage_one"].items())),
        history=tuple(map(_read_iteration, node["history"].items())),
        status=Status(node["status"].choice(list(Status))),
        cost=Cost(node["settings"]["cost"].choice(list(Cost))),
        fixed=tuple(n.choice(names) for n in camera["fixed"].items()),
        undetermined=tuple(
            Undetermined(n["name"].choice(names), n["reason"].text())
            for n in node["undetermined"].items()
        ),
        diagnosis=read_diagnosis(node.get("diagnosis")),
        board_shape=_read_board_shape(node.get("plate")),
        board_shape_error=doubt.number() if (doubt := node.get("plate_doubt_mm")) else 0.0,
        view_scatter=scatter.number() if (scatter := node.get("view_scatter")) else 0.0,
        warnings=tuple(n.text() for n in node["warnings"].items()),
        settings=_read_settings(node["settings"]),
        digest=node["inputs_sha256"].text(),
    )


def _read_settings(node: Node) -> dict[str, Any]:
    held = {name: value.number() for name, value in node["fixed"].members().items()}
    settings = {**node.value, "fixed": held}
    if (stated := node.get("prior_mm")) is not None:
        prior = read_prior(stated)
        settings["prior_mm"] = [prior.in_plane, prior.out_of_plane]
    return settings


def _read_board_shape(node: Node | None) -> BoardShape | None:
    """The plate, which results written before plates were estimated do not have."""
    return None if node is None or node.value is None else read_board_shape_record(node)


def _read_camera(node: Node, model: str) -> Camera:
    params = node["params"]
    for name in ("fx", "fy"):
        if not params[name].number() > 0:
            params[name].fail("a focal length above 0")
    values = np.array([params[name].number() for name in parameter_names(model)])
    return Camera(read_size(node["size"]), values, model)


def _by_name(node: Node, names: tuple[str, ...]) -> Array:
    return np.array([node[name].number(nullable=True) for name in names])


def _read_iteration(node: Node) -> Iteration:
    return Iteration(node["index"].integer(), *(node[k].number() for k in _ITERATION[1:]))


def _export(result: Result, path: Path) -> ExportReport:
    write_result(result, path)
    return ExportReport(path, EXPORTER.limits)


EXPORTER = Exporter(
    name="result",
    title="Result as JSON",
    suffixes=(".json",),
    limits="Complete: camera, poses, residuals, corners, settings; can be solved again.",
    write=_export,
    partial=True,
)
