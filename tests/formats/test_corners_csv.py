"""Corners as CSV: exact, and readable by any reader."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result, View, ViewStatus
from calibgui.formats.corners_csv import write_corners_csv
from calibgui.formats.csv_table import read_csv_rows

_HEADER = "image,row,col,u_px,v_px,x_mm,y_mm\n"


def _read(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.parametrize("name", ["result", "weighted"])
def test_every_bit_of_the_corners_reads_back(
    tmp_path: Path, name: str, request: pytest.FixtureRequest
) -> None:
    result = request.getfixturevalue(name)
    file = tmp_path / "corners.csv"
    write_corners_csv(result.views, result.board, file)
    rows = _read(file)
    for view in result.views:
        if view.status is ViewStatus.FOUND:
            own = [row for row in rows if row["image"] == view.image]
            uv, xy, cov = view.observation(result.board)
            columns = [*uv.T, *xy.T]
            if cov is not None:
                columns += [cov[:, 0, 0], cov[:, 0, 1], cov[:, 1, 1]]
            numbers = [[float(row[name]) for name in list(row)[3:]] for row in own]
            assert np.array_equal(numbers, np.transpose(columns))


def test_there_is_a_row_for_each_corner(tmp_path: Path, result: Result) -> None:
    file = tmp_path / "corners.csv"
    write_corners_csv(result.views, result.board, file)
    rows = _read(file)
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


def test_views_without_corners_have_no_rows(tmp_path: Path) -> None:
    write_corners_csv([View("a.png")], None, tmp_path / "corners.csv")
    assert (tmp_path / "corners.csv").read_text() == _HEADER


def test_a_name_that_is_not_unicode_is_written_for_every_reader(
    tmp_path: Path, result: Result
) -> None:
    first = next(view for view in result.views if view.status is ViewStatus.FOUND)
    file = tmp_path / "corners.csv"
    write_corners_csv([replace(first, image="bad\udcff.png")], result.board, file)
    assert {row["image"] for row in _read(file)} == {"bad\\udcff.png"}


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
    assert list(dict.fromkeys(row["image"] for row in _read(file))) == named


def test_a_name_that_is_a_formula_is_not_computed(tmp_path: Path, result: Result) -> None:
    views = [replace(view, image="=1+1.png") for view in result.views]
    file = tmp_path / "corners.csv"
    write_corners_csv(views, result.board, file)
    assert {row["image"] for row in _read(file)} == {"'=1+1.png"}
    assert {row["image"] for row in read_csv_rows(file)} == {"=1+1.png"}
