"""calibgui rays: what pixels look at."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from calibgui.cli.main import main
from tests.photographs import BOARD

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def points(tmp_path: Path) -> Path:
    """Two pixels of the image, and one outside."""
    file = tmp_path / "points.csv"
    file.write_text("name,u,v\na,100,100\nb,160,120\nc,400,3\n")
    return file


def test_rays_are_tabulated(
    result_file: Path, points: Path, tmp_path: Path, capsys: Capture
) -> None:
    table = tmp_path / "rays.csv"
    assert main(["rays", str(result_file), str(points), "-o", str(table)]) == 0
    assert "1 pixel without an answer: outside of the image" in capsys.readouterr().out
    first, _, last = csv.DictReader(table.read_text().splitlines())
    ray = np.array([float(first[f"ray_{axis}"]) for axis in "xyz"])
    assert np.linalg.norm(ray) == pytest.approx(1)
    assert (first["name"], first["reason"]) == ("a", "")
    assert (last["name"], last["ray_x"], last["reason"]) == ("c", "", "outside of the image")


def test_corners_lie_where_the_board_has_them(
    result_file: Path, photographs: Path, tmp_path: Path
) -> None:
    poses, pixels, table = (tmp_path / name for name in ("poses.json", "corners.csv", "out.csv"))
    image = photographs / "view2.png"
    assert main(["pose", str(result_file), str(image), "--square", "30", "-o", str(poses)]) == 0
    view = next(
        view
        for view in json.loads(result_file.read_text())["views"]
        if view["image"].endswith(image.name)
    )
    rows = [f"{u},{v}" for u, v in view["uv"]]
    pixels.write_text("\n".join(["u,v", *rows]))
    command = ["rays", str(result_file), str(pixels), "--pose", str(poses), "-o", str(table)]
    assert main([*command, "--sigma", "0.01", "-q"]) == 0
    answers = list(csv.DictReader(table.read_text().splitlines()))
    seen = np.array([[float(row["x_mm"]), float(row["y_mm"])] for row in answers])
    sigma = np.array([[float(row["sigma_x_mm"]), float(row["sigma_y_mm"])] for row in answers])
    error = seen - BOARD.points(np.array(view["grid"]))
    assert np.abs(error).max() < 0.02
    assert np.abs(error / sigma).max() < 5


def test_stated_plane(result_file: Path, points: Path, capsys: Capture) -> None:
    command = ["rays", str(result_file), str(points), "--plane", "0,0,500,0,0,0", "--json"]
    assert main(command) == 0
    answer = json.loads(capsys.readouterr().out)
    rays, xy = np.array(answer["rays"][:2]), np.array(answer["xy_mm"][:2])
    np.testing.assert_allclose(xy, 500 * rays[:, :2] / rays[:, 2:])
    assert answer["xy_mm"][2] == [None, None]


def test_refusals(result_file: Path, points: Path, tmp_path: Path, capsys: Capture) -> None:
    command = ["rays", str(result_file), str(points)]
    assert main([*command, "-o", str(points)]) == 1
    assert main([*command, "-o", str(tmp_path / "rays.txt")]) == 1
    with pytest.raises(SystemExit):
        main([*command, "--image", "view1.png"])
    points.write_text("u,v\n-5,0\n")
    assert main(command) == 1
    assert "None of the 1 pixels can be traced: outside of the image" in capsys.readouterr().err
