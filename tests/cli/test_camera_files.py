"""calibgui check and convert, and the subcommands that read camera files of other programs."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.cli.main import main
from calibgui.engine.camera import pixels_from_rays, rays_from_pixels
from calibgui.formats import read_camera
from tests.photographs import COUNT

Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def opencv_file(result_file: Path) -> Path:
    """The result's camera as OpenCV has it."""
    file = result_file.with_name("camera.yaml")
    assert main(["convert", str(result_file), "--export", f"opencv={file}", "-q"]) == 0
    return file


@pytest.fixture
def fisheye_file(tmp_path: Path) -> Path:
    """A lens of 200 degrees in a file of Kalibr's."""
    file = tmp_path / "camchain.yaml"
    file.write_text(
        "cam0:\n"
        "  camera_model: pinhole\n"
        "  distortion_model: equidistant\n"
        "  intrinsics: [330.0, 330.0, 503.0, 396.0]\n"
        "  distortion_coeffs: [-0.02, 0.002, -0.001, 0.0001]\n"
        "  resolution: [1000, 800]\n"
    )
    return file


def changed(result_file: Path, folder: Path, scale: float) -> Path:
    """The result with focal lengths that are off."""
    content = json.loads(result_file.read_text())
    for name in ("fx", "fy"):
        content["camera"]["params"][name] *= scale
    file = folder / "changed.json"
    file.write_text(json.dumps(content))
    return file


def test_check_of_a_good_calibration(result_file: Path, photographs: Path, capsys: Capture) -> None:
    assert main(["check", str(result_file), str(photographs)]) == 0
    out = capsys.readouterr().out
    assert "The calibration is still good" in out
    assert "view1.png" in out
    assert max(map(len, out.splitlines())) <= 80


