"""The subcommand series, and the limit of diff, on a result and changed copies of it."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from calibgui.app.calibrating.series import (
    Scalar,
    analyse_series,
    choose_axis_text,
    parse_value,
    read_series,
)
from calibgui.cli.main import main
from calibgui.engine.errors import CalibrationError
from calibgui.formats import read_camera
from calibgui.report.series_figures import draw_series

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


@pytest.mark.parametrize(
    ("name", "suffix", "what"),
    [
        ("ros", ".yaml", r"holds a camera only \(ROS camera_info\): neither corners, nor"),
        ("lensfun", ".xml", "is a lensfun database"),
    ],
)
def test_another_file_is_named_and_which_one_to_give_instead(
    folder: Path, result_file: Path, name: str, suffix: str, what: str
) -> None:
    file = folder / f"camera{suffix}"
    assert main(["convert", str(result_file), "--export", f"{name}={file}", "-q"]) == 0
    with pytest.raises(CalibrationError, match=rf"camera\{suffix} {what}") as caught:
        read_series([folder / "a.json", file], Scalar.TEMPERATURE)  # before values are missed
    assert "result.json of the calibration that it was written from" in caught.value.hint


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
    [
        (["--export", "ros=x.yaml"], "--at VALUE"),
        (["--at", "warm"], "no value of temperature"),
        (["--by", "weather"], "choose from 'zoom', 'focus', 'temperature', 'date'"),
    ],
)
def test_wrong_usage_is_explained(
    folder: Path, options: list[str], text: str, capsys: Capture
) -> None:
    with pytest.raises(SystemExit):
        run(folder, *options)
    assert text in capsys.readouterr().err


@pytest.fixture
def partial(folder: Path, corners_file: Path) -> Path:
    """One more result in the folder, at 25 degrees, of one view."""
    corners = json.loads(corners_file.read_text())
    corners["views"] = [view for view in corners["views"] if "uv" in view][:1]
    one_view = folder.parent / "one-view.json"
    one_view.write_text(json.dumps(corners))
    file = folder / "e.json"
    assert main(["calibrate", str(one_view), "-q", "-o", str(file)]) == 1
    with (folder / "values.csv").open("a") as table:
        table.write("e.json,25\n")
    return file


def test_a_result_that_is_not_determined_is_left_out_by_name(
    partial: Path, folder: Path, capsys: Capture
) -> None:
    capsys.readouterr()
    table = folder.parent / "table.csv"
    assert run(folder, "--at", "25", "--table", str(table)) == 0
    printed = capsys.readouterr().out
    said = " ".join(printed.split())
    assert (
        f"{partial} is left out, as its photographs do not determine the camera. One view" in said
    )
    assert [line.split() for line in printed.splitlines()].count(
        ["25", "°C", *["left", "out"] * 3]
    ) == 3
    with table.open() as file:
        *used, last = csv.DictReader(file)
    assert [row["left_out"] for row in used] == [""] * 4
    assert (last["value"], last["file"], last["fx"]) == ("25.0", str(partial), "")
    assert "One view" in last["left_out"]
    # The rest is as it would be without it.
    assert run(folder, "--at", "25", "--json") == 0
    answer = json.loads(capsys.readouterr().out)
    (left_out,) = answer.pop("left_out")
    assert (left_out["file"], left_out["value"]) == (str(partial), 25.0)
    partial.unlink()
    assert run(folder, "--at", "25", "--json") == 0
    assert json.loads(capsys.readouterr().out) == answer | {"left_out": []}


def test_what_is_left_out_needs_no_value(partial: Path, folder: Path, capsys: Capture) -> None:
    rows = (folder / "values.csv").read_text().replace("e.json,25\n", "")
    (folder / "values.csv").write_text(rows)
    capsys.readouterr()
    assert run(folder, "--json") == 0
    (left_out,) = json.loads(capsys.readouterr().out)["left_out"]
    assert (left_out["file"], left_out["value"]) == (str(partial), None)


def test_too_few_results_that_are_determined_are_refused(
    partial: Path, folder: Path, capsys: Capture
) -> None:
    for name in "ab":
        (folder / f"{name}.json").unlink()
    capsys.readouterr()
    assert run(folder) == 1
    problem = " ".join(capsys.readouterr().err.split())
    assert "2 of 3 results can be used, and a series needs 3" in problem
    assert f"{partial} is left out: One view" in problem


def test_a_date_is_a_date(folder: Path, capsys: Capture) -> None:
    rows = "".join(f"{name}.json,2026-0{k}-01\n" for k, name in enumerate(VALUES, start=1))
    (folder / "values.csv").write_text(f"file,value\n{rows}")
    table = ["--values", str(folder / "values.csv")]
    assert main(["series", str(folder), "--by", "date", *table, "--at", "2026-02-15"]) == 0
    out = capsys.readouterr().out
    assert "2026-02-15 00:00" in out


@pytest.mark.parametrize(
    ("dates", "text"),
    [
        (["2026-01-01", "2026-02-01", "2026-03-01", "2026-04-01"], "2026-02-01"),
        ([f"2026-02-01 0{hour}:30" for hour in range(6, 10)], "02-01 00:00"),
    ],
)
def test_dates_are_written_on_axes_as_dates(folder: Path, dates: list[str], text: str) -> None:
    rows = "".join(f"{name}.json,{date}\n" for name, date in zip(VALUES, dates, strict=True))
    (folder / "values.csv").write_text(f"file,value\n{rows}")
    results = [folder / f"{name}.json" for name in VALUES]
    analysed = analyse_series(results, Scalar.DATE, folder / "values.csv")
    write = choose_axis_text(analysed)
    assert write is not None
    assert write(parse_value("2026-02-01", Scalar.DATE)) == text
    figure = draw_series(analysed.series, "date", write)
    figure.draw_without_rendering()
    (bottom,) = [panel for panel in figure.axes if panel.get_title() == "p2"]
    labels = [label.get_text() for label in bottom.get_xticklabels()]
    assert labels == [write(at) for at in bottom.get_xticks()]
