"""The whole line from photographs of parts of a PuzzleBoard to a result."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from calibgui.app.photographs.board_recognition import find_other_pattern
from calibgui.app.photographs.detection import find_views
from calibgui.cli.main import main
from calibgui.dataset import View
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.reading import write_image
from calibgui.engine.images.rendering import render_view
from calibgui.formats.result_json import read_result
from tests.engine import scenes

CAMERA = Camera((480, 360), [490.0, 493.0, 236.0, 182.0, 0.15, 0.03, 0.0, 3e-4, -4e-4, 0.0])
BOARD = Board(8, 11, 20.0, PuzzleBoard((50, 100)))
_SCHEMA = Path(__file__).parents[2] / "resources" / "schema" / "result-1.schema.json"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Views of which most show a part of the board only, and one that is turned."""
    folder = tmp_path_factory.mktemp("puzzleboard")
    rng = np.random.default_rng(4)
    for k in range(5):
        pose = scenes.looking(CAMERA, rng, fill=(0.8, 1.2), board=BOARD)
        image = render_view(CAMERA, pose, BOARD, blur=0.7, noise=1.0, seed=k)
        write_image(folder / f"view{k}.png", image)
    return folder


@pytest.mark.slow
def test_from_photographs_to_a_result(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "result.json"
    options = ["--target", "puzzleboard", "--origin", "50x100", "--board", "8x11", "--square", "20"]
    assert main(["calibrate", str(folder), *options, "-o", str(out), "-q"]) == 0
    jsonschema.validate(json.loads(out.read_text()), json.loads(_SCHEMA.read_text()))
    result = read_result(out)
    np.testing.assert_allclose(result.calibration.camera.params[:4], CAMERA.params[:4], atol=0.4)
    assert result.board == BOARD


def test_counted_from_the_whole_pattern_if_nothing_is_stated(folder: Path) -> None:
    """Parts of the board have the same numbers in all views."""
    images = sorted(folder.glob("*.png"))[:2]
    found = find_views(images, pattern=PuzzleBoard())
    assert found.grid_size == (58, 111)
    stated = find_views(images, BOARD.grid_size, pattern=BOARD.pattern)
    for view, known in zip(found.views, stated.views, strict=True):
        assert view.corners is not None
        assert known.corners is not None
        np.testing.assert_array_equal(view.corners.grid - (50, 100), known.corners.grid)
        np.testing.assert_array_equal(view.corners.uv, known.corners.uv)


def test_it_is_recognised_when_another_board_is_stated(folder: Path) -> None:
    images = [str(folder / f"view{k}.png") for k in (0, 1)]
    assert find_other_pattern([View(str(image)) for image in images], CHECKERBOARD) == PuzzleBoard()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--origin", "50x100"], "--origin is for --target puzzleboard"),
        (["--target", "puzzleboard", "--origin", "50"], "is not ROWxCOL"),
        (["--target", "puzzleboard", "--origin", "50x600"], "no corner 50 x 600"),
    ],
)
def test_what_does_not_go_together(
    options: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["detect", "nowhere.png", *options])
    assert ended.value.code == 2
    assert says in " ".join(capsys.readouterr().err.split())
