"""Folders of undistorted and rectified images."""

from __future__ import annotations

import errno
import json
import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.outputs.resampling import (
    GEOMETRY_FILE,
    Undistortion,
    WrittenImage,
    rectify_files,
    undistort_files,
)
from calibgui.app.photographs.paths import find_images
from calibgui.dataset import CornerSet, Result, View, ViewStatus
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import distort_points
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.features.corners import Corners
from calibgui.engine.files import describe_write_error
from calibgui.engine.images.projections import Projection
from calibgui.engine.images.reading import read_image, write_image
from calibgui.engine.images.undistortion import FieldOfView
from tests.engine import scenes
from tests.photographs import BOARD, CAMERA, COUNT, draw_poses


@pytest.fixture(scope="module")
def result(photographs: Path) -> Result:
    scene = scenes.seen(CAMERA, draw_poses(), BOARD)
    views = []
    for number, seen in enumerate(scene.views, start=1):
        grid = np.rint(seen.xy[:, ::-1] / BOARD.square)
        found = Corners((BOARD.rows, BOARD.cols), grid, seen.uv, seen.uv)
        image = str(photographs / f"view{number}.png")
        views.append(View(image, ViewStatus.FOUND, corners=found))
    return calibrate_views(CornerSet(CAMERA.size, tuple(views), BOARD))


def test_undistorted_images_are_a_pinholes(photographs: Path, tmp_path: Path) -> None:
    images = find_images([str(photographs)])
    told: list[int] = []
    written = undistort_files(
        CAMERA, images, tmp_path, progress=lambda done, total, _: told.append(total - done)
    )
    assert [one.source for one in written] == list(images)
    assert told == list(range(COUNT - 1, -1, -1))
    geometry = json.loads((tmp_path / GEOMETRY_FILE).read_text())
    assert geometry["kind"] == "undistorted"
    assert geometry["projection"] == "perspective"
    assert "rotations" not in geometry
    assert set(geometry["images"]) == {path.name for path in images}
    # Corners of the new image, distorted again, are the corners of the photograph.
    ideal = find_corners(read_image(written[0].paths[""]).pixels, (6, 7)).uv
    back = distort_points(ideal, CAMERA, np.array(geometry["matrix"]))
    measured = find_corners(read_image(images[0]).pixels, (6, 7)).uv
    assert np.linalg.norm(back - measured, axis=1).max() < 0.2


def test_rectified_images_show_the_board_square(
    result: Result, photographs: Path, tmp_path: Path
) -> None:
    written = rectify_files(result, find_images([str(photographs)]), tmp_path, pixels_per_mm=1.0)
    geometry = json.loads((tmp_path / GEOMETRY_FILE).read_text())
    assert geometry["size"] == [8 * 30, 7 * 30]
    assert "projection" not in geometry
    matrix = np.array(geometry["matrix"])
    for one in written:
        corners = find_corners(read_image(one.paths[""]).pixels, (6, 7))
        expected = BOARD.points(corners.grid) @ matrix[:2, :2] + matrix[:2, 2]
        assert np.linalg.norm(corners.uv - expected, axis=1).max() < 0.3


def test_the_scale_left_open_is_about_the_photographs(
    result: Result, photographs: Path, tmp_path: Path
) -> None:
    rectify_files(result, find_images([str(photographs)]), tmp_path)
    width, _ = json.loads((tmp_path / GEOMETRY_FILE).read_text())["size"]
    assert 0.5 < width / CAMERA.size[0] < 1.1


def reasons(written: tuple[WrittenImage, ...]) -> dict[str, str]:
    return {one.source.name: one.reason for one in written if not one.paths}


def test_what_cannot_be_done_is_said_and_the_rest_done(
    result: Result, photographs: Path, tmp_path: Path
) -> None:
    source = tmp_path / "in"
    shutil.copytree(photographs, source)
    (source / "text.png").write_text("no image")
    write_image(source / "other.png", np.zeros((240, 320), np.uint8))
    write_image(source / "small.png", np.zeros((24, 32), np.uint8))
    images = find_images([str(source)])
    undone = reasons(undistort_files(CAMERA, images, tmp_path / "u"))
    assert set(undone) == {"text.png", "small.png"}
    assert "32 x 24" in undone["small.png"]
    # Poses are found by name where the folder is another.
    undone = reasons(rectify_files(result, images, tmp_path / "r"))
    assert set(undone) == {"text.png", "other.png", "small.png"}
    assert "not one of the calibrated views" in undone["other.png"]
    assert not list((tmp_path / "r").glob(".*"))


