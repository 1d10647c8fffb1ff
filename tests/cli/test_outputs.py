"""No subcommand replaces a file that calibgui did not write there, unless it is told to."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from calibgui.cli.main import main
from tests.photographs import COUNT

Capture = pytest.CaptureFixture[str]

COMMANDS = {
    "calibrate": "calibrate CORNERS -o OUT.json",
    "calibrate-export": "calibrate CORNERS --export ros=OUT.yaml",
    "calibrate-board-shape": "calibrate CORNERS --board-shape bow --save-board-shape OUT.json",
    "detect": "detect PHOTOGRAPHS -o OUT.json",
    "convert": "convert RESULT --export opencv=OUT.yaml",
    "models": "models CORNERS -o OUT.json",
    "compare": "compare CORNERS -o OUT.json",
    "compare-figure": "compare CORNERS --figure OUT.png",
    "uncertainty": "uncertainty RESULT -o OUT.png",
    "views": "views RESULT -o OUT.png",
    "views-next": "views RESULT --next OUT.svg",
    "diff": "diff RESULT RESULT -o OUT.pdf",
    "demo": "demo -o FOLDER",
    "paper": "paper PHOTOGRAPHS -o FOLDER",
    "undistort": "undistort RESULT PHOTOGRAPHS -o FOLDER",
    "rectify": "rectify RESULT PHOTOGRAPHS -o FOLDER",
}
"""Command lines; FOLDER has files of the names that are written to it."""
MINE = "not to be lost"


@pytest.mark.parametrize("name", COMMANDS)
def test_a_file_of_the_users_stays(
    name: str,
    result_file: Path,
    corners_file: Path,
    photographs: Path,
    tmp_path: Path,
    capsys: Capture,
) -> None:
    paths = {
        "CORNERS": corners_file,
        "RESULT": result_file,
        "PHOTOGRAPHS": photographs,
        "FOLDER": tmp_path,
    }
    words = [
        str(paths.get(w, w.replace("OUT", str(tmp_path / "out")))) for w in COMMANDS[name].split()
    ]
    for file in ("out.json", "out.yaml", "out.png", "out.svg", "out.pdf"):
        (tmp_path / file).write_text(MINE)
    for file in ("undistorted.png", "index.html", "view1.png"):  # of demo, paper, and the others
        (tmp_path / file).write_text(MINE)
    assert main(words) == 1
    assert "--overwrite" in capsys.readouterr().err
    assert {path.read_text() for path in tmp_path.iterdir()} == {MINE}


def test_own_files_are_replaced_and_others_with_the_option(
    corners_file: Path, result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    out = str(tmp_path / "out.json")
    calibrate = ["calibrate", str(corners_file), "-q", "-o", out]
    for _ in range(2):
        assert main(calibrate) == 0
    assert main(["detect", str(photographs / "view1.png"), "-q", "-o", out]) == 1, "another kind"
    assert "is not a corners.json that calibgui wrote" in capsys.readouterr().err
    assert main(["detect", str(photographs / "view1.png"), "-q", "-o", out, "--overwrite"]) == 0
    assert main(["detect", str(photographs / "view1.png"), "-q", "-o", out]) == 0

    folder = str(tmp_path / "folder")
    rectify = ["rectify", str(result_file), "-q", "-o", folder]
    for _ in range(2):
        assert main(rectify) == 0
    (tmp_path / "folder" / "view1.png").write_text(MINE)
    assert main(rectify) == 1
    assert main([*rectify, "--overwrite"]) == 0
    assert len(list((tmp_path / "folder").glob("*.png"))) == COUNT


def test_regions_that_are_read_are_never_replaced(
    photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    regions = tmp_path / "roi.json"
    content = json.dumps({"view1.png": [[0, 0], [319, 0], [319, 239], [0, 239]]})
    regions.write_text(content)
    detect = ["detect", str(photographs / "view1.png"), "--roi", str(regions)]
    for option in ([], ["--overwrite"]):
        assert main([*detect, "-o", str(regions), *option]) == 1
        assert "roi.json is one of the files to read" in capsys.readouterr().err
    assert regions.read_text() == content


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
def test_pipes_and_devices_are_refused_as_inputs(tmp_path: Path, capsys: Capture) -> None:
    pipe = tmp_path / "pipe.json"
    os.mkfifo(pipe)
    for words in (
        ["calibrate", str(pipe)],
        ["uncertainty", str(pipe)],
        ["convert", "/dev/zero", "--model", "pinhole"],
        ["detect", str(pipe)],
    ):
        assert main(words) == 1
        assert "a device or a pipe" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "remedy"),
    [
        ("calibrate CORNERS -o camera.yaml", "--export opencv=camera.yaml or --export ros="),
        ("detect PHOTOGRAPHS -o corners.csv", "--export corners-csv=corners.csv"),
    ],
)
def test_json_is_not_written_as_a_file_of_another_format(
    words: str,
    remedy: str,
    corners_file: Path,
    photographs: Path,
    tmp_path: Path,
    capsys: Capture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    paths = {"CORNERS": str(corners_file), "PHOTOGRAPHS": str(photographs)}
    assert main([paths.get(word, word) for word in words.split()]) == 1
    said = capsys.readouterr().err
    assert "is not named as JSON" in said and remedy in said
    assert not list(tmp_path.iterdir())
