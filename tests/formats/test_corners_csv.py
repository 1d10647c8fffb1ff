"""Corners as CSV: exact, readable by any reader, wrong lines named."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.errors import CalibrationError
from calibgui.formats.corners_csv import read_corners_csv, write_corners_csv
from tests.formats.records import same

_HEADER = "image,row,col,u_px,v_px,x_mm,y_mm\n"


@pytest.mark.parametrize("name", ["result", "weighted"])
def test_every_bit_of_the_corners_reads_back(
    tmp_path: Path, name: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(name)
    file = tmp_path / "corners.csv"
    write_corners_csv(result.views, result.board, file)
    found = [view for view in result.views if view.status is ViewStatus.FOUND]
    for written, read in zip(found, read_corners_csv(file), strict=True):
        assert read.image == written.image
        assert same(
            tuple(read.observation(None)),
            tuple(written.observation(result.board)),
        )


def test_any_csv_reader_finds_a_row_for_each_corner(tmp_path: Path, result: Result) -> None:
    file = tmp_path / "corners.csv"
    write_corners_csv(result.views, result.board, file)
    with file.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert list(rows[0]) == _HEADER.strip().split(",")
    assert len(rows) == 6 * 48 - 5
    assert {row["image"] for row in rows} == {
        v.image for v in result.views if v.corners or v.points
    }
    for row in rows:
        if row["image"] == "foreign.png":
            assert row["row"] == row["col"] == ""
        else:
            assert float(row["x_mm"]) == 30 * int(row["col"])
            assert float(row["y_mm"]) == 30 * int(row["row"])


def test_columns_that_help_may_be_missing(tmp_path: Path) -> None:
    file = tmp_path / "bare.csv"
    file.write_text("x_mm,y_mm,image,u_px,v_px\r\n0,30,a.png,1.5,2\r\n30,30,a.png,4,5\r\n")
    (view,) = read_corners_csv(file)
    assert np.array_equal(view.observation(None).uv, [[1.5, 2], [4, 5]])
    assert np.array_equal(view.observation(None).xy, [[0, 30], [30, 30]])


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "has no corners"),
        (_HEADER, "has no corners"),
        ("image,u_px\na.png,1\n", "has no v_px, x_mm, y_mm"),
        (_HEADER + "a.png,0,0,1,2,0,0\na.png,0,1,1,,30,0\n", r"v_px of corner 2 \(a.png\)"),
        (_HEADER + "a.png,0,0,1,nan,0,0\n", r"v_px of corner 1 \(a.png\)"),
        (_HEADER + "a.png,0,0,1,2,0\n", r"y_mm of corner 1 \(a.png\)"),
        (
            _HEADER.strip()
            + ",cov_uu,cov_uv,cov_vv\na.png,0,0,1,2,0,0,1,0,1\na.png,0,1,2,2,9,0,,,\n",
            "some corners of a.png have covariances",
        ),
        ("\ud800", "is not a CSV file"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, content: str, message: str) -> None:
    file = tmp_path / "corners.csv"
    file.write_bytes(content.encode("utf-8", "surrogatepass"))
    with pytest.raises(CalibrationError, match=message) as caught:
        read_corners_csv(file)
    assert str(file) in caught.value.message
    assert caught.value.hint


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match=r"absent\.csv does not exist"):
        read_corners_csv(tmp_path / "absent.csv")


def test_views_without_corners_have_no_rows(tmp_path: Path) -> None:
    write_corners_csv([View("a.png")], None, tmp_path / "corners.csv")
    assert (tmp_path / "corners.csv").read_text() == _HEADER


def test_a_name_that_is_not_unicode_is_written_for_every_reader(
    tmp_path: Path, result: Result
) -> None:
    first = next(view for view in result.views if view.status is ViewStatus.FOUND)
    file = tmp_path / "corners.csv"
    write_corners_csv([replace(first, image="bad\udcff.png")], result.board, file)
    assert {view.image for view in read_corners_csv(file)} == {"bad\\udcff.png"}


def test_a_name_that_no_file_has_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "corners.csv"
    path.write_text("image,row,col,u_px,v_px,x_mm,y_mm\na\0b.png,0,0,1,2,3,4\n")
    with pytest.raises(CalibrationError, match=r"image of corner 1 is no name of a file"):
        read_corners_csv(path)


@pytest.mark.parametrize(
    ("images", "named"),
    [
        (["/data/photos/a.png", "/data/photos/b.png"], ["a.png", "b.png"]),
        (["/data/left/a.png", "/data/right/a.png"], ["left/a.png", "right/a.png"]),
        (["photos/a.png", "/data/b.png"], ["photos/a.png", "/data/b.png"]),
    ],
)
def test_images_are_named_without_what_differs_between_computers(
    tmp_path: Path, result: Result, images: list[str], named: list[str]
) -> None:
    found = [view for view in result.views if view.status is ViewStatus.FOUND]
    views = [replace(view, image=image) for view, image in zip(found, images, strict=False)]
    file = tmp_path / "corners.csv"
    write_corners_csv(views, result.board, file)
    assert [view.image for view in read_corners_csv(file)] == named
