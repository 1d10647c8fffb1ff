"""corners.json: the exact public format, this program's additions, and every way to be wrong."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from calibgui.dataset import CornerSet, Result, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.errors import CalibrationError
from calibgui.formats.corners_json import encode_corners, read_corners, write_corners
from calibgui.formats.json_document import dumps
from tests.formats.records import same

_FOREIGN: dict[str, Any] = {
    "size": [640, 480],
    "views": [
        {"image": "a.png", "uv": [[1, 2], [3.5, 4]], "board": [[0, 0], [30, 0]]},
        {
            "image": "b.png",
            "uv": [[1, 2]],
            "board": [[0, 0]],
            "cov": [[[0.01, 0], [0, 0.02]]],
            "camera": "left",
        },
        {"image": "c.png", "uv": [], "board": []},
    ],
    "comment": "from elsewhere",
}


def _read(tmp_path: Path, content: Any) -> CornerSet:
    file = tmp_path / "corners.json"
    file.write_text(json.dumps(content))
    return read_corners(file)


def test_the_bare_format_of_any_program_is_read(tmp_path: Path) -> None:
    corners = _read(tmp_path, _FOREIGN)
    assert corners.size == (640, 480)
    assert corners.board is None
    a, b, c = corners.views
    assert (a.image, a.status, a.usable) == ("a.png", ViewStatus.FOUND, True)
    assert np.array_equal(a.observation(None).uv, [[1, 2], [3.5, 4]])
    assert np.array_equal(a.observation(None).xy, [[0, 0], [30, 0]])
    assert a.observation(None).cov is None
    assert np.array_equal(b.observation(None).cov, [[[0.01, 0], [0, 0.02]]])
    assert (c.status, c.usable) == (ViewStatus.NO_BOARD, False)


def test_what_is_written_has_the_bare_format(tmp_path: Path, result: Result) -> None:
    """Read as a stranger would: nothing but the four public keys of each view."""
    file = tmp_path / "corners.json"
    write_corners(CornerSet((640, 480), result.views, result.board), file)
    content = json.loads(file.read_text(encoding="utf-8"))
    assert content["size"] == [640, 480]
    assert [view["image"] for view in content["views"]] == [view.image for view in result.views]
    for view, written in zip(result.views, content["views"], strict=True):
        if view.status is ViewStatus.FOUND:
            points = view.observation(result.board)
            assert np.array_equal(written["uv"], points.uv)
            assert np.array_equal(written["board"], points.xy)
        else:
            assert written["uv"] == written["board"] == []


@pytest.mark.parametrize("name", ["result", "weighted"])
def test_everything_this_program_knows_reads_back(
    tmp_path: Path, name: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(name)
    corners = CornerSet((640, 480), result.views, result.board)
    write_corners(corners, tmp_path / "corners.json")
    assert same(read_corners(tmp_path / "corners.json"), corners)


def test_edited_plate_points_count_for_more_than_the_grid(tmp_path: Path, result: Result) -> None:
    """A measured board: the corners keep their grid, the calibration gets the file's points."""
    content = json.loads(dumps(encode_corners(CornerSet((640, 480), result.views, result.board))))
    content["views"][1]["board"][3] = [90.25, 0.5]
    view = _read(tmp_path, content).views[1]
    assert view.corners is not None
    assert np.array_equal(view.observation(result.board).xy[3], [90.25, 0.5])


def test_found_corners_follow_another_square_size(tmp_path: Path, result: Result) -> None:
    content = encode_corners(CornerSet((640, 480), result.views, result.board))
    (tmp_path / "corners.json").write_text(dumps(content))
    view = read_corners(tmp_path / "corners.json").views[1]
    assert view.observation(Board(6, 8, 60.0)).xy.max() == 7 * 60.0


@pytest.mark.parametrize(
    ("place", "value", "message"),
    [
        (["size"], [640], "size is not a list of 2 entries"),
        (["size"], [640, 0], "size is not the width and height"),
        (["size"], [640.5, 480], "size is not an array of integers"),
        (["views", 0, "orientation"], 9, "orientation is not an EXIF orientation from 1 to 8"),
        (["views"], {}, "views is not a list"),
        (["views", 1], 7, "view 2 is not an object"),
        (["views", 1, "image"], 7, "view 2.image is not text"),
        (["views", 0, "uv", 1], [1, None], r"view 1 \(a.png\).uv\[1\]\[1\] is not a finite"),
        (["views", 0, "uv", 1], [1, 2, 3], r"view 1 \(a.png\).uv\[1\] is not a list of 2"),
        (["views", 0, "board"], [[0, 0]], r"view 1 \(a.png\).board is not a list of 2 entries"),
        (["views", 0, "uv", 0, 0], float("nan"), r"uv\[0\]\[0\] is not a finite number"),
        (["views", 1, "cov"], [[0.1, 0.1]], r"view 2 \(b.png\).cov\[0\]\[0\] is not a list"),
        (["views", 0, "status"], "seen", r"view 1 \(a.png\).status is not one of waiting, found"),
        (["views", 0, "status"], "no-board", "although the view has corners"),
        (["views", 2, "status"], "found", "although the status is 'found'"),
        (["format"], "calibgui-result", "is not a file of corners"),
        (["size"], [1e18, 480], "size is not an array of integers"),
        (["target"], {"rows": 1, "cols": 4, "square_mm": 30}, "rows is not a number of corners"),
        (["target"], {"rows": 4, "cols": 4, "square_mm": 0}, "square_mm is not a length above 0"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, place: list[Any], value: Any, message: str) -> None:
    content = copy.deepcopy(_FOREIGN)
    node = content
    for key in place[:-1]:
        node = node[key]
    node[place[-1]] = value
    with pytest.raises(CalibrationError, match=message):
        _read(tmp_path, content)


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"size": [640.5, 480]}, "size is not an array of integers"),
        ({"size": [640, -1]}, "size is not the width and height of an image"),
        ({"cov": [[[1, 0.5], [0.4, 1]]]}, "cov is not a covariance: it is not symmetric"),
        ({"cov": [[[1, 2], [2, 1]]]}, "cov is not a covariance: it has a correlation beyond 1"),
        ({"cov": [[[-1, 0], [0, 1]]]}, "cov is not a covariance: it has a variance below 0"),
        ({"shape": [10**9, 10**9]}, "shape is not the rows and columns of a board, from 1 to 1000"),
        ({"shape": [0, 4]}, "shape is not the rows and columns of a board"),
        ({"grid": [[-1, 0]]}, "grid is not a list of rows and columns on a board of 3 x 4"),
        ({"grid": [[0, 4]]}, "grid is not a list of rows and columns on a board of 3 x 4"),
        ({"target": {"rows": 10**9, "cols": 9, "square_mm": 1}}, "rows is not a number of corners"),
        ({"cov": [[[None, 0], [0, 1]]]}, "cov.* is not a finite number"),
    ],
)
def test_impossible_sizes_places_and_covariances_are_named(
    tmp_path: Path, change: dict[str, Any], problem: str
) -> None:
    view = {"image": "a.png", "uv": [[1, 2]], "board": [[0, 0]], "shape": [3, 4], "grid": [[0, 0]]}
    content: dict[str, Any] = {"size": [640, 480], "views": [view]}
    for name, value in change.items():
        (content if name in ("size", "target") else view)[name] = value
    file = tmp_path / "corners.json"
    file.write_text(json.dumps(content))
    with pytest.raises(CalibrationError, match=problem) as caught:
        read_corners(file)
    assert "corners.json" in caught.value.message
