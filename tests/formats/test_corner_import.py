"""Corners of other programs: the same numbers at the same places, whatever the file is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import CornerSet, Result, ViewStatus
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import write_image
from calibgui.formats.corner_import import read_corner_file
from calibgui.formats.corners_csv import write_corners_csv
from calibgui.formats.corners_json import EXAMPLE, write_corners

_SIZE = (1280, 720)
_GRID = np.argwhere(np.ones((3, 4), bool))
_UV = np.array([100.5, 80.25]) + _GRID[:, ::-1] * [60.5, 0.5] + _GRID * [0.25, 55.75]


def _write(folder: Path, name: str, lines: list[str]) -> Path:
    (folder / name).write_text("\n".join(lines) + "\n")
    return folder / name


def _write_vnl(folder: Path, legend: str, *ends: str) -> Path:
    """Write corners of one image, each followed by one of `ends` by turns."""
    rows = [f"a.png {u!r} {v!r}{ends[k % len(ends)]}" for k, (u, v) in enumerate(_UV.tolist())]
    return _write(folder, "corners.vnl", [f"# filename x y{legend}", *rows])


def test_rows_of_mrcal_are_the_board_row_by_row(tmp_path: Path) -> None:
    file = _write_vnl(tmp_path, " level", " 0")
    file.write_text("## mrgingham\n" + file.read_text() + "b.png - - -\n")
    corner_set = read_corner_file(file, (3, 4), 25.0, _SIZE)
    assert corner_set.size == _SIZE
    assert corner_set.lengths_confirmed
    seen, unseen = corner_set.views
    uv, xy, cov = seen.observation(corner_set.board)
    np.testing.assert_array_equal(uv, _UV)
    np.testing.assert_array_equal(xy, 25.0 * _GRID[:, ::-1])
    assert cov is None
    assert (unseen.image, unseen.status) == ("b.png", ViewStatus.NO_BOARD)
    assert unseen.reason


@pytest.mark.parametrize(
    ("legend", "ends", "ratio"),
    [(" level", (" 0", " 1"), 4.0), (" level", (" 3", " 1"), 1 / 16),
     (" weight", (" 1", " .2"), 25.0)],
)  # fmt: skip
def test_uneven_levels_and_weights_of_mrcal_are_covariances(
    tmp_path: Path, legend: str, ends: tuple[str, ...], ratio: float
) -> None:
    corner_set = read_corner_file(_write_vnl(tmp_path, legend, *ends), (3, 4), None, _SIZE)
    assert not corner_set.lengths_confirmed
    cov = corner_set.views[0].observation(corner_set.board).cov
    assert cov is not None
    np.testing.assert_allclose(cov[1::2], ratio * cov[::2], rtol=1e-12)
    np.testing.assert_array_equal(cov[:, 0, 0], cov[:, 1, 1])
    assert not cov[:, 0, 1].any()


@pytest.mark.parametrize(
    ("legend", "lost"),
    [(" level", "a.png - - -"), (" level", "a.png 9 9 -1"), (" level", "a.png 9 9 -"),
     (" weight", "a.png 9 9 0"), (" level", "a.png -1 -1 0"), ("", "a.png -1.0 -1.0")],
)  # fmt: skip
def test_corners_that_mrcal_leaves_out_take_their_place_and_are_none(
    tmp_path: Path, legend: str, lost: str
) -> None:
    file = _write_vnl(tmp_path, legend, "")
    lines = file.read_text().splitlines()
    lines[6] = lost  # the sixth corner
    _write(tmp_path, file.name, lines)
    corners = read_corner_file(file, (3, 4), None, _SIZE).views[0].corners
    assert corners is not None
    np.testing.assert_array_equal(corners.grid, np.delete(_GRID, 5, axis=0))
    np.testing.assert_array_equal(corners.uv, np.delete(_UV, 5, axis=0))


def test_the_boards_rows_and_columns_of_mrcal_must_be_stated(tmp_path: Path) -> None:
    file = _write_vnl(tmp_path, "", "")
    with pytest.raises(CalibrationError, match="how many rows") as caught:
        read_corner_file(file, size=_SIZE)
    assert "3x4, 4x3" in caught.value.hint
    with pytest.raises(CalibrationError, match=r"12 rows for a\.png; a board of 4 x 4 has 16"):
        read_corner_file(file, (4, 4), size=_SIZE)


def test_a_word_among_numbers_of_mrcal_is_named_with_its_line(tmp_path: Path) -> None:
    file = _write_vnl(tmp_path, "", "")
    file.write_text(file.read_text().replace("100.5", "nan"))
    with pytest.raises(CalibrationError, match="corner in line 2: 'nan' is not a number"):
        read_corner_file(file, (3, 4), size=_SIZE)


@pytest.mark.parametrize(
    ("head", "places", "square", "confirmed"),
    [
        ("image,u,v,row,col", _GRID, 30.0, False),
        ("filename,x,y,row,column", _GRID, 30.0, False),
        ("image,u_px,v_px,X,Y", 25 * _GRID[:, ::-1], None, True),
        ("name,u,v,x,y", 25 * _GRID[:, ::-1], None, True),
        ("image,u,v,x_m,y_m", 0.025 * _GRID[:, ::-1], None, True),
    ],
)
def test_tables_are_read_by_the_names_of_their_columns(
    tmp_path: Path, head: str, places: np.ndarray, square: float | None, confirmed: bool
) -> None:
    rows = np.hstack([_UV, places]).tolist()
    file = _write(tmp_path, "a.csv", [head, *(",".join(map(str, ["a.png", *r])) for r in rows)])
    corner_set = read_corner_file(file, size=_SIZE)
    assert (corner_set.board and corner_set.board.square) == square
    assert corner_set.lengths_confirmed == confirmed
    uv, xy, _ = corner_set.views[0].observation(corner_set.board)
    np.testing.assert_array_equal(uv, _UV)
    np.testing.assert_allclose(xy, (square or 25.0) * _GRID[:, ::-1], rtol=1e-12)
    if square is None:
        with pytest.raises(CalibrationError, match=r"already gives .* in millimetres"):
            read_corner_file(file, square=20.0, size=_SIZE)
    else:
        stated = read_corner_file(file, square=20.0, size=_SIZE)
        assert stated.lengths_confirmed
        np.testing.assert_array_equal(
            stated.views[0].observation(stated.board).xy, 20.0 * _GRID[:, ::-1]
        )


@pytest.mark.parametrize("name", ["result", "weighted"])
def test_our_own_table_comes_back(
    tmp_path: Path, name: str, request: pytest.FixtureRequest
) -> None:
    result: Result = request.getfixturevalue(name)
    views = [v for v in result.views if v.corners is not None]
    write_corners_csv(views, result.board, tmp_path / "a.csv")
    read = read_corner_file(tmp_path / "a.csv", size=_SIZE)
    assert read.board is not None
    assert result.board is not None
    assert read.board.square == result.board.square
    for own, again in zip(views, read.views, strict=True):
        for a, b in zip(own.observation(result.board), again.observation(read.board), strict=True):
            np.testing.assert_array_equal(a, b)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (["image,u,v", "a,1,2"], "is no table of corners"),
        (["image,u,v,row,col", "a,1,,0,0"], "line 2: '' in the column v is not a number"),
        (["image,u,v,row,col", "a,1,2,0.5,0"], "no whole number"),
        (["image,u,v,row,col", "a,1,2,0,-1"], "no whole number"),
        (["image,u,v,row,col", "a,1,2,0,1000000"], "no whole number"),
        (["image,u,v,row,col", "a,1,2,0,0", "a,3,4,0,0"], "two corners in one place of a"),
    ],
)
def test_faults_of_a_table_are_named(tmp_path: Path, rows: list[str], message: str) -> None:
    with pytest.raises(CalibrationError, match=message) as caught:
        read_corner_file(_write(tmp_path, "a.csv", rows), size=_SIZE)
    assert "a.csv" in caught.value.message


def test_the_size_is_that_of_an_image_beside_the_file_or_stated(tmp_path: Path) -> None:
    file = _write_vnl(tmp_path, "", "")
    with pytest.raises(CalibrationError, match="does not say how large its images are"):
        read_corner_file(file, (3, 4))
    write_image(tmp_path / "a.png", np.zeros((30, 40), np.uint8))
    assert read_corner_file(file, (3, 4)).size == (40, 30)
    assert read_corner_file(file, (3, 4), size=_SIZE).size == _SIZE


def test_what_is_refused_shows_a_file_that_is_read(tmp_path: Path) -> None:
    for name, text in (("a.json", '{"poses": []}'), ("a.csv", "time;x;y\n"), ("a.vnl", "1 2 3\n")):
        with pytest.raises(CalibrationError, match="is not a file of corners") as caught:
            read_corner_file(_write(tmp_path, name, [text]))
        assert EXAMPLE in caught.value.hint
    assert len(EXAMPLE.splitlines()) == 5
    shown = read_corner_file(_write(tmp_path, "b.json", [EXAMPLE]))
    assert shown.size == _SIZE
    assert len(shown.views[0].observation(None).uv) == 4


def test_what_a_file_says_itself_is_not_stated_otherwise(tmp_path: Path, result: Result) -> None:
    size = result.calibration.camera.size
    write_corners(CornerSet(size, result.views, result.board), tmp_path / "a.json")
    assert result.board is not None
    assert read_corner_file(tmp_path / "a.json", result.board.grid_size, size=size).size == size
    with pytest.raises(CalibrationError, match=r"is for images of \d+ x \d+ px"):
        read_corner_file(tmp_path / "a.json", size=(99, 99))
    with pytest.raises(CalibrationError, match="says itself where the corners are"):
        read_corner_file(tmp_path / "a.json", (3, 3))
