"""The corners that a subcommand works on, and what is said of them."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.cli import corners
from calibgui.cli.arguments import parse_square
from calibgui.cli.console import Console
from calibgui.cli.corners import read_or_search
from calibgui.cli.main import main
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.formats.corners_json import read_corners, write_corners
from calibgui.formats.result_json import read_result
from calibgui.report.tables import WIDTH_CHARACTERS

_CORNERS = Path(__file__).parents[1] / "golden" / "corners.json"


@pytest.mark.parametrize("name", ["corners.vnl", "corners.csv"])
def test_corners_of_other_programs_are_taken_for_photographs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    own = read_corners(_CORNERS)
    assert own.board is not None
    corners = [
        (view.image, replace(view.corners, cov=None))
        for view in own.views
        if view.corners is not None and view.corners.complete
    ]
    views = tuple(View(image, ViewStatus.FOUND, corners=each) for image, each in corners)
    write_corners(replace(own, views=views), tmp_path / "own.json")
    rows = [
        (image, *uv, *place)
        for image, each in corners
        for uv, place in zip(each.uv.tolist(), each.grid.tolist(), strict=True)
    ]
    if name.endswith(".vnl"):
        lines = ["# filename x y", *(f"{image} {u!r} {v!r}" for image, u, v, *_ in rows)]
    else:
        lines = ["image,u,v,row,col", *(",".join(map(str, row)) for row in rows)]
    (tmp_path / name).write_text("\n".join(lines) + "\n")
    rows_and_columns, size = ("x".join(map(str, pair)) for pair in (own.board.grid_size, own.size))
    stated = ["--board", rows_and_columns, "--size", size, "--square", str(own.board.square)]
    figures = []
    for arguments in ([str(tmp_path / "own.json")], [str(tmp_path / name), *stated]):
        assert main(["calibrate", "--json", *arguments, "--as-asked", "--model", "pinhole"]) == 0
        figures.append(json.loads(capsys.readouterr().out)["camera"]["params"])
    assert figures[0] == figures[1]


def test_what_is_recognised_is_told_in_lines_that_fit(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    remark = f"The photographs show: {'ChArUco board, ' * 10}DICT_4X4_50."
    found = CornerSet((640, 480), (), None), [remark]
    monkeypatch.setattr(corners, "search_board", lambda *_: found)
    options = argparse.Namespace(paths=["photographs"], square=20.0, exclude=())
    assert read_or_search(options, Console()) is found[0]
    printed = capsys.readouterr().out
    assert " ".join(printed.split()) == remark
    assert max(map(len, printed.splitlines())) <= WIDTH_CHARACTERS


@pytest.mark.parametrize(
    ("text", "square", "sigma"),
    [
        ("30", 30.0, 0.0),
        ("30+-0.02", 30.0, 0.02),
        ("30 ± 0.02", 30.0, 0.02),
        ("3cm+-0.02mm", 30.0, 0.02),
        ("0.03m±0.00002", 30.0, 0.02),
        ("300+-0.05/10", 30.0, 0.005),
        ("300.00 ± 0.05 mm (k=2) / 10", 30.0, 0.0025),
        ("300/10", 30.0, 0.0),
    ],
)
def test_a_side_of_squares_has_an_uncertainty(text: str, square: float, sigma: float) -> None:
    assert parse_square(text) == (pytest.approx(square), pytest.approx(sigma))


@pytest.mark.parametrize(
    "text", ["", "30+-", "30+-40", "30/0", "30 (k=2)", "30+-x", "a+-1", "1/2/3"]
)
def test_what_is_no_side_of_squares_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        parse_square(text)


def test_the_scale_of_the_board_reaches_the_result(
    corners_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result = tmp_path / "result.json"
    exact = tmp_path / "exact.json"
    for square, file in (("30+-0.03", result), ("30", exact)):
        command = ["calibrate", str(corners_file), "--as-asked", "--square", square, "-q"]
        assert main([*command, "-o", str(file)]) == 0
    scaled, plain = (json.loads(file.read_text()) for file in (result, exact))
    assert scaled["target"]["square_sigma_mm"] == 0.03
    assert "square_sigma_mm" not in plain["target"]
    view, other = (next(v for v in each["views"] if v["rvec"]) for each in (scaled, plain))
    assert view["pose_covariance_by_views"] == other["pose_covariance"]
    assert view["sigma_tvec_mm"][2] ** 2 == pytest.approx(
        other["sigma_tvec_mm"][2] ** 2 + (0.001 * view["tvec_mm"][2]) ** 2
    )
    again = read_result(result)
    assert again.calibration.pose_covariances[0].tolist() == other["pose_covariance"]
    capsys.readouterr()
    length = ["uncertainty", str(result), "--length", "100", "--at", "500"]
    assert main([*length, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["length"]["by_scale_mm"] == pytest.approx(0.1)
    assert main(length) == 0
    assert "% the board's scale." in " ".join(capsys.readouterr().out.split())