def test_check_of_a_changed_camera(
    result_file: Path, corners_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    wrong = changed(result_file, tmp_path, 1.02)
    assert main(["check", str(corners_file), "--with", str(wrong), "-q"]) == 3
    captured = capsys.readouterr()
    assert not captured.err
    assert captured.out.startswith("The camera has changed") and captured.out.count("\n") == 1
    assert main(["check", str(wrong), str(corners_file), "--json", "--limit", "20"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["verdict"] == "still good"
    assert answer["change_px"] > 1
    assert answer["scale"] == pytest.approx(-0.02, abs=0.003)
    assert len(answer["views"]) == COUNT
    assert sum(view["corners"] for view in answer["views"]) == answer["corners"]


def test_check_that_cannot_tell(result_file: Path, photographs: Path, capsys: Capture) -> None:
    one = [str(photographs / "view1.png"), "--limit", "0.0001"]
    assert main(["check", str(result_file), *one]) == 1
    out = capsys.readouterr().out
    assert "cannot tell" in out
    assert "Add pictures in which the board" in " ".join(out.split())


def test_check_with_the_file_of_another_program(
    opencv_file: Path, photographs: Path, capsys: Capture
) -> None:
    assert main(["check", str(opencv_file), str(photographs)]) == 0
    assert "states no standard deviations" in capsys.readouterr().out


def test_check_refuses(
    result_file: Path, fisheye_file: Path, photographs: Path, capsys: Capture
) -> None:
    assert main(["check", str(fisheye_file), str(photographs)]) == 1
    assert "a camera of 1000 x 800 px" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["check", str(result_file)])


def test_convert_states_the_error(fisheye_file: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "basalt.json"
    arguments = [str(fisheye_file), "--model", "double-sphere", "--export", f"basalt={out}"]
    assert main(["convert", *arguments]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "without corners; differs by at most" in text
    assert "degrees from the axis" in text
    assert main(["convert", *arguments, "--json"]) == 0
    stated = json.loads(capsys.readouterr().out)["largest_error_px"]
    before, after = read_camera(fisheye_file).camera, read_camera(out).camera
    uv = np.random.default_rng(0).uniform((0, 0), (999, 799), (50000, 2))
    error = np.linalg.norm(pixels_from_rays(rays_from_pixels(uv, before), after) - uv, axis=1)
    assert stated / 3 < error.max() <= 1.01 * stated


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("opencv", "a.yaml"),
        ("opencv", "a.json"),
        ("ros", "a.yaml"),
        ("kalibr", "a.yaml"),
        ("basalt", "a.json"),
        ("colmap", "a.txt"),
    ],
)
def test_convert_writes_what_is_read_again(
    name: str, file: str, fisheye_file: Path, tmp_path: Path
) -> None:
    out = tmp_path / file
    assert main(["convert", str(fisheye_file), "--export", f"{name}={out}", "-q"]) == 0
    again = read_camera(out).camera
    original = read_camera(fisheye_file).camera
    assert again.model == "kannala-brandt"
    np.testing.assert_allclose(again.params, original.params, rtol=1e-12, atol=1e-12)


def test_convert_writes_what_opencv_reads(fisheye_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "a.yaml"
    assert main(["convert", str(fisheye_file), "--export", f"opencv={out}", "-q"]) == 0
    storage = cv2.FileStorage(str(out), cv2.FILE_STORAGE_READ)
    assert storage.getNode("camera_matrix").mat()[0, 2] == 503
    assert storage.getNode("nframes").empty()


def test_convert_a_part_of_the_image(fisheye_file: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "a.cameramodel"
    export = ["--export", f"mrcal={out}"]
    assert main(["convert", str(fisheye_file), *export]) == 1
    problem = capsys.readouterr().err
    assert "cannot follow this lens" in problem
    assert "--within" in problem
    assert not out.exists()
    assert main(["convert", str(fisheye_file), *export, "--within", "50"]) == 0
    assert "up to 50 degrees" in " ".join(capsys.readouterr().out.split())
    assert "'valid_intrinsics_region': [[" in out.read_text()
    assert "up to 50 degrees" in out.read_text()


def test_convert_a_result_on_its_corners(
    result_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    out = tmp_path / "a.json"
    arguments = ["--model", "brown-conrady", "--export", f"result={out}"]
    assert main(["convert", str(result_file), *arguments]) == 0
    assert "Calibrated again on the same corners" in " ".join(capsys.readouterr().out.split())
    assert read_camera(out).camera.model == "brown-conrady"
    assert read_camera(out).covariance is not None


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (
            ["--export", "result=a.json"],
            "holds corners or the poses of photographs, and there are none",
        ),
        (["--model", "eucm", "--export", "ros=a.yaml"], "does not hold the lens model eucm"),
        (["--model", "pinhole"], "cannot follow this lens"),
        (["--export-all", "all"], "holds a camera only, and many formats hold corners or poses"),
    ],
)
def test_convert_refuses(
    arguments: list[str],
    problem: str,
    fisheye_file: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["convert", str(fisheye_file), *arguments]) == 1
    assert problem in capsys.readouterr().err


def test_what_a_result_says_of_camera_and_lens_is_kept(result_file: Path, tmp_path: Path) -> None:
    content = json.loads(result_file.read_text())
    content["hardware"] = {"maker": "Acme", "model": "X-1"}
    file, out = tmp_path / "named.json", tmp_path / "lens.xml"
    file.write_text(json.dumps(content))
    export = ["--export", f"lensfun={out}", "--hardware", "model=X-2"]
    assert main(["convert", str(file), *export]) == 0
    assert "<maker>Acme</maker>" in out.read_text()
    assert "<model>X-2</model>" in out.read_text()


def test_camera_and_lens_are_named_in_exports(opencv_file: Path, tmp_path: Path) -> None:
    out = tmp_path / "lens.xml"
    hardware = ["--hardware", "maker=Acme", "--hardware", "crop=2", "--hardware", "type=fisheye"]
    assert main(["convert", str(opencv_file), "--export", f"lensfun={out}", *hardware]) == 0
    text = out.read_text()
    assert "<maker>Acme</maker>" in text and "<type>fisheye</type>" in text
    assert "<cropfactor>2</cropfactor>" in text


@pytest.mark.parametrize("pair", ["type=round", "colour=red", "crop=0", "maker"])
def test_hardware_that_is_none_is_refused(pair: str, opencv_file: Path, capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main(["convert", str(opencv_file), "--hardware", pair])
    assert "--hardware" in capsys.readouterr().err


def test_diff_of_camera_files(result_file: Path, opencv_file: Path, capsys: Capture) -> None:
    assert main(["diff", str(result_file), str(opencv_file), "--covered", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["worst_px"] < 0.5
    assert answer["expected_rms_px"] is None
    assert main(["diff", str(opencv_file), str(result_file)]) == 0
    assert "not known" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["diff", str(opencv_file), str(result_file), "--covered"])


def test_undistort_with_a_camera_file(opencv_file: Path, photographs: Path, tmp_path: Path) -> None:
    arguments = [str(opencv_file), str(photographs / "view1.png"), "-o", str(tmp_path / "new")]
    assert main(["undistort", *arguments, "-q"]) == 0
    assert (tmp_path / "new/view1.png").exists()


@pytest.mark.parametrize("command", ["undistort", "rectify", "check"])
@pytest.mark.parametrize("name", ["", "view1.png"])
def test_the_camera_is_named_before_the_photographs(
    command: str, name: str, result_file: Path, photographs: Path, capsys: Capture
) -> None:
    options = [] if command == "check" else ["-o", str(photographs / "out")]
    assert main([command, str(photographs / name), str(result_file), *options]) == 1
    problem = capsys.readouterr().err
    assert f"{photographs / name} holds photographs, where a camera's file is expected" in problem


@pytest.mark.parametrize("command", ["uncertainty", "views"])
def test_what_needs_corners_says_so(command: str, opencv_file: Path, capsys: Capture) -> None:
    assert main([command, str(opencv_file)]) == 1
    problem = capsys.readouterr().err
    assert "holds a camera only (OpenCV" in problem
    assert "calibgui calibrate -o" in problem


def test_a_file_of_several_cameras(fisheye_file: Path, capsys: Capture) -> None:
    text = fisheye_file.read_text()
    fisheye_file.write_text(text + text.replace("cam0", "cam1").replace("330.0", "340.0"))
    one = str(fisheye_file)
    assert main(["convert", one, "--model", "eucm"]) == 1
    assert "holds 2 cameras" in capsys.readouterr().err
    assert main(["convert", one, "--model", "ucm", "--within", "60", "--camera", "cam1"]) == 0
    capsys.readouterr()
    assert main(["diff", one, one, "--camera-a", "cam0", "--camera-b", "cam1", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["worst_px"] > 5


def test_a_file_that_does_not_state_the_size(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "camera.json"
    file.write_text(
        '{"camera_matrix": [[600, 0, 320], [0, 600, 240], [0, 0, 1]], '
        '"dist_coeff": [[-0.2, 0.1, 0, 0, 0]]}'
    )
    arguments = [str(file), "--model", "brown-conrady", "--json"]
    assert main(["convert", *arguments]) == 1
    assert "how large its images are" in capsys.readouterr().err
    assert main(["convert", *arguments, "--size", "640x480"]) == 0
    assert json.loads(capsys.readouterr().out)["size"] == [640, 480]
    with pytest.raises(SystemExit):
        main(["convert", *arguments, "--size", "640x0"])
