"""rig.json: a rig with everything needed to use and to judge it.

    {"format": "calibgui-rig", "version": 1, "status", "target": board or null,
     "lengths_confirmed", "rms_px", "rms_alone_px", "noise_px", "disagreement",
     "cameras": [{"name", "model", "size", "params": {...}, "sigma": {...}, "rvec", "tvec_mm",
                  "sigma_rvec", "sigma_tvec_mm", "offset_s", "sigma_offset_s"}, ...],
     "covariance", "covariance_by_noise": (n x n) of all parameters, camera by camera in the order
                  params, rvec, tvec_mm, offset_s, then rvec, tvec_mm of the boards but the first; 0
                  for what was held,
     "pairs": [{"cameras": [a, b], "instants", "scatter_mm", "scatter_by_noise_mm"}, ...],
     "instants": [{"number", "name", "rvec", "tvec_mm"}, ...],
     "boards": [{"name", "target", "reference", "rvec", "tvec_mm", "sigma_rvec", "sigma_tvec_mm",
                 "shape": as in board-shape.json, or null}, ...],
     "views": [{"camera", "board", "instant", "image", "uv", "xy_mm", "residuals_px", "alone_px",
                "contradiction_px", "turned_deg"}, ...],
     "left_out": [{"camera", "board", "instant", "image", "error_px"}, ...],
     "mistakes": [{"kind", "cameras": [a, b], "instants", "value"}, ...], "remarks", "versions"}

Reader: any JSON reader; `read_rig`. Cameras count from 0. A point X, mm, of the rig's frame, which
is that of the first camera, is at R X + tvec_mm in a camera's frame (X right, Y down, Z ahead),
R = exp(rvec), rad; the pose of an instant brings points of the first board into the rig's frame,
that of a board its points into the frame of the board `reference`. A camera is later than the first
one by offset_s. Files of versions with one board lack `boards` and the `board` of views.
Cannot hold: covariances of corners, and how each camera alone was calibrated.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from calibgui.dataset import RigResult
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Observation, Status
from calibgui.engine.camera import Camera, list_parameter_names
from calibgui.engine.geometry import Pose
from calibgui.engine.rig import (
    Layout,
    LeftOutView,
    Mistake,
    PlacedBoard,
    Rig,
    RigMistake,
    RigPair,
    RigView,
)
from calibgui.formats.board_shape_json import decode_board_shape, encode_board_shape
from calibgui.formats.json_document import check_format, read_json, write_json
from calibgui.formats.node import Node
from calibgui.formats.pattern_json import decode_board, encode_board
from calibgui.formats.result_json import decode_model

FORMAT = "calibgui-rig"
VERSION = 1


def write_rig(result: RigResult, path: str | os.PathLike[str]) -> None:
    """Write rig.json.

    Raises:
        CalibrationError: if the file cannot be written.
    """
    write_json(path, encode_rig(result))


def encode_rig(result: RigResult) -> dict[str, Any]:
    """Return the content of rig.json."""
    rig = result.rig
    return {
        "format": FORMAT,
        "version": VERSION,
        "status": rig.status,
        "target": encode_board(result.boards[0]) if result.boards else None,
        "lengths_confirmed": result.lengths_confirmed,
        "rms_px": rig.rms,
        "rms_alone_px": rig.rms_alone,
        "noise_px": rig.noise,
        "disagreement": rig.disagreement,
        "cameras": [_encode_camera(rig, c) for c in range(len(rig.cameras))],
        "covariance": rig.covariance,
        "covariance_by_noise": rig.noise_covariance,
        "pairs": [
            {
                "cameras": [pair.first, pair.second],
                "instants": pair.shared,
                "scatter_mm": pair.scatter,
                "scatter_by_noise_mm": pair.noise_scatter,
            }
            for pair in rig.pairs
        ],
        "instants": [
            {
                "number": instant,
                "name": result.instants[instant],
                "rvec": board.rvec,
                "tvec_mm": board.tvec,
            }
            for instant, board in zip(rig.instants, rig.boards, strict=True)
        ],
        "boards": [_encode_placed_board(result, b) for b in range(len(rig.placed_boards))],
        "views": [_encode_view(result, view) for view in rig.views],
        "left_out": [
            {
                "camera": view.camera,
                "board": view.board,
                "instant": view.instant,
                "image": result.images[view.camera, view.instant],
                "error_px": view.error,
            }
            for view in rig.left_out
        ],
        "mistakes": [
            {
                "kind": mistake.kind,
                "cameras": [mistake.other, mistake.camera],
                "instants": mistake.instants,
                "value": mistake.value,
            }
            for mistake in rig.mistakes
        ],
        "remarks": result.remarks,
        "versions": result.versions,
    }


def _encode_camera(rig: Rig, c: int) -> dict[str, Any]:
    camera, pose, sigma = rig.cameras[c], rig.poses[c], rig.pose_sigma(c)
    return {
        "name": rig.names[c],
        "model": camera.model,
        "size": camera.size,
        "params": dict(zip(camera.names, camera.params.tolist(), strict=True)),
        "sigma": dict(zip(camera.names, rig.camera_sigma(c).tolist(), strict=True)),
        "rvec": pose.rvec,
        "tvec_mm": pose.tvec,
        "sigma_rvec": sigma[:3],
        "sigma_tvec_mm": sigma[3:],
        "offset_s": float(rig.offsets[c]),
        "sigma_offset_s": rig.offset_sigma(c),
    }


def _encode_placed_board(result: RigResult, b: int) -> dict[str, Any]:
    board, sigma = result.rig.placed_boards[b], result.rig.board_sigma(b)
    return {
        "name": board.name,
        "target": encode_board(result.boards[b]) if result.boards else None,
        "reference": board.reference,
        "rvec": board.pose.rvec,
        "tvec_mm": board.pose.tvec,
        "sigma_rvec": sigma[:3],
        "sigma_tvec_mm": sigma[3:],
        "shape": None if board.shape is None else encode_board_shape(board.shape),
    }


def _encode_view(result: RigResult, view: RigView) -> dict[str, Any]:
    seen = result.observations[view.camera, view.board, view.instant]
    return {
        "camera": view.camera,
        "board": view.board,
        "instant": view.instant,
        "image": result.images[view.camera, view.instant],
        "uv": seen.uv,
        "xy_mm": seen.xy,
        "residuals_px": view.residuals,
        "alone_px": view.alone,
        "contradiction_px": view.contradiction,
        "turned_deg": view.turned,
    }


def read_rig(path: str | os.PathLike[str]) -> RigResult:
    """Read rig.json.

    Raises:
        CalibrationError: if the file cannot be read, is of another format or a newer version, or
            something in it is wrong; the message names the place.
    """
    node = read_json(path)
    check_format(node, FORMAT, VERSION, "a rig", "Name a file that `calibgui rig -o` wrote.")
    cameras = node["cameras"].items()
    if len(cameras) < 2:
        node["cameras"].fail("a list of at least two cameras")
    instants = {
        entry["number"].integer(): entry["name"].text() for entry in node["instants"].items()
    }
    boards = _decode_boards(node)
    images: dict[tuple[int, int], str] = {}
    observations: dict[tuple[int, int, int], Observation] = {}
    views = []
    for entry in node["views"].items():
        view = _decode_view(entry, len(cameras), len(boards), instants)
        images[view.camera, view.instant] = entry["image"].file_name()
        uv = entry["uv"].numbers(None, 2)
        seen = Observation(uv, entry["xy_mm"].numbers(len(uv), 2))
        observations[view.camera, view.board, view.instant] = seen
        views.append(view)
    left_out = []
    for entry in node["left_out"].items():
        camera, board, instant = _decode_place(entry, len(cameras), len(boards), instants)
        images[camera, instant] = entry["image"].file_name()
        left_out.append(LeftOutView(camera, instant, entry["error_px"].number(), board))
    rig = _decode_rig(node, cameras, boards, tuple(views), tuple(left_out))
    return RigResult(
        rig,
        instants,
        images,
        observations,
        _decode_targets(node),
        node["lengths_confirmed"].flag(),
        tuple(entry.text() for entry in node["remarks"].items()),
        {name: version.text() for name, version in node["versions"].members().items()},
    )


def _decode_targets(node: Node) -> tuple[Board, ...]:
    """Return the boards of known layout."""
    entries = node.get("boards")
    nodes = [node] if entries is None else entries.items()
    found = [decode_board(entry.get("target")) for entry in nodes]
    return tuple(board for board in found if board is not None)


def _decode_boards(node: Node) -> tuple[PlacedBoard, ...]:
    """Return the places of the boards; that of the only one in files that hold none."""
    entries = node.get("boards")
    if entries is None:
        return (PlacedBoard(),)
    boards = []
    for b, entry in enumerate(entries.items()):
        shape = entry.get("shape")
        boards.append(
            PlacedBoard(
                entry["name"].text(),
                _decode_pose(entry),
                _decode_index(entry["reference"], b + 1, "board"),
                None if shape is None else decode_board_shape(shape),
            )
        )
    if not boards:
        entries.fail("a list of at least one board")
    return tuple(boards)


def _decode_rig(
    node: Node,
    cameras: list[Node],
    boards: tuple[PlacedBoard, ...],
    views: tuple[RigView, ...],
    left_out: tuple[LeftOutView, ...],
) -> Rig:
    decoded = tuple(map(_decode_camera, cameras))
    size = Layout(tuple(len(camera.params) for camera in decoded), len(boards)).size
    return Rig(
        names=tuple(entry["name"].text() for entry in cameras),
        cameras=decoded,
        poses=tuple(map(_decode_pose, cameras)),
        offsets=np.array([entry["offset_s"].number() for entry in cameras]),
        covariance=node["covariance"].covariances(size, size),
        noise_covariance=node["covariance_by_noise"].covariances(size, size),
        instants=tuple(entry["number"].integer() for entry in node["instants"].items()),
        boards=tuple(map(_decode_pose, node["instants"].items())),
        views=views,
        noise=node["noise_px"].number(nullable=True),
        disagreement=node["disagreement"].number(),
        status=Status(node["status"].choice(list(Status))),
        pairs=tuple(_decode_pair(entry, len(cameras)) for entry in node["pairs"].items()),
        left_out=left_out,
        mistakes=tuple(_decode_mistake(entry, len(cameras)) for entry in node["mistakes"].items()),
        placed_boards=boards,
    )


def _decode_mistake(node: Node, cameras: int) -> RigMistake:
    other, camera = (_decode_index(entry, cameras) for entry in node["cameras"].items(2))
    return RigMistake(
        Mistake(node["kind"].choice(list(Mistake))),
        camera,
        other,
        tuple(node["instants"].integers(None).tolist()),
        node["value"].number(),
    )


def _decode_camera(node: Node) -> Camera:
    model, params = decode_model(node["model"]), node["params"]
    for name in ("fx", "fy"):
        if not params[name].number() > 0:
            params[name].fail("a focal length above 0")
    values = [params[name].number() for name in list_parameter_names(model)]
    return Camera(node["size"].image_size(), np.array(values), model)


def _decode_pose(node: Node) -> Pose:
    return Pose(node["rvec"].numbers(3), node["tvec_mm"].numbers(3))


def _decode_pair(node: Node, cameras: int) -> RigPair:
    first, second = (_decode_index(entry, cameras) for entry in node["cameras"].items(2))
    return RigPair(
        first,
        second,
        node["instants"].integer(),
        node["scatter_mm"].number(),
        node["scatter_by_noise_mm"].number(),
    )


def _decode_view(node: Node, cameras: int, boards: int, instants: dict[int, str]) -> RigView:
    camera, board, instant = _decode_place(node, cameras, boards, instants)
    return RigView(
        camera,
        instant,
        node["residuals_px"].numbers(None, 2),
        node["alone_px"].number(),
        node["contradiction_px"].number(),
        node["turned_deg"].number(),
        board,
    )


def _decode_place(
    node: Node, cameras: int, boards: int, instants: dict[int, str]
) -> tuple[int, int, int]:
    """Return the numbers of a view's camera, board and instant."""
    instant = node["instant"].integer()
    if instant not in instants:
        node["instant"].fail("the number of an instant")
    of_board = node.get("board")
    board = 0 if of_board is None else _decode_index(of_board, boards, "board")
    return _decode_index(node["camera"], cameras), board, instant


def _decode_index(node: Node, count: int, what: str = "camera") -> int:
    if not 0 <= node.integer() < count:
        node.fail(f"the number of a {what}, from 0 to {count - 1}")
    return node.integer()
