"""The subcommand series, and the limit of diff, on a result and changed copies of it."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from calibgui.app.series import Scalar, read_series
from calibgui.cli.main import main
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera

Capture = pytest.CaptureFixture[str]
VALUES = {"a": 10.0, "b": 20.0, "c": 30.0, "d": 40.0}


def change(result_file: Path, file: Path, **factors: float) -> Path:
    """A copy of the result with parameters multiplied by factors."""
    content = json.loads(result_file.read_text())
    for name, factor in factors.items():
        content["camera"]["params"][name] *= factor
    file.write_text(json.dumps(content))
    return file


@pytest.fixture
def folder(result_file: Path, tmp_path: Path) -> Path:
    """Results whose focal length grows by a thousandth with every 10 degrees, and their table."""
    for name, value in VALUES.items():
        factor = 1 + 1e-4 * value
        change(result_file, tmp_path / f"{name}.json", fx=factor, fy=factor)
    rows = "".join(f"{name}.json,{value}\n" for name, value in VALUES.items())
    (tmp_path / "values.csv").write_text(f"file,value\n{rows}")
    return tmp_path


def run(folder: Path, *options: str) -> int:
    table = ["--values", str(folder / "values.csv")]
    return main(["series", str(folder), "--by", "temperature", *table, *options])


def focal(file: Path) -> Any:
    return json.loads(file.read_text())["camera"]["params"]["fx"]


def test_the_camera_between_the_settings_is_printed_and_exported(
    folder: Path, result_file: Path, capsys: Capture
) -> None:
    camera, table, figure = (folder / name for name in ("camera.yaml", "table.csv", "plot.png"))
    outputs = ["--export", f"opencv={camera}", "--table", str(table), "-o", str(figure)]
    assert run(folder, "--at", "25", *outputs) == 0
    out = capsys.readouterr().out
    assert "A straight line describes the camera" in out
    assert max(map(len, out.partition("Wrote")[0].splitlines())) <= 80
    expected = focal(result_file) * 1.0025
    assert read_camera(camera).camera.focal[0] == pytest.approx(expected, rel=1e-4)
    with table.open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["value"]) for row in rows] == list(VALUES.values())
    assert float(rows[1]["fx"]) == pytest.approx(focal(folder / "b.json"))
    with Image.open(figure) as drawn:
        assert drawn.size[0] > 500


def test_a_profile_of_all_focal_lengths_is_exported(folder: Path, capsys: Capture) -> None:
    gyroflow, lensfun = folder.parent / "profile.json", folder / "lens.xml"
    table = ["--values", str(folder / "values.csv")]
    exports = ["--export", f"gyroflow={gyroflow}", "--export", f"lensfun={lensfun}"]
    assert main(["series", str(folder), "--by", "zoom", *table, *exports, "-q"]) == 0
    capsys.readouterr()
    profile = json.loads(gyroflow.read_text())
    entries = profile["interpolations"]
    assert list(entries) == ["10", "20", "30", "40"]
    main(["series", str(folder), "--by", "zoom", *table, "--at", "30", "--json"])
    there = json.loads(capsys.readouterr().out)["at"]["params"]
    matrix = entries["30"]["camera_matrix"]
    assert matrix[0][2] == pytest.approx(there["cx"], abs=0.5), "refitted in another lens model"
    assert lensfun.read_text().count("<distortion ") == 4


def test_the_answer_for_programs_has_the_uncertainty(folder: Path, capsys: Capture) -> None:
    assert run(folder, "--at", "25", "--json") == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["function"] == "degree 1"
    assert answer["at"]["sigma"]["fx"] > 0
    assert len(answer["from_first"]) == 3


def test_the_exit_code_of_diff_tells_of_a_drift(result_file: Path, tmp_path: Path) -> None:
    moved = change(result_file, tmp_path / "moved.json", fx=1.02, fy=1.02)
    unchanged = change(result_file, tmp_path / "same.json")
    assert main(["diff", str(result_file), str(moved), "--limit", "0.3", "-q"]) == 3
    assert main(["diff", str(result_file), str(moved), "--limit", "30", "-q"]) == 0
    assert main(["diff", str(result_file), str(unchanged), "--limit", "0.3", "-q"]) == 0
    assert main(["diff", str(result_file), str(moved), "-q"]) == 0


def test_files_without_a_value_are_named(folder: Path) -> None:
    (folder / "values.csv").write_text("file,value\na.json,1\n")
    with pytest.raises(CalibrationError, match=r"no value for .*b\.json"):
        read_series([folder / "b.json"], Scalar.FOCUS, folder / "values.csv")
    (folder / "values.csv").write_text("file,value\na.json,warm\n")
    with pytest.raises(CalibrationError, match=r"values\.csv, line 2"):
        read_series([folder / "a.json"], Scalar.FOCUS, folder / "values.csv")
    with pytest.raises(CalibrationError, match="do not state the focus"):
        read_series([folder / "a.json"], Scalar.FOCUS)


def test_focal_lengths_are_read_from_photographs(folder: Path) -> None:
    content = json.loads((folder / "a.json").read_text())
    exif = Image.Exif()
    exif.get_ifd(0x8769)[37386] = 35.0
    for view in content["views"]:
        name = Path(view["image"]).name
        Image.new("L", (640, 480)).save(folder / name, format="JPEG", exif=exif)
        view["image"] = name
    (folder / "a.json").write_text(json.dumps(content))
    assert read_series([folder / "a.json"], Scalar.ZOOM)[0].value == pytest.approx(35.0)


@pytest.mark.parametrize(
    ("options", "text"),
    [(["--export", "ros=x.yaml"], "--at VALUE"), (["--at", "warm"], "no value of temperature")],
)
def test_wrong_usage_is_explained(
    folder: Path, options: list[str], text: str, capsys: Capture
) -> None:
    with pytest.raises(SystemExit):
        run(folder, *options)
    assert text in capsys.readouterr().err


def test_a_date_is_a_date(folder: Path, capsys: Capture) -> None:
    rows = "".join(f"{name}.json,2026-0{k}-01\n" for k, name in enumerate(VALUES, start=1))
    (folder / "values.csv").write_text(f"file,value\n{rows}")
    table = ["--values", str(folder / "values.csv")]
    assert main(["series", str(folder), "--by", "date", *table, "--at", "2026-02-15"]) == 0
    out = capsys.readouterr().out
    assert "2026-02-15 00:00" in out
