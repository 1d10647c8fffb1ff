"""The command line says first what a calibration is worth, and which option makes it better."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from calibgui.cli.main import main

Capture = pytest.CaptureFixture[str]


def test_the_option_beside_a_finding_does_what_is_promised(
    corners_file: Path, capsys: Capture
) -> None:
    assert main(["calibrate", str(corners_file), "--model", "pinhole"]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told[0].startswith("CAN BE ") and told[0].endswith(" TIMES BETTER.")
    assert told[1].startswith("Error of a pixel: centre ") and " mm away." in told[1] + told[2]
    assert len(told) <= 25
    option = next(line for line in told if line.startswith("  > ")).removeprefix("  > Add ")
    assert main(["calibrate", str(corners_file), "-q", *option.partition(" (")[0].split()]) == 0
    better = capsys.readouterr().out
    assert better.startswith("GOOD. ") and better.count("\n") == 1


def test_of_two_pictures_side_by_side_it_says_to_cut_them_apart_first(
    content: Any, tmp_path: Path, capsys: Capture
) -> None:
    width = content["size"][0]
    content["size"][0] *= 2
    for view in content["views"][::2]:
        view["uv"] = [[u + width, v] for u, v in view["uv"]]
    file = tmp_path / "corners.json"
    file.write_text(json.dumps(content))
    main(["calibrate", str(file), "--as-asked"])
    told = " ".join(capsys.readouterr().out.split())
    remedy = "Cut the photographs apart, and calibrate each side by itself."
    assert f"> {remedy} Or add --exclude " in told
    main(["calibrate", str(file)])
    told = " ".join(capsys.readouterr().out.split())
    assert "left out; errors " in told and f" times smaller. {remedy}" in told


def test_images_are_left_out_by_name(corners_file: Path, capsys: Capture) -> None:
    names = [Path(v["image"]).name for v in json.loads(corners_file.read_text())["views"]]
    assert main(["calibrate", str(corners_file), "-q", "--exclude", names[1]]) == 0
    assert f"{len(names) - 1} of {len(names)} images" in capsys.readouterr().out
    assert main(["calibrate", str(corners_file), "-q", "--exclude", "nothing.png"]) == 1
    assert "no image 'nothing.png' to leave out" in capsys.readouterr().err


def test_images_are_left_out_by_a_pattern(content: Any, tmp_path: Path, capsys: Capture) -> None:
    for k, view in enumerate(content["views"]):
        view["image"] = f"{'left' if k < 2 else 'right'}[{k}].png"
    file = tmp_path / "corners.json"
    file.write_text(json.dumps(content))
    count = len(content["views"])
    assert main(["calibrate", str(file), "-q", "--exclude", "left*"]) == 0
    assert f"{count - 2} of {count} images" in capsys.readouterr().out
    assert main(["calibrate", str(file), "-q", "--exclude", "left[0].png"]) == 0
    assert f"{count - 1} of {count} images" in capsys.readouterr().out


def test_json_holds_the_verdict(corners_file: Path, capsys: Capture) -> None:
    assert main(["calibrate", str(corners_file), "--json", "--fix", "fx=300"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["verdict"]["grade"] == "can-be-better"
    assert record["verdict"]["times_better"] == record["findings"][0]["times_better"] > 10
    assert record["findings"][0]["action"] == {
        "kind": "free-held-value",
        "views": [],
        "parameters": ["fx"],
        "model": None,
    }
