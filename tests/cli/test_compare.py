"""calibgui compare: the methods printed, as JSON, in a file and in a picture."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from calibgui.cli.main import main
from calibgui.engine import assessment
from calibgui.engine.assessment.choices import method_comparison
from calibgui.formats.result_json import read_result
from calibgui.report.methods import QUANTITIES
from tests.photographs import COUNT

Capture = pytest.CaptureFixture[str]
FEW = ("lucchese", "bouguet", "zhang-closed-form", "dlt", "stein")


@pytest.fixture
def few_methods(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let there be few methods to compare, which is quick."""
    listed = method_comparison.list_compared_methods()
    few = {name: listed[name] for name in FEW}
    monkeypatch.setattr(method_comparison, "list_compared_methods", lambda: few)


@pytest.mark.usefixtures("few_methods")
def test_a_corners_file_is_compared_on(corners_file: Path, tmp_path: Path, capsys: Capture) -> None:
    file, figure = tmp_path / "methods.json", tmp_path / "methods.png"
    options = ["-o", str(file), "--figure", str(figure)]
    assert main(["compare", str(corners_file), *options]) == 0
    printed, problems = capsys.readouterr()
    assert problems == ""
    assert f"corners in {COUNT} views (* without lengths)" in printed
    assert "predicts unseen views best" in printed
    lines = printed.splitlines()
    assert all(len(line) <= 100 or str(tmp_path) in line for line in lines)
    assert figure.read_bytes().startswith(b"\x89PNG")
    content = json.loads(file.read_text())
    assert content["chosen_camera"]["model"] == "lucchese"
    rows = {row["name"]: row for row in content["methods"]}
    assert tuple(rows) == FEW
    for row in rows.values():
        check_row(row)
    bouguet = rows["bouguet"]
    line = next(line for line in lines if line.split()[:1] == ["bouguet"]).split()
    assert abs(float(line[1]) - bouguet["values_px"]["fx"]) < 0.1
    assert (
        dict(zip(bouguet["lens"]["names"], bouguet["lens"]["sigma"], strict=True))["skew"] is None
    )
    assert rows["lucchese"]["difference_worst_px"] < 1e-6


def check_row(row: dict[str, Any]) -> None:
    """Check that all that is not known of a method is null."""
    assert row["title"] and row["source"] and row["limits"]
    known = {name for name in QUANTITIES if row["values_px"][name] is not None}
    expected = {
        "lucchese": {"fx", "fy", "cx", "cy"},
        "bouguet": {"fx", "fy", "cx", "cy"},
        "zhang-closed-form": set(QUANTITIES),
        "dlt": set(),
        "stein": {"cx", "cy"},
    }
    assert known == expected[row["name"]]
    is_refused = row["kind"] == "refused"
    assert is_refused == (row["name"] == "dlt")
    for key in ("rms_px", "unseen_rms_px", "seconds", "difference_rms_px", "lens", "difference"):
        assert (row[key] is None) == is_refused, key
    assert (row["shift_px"] is None) == (row["name"] in ("dlt", "zhang-closed-form"))
    if is_refused:
        assert "not known to each other" in row["remarks"][0]


@pytest.mark.usefixtures("few_methods")
def test_known_poses_of_the_board_allow_the_dlt(
    corners_file: Path, result_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    """The camera frame itself is one in which the camera stands still."""
    result, file = read_result(result_file), tmp_path / "poses.json"
    poses = {
        view.image: {"rvec": pose.rvec.tolist(), "tvec": pose.tvec.tolist()}
        for view, pose in zip(result.used, result.calibration.poses, strict=True)
    }
    file.write_text(json.dumps(poses))
    assert main(["compare", str(corners_file), "--board-poses", str(file), "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    dlt = next(row for row in content["methods"] if row["name"] == "dlt")
    assert dlt["kind"] == "camera" and dlt["unseen_rms_px"] is not None
    fx = content["chosen_camera"]["params"]["fx"]
    assert abs(dlt["values_px"]["fx"] - fx) < 0.05 * fx
    del poses[result.used[0].image]
    file.write_text(json.dumps(poses))
    assert main(["compare", str(corners_file), "--board-poses", str(file)]) == 1
    assert f"not stated for {Path(result.used[0].image).name}." in capsys.readouterr().err


@pytest.mark.usefixtures("few_methods")
def test_quiet_is_one_line(corners_file: Path, capsys: Capture) -> None:
    assert main(["compare", str(corners_file), "-q"]) == 0
    printed, problems = capsys.readouterr()
    assert "lucchese" in printed and printed.count("\n") == 1
    assert problems == ""


def test_what_cannot_be_compared_is_told(content: dict, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "one.json"
    file.write_text(json.dumps(content | {"views": content["views"][:1]}))
    assert main(["compare", str(file)]) == 1
    assert capsys.readouterr().err.startswith("calibgui: ")
    for option in (["-o", str(tmp_path / "no" / "a.json")], ["--figure", str(tmp_path / "a.txt")]):
        assert main(["compare", str(file), *option]) == 1
        assert str(tmp_path) in capsys.readouterr().err


def test_poses_in_millimetres_need_the_square(photographs: Path, capsys: Capture) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["compare", str(photographs), "--board-poses", "poses.json"])
    assert ended.value.code == 2
    assert "add --square MM" in capsys.readouterr().err


@pytest.mark.slow
def test_all_methods_are_compared(
    corners_file: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    all_with_two_folds = partial(assessment.compare_methods, folds=2)
    monkeypatch.setattr(assessment, "compare_methods", all_with_two_folds)
    assert main(["compare", str(corners_file), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in found["methods"]] == list(
        method_comparison.list_compared_methods()
    )
