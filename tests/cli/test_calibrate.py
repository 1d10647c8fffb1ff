"""calibgui calibrate: from photographs or corners to a result, and every way to fail."""

from __future__ import annotations

import io
import json
import math
import shutil
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from calibgui.app.calibrating.settings import BEST_SETTINGS, Settings
from calibgui.cli.arguments import parse_length
from calibgui.cli.main import main
from calibgui.engine.boards.shape import BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration.result import Cost
from calibgui.engine.camera.models import list_parameter_names
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.reading import write_image
from calibgui.formats import EXPORTERS, read_camera
from calibgui.formats.result_json import read_result
from tests.photographs import BOARD, CAMERA, COUNT

Capture = pytest.CaptureFixture[str]


def test_photographs_give_the_camera_that_took_them(
    photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "result.json"
    assert main(["calibrate", str(photographs), "--square", "30", "-o", str(file)]) == 0
    result = read_result(file)
    camera, sigma = result.calibration.camera, result.calibration.sigma
    assert camera.size == CAMERA.size and len(result.used) == COUNT
    free = sigma > 0
    assert (np.abs(camera.params - CAMERA.params)[free] < 5 * sigma[free]).all()
    printed, problems = capsys.readouterr()
    assert problems == ""
    first = "GOOD. The photographs show nothing wrong.\nError of a pixel: centre 0.0"
    assert printed.startswith(first) and "\nCamera, 320 x 240 px" in printed
    assert "\nRMS 0.0" in printed and f"{COUNT} of {COUNT} images" in printed
    assert "Wrote" in printed and "-v shows each view" in printed
    assert len(printed.splitlines()) <= 25
    # Only the name of a file may be longer than a line.
    assert all(len(line) <= 80 or str(file) in line for line in printed.splitlines())


def test_without_a_square_lengths_are_conditional(
    photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    """The camera is the same, and each length says what it rests on; stating the side ends that."""
    corners, result = tmp_path / "corners.json", tmp_path / "result.json"
    camera = tmp_path / "camera.yaml"
    exports = ["--export", f"corners={corners}", "--export", f"kalibr={camera}"]
    assert main(["calibrate", str(photographs), "-o", str(result), *exports]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert printed.startswith("GOOD.")
    assert "Lengths hold if squares are 30 mm. --square MM states it." in printed
    assert not read_result(result).lengths_confirmed
    assert "Lengths hold if squares are 30 mm." in camera.read_text(encoding="utf-8")

    assert main(["calibrate", str(corners), "-o", str(result)]) == 0
    assert "if squares are 30 mm" in capsys.readouterr().out
    assert main(["calibrate", str(corners), "--square", "25", "-o", str(result)]) == 0
    assert "if squares" not in capsys.readouterr().out
    assert read_result(result).lengths_confirmed


def test_every_setting_has_its_option(corners_file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The window offers the same record: see tests/gui/test_settings_panel.py."""
    asked: list[Settings] = []

    def noted(_: object, settings: Settings, search: bool, **__: object) -> None:
        assert not search  # of a corners file the images stay out
        asked.append(settings)
        raise CalibrationError("noted", "")

    monkeypatch.setattr("calibgui.cli.calibrate.calibrate_best", noted)
    options = [
        "--fix",
        "k3,fx=650",
        "--free",
        "p3",
        "--robust",
        "--weigh-views",
        "--board-shape",
        "free",
        "--prior",
        "0.1,0.3",
        "--once",
    ]
    main(["calibrate", str(corners_file), *options])
    main(["calibrate", str(corners_file), "--cost", "reference", "--plate", "free"])
    main(["calibrate", str(corners_file), "--model", "brown-conrady"])
    main(["calibrate", str(corners_file), "--method", "bouguet"])
    main(["calibrate", str(corners_file), "--model", "auto", "--method", "lucchese"])
    main(["calibrate", str(corners_file), "--for", "colmap=cameras.txt"])
    changed, other, forward, toolbox, automatic, native = asked
    assert native.model is None and native.candidates[0] == "brown-conrady-4"
    assert other.cost is Cost.REFERENCE
    assert other.board_shape is BoardShapeModel.FREE  # by the older name of the option
    assert forward.model == "brown-conrady"
    assert changed == Settings(
        fixed={"k3": None, "fx": 650.0},
        freed=("p3",),
        board_shape=BoardShapeModel.FREE,
        prior=BoardShapePrior(0.1, 0.3),
        robust=True,
        weigh_views=True,
        once=True,
        improve=True,
    )
    assert (toolbox.method, toolbox.model) == ("bouguet", "brown-conrady-4")
    assert (automatic.method, automatic.model) == ("lucchese", None)
    # Those that take all corners as equally good take few of these settings.
    # A known camera is for 'calibgui pose'.
    elsewhere = {"cost", "model", "candidates", "method", "known"}
    names = {field.name for field in fields(Settings)} - elsewhere
    assert all(getattr(changed, name) != getattr(Settings(), name) for name in names)


def test_what_is_not_stated_is_chosen_unless_the_rest_is_asked_for_as_it_is(
    corners_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Settings] = []

    def noted(_: object, settings: Settings, **__: object) -> None:
        asked.append(settings)
        raise CalibrationError("noted", "")

    monkeypatch.setattr("calibgui.cli.calibrate.calibrate_best", noted)
    for options in (
        "",
        "--as-asked",
        "--model brown-conrady",
        "--board-shape nominal",
        "--prior 0.1,0.3 --square 30",
        "--fix k3",
        "--method bouguet",
    ):
        main(["calibrate", str(corners_file), *options.split()])
    best, plain, model, board, prior, fixed, method = asked
    assert best == BEST_SETTINGS
    assert plain == method.__class__()
    assert (model.model, model.board_shape, model.improve) == ("brown-conrady", None, True)
    assert (board.model, board.board_shape) == (None, BoardShapeModel.NOMINAL)
    assert (prior.model, prior.board_shape) == (None, BoardShapeModel.NOMINAL)
    assert (fixed.model, fixed.board_shape) == ("lucchese", None)
    assert not method.improve and method.board_shape is BoardShapeModel.NOMINAL


def test_a_focal_length_is_held_in_pixels(capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main(["calibrate", "a.png", "--fix", "fy=-5"])
    assert "State a number of pixels above 0, as fy=650." in capsys.readouterr().err


def test_corners_need_no_square(corners_file: Path, tmp_path: Path) -> None:
    file = tmp_path / "result.json"
    assert main(["calibrate", str(corners_file), "-q", "-o", str(file)]) == 0
    assert read_result(file).board == BOARD


@pytest.mark.parametrize("text", ["30", "30mm", "3 cm", "0.03m", " 30 "])
def test_a_square_may_have_a_unit(text: str) -> None:
    assert parse_length(text) == pytest.approx(30)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("0.03", "say 0.03m if it is metres, 0.03mm if it is not"),
        ("m", "above 0"),
        ("", "above 0"),
        ("2km", "the units are mm, cm, m, in"),
    ],
)
def test_a_square_in_metres_is_not_taken_for_millimetres(
    corners_file: Path, text: str, reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(["calibrate", str(corners_file), "--square", text])
    assert reason in capsys.readouterr().err


def test_a_square_given_with_corners_scales_the_poses(corners_file: Path, tmp_path: Path) -> None:
    files = [tmp_path / "30.json", tmp_path / "15.json"]
    for file in files:
        options = ["--square", file.stem, "-q", "-o", str(file)]
        assert main(["calibrate", str(corners_file), *options]) == 0
    full, half = (read_result(file).calibration for file in files)
    np.testing.assert_allclose(half.camera.params, full.camera.params, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(half.poses[0].tvec, full.poses[0].tvec / 2, rtol=1e-6)


def test_corners_from_elsewhere(content: Any, tmp_path: Path) -> None:
    bare = {
        "size": content["size"],
        "views": [{key: v[key] for key in ("image", "uv", "board")} for v in content["views"]],
    }
    file, result = tmp_path / "bare.json", tmp_path / "result.json"
    file.write_text(json.dumps(bare))
    assert main(["calibrate", str(file), "-q", "-o", str(result)]) == 0
    assert main(["calibrate", str(file), "-q", "--square", "30"]) == 1  # it states its own


def test_json_is_all_there_is_on_stdout(corners_file: Path, capsys: Capture) -> None:
    assert main(["calibrate", str(corners_file), "--json"]) == 0
    printed, problems = capsys.readouterr()
    record = json.loads(printed)
    assert record["format"] == "calibgui-result"
    assert record["residuals"]["count"] == COUNT * 42
    assert problems == ""


def test_quiet_is_one_line(corners_file: Path, capsys: Capture) -> None:
    assert main(["calibrate", str(corners_file), "--quiet"]) == 0
    printed, problems = capsys.readouterr()
    assert printed.startswith("GOOD. The photographs show nothing wrong. Error of a ")
    assert printed.endswith(f", {COUNT} of {COUNT} images.\n") and printed.count("\n") == 1
    assert problems == ""


def test_quiet_says_what_is_wrong(corners_file: Path, capsys: Capture) -> None:
    assert main(["calibrate", str(corners_file), "--fix", "fx=300", "--quiet"]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("CAN BE ") and " TIMES BETTER. " in printed
    assert "fx" in printed.split(". ")[1] and "Do: leave fx out of --fix." in printed


def test_quiet_says_what_to_do_where_no_option_helps(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    corners = json.loads(corners_file.read_text())
    corners["views"] = corners["views"][:2]
    rng = np.random.default_rng(1)
    for view in corners["views"]:
        view["uv"] = (view["uv"] + rng.normal(0, 0.5, np.shape(view["uv"]))).tolist()
    (tmp_path / "few.json").write_text(json.dumps(corners))
    assert main(["calibrate", str(tmp_path / "few.json"), "--quiet"]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("NOT USABLE. 2 views are too few.") and printed.count("\n") == 1
    assert ". Do: Add views with the board tilted by" in printed and printed.endswith("enough.\n")


def test_the_verdict_and_the_camera_come_first(corners_file: Path, capsys: Capture) -> None:
    assert main(["calibrate", str(corners_file), "--fix", "fx=300"]) == 0
    told = capsys.readouterr().out
    places = [told.index(words) for words in ("CAN BE ", "Error of", "Camera, ", "RMS ", "-v ")]
    assert places[0] == 0 and places == sorted(places)


def test_verbose_adds_all_that_is_known(corners_file: Path, capsys: Capture) -> None:
    assert main(["calibrate", str(corners_file)]) == 0
    verdict = capsys.readouterr().out.splitlines()[0]
    assert main(["calibrate", str(corners_file), "--stage-one"]) == 0
    told = capsys.readouterr().out
    assert told.startswith(verdict)
    headings = ["Camera, 320 x 240 px", "paper's frame", "Residuals of", "Views\n", "Stage I, each"]
    places = [told.index(words) for words in headings]
    assert places == sorted(places)
    assert max(map(len, told.splitlines())) <= 80


def test_corners_and_results_pass_through_the_standard_streams(
    corners_file: Path,
    photographs: Path,
    tmp_path: Path,
    capsys: Capture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def read_on(content: str) -> None:
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content.encode())))

    assert main(["detect", str(photographs), "--square", "30", "-o", "-"]) == 0
    printed = capsys.readouterr().out
    assert json.loads(printed)["views"] == json.loads(corners_file.read_text())["views"]
    read_on(printed)
    assert main(["calibrate", "-", "-o", "-"]) == 0
    printed = capsys.readouterr().out
    assert json.loads(printed)["residuals"]["count"] == COUNT * 42
    read_on(printed)
    assert main(["uncertainty", "-"]) == 0
    assert "at the image's centre" in capsys.readouterr().out
    read_on(printed)
    assert main(["undistort", "-", str(photographs), "-o", str(tmp_path / "undistorted")]) == 0
    read_on(printed)
    assert main(["convert", "-", "--export", f"ros={tmp_path / 'camera.yaml'}"]) == 0
    read_on("no JSON")
    assert main(["calibrate", "-"]) == 1
    assert "standard-input is not a file of corners" in capsys.readouterr().err


def test_parameters_are_held_and_freed(corners_file: Path, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "result.json"
    options = ["--fix", "k3,p1=0.001,fx=330", "--free", "p3", "-o", str(file)]
    assert main(["calibrate", str(corners_file), *options]) == 0
    calibration = read_result(file).calibration
    value = dict(zip(list_parameter_names("lucchese"), calibration.camera.params, strict=True))
    assert (value["k3"], value["p1"], value["fx"]) == (0.0, 0.001, 330.0)
    assert calibration.fixed == ("fx", "k3", "p1")
    assert "330 (held)" in capsys.readouterr().out


@pytest.mark.parametrize("cost", ["reference", "paper"])
def test_other_costs(corners_file: Path, cost: str, capsys: Capture) -> None:
    assert main(["calibrate", str(corners_file), "--cost", cost, "-v"]) == 0
    printed = capsys.readouterr().out
    assert ("its own SD" in printed) == (cost == "paper")
    assert max(map(len, printed.splitlines())) <= 80


def test_exports_are_written_and_described(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    yaml, csv = tmp_path / "camera.yaml", tmp_path / "corners.csv"
    options = ["--export", f"opencv={yaml}", "--export", f"corners-csv={csv}"]
    assert main(["calibrate", str(corners_file), *options]) == 0
    assert "camera_matrix" in yaml.read_text() and csv.exists()
    assert "refitted" in capsys.readouterr().out


def test_the_lens_model_is_chosen(corners_file: Path, tmp_path: Path, capsys: Capture) -> None:
    file, yaml = tmp_path / "result.json", tmp_path / "camera.yaml"
    options = ["--model", "brown-conrady", "--fix", "k3", "-o", str(file)]
    assert main(["calibrate", str(corners_file), *options, "--export", f"ros={yaml}"]) == 0
    camera = read_result(file).calibration.camera
    assert camera.names == ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "skew")
    assert camera.params[8] == 0.0
    assert "as calibrated" in " ".join(capsys.readouterr().out.split())
    assert str(camera.params[0]) in yaml.read_text()  # nothing was refitted


def test_the_printed_lens_belongs_to_the_papers_cost(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "result.json"
    assert main(["calibrate", str(corners_file), "--cost", "paper", "-q", "-o", str(file)]) == 0
    assert read_result(file).calibration.camera.model == "lucchese-pixels"
    with pytest.raises(SystemExit):
        main(["calibrate", str(corners_file), "--cost", "paper", "--model", "brown-conrady"])
    problem = " ".join(capsys.readouterr().err.split())
    assert "cannot be combined with 'brown-conrady'" in problem


def test_names_are_judged_against_the_chosen_model(corners_file: Path, capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main(["calibrate", str(corners_file), "--model", "brown-conrady", "--fix", "p3"])
    problem = " ".join(capsys.readouterr().err.split())
    assert "'brown-conrady' has no parameter 'p3'" in problem
    assert "Choose from fx, fy, cx, cy, k1, k2, p1, p2, k3" in problem


def test_an_export_that_cannot_follow_the_lens_costs_only_itself(
    corners_file: Path, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("calibgui.formats.camera_refit.MAX_REFIT_ERROR", 0.0)
    result, yaml, lines = (tmp_path / name for name in ("result.json", "a.yaml", "a.py"))
    options = ["-o", str(result), "--export", f"ros={yaml}", "--export", f"python={lines}"]
    assert main(["calibrate", str(corners_file), *options]) == 1
    printed, problems = capsys.readouterr()
    assert "cannot follow this lens" in problems and str(yaml) in problems
    assert "Camera, 320 x 240 px" in printed
    assert f"Wrote {lines}" in " ".join(printed.split()), "long paths are wrapped"
    assert result.exists() and lines.exists() and not yaml.exists()


def test_bad_images_are_reported_by_name_and_skipped(
    photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    shutil.copytree(photographs, tmp_path, dirs_exist_ok=True)
    (tmp_path / "text.png").write_text("no image")
    write_image(tmp_path / "small.png", np.zeros((100, 100), np.uint8))
    write_image(tmp_path / "blank.png", np.full((240, 320), 99, np.uint8))
    assert main(["calibrate", str(tmp_path), "--square", "30", "--board", "6x7"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "text.png is not an image" in printed
    assert "small.png: 100 x 100 pixels" in printed
    assert "blank.png: No checkerboard was found." in printed


def test_a_region_of_interest_is_passed_on(
    photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    # Far from the board: the one view that it spoils shows that it was used.
    roi = tmp_path / "roi.json"
    roi.write_text(json.dumps({"view2.png": [[0, 0], [20, 0], [20, 20], [0, 20]]}))
    options = ["--square", "30", "--board", "6x7", "--roi", str(roi)]
    assert main(["calibrate", str(photographs), *options]) == 0
    assert "view2.png: No" in capsys.readouterr().out


# --- what cannot be done --------------------------------------------------------------------------


def refused(arguments: list[str], capsys: Capture, *words: str) -> None:
    """The command fails with code 1, nothing on stdout and `words` in its one-line reason."""
    assert main(["calibrate", *arguments]) == 1
    printed, problems = capsys.readouterr()
    assert printed == ""
    last = problems.strip().splitlines()[-1]
    assert last.startswith("calibgui: ")
    for word in words:
        assert word in last


def test_no_board_anywhere(tmp_path: Path, capsys: Capture) -> None:
    for k in range(2):
        write_image(tmp_path / f"blank{k}.png", np.full((240, 320), 99, np.uint8))
    arguments = [str(tmp_path), "--square", "30", "-o", str(tmp_path / "result.json")]
    assert main(["calibrate", *arguments]) == 1
    problems = capsys.readouterr().err
    assert "blank0.png, blank1.png: No checkerboard" in problems
    last = problems.splitlines()[-1]
    for words in ("found in none of the images.", "Photograph", "--roi", "--target"):
        assert words in last
    assert not (tmp_path / "result.json").exists()


def test_nothing_found(tmp_path: Path, capsys: Capture) -> None:
    refused([str(tmp_path), "--square", "30"], capsys, "holds no images")
    refused([str(tmp_path / "x.png"), "--square", "30"], capsys, "x.png does not exist")


def write(content: Any, folder: Path) -> str:
    file = folder / "corners.json"
    file.write_text(json.dumps(content))
    return str(file)


@pytest.mark.parametrize("number", [math.nan, None, 1e999, "12"])
def test_a_corner_that_is_no_number(
    content: Any, tmp_path: Path, capsys: Capture, number: object
) -> None:
    content["views"][1]["uv"][3][0] = number
    refused([write(content, tmp_path)], capsys, "view 2", "view2.png", "uv[3][0]")


def test_a_truncated_corners_file(corners_file: Path, tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "corners.json"
    file.write_text(corners_file.read_text()[:5000])
    refused([str(file)], capsys, "corners.json is cut short")


def test_a_mirrored_view_is_named(content: Any, tmp_path: Path, capsys: Capture) -> None:
    view = content["views"][4]
    view["uv"] = [[319 - u, v] for u, v in view["uv"]]
    refused([write(content, tmp_path)], capsys, "view5.png", "mirrored")


def test_outputs_are_checked_before_the_work(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    missing = tmp_path / "missing" / "result.json"
    refused([str(corners_file), "-o", str(missing)], capsys, "does not exist")
    refused([str(corners_file), "-o", str(tmp_path)], capsys, "is a folder")
    file = tmp_path / "corners.json"
    file.write_bytes(corners_file.read_bytes())
    refused([str(file), "-o", str(file)], capsys, "corners.json is one of the files to read")
    assert file.read_bytes() == corners_file.read_bytes()
    refused([str(corners_file), "--export", f"ros={missing.parent / 'a.yaml'}"], capsys, "exist")


@pytest.mark.parametrize(
    "wrong",
    [
        [],
        ["a.png", "--prior", "0.1,0.3"],  # in mm, and no --square
        ["a.png", "--save-board-shape", "b.json", "--board-shape", "free"],
        ["a.png", "--square", "0"],
        ["a.png", "--square", "nan"],
        ["a.png", "--square", "30", "--board", "12"],
        ["a.png", "--square", "30", "--board", "1x1"],
        ["a.png", "--square", "30", "--cost", "none"],
        ["a.png", "--square", "30", "--fix", "k9"],
        ["a.png", "--square", "30", "--fix", "k1=x"],
        ["a.png", "--square", "30", "--fix", "k1=nan"],
        ["a.png", "--square", "30", "--fix", "p3", "--free", "p3"],
        ["a.png", "--square", "30", "--free", ""],
        ["a.png", "--square", "30", "--export", "opencv"],
        ["a.png", "--square", "30", "--export", "none=a.json"],
        ["a.png", "--square", "30", "--export", "ros=a.txt"],
        ["a.png", "--square", "30", "--model", "none"],
        ["a.png", "--square", "30", "--model", "lucchese-pixels"],
        ["a.png", "--square", "30", "--model", "brown-conrady", "--cost", "paper"],
        ["a.png", "--square", "30", "--model", "brown-conrady", "--fix", "p3"],
        ["a.png", "--square", "30", "--model", "brown-conrady", "--free", "p3"],
        ["a.png", "--square", "30", "--method", "none"],
        ["a.png", "--square", "30", "--method", "bouguet", "--model", "auto"],
        ["a.png", "--square", "30", "--method", "bouguet", "--model", "rational"],
        ["a.png", "--square", "30", "--method", "bouguet", "--plate", "free"],
        ["a.png", "--square", "30", "--method", "bouguet", "--weigh-views"],
        ["a.png", "--square", "30", "--weigh-views", "--cost", "paper"],
        ["a.png", "--square", "30", "--as-asked", "--save-board-shape", "a.json"],
        ["a.png", "--square", "30", "--board-shape", "free", "--prior", "0.1"],
        ["a.png", "--square", "30", "--plate", "free", "--prior", "0.1"],
        ["a.png", "--square", "30", "--plate", "bow", "--prior", "0.1,0.3"],
        ["a.png", "b.json", "--square", "30"],
        ["corners.json", "--target", "charuco"],
        ["corners.json", "--corners", "saddle"],
    ],
)
def test_wrong_usage_is_said_before_any_work(wrong: list[str], capsys: Capture) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["calibrate", *wrong])
    assert ended.value.code == 2
    assert "usage: calibgui calibrate" in capsys.readouterr().err


@pytest.mark.parametrize("reader", ["opencv", "kalibr"])
def test_a_reader_gets_the_camera_as_it_was_calibrated(
    reader: str, corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    file = tmp_path / "camera.yaml"
    assert main(["calibrate", str(corners_file), "--for", f"{reader}={file}"]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert f"Wrote {file}. Lens model " in told and "as calibrated." in told
    assert read_camera(file).camera.model in EXPORTERS[reader].models


def test_a_reader_and_a_lens_model_do_not_go_together(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    reader = f"ros={tmp_path / 'camera.yaml'}"
    with pytest.raises(SystemExit):
        main(["calibrate", str(corners_file), "--for", reader, "--model", "pinhole"])
    assert "with --model say --export ros=FILE" in capsys.readouterr().err


def test_limits_decide_the_exit_code_and_are_written(
    corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    file, limits = tmp_path / "result.json", tmp_path / "mine.toml"
    command = ["calibrate", str(corners_file), "--as-asked", "-o", str(file), "--limits"]
    assert main([*command, "hobby-robot"]) == 3
    printed = " ".join(capsys.readouterr().out.split())
    assert "FAIL by the limits hobby-robot. 6 views are used, fewer than the limit of 8." in printed
    written = json.loads(file.read_text(encoding="utf-8"))
    assert written["limits"]["fewest_views"] == 8 and not written["acceptance"]["passed"]
    assert "6 views are used, fewer than the limit of 8." in written["acceptance"]["reasons"]
    limits.write_text("fewest_views = 6")
    assert main([*command, str(limits), "-q"]) == 0
    assert "PASS by the limits mine." in capsys.readouterr().out
    again = read_result(file)
    assert again.limits is not None and again.limits.fewest_views == 6
    limits.write_text("largest_change_px = 6")
    assert main([*command, str(limits)]) == 1
    assert "largest_change_px" in capsys.readouterr().err
