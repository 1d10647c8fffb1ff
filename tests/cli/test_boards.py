"""The whole line from photographs of a ChArUco board or of circles to the exported file."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from calibgui.app.calibrating.synthetic import run_synthetic_check
from calibgui.cli.main import main
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.reading import write_image
from calibgui.engine.images.rendering import render_view
from calibgui.formats.corners_json import read_corners
from calibgui.formats.result_json import read_result
from tests.engine import scenes

CAMERA = Camera((480, 360), [490.0, 493.0, 236.0, 182.0, 0.15, 0.03, 0.0, 3e-4, -4e-4, 0.0])
BOARDS = {
    "charuco": Board(5, 7, 30.0, Charuco("DICT_4X4_50", 0.7)),
    "asymmetric-circles": Board(9, 4, 15.0, Circles(True, 0.8)),
    "aprilgrid": Board(8, 8, 30.0, AprilGrid("t36h11", 0.3, 2, False)),
    "bare-aprilgrid": Board(8, 8, 30.0, AprilGrid("t36h11", 0.3, 2, False, False)),
}
_SCHEMA = Path(__file__).parents[2] / "resources" / "schema" / "result-1.schema.json"


@pytest.fixture(scope="module", params=list(BOARDS))
def kind(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def folder(kind: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp(kind)
    rng, grid_size = np.random.default_rng(2), BOARDS[kind]
    for k in range(6):
        pose = scenes.looking(CAMERA, rng, fill=(0.45, 0.55), board=grid_size)
        image = render_view(CAMERA, pose, grid_size, blur=0.7, noise=1.0, seed=k)
        write_image(folder / f"view{k}.png", image)
    return folder


@pytest.mark.slow
def test_from_photographs_to_exports(
    kind: str, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    grid_size = BOARDS[kind]
    stated = ["--target", grid_size.pattern.kind, "--square", str(grid_size.square)]
    if kind != "charuco":
        stated += ["--board", f"{grid_size.rows}x{grid_size.cols}"]
    out, corners = tmp_path / "result.json", tmp_path / "corners.json"
    exports = ["--export", f"opencv={tmp_path / 'camera.yaml'}", "--export", f"corners={corners}"]
    assert main(["calibrate", str(folder), *stated, "-o", str(out), *exports]) == 0
    assert "The photographs show:" in capsys.readouterr().out
    jsonschema.validate(json.loads(out.read_text()), json.loads(_SCHEMA.read_text()))
    result = read_result(out)
    camera = result.calibration.camera
    np.testing.assert_allclose(camera.params[:4], CAMERA.params[:4], atol=0.25)
    assert result.calibration.noise < 0.02
    assert result.board is not None
    assert result.board.grid_size == grid_size.grid_size
    assert result.board.pattern.kind == grid_size.pattern.kind
    # The corners alone, and rendered views of what was found, give the same camera.
    assert main(["calibrate", str(corners), "-q", "-o", str(tmp_path / "again.json")]) == 0
    again = read_result(tmp_path / "again.json").calibration.camera
    np.testing.assert_allclose(again.params, camera.params, rtol=1e-9)
    check = run_synthetic_check(result, blur=0.7)
    assert all(view.usable for view in check.synthetic.views)
    drawn = check.synthetic.calibration.camera.params
    np.testing.assert_allclose(drawn[:4], camera.params[:4], atol=0.25)


def test_nothing_need_be_said_of_the_board(
    kind: str, folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "corners.json"
    assert main(["detect", str(folder), "-o", str(out)]) == 0
    assert "The photographs show:" in capsys.readouterr().out
    corner_set = read_corners(out)
    assert corner_set.board is not None
    assert corner_set.board.pattern.kind == BOARDS[kind].pattern.kind
    assert corner_set.board.grid_size == BOARDS[kind].grid_size
    assert sum(view.usable for view in corner_set.views) >= 5


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--target", "circles", "--board", "5x7", "--corners", "saddle"], "not for circles"),
        (["--target", "circles", "--board", "5x7", "--marker", "3"], "--marker is for"),
        (["--dictionary", "DICT_4X4_50"], "--dictionary is for --target charuco"),
        (["--target", "charuco", "--marker", "3"], "--marker needs --square"),
        (
            ["--target", "charuco", "--square", "3", "--marker", "4"],
            "1.333 of the side of its square",
        ),
        (["--target", "charuco", "--dictionary", "DICT_3"], "no dictionary DICT_3"),
        (["--target", "charuco", "--from-top"], "--from-top is for --target aprilgrid or"),
        (["--target", "tagged-checkerboard", "--step", "3"], "every 3 squares"),
    ],
)
def test_what_does_not_go_together(
    options: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["detect", "nowhere.png", *options])
    assert ended.value.code == 2
    assert says in " ".join(capsys.readouterr().err.split())
