"""calibgui undistort and rectify: folders of new images."""

from __future__ import annotations

import json
import math
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.app.outputs.resampling import GEOMETRY_FILE
from calibgui.cli.main import main
from calibgui.engine.images.reading import read_image_size
from tests.photographs import CAMERA, COUNT

Capture = pytest.CaptureFixture[str]


def test_undistort_writes_a_folder(
    result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    out = tmp_path / "new" / "folder"
    assert main(["undistort", str(result_file), str(photographs), "-o", str(out)]) == 0
    assert f"Wrote {COUNT} images" in capsys.readouterr().out
    assert read_image_size(out / "view1.png") == CAMERA.size
    assert len(list(out.iterdir())) == COUNT + 1


def test_an_image_is_no_folder(result_file: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "straight.png"
    with pytest.raises(SystemExit):
        main(["undistort", str(result_file), "view1.png", "-o", str(out)])
    assert "name a folder for the new ones" in capsys.readouterr().err
    assert not out.exists()


def test_the_field_of_view_is_passed_on(
    result_file: Path, photographs: Path, tmp_path: Path
) -> None:
    focal = {}
    for view in ("all", "same-scale", "no-border"):
        arguments = [str(result_file), str(photographs / "view1.png"), "--view", view, "-q"]
        assert main(["undistort", *arguments, "-o", str(tmp_path / view)]) == 0
        focal[view] = json.loads((tmp_path / view / GEOMETRY_FILE).read_text())["matrix"][0][0]
    assert focal["all"] < focal["no-border"]
    assert focal["same-scale"] == pytest.approx(CAMERA.focal[0], rel=1e-2)


def test_rectify_takes_the_calibrated_images_by_default(
    result_file: Path, tmp_path: Path, capsys: Capture
) -> None:
    options = ["--scale", "2", "--json", "-o", str(tmp_path / "out")]
    assert main(["rectify", str(result_file), *options]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert len(answer["written"]) == COUNT and answer["skipped"] == {}
    assert read_image_size(tmp_path / "out" / "view1.png") == (8 * 60, 7 * 60)


def test_photographs_that_are_not_found_are_asked_for(
    result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    moved = tmp_path / "moved.json"
    moved.write_text(result_file.read_text().replace(str(photographs), "photographs"))
    out = ["-o", str(tmp_path / "out")]
    assert main(["rectify", str(moved), *out]) == 1
    assert f"or their folder after {moved}" in capsys.readouterr().err
    shutil.copytree(photographs, tmp_path / "photographs")
    assert main(["rectify", str(moved), *out]) == 0


def test_a_skipped_image_is_named_and_none_written_fails(
    result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    text = tmp_path / "text.png"
    text.write_text("no image")
    both = [str(result_file), str(photographs / "view1.png"), str(text)]
    assert main(["undistort", *both, "-o", str(tmp_path / "a")]) == 1
    assert f"skipped: {text} is not an image" in capsys.readouterr().err
    assert (tmp_path / "a" / "view1.png").exists()
    assert main(["undistort", str(result_file), str(text), "-o", str(tmp_path / "b")]) == 1
    assert "No image was written" in capsys.readouterr().err


def test_a_file_that_is_no_result_is_refused(
    corners_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    assert main(["undistort", str(corners_file), str(photographs), "-o", str(tmp_path)]) == 1
    assert "corners.json holds corners, but no camera" in capsys.readouterr().err


def test_a_projection_and_a_field_of_view(
    result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    """The width shows the angle, and what is lost is told."""
    options = ["--projection", "cylindrical", "--fov", "30", "-o", str(tmp_path)]
    assert main(["undistort", str(result_file), str(photographs / "view1.png"), *options]) == 0
    assert "Cylindrical of 30 degrees: the outer " in capsys.readouterr().out
    geometry = json.loads((tmp_path / GEOMETRY_FILE).read_text())
    assert geometry["projection"] == "cylindrical"
    assert geometry["matrix"][0][0] == pytest.approx(320 / math.radians(30))
    assert geometry["matrix"][1][1] == geometry["matrix"][0][0]


def test_a_cube_has_files_named_after_its_faces(
    result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    source = photographs / "view1.png"
    options = ["--projection", "cube", "--json", "-o", str(tmp_path)]
    assert main(["undistort", str(result_file), str(source), *options]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["written"] == {str(source): {"front": str(tmp_path / "view1_front.png")}}
    assert answer["shown"] == "Cube of front: everything that the lens sees is shown."


def test_what_cannot_be_shown_is_said(
    result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    arguments = ["undistort", str(result_file), str(photographs), "-o", str(tmp_path / "new")]
    assert main([*arguments, "--fov", "180"]) == 1
    assert "Choose a field of view above 0 and below 180 degrees" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main([*arguments, "--fov", "90", "--view", "no-border"])


def test_rectify_locates_the_board_with_any_camera(
    result_file: Path, photographs: Path, tmp_path: Path, capsys: Capture
) -> None:
    """As the calibration does, also in photographs of half the size."""
    camera, folder = tmp_path / "camera.yaml", tmp_path / "rectified"
    assert main(["convert", str(result_file), "--export", f"opencv={camera}", "-q"]) == 0
    options = ["--square", "30", "--scale", "1", "-q"]
    image = photographs / "view2.png"
    small = tmp_path / "small" / image.name
    small.parent.mkdir()
    pixels = cv2.imread(str(image), cv2.IMREAD_GRAYSCALE)
    cv2.imwrite(str(small), cv2.resize(pixels, (160, 120), interpolation=cv2.INTER_AREA))
    made = []
    for source, file, place in (
        (result_file, image, folder / "own"),
        (camera, image, folder / "other"),
        (camera, small, folder / "small"),
    ):
        place.parent.mkdir(exist_ok=True)
        assert main(["rectify", str(source), str(file), "-o", str(place), *options]) == 0
        made.append(cv2.imread(str(place / image.name), cv2.IMREAD_GRAYSCALE).astype(float))
    own, other, halved = made
    assert own.shape == other.shape == halved.shape
    # Symmetric boards have two first corners.
    assert min(np.abs(own - turned).mean() for turned in (other, other[::-1, ::-1])) < 2
    assert min(np.abs(own - turned).mean() for turned in (halved, halved[::-1, ::-1])) < 12
    assert "scaled by 0.5" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["rectify", str(camera), "-o", str(folder / "none")])
