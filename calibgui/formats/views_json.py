"""A view as a JSON object, the same in corners.json, result.json and whatever holds views.

    image    name or path                       uv      (n, 2) px, array frame; [] if none
    status   see ViewStatus                     board   (n, 2) mm on the board
    reason   why it cannot be used              cov     (n, 2, 2) px^2, where known
    enabled  true if the user wants it          roi     (4, 2) px, where given by the user
    note     how its corners were found, if unusual
    orientation  EXIF orientation by which the pixels were turned, where known
    field    "odd" or "even", where the image is interlaced and one field of it was searched
    circle   [u, v, radius], px: what the lens lights of the image, unless it is all

and for corners found on a board of known layout their `grid` (row, column), the board's
`shape`, first `estimate`, `ambiguity`, `relative`, `method` and the searched `outline`; also
`others`, further boards in the image, each with its `shape` and `outline`, and the `pattern` as
the image shows it, unless it is a checkerboard.
`image`, `uv` and `board` suffice: the others have defaults.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from calibgui.dataset import View, ViewStatus
from calibgui.engine.boards import CHECKERBOARD, Board, Symmetry
from calibgui.engine.calibration import Observation
from calibgui.engine.camera import ImageCircle
from calibgui.engine.features import Corners, OtherBoard
from calibgui.engine.images import Field
from calibgui.formats.node import Node
from calibgui.formats.pattern_json import decode_pattern, encode_pattern


def encode_view(view: View, board: Board | None) -> dict[str, Any]:
    """Return the JSON object of a view; `board` gives found corners their places, mm."""
    record: dict[str, Any] = {
        "image": view.image,
        "status": view.status,
        "reason": view.reason,
        "enabled": view.enabled,
    }
    if view.note:
        record["note"] = view.note
    if view.orientation is not None:
        record["orientation"] = view.orientation
    if view.field is not None:
        record["field"] = view.field
    if view.roi is not None:
        record["roi"] = view.roi
    if view.circle is not None:
        record["circle"] = view.circle
    if view.points is None and view.corners is None:
        return record | {"uv": [], "board": []}
    uv, xy, cov = view.observation(board)
    record |= {"uv": uv, "board": xy}
    if cov is not None:
        record["cov"] = cov
    if view.corners is not None:
        record |= _encode_corners(view.corners)
    return record


def _encode_corners(corners: Corners) -> dict[str, Any]:
    record: dict[str, Any] = {
        "shape": corners.shape,
        "grid": corners.grid,
        "estimate": corners.estimate,
        "ambiguity": corners.ambiguity,
        "relative": corners.relative,
        "method": corners.method,
    }
    if corners.roi is not None:
        record["outline"] = corners.roi
    if corners.others:
        record["others"] = [other._asdict() for other in corners.others]
    if corners.pattern != CHECKERBOARD:
        record["pattern"] = encode_pattern(corners.pattern)
    return record


def decode_views(node: Node, board: Board | None) -> tuple[View, ...]:
    """Return the views of a list of JSON objects.

    Raises:
        CalibrationError: if something is wrong; the message names file, view and entry.
    """
    return tuple(_decode_view(item, k, board) for k, item in enumerate(node.items()))


def _decode_view(node: Node, k: int, board: Board | None) -> View:
    """Decode the k-th view of a list, counted from 0."""
    image = node.named(f"view {k + 1}")["image"].file_name()
    node = node.named(f"view {k + 1} ({image})")
    uv = node["uv"].numbers(None, 2)
    xy = node["board"].numbers(len(uv), 2)
    cov = node.get("cov")
    points = Observation(uv, xy, cov.covariances(len(uv), 2, 2) if cov else None)
    corners = _decode_corners(node, points) if len(uv) else None
    # Found corners take their places from the board, unless the file gives others.
    on_board = corners and board and np.array_equal(board.points(corners.grid), xy)
    return View(
        image=image,
        status=_decode_status(node, found=len(uv) > 0),
        reason=reason.text() if (reason := node.get("reason")) else "",
        note=note.text() if (note := node.get("note")) else "",
        corners=corners,
        points=points if len(uv) and not on_board else None,
        roi=roi.numbers(4, 2) if (roi := node.get("roi")) else None,
        orientation=_decode_orientation(node.get("orientation")),
        field=decode_field(node.get("field")),
        circle=decode_circle(node.get("circle")),
        enabled=enabled.flag() if (enabled := node.get("enabled")) else True,
    )


def decode_field(node: Node | None) -> Field | None:
    """Return the field of its name; None of nothing."""
    return None if node is None else Field(node.choice(list(Field)))


def decode_circle(node: Node | None) -> ImageCircle | None:
    """Return the image circle of [u, v, radius]; None of nothing."""
    if node is None:
        return None
    circle = ImageCircle(*node.numbers(3).tolist())
    if not circle.radius > 0:
        node.fail("a column, a row and a radius above 0")
    return circle


def _decode_orientation(node: Node | None) -> int | None:
    if node is None:
        return None
    if not 1 <= node.integer() <= 8:
        node.fail("an EXIF orientation from 1 to 8")
    return node.integer()


def _decode_status(node: Node, found: bool) -> ViewStatus:
    """Decode the status, which older files lack, and check it against the corners."""
    stated = node.get("status")
    if stated is None:
        return ViewStatus.FOUND if found else ViewStatus.NO_BOARD
    status = ViewStatus(stated.choice(list(ViewStatus)))
    if found and status is not ViewStatus.FOUND:
        stated.fail("'found' although the view has corners")
    if status is ViewStatus.FOUND and not found:
        node["uv"].fail("a list of corners although the status is 'found'")
    return status


def _decode_corners(node: Node, points: Observation) -> Corners | None:
    """Return the corners with their places on a board; None if the file does not give these."""
    grid, shape = node.get("grid"), node.get("shape")
    if grid is None or shape is None:
        return None
    size, places = shape.grid_size(), grid.integers(len(points.uv), 2)
    if (places < 0).any() or (places >= size).any():
        grid.fail(f"a list of rows and columns on a board of {size[0]} x {size[1]}")
    estimate, outline = node.get("estimate"), node.get("outline")
    ambiguity, relative = node.get("ambiguity"), node.get("relative")
    others = node.get("others")
    n = len(points.uv)
    return Corners(
        shape=size,
        grid=places,
        uv=points.uv,
        estimate=estimate.numbers(n, 2) if estimate else points.uv,
        cov=points.cov,
        ambiguity=Symmetry(ambiguity.choice(list(Symmetry))) if ambiguity else Symmetry.NONE,
        roi=outline.numbers(4, 2) if outline else None,
        method=method.text() if (method := node.get("method")) else "",
        relative=relative.flag() if relative else False,
        others=tuple(map(_decode_other, others.items())) if others else (),
        pattern=decode_pattern(node.get("pattern")),
    )


def _decode_other(node: Node) -> OtherBoard:
    return OtherBoard(node["shape"].grid_size(), node["outline"].numbers(4, 2))
