"""Images of another size than the calibration's: the camera of their mode is taken, and said."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from calibgui.cli.main import main
from calibgui.engine.camera import pixels_from_rays, rays_from_pixels
from calibgui.formats import read_camera
from tests.photographs import BOARD

Capture = pytest.CaptureFixture[str]
PIXELS = np.random.default_rng(0).uniform(20, 140, (30, 2))


@pytest.fixture
def opencv_file(result_file: Path, tmp_path: Path) -> Path:
    file = tmp_path / "camera.yaml"
    assert main(["convert", str(result_file), "--export", f"opencv={file}", "-q"]) == 0
    return file


@pytest.fixture
def streams(photographs: Path, tmp_path: Path) -> dict[str, Path]:
    """Folders with the photographs of 320 x 240 px halved, cropped, upside down and mirrored."""
    makers = {
        "half": lambda image: cv2.resize(image, (160, 120), interpolation=cv2.INTER_AREA),
        "cropped": lambda image: image[10:230],
        "corner": lambda image: image[20:, 30:],
        "turned": lambda image: image[::-1, ::-1],
    }
    for name, make in makers.items():
        (tmp_path / name).mkdir()
        for file in photographs.glob("*.png"):
            image = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
            cv2.imwrite(str(tmp_path / name / file.name), make(image))
    return {name: tmp_path / name for name in makers}


def locate(camera: Path, images: Path, out: Path, *options: str) -> dict[str, np.ndarray]:
    """Where `calibgui pose` finds the boards, by photograph."""
    arguments = ["pose", str(camera), str(images), "--square", "30", "-o", str(out), "-q"]
    assert main([*arguments, *options]) == 0
    views = json.loads(out.read_text())["views"]
    return {Path(view["image"]).name: np.array(view["tvec_mm"]) for view in views}


@pytest.mark.parametrize(
    ("stream", "options"),
    [("half", []), ("cropped", []), ("corner", ["--crop", "30,20,290x220"])],
)
def test_boards_are_where_they_are_in_the_whole_images(
    stream: str,
    options: list[str],
    result_file: Path,
    photographs: Path,
    streams: dict[str, Path],
    tmp_path: Path,
    capsys: Capture,
) -> None:
    whole = locate(result_file, photographs, tmp_path / "whole.json")
    capsys.readouterr()
    found = locate(result_file, streams[stream], tmp_path / "stream.json", *options)
    assert "count as" in capsys.readouterr().err
    compared = [name for name in whole if name in found]
    assert len(compared) >= 3
    for name in compared:
        np.testing.assert_allclose(found[name], whole[name], atol=0.5)


def test_stream_that_is_turned_sees_the_board_turned(
    result_file: Path, photographs: Path, streams: dict[str, Path], tmp_path: Path
) -> None:
    """The board's corners are the same, whichever of them is its first."""
    places = []
    for folder, flip in ((photographs, []), (streams["turned"], ["--flip", "both"])):
        found = tmp_path / "poses.json"
        locate(result_file, folder, found, *flip)
        xyz = np.column_stack([BOARD.points(), np.zeros(BOARD.rows * BOARD.cols)])
        for view in json.loads(found.read_text())["views"][:3]:
            R = Rotation.from_rotvec(view["rvec"]).as_matrix()
            places.append((xyz @ R.T + view["tvec_mm"]).mean(axis=0))
    for upright, turned in zip(places[:3], places[3:], strict=True):
        np.testing.assert_allclose(turned, upright * [-1, -1, 1], atol=0.5)


def test_undistort_and_check_take_the_stream(
    result_file: Path, streams: dict[str, Path], tmp_path: Path, capsys: Capture
) -> None:
    out = tmp_path / "undistorted"
    assert main(["undistort", str(result_file), str(streams["half"]), "-o", str(out)]) == 0
    assert "images of 160 x 120 px count as the whole of 320 x 240 px, scaled by 0.5" in (
        capsys.readouterr().err
    )
    geometry = json.loads((out / "resampled.json").read_text())
    assert geometry["size"] == [160, 120]
    code = main(["check", str(result_file), str(streams["cropped"]), "--square", "30"])
    assert code == 0
    assert "rows 10 to 229" in capsys.readouterr().err


