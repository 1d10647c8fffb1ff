"""Kalibr's camchain.yaml, with one camera; ``rig_files.py`` writes those of several.

Reader: Kalibr, programs that take its calibrations (VINS, OpenVINS, Basalt's converter), any YAML
reader, and `read_kalibr`. Pixels are OpenCV's (0-based, integer at pixel centres). The models are
Kalibr's pinhole with radtan (k1 k2 p1 p2), equidistant (cv2.fisheye's k1 k2 k3 k4) or none, omni
with radtan (Mei's model) or none, eucm and ds; parameters of the projection stand before fx.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.

A camchain holds cameras by name, cam0, cam1 and so on; their poses to each other are not read.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.camera import Camera
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import FRAME, Exporter, ExportReport
from calibgui.formats.importer import CameraText, ImportedCamera, Importer
from calibgui.formats.node import Node
from calibgui.formats.yaml_document import format_number, parse_yaml


class _Model(NamedTuple):
    """A lens model of Kalibr's."""

    camera: str
    """Its `camera_model`."""
    distortion: str
    """Its `distortion_model`."""
    model: str
    """Our id of the model."""
    intrinsics: str
    """Names of the parameters in `intrinsics`."""
    coefficients: str = ""
    """Names of the parameters in `distortion_coeffs`."""


_PINHOLE = "fx fy cx cy"
_MODELS = (
    _Model("pinhole", "radtan", "brown-conrady-4", _PINHOLE, "k1 k2 p1 p2"),
    _Model("pinhole", "equidistant", "kannala-brandt", _PINHOLE, "k1 k2 k3 k4"),
    _Model("pinhole", "none", "pinhole", _PINHOLE),
    _Model("omni", "radtan", "mei", f"xi {_PINHOLE}", "k1 k2 p1 p2"),
    _Model("omni", "none", "mei", f"xi {_PINHOLE}"),
    _Model("eucm", "none", "eucm", f"alpha beta {_PINHOLE}"),
    _Model("eucm", "none", "ucm", f"alpha beta {_PINHOLE}"),  # beta = 1
    _Model("ds", "none", "double-sphere", f"xi alpha {_PINHOLE}"),
)
"""Kalibr's models that we have; of two that are read or written alike the first is taken."""
_ALIASES = {"equi": "equidistant", "pinhole": "none"}
"""Other names of distortion models in files of Kalibr's users."""


def write_kalibr(result: Result, path: Path) -> ExportReport:
    """Write a camchain with the camera cam0."""
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_camchain(fitted.camera, note)
    )


def format_camchain(camera: Camera, note: str) -> str:
    """Return the text of the file; `camera` is in one of the format's models."""
    return f"# {note}\n# {FRAME}\n{format_camera(camera, 0)}"


def format_camera(
    camera: Camera,
    number: int,
    overlaps: Sequence[int] = (),
    from_before: Array | None = None,
) -> str:
    """Return the entry of a camera.

    Args:
        camera: the camera, in one of the format's models.
        number: its place in the chain, from 0.
        overlaps: places of the cameras that see the board at the same time.
        from_before: T_cn_cnm1 (4, 4), to its frame from that of the camera before it, m.
    """
    model = next(model for model in _MODELS if model.model == camera.model)
    values = {"beta": 1.0} | dict(zip(camera.names, camera.params.tolist(), strict=True))
    width, height = camera.size
    chain = ""
    if from_before is not None:
        rows = (f"  - [{', '.join(map(format_number, row))}]\n" for row in from_before.tolist())
        chain = f"  T_cn_cnm1:\n{''.join(rows)}"
    return (
        f"cam{number}:\n{chain}"
        f"  cam_overlaps: {list(overlaps)}\n"
        f"  camera_model: {model.camera}\n"
        f"  distortion_coeffs: {_format_list(model.coefficients, values)}\n"
        f"  distortion_model: {model.distortion}\n"
        f"  intrinsics: {_format_list(model.intrinsics, values)}\n"
        f"  resolution: [{width}, {height}]\n"
        f"  rostopic: /cam{number}/image_raw\n"
    )


def _format_list(names: str, values: dict[str, float]) -> str:
    return f"[{', '.join(format_number(values[name]) for name in names.split())}]"


def read_kalibr(source: CameraText) -> ImportedCamera:
    """Read a camera of a camchain.

    Raises:
        CalibrationError: if something is missing or wrong, several cameras are there and none is
            chosen, or the lens model is none of ours.
    """
    content = parse_yaml(source.text, source.file)
    cameras = {
        str(name): node
        for name, node in content.members().items()
        if isinstance(node.value, dict) and "camera_model" in node.value
    }
    name, node = source.choose_camera(cameras)
    model = _find_model(source, node)
    values = _read_list(node["intrinsics"], model.intrinsics)
    if model.coefficients:
        values |= _read_list(node["distortion_coeffs"], model.coefficients)
    size = source.choose_size(node["resolution"].image_size())
    notes = (f"The camera {name} of {len(cameras)}.",) if len(cameras) > 1 else ()
    camera = source.make_camera(size, model.model, values)
    return ImportedCamera(camera, EXPORTER.title, notes=notes)


def _find_model(source: CameraText, node: Node) -> _Model:
    """Return the model of a camera of the camchain."""
    camera = node["camera_model"].text()
    # YAML has no word for nothing but null, and Kalibr's readers write the word none.
    stated = entry.text() if (entry := node.get("distortion_model")) else "none"
    distortion = _ALIASES.get(stated, stated)
    for model in _MODELS:
        if (model.camera, model.distortion) == (camera, distortion):
            break
    else:
        readable = dict.fromkeys(f"{model.camera}-{model.distortion}" for model in _MODELS)
        source.refuse_model(f"{camera}-{distortion}", list(readable))
    return model


def _read_list(node: Node, names: str) -> dict[str, float]:
    """Return the parameters of a list by their names."""
    numbers = node.numbers(None).tolist()
    if len(numbers) != len(names.split()):
        node.fail(f"the {len(names.split())} numbers {names}")
    return dict(zip(names.split(), numbers, strict=True))


EXPORTER = Exporter(
    name="kalibr",
    title="Kalibr camchain",
    suffixes=(".yaml", ".yml"),
    models=tuple(model.model for model in _MODELS),
    refits=("brown-conrady-4", "kannala-brandt"),
    readers="Kalibr, VINS-Fusion, any reader of YAML",
    keeps="the camera as radtan, equidistant, omni, eucm or ds",
    loses="standard deviations, poses, corners",
    write=write_kalibr,
)
IMPORTER = Importer(
    EXPORTER.title,
    re.compile(r"^[ \t]+camera_model[ \t]*:", re.MULTILINE),
    read_kalibr,
    several=True,
)