def test_a_disk_that_is_full_is_said_once(
    photographs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The images that could not be written are not listed one by one, as if they were at fault."""

    def refuse(path: Path, *_: object) -> None:
        raise describe_write_error(path, OSError(errno.ENOSPC, "No space left on device"))

    monkeypatch.setattr("calibgui.app.outputs.resampling.write_image", refuse)
    with pytest.raises(CalibrationError, match=r"view\d\.png cannot be written: No space left"):
        undistort_files(CAMERA, find_images([str(photographs)]), tmp_path)


def test_photographs_are_never_overwritten(photographs: Path, tmp_path: Path) -> None:
    shutil.copytree(photographs, tmp_path / "a")
    shutil.copytree(photographs, tmp_path / "b")
    images = find_images([str(tmp_path / "a")])
    with pytest.raises(CalibrationError, match="overwritten"):
        undistort_files(CAMERA, images, tmp_path / "b" / ".." / "a")
    with pytest.raises(CalibrationError, match="same name"):
        undistort_files(CAMERA, find_images([str(tmp_path / "*" / "*.png")]), tmp_path / "c")


def test_progress_can_cancel_and_leaves_whole_images(photographs: Path, tmp_path: Path) -> None:
    def cancel(*_: object) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        undistort_files(
            CAMERA,
            find_images([str(photographs)]),
            tmp_path,
            Undistortion(view=FieldOfView.NO_BORDER),
            cancel,
        )
    names = {path.name for path in tmp_path.iterdir()}
    record = json.loads((tmp_path / GEOMETRY_FILE).read_text())["written"]
    assert names == {GEOMETRY_FILE, *record}
    for name in record:
        assert read_image(tmp_path / name).size == CAMERA.size
    # What a cancelled call has made, the next one may replace.
    undistort_files(CAMERA, find_images([str(photographs)]), tmp_path)


def test_the_faces_of_a_cube_and_their_geometry(photographs: Path, tmp_path: Path) -> None:
    fisheye = Camera(CAMERA.size, [90.0, 90, 159.5, 119.5, 0, 0, 0, 0], "kannala-brandt")
    images = find_images([str(photographs / "view1.png"), str(photographs / "view2.png")])
    written = undistort_files(fisheye, images, tmp_path, Undistortion(Projection.CUBE))
    geometry = json.loads((tmp_path / GEOMETRY_FILE).read_text())
    assert geometry["projection"] == "cube"
    assert geometry["size"] == [180, 180]
    names = ["front", "left", "right", "top", "bottom"]
    assert list(geometry["rotations"]) == names
    assert [path.name for path in written[1].paths.values()] == [
        f"view2_{name}.png" for name in names
    ]
    assert geometry["images"]["view2_top.png"] == str(images[1])
    # By the stated formula, a pixel of a face is where the equidistant lens sees its ray.
    photograph = read_image(images[1]).pixels
    (fx, _, cx), (_, fy, cy), _ = geometry["matrix"]
    for name, u, v in (("left", 150, 90), ("top", 90, 120), ("front", 60, 80)):
        ray = np.array(geometry["rotations"][name]) @ [(u - cx) / fx, (v - cy) / fy, 1.0]
        theta = np.arctan2(np.hypot(*ray[:2]), ray[2])
        at = [159.5, 119.5] + 90 * theta * ray[:2] / np.hypot(*ray[:2])
        expected = cv2.remap(
            photograph, *(np.full((1, 1), x, np.float32) for x in at), cv2.INTER_LINEAR
        )
        level = float(read_image(tmp_path / f"view2_{name}.png").pixels[v, u])
        assert level == pytest.approx(float(expected[0, 0]), abs=2)


def test_an_impossible_undistortion_is_refused_at_once(photographs: Path, tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="cannot show 200 degrees"):
        undistort_files(
            CAMERA,
            find_images([str(photographs)]),
            tmp_path / "none",
            Undistortion(field_of_view=np.deg2rad(200)),
        )
    assert not (tmp_path / "none").exists()