@pytest.mark.parametrize("format_name", ["opencv", "ros", "basalt", "mrcal", "result"])
def test_convert_writes_the_camera_of_the_stream(
    format_name: str, opencv_file: Path, result_file: Path, tmp_path: Path
) -> None:
    source = result_file if format_name == "result" else opencv_file
    suffix = {"result": "json", "basalt": "json", "mrcal": "cameramodel"}.get(format_name, "yaml")
    out = tmp_path / f"stream.{suffix}"
    mode = ["--crop", "20,0,300x200", "--binning", "2"]
    assert main(["convert", str(source), *mode, "--export", f"{format_name}={out}", "-q"]) == 0
    whole, stream = read_camera(source).camera, read_camera(out).camera
    assert stream.size == (150, 100)
    inside = PIXELS[(PIXELS > [25, 5]).all(axis=1)]
    np.testing.assert_allclose(
        pixels_from_rays(rays_from_pixels(inside, whole), stream),
        (inside - [20, 0] + 0.5) / 2 - 0.5,
        atol=1e-6,
    )


def test_result_keeps_calibration_and_mode(
    result_file: Path, streams: dict[str, Path], photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    half = tmp_path / "half.json"
    command = ["convert", str(result_file), "--scale", "0.5", "--export", f"result={half}"]
    assert main([*command, "-q"]) == 0
    content = json.loads(half.read_text())
    assert (content["version"], content["sensor_mode"]["size"]) == (2, [160, 120])
    assert content["camera"] == json.loads(result_file.read_text())["camera"]
    stored = read_camera(half)
    assert stored.covariance is not None
    assert stored.camera.size == (160, 120)
    assert stored.camera.params[0] == pytest.approx(content["camera"]["params"]["fx"] / 2)

    # Its own images need no word; those of the calibration are known.
    capsys.readouterr()
    own = locate(half, streams["half"], tmp_path / "own.json")
    assert "count as" not in capsys.readouterr().err
    whole = locate(half, photographs, tmp_path / "whole.json")
    for name, place in own.items():
        np.testing.assert_allclose(place, whole[name], atol=0.5)

    # Of a part of the images too: they are larger than it, which no crop of it would explain.
    part = tmp_path / "part.json"
    command = ["convert", str(result_file), "--crop", "0,20,320x200"]
    assert main([*command, "--export", f"result={part}", "-q"]) == 0
    for name, place in locate(part, photographs, tmp_path / "again.json").items():
        np.testing.assert_allclose(place, whole[name], atol=1e-3)

    # Back again it is the calibration's, without a mode.
    back = tmp_path / "back.json"
    command = ["convert", str(half), "--to-size", "320x240", "--export", f"result={back}"]
    assert main([*command, "-q"]) == 0
    assert json.loads(back.read_text())["version"] == 1
    assert main(["uncertainty", str(half), "-q"]) == 0
    assert "works with those of the calibration, 320 x 240" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["--to-size", "200x80"], "Say which: --crop 60,80,200x80"),
        (["--to-size", "240x320"], "turned by a quarter"),
        (["--crop", "100,0,300x200"], "no part of 300 x 200"),
        (["--scale", "0.5", "--export", "corners={}/a.json"], "there are none of this camera"),
    ],
)
def test_refusals(
    options: list[str], problem: str, result_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    options = [option.format(tmp_path) for option in options]
    assert main(["convert", str(result_file), *options]) == 1
    assert problem in " ".join(capsys.readouterr().err.split())


def test_stated_mode_must_lead_to_the_images(
    result_file: Path, streams: dict[str, Path], capsys: Capture
) -> None:
    assert main(["pose", str(result_file), str(streams["half"]), "--scale", "0.25"]) == 1
    assert "leads to images of 80 x 60 px" in capsys.readouterr().err
