"""The whole line from photographs of listed circles to a camera, on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from calibgui.cli.main import main
from calibgui.engine.boards import Board, ListedCircles, list_circles
from calibgui.engine.images.reading import write_image
from calibgui.engine.images.rendering import render_view
from calibgui.formats.corners_json import read_corners
from calibgui.formats.fleet_ledger import open_ledger
from calibgui.formats.result_json import read_result
from tests.cli.test_boards import _SCHEMA, CAMERA
from tests.engine import scenes
from tests.scenes.circle_lists import list_rows_by_turns

PLACES = list_rows_by_turns(8, 11, 15.0)


@pytest.fixture
def layout(tmp_path: Path) -> Path:
    file = tmp_path / "board.csv"
    file.write_text("x,y\n" + "\n".join(f"{x},{y}" for x, y in PLACES))
    return file


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    pattern, pitch = list_circles(PLACES, 8.0)
    board, rng = Board(*pattern.grid_size, pitch, pattern), np.random.default_rng(2)
    folder = tmp_path / "photographs"
    folder.mkdir()
    for k in range(6):
        pose = scenes.looking(CAMERA, rng, fill=(0.45, 0.55), board=board)
        image = render_view(CAMERA, pose, board, blur=0.7, noise=1.0, seed=k)
        write_image(folder / f"view{k}.png", image)
    return folder


def test_a_camera_from_listed_circles(
    layout: Path, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, corners = tmp_path / "result.json", tmp_path / "corners.json"
    assert main(["detect", str(folder), "--layout", str(layout), "-o", str(corners)]) == 0
    assert f"Board of {len(PLACES)} listed circles" in capsys.readouterr().out
    found = read_corners(corners)
    assert found.lengths_confirmed and found.board is not None
    assert isinstance(found.board.pattern, ListedCircles)
    assert main(["calibrate", str(corners), "-o", str(out), "-q"]) == 0
    jsonschema.validate(json.loads(out.read_text()), json.loads(_SCHEMA.read_text()))
    result = read_result(out)
    np.testing.assert_allclose(result.calibration.camera.params[:4], CAMERA.params[:4], atol=0.3)


def test_a_manifest_names_the_list_of_a_camera(layout: Path, folder: Path, tmp_path: Path) -> None:
    manifest, ledger = tmp_path / "manifest.csv", tmp_path / "fleet.db"
    manifest.write_text(f"id,paths,board\na,{folder.name},{layout.name}\n")
    assert main(["batch", str(manifest), "-o", str(ledger), "--workers", "1", "--once"]) == 0
    with open_ledger(ledger) as kept:
        (camera,) = kept.read()
    found = read_result(tmp_path / str(camera.result)).calibration.camera.params[0]
    assert found == pytest.approx(CAMERA.params[0], abs=0.3)


def test_a_listed_board_is_printed(layout: Path, tmp_path: Path) -> None:
    out = str(tmp_path / "board.svg")
    assert main(["print", "--layout", str(layout), "--diameter", "8", "-o", out]) == 0
    assert Path(out).read_text().count("<circle") == len(PLACES)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--target", "listed-circles"], "needs --layout"),
        (["--layout", "FILE", "--target", "circles"], "not for circles"),
        (["--layout", "FILE", "--square", "20"], "follow from --layout"),
        (["--layout", "FILE", "--board", "8x9"], "follow from --layout"),
        (["--layout", "FILE", "--diameter", "30"], "touch"),
        (["--layout", "nowhere.csv"], "nowhere.csv"),
    ],
)
def test_what_does_not_go_together_is_said(
    options: list[str], says: str, layout: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    named = [str(layout) if option == "FILE" else option for option in options]
    with pytest.raises(SystemExit):
        main(["detect", str(layout.parent), *named])
    assert says in capsys.readouterr().err
