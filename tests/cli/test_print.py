"""A board is written to a file that the corner finder reads again."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibgui.cli.main import main
from calibgui.engine import opencv
from calibgui.engine.boards import KINDS, list_circles
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.images import read_image
from tests.scenes.circle_lists import list_rows_by_turns

Capture = pytest.CaptureFixture[str]


@pytest.mark.parametrize("target", ["checkerboard", "asymmetric-circles", "aprilgrid"])
def test_what_is_printed_is_found(target: str, tmp_path: Path) -> None:
    size = {"aprilgrid": "8x8", "asymmetric-circles": "7x4"}.get(target, "6x9")
    file = tmp_path / "board.png"
    assert main(["print", size, "--target", target, "-q", "-o", str(file)]) == 0
    pixels = read_image(file).pixels
    for _ in range(2):
        pixels = opencv.halve_image(pixels)
    found = find_corners(pixels, pattern=KINDS[target])
    assert "x".join(map(str, found.shape)) == size


def test_listed_circles_are_printed_and_found(tmp_path: Path) -> None:
    places = list_rows_by_turns(7, 9, 20.0)
    layout, file = tmp_path / "list.csv", tmp_path / "board.png"
    layout.write_text("x,y\n" + "\n".join(f"{x},{y}" for x, y in places))
    assert main(["print", "--layout", str(layout), "-q", "-o", str(file)]) == 0
    pixels = read_image(file).pixels
    for _ in range(2):
        pixels = opencv.halve_image(pixels)
    assert len(find_corners(pixels, pattern=list_circles(places)[0])) == len(places)
    with pytest.raises(SystemExit):
        main(["print", "-o", str(tmp_path / "none.png")])


def test_the_square_is_as_large_as_the_paper_allows(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "board.pdf"
    assert main(["print", "6x9", "--paper", "A3", "--json", "-o", str(file)]) == 0
    assert json.loads(capsys.readouterr().out)["square_mm"] == 33.0
    assert main(["print", "6x9", "--square", "50", "-o", str(tmp_path / "large.pdf")]) == 1
    assert "Use at most 22.5 mm, or larger paper." in capsys.readouterr().err


def test_a_file_of_another_kind_is_kept(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "notes.pdf"
    file.write_text("mine")
    assert main(["print", "6x9", "-o", str(file)]) == 1
    assert file.read_text() == "mine" and "notes.pdf" in capsys.readouterr().err
    assert main(["print", "6x9", "-o", str(tmp_path / "board.gif")]) == 1
    assert "is not named as PDF, SVG or PNG" in capsys.readouterr().err


@pytest.mark.parametrize("suffix", [".pdf", ".svg", ".png"])
def test_its_own_file_is_written_anew(suffix: str, tmp_path: Path) -> None:
    file = tmp_path / f"board{suffix}"
    for size in ("3x4", "4x5"):
        assert main(["print", size, "-q", "-o", str(file)]) == 0
