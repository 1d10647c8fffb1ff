"""Corners as Zhang published them, and as OpenCV's calibration sample writes them."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.engine.errors import CalibrationError
from calibgui.formats.corner_import import read_corner_file

_UV = np.random.default_rng(2).uniform(0, 400, (11, 12, 2))
_XY = np.stack(np.meshgrid([0, 30.0, 60, 90], [0, 30.0, 60]), axis=-1).reshape(-1, 2)


def write_list(path: Path, points: np.ndarray) -> None:
    rows = points.reshape(-1, 8)
    path.write_text("\n".join(" ".join(map(repr, row.tolist())) for row in rows) + "\n")


def test_zhangs_lists_are_found_beside_the_boards(tmp_path: Path) -> None:
    write_list(tmp_path / "Model.txt", _XY)
    for k, uv in enumerate(_UV, 1):
        write_list(tmp_path / f"data{k}.txt", uv)
    (tmp_path / "readme.txt").write_text("Five photographs.\n")
    write_list(tmp_path / "other.txt", _XY[:8])
    with pytest.raises(CalibrationError, match="does not say how large"):
        read_corner_file(tmp_path / "Model.txt")
    read = read_corner_file(tmp_path / "Model.txt", size=(640, 480))
    assert [view.image for view in read.views] == [f"data{k}.txt" for k in range(1, 12)]
    for view, uv in zip(read.views, _UV, strict=True):
        observed = view.observation(None)
        assert np.array_equal(observed.uv, uv) and np.array_equal(observed.xy, _XY)


def test_a_board_without_photographs_is_named(tmp_path: Path) -> None:
    write_list(tmp_path / "Model.txt", _XY)
    with pytest.raises(CalibrationError, match="lists 12 points of a board, and no text beside it"):
        read_corner_file(tmp_path / "Model.txt", size=(640, 480))
    (tmp_path / "Model.txt").write_text("1 2 3 4 5 6 7 8 9\n")
    with pytest.raises(CalibrationError, match=r"Model\.txt is no list of points"):
        read_corner_file(tmp_path / "Model.txt", size=(640, 480))


@pytest.mark.data
def test_zhangs_own_lists_are_read(data_dir: Path) -> None:
    read = read_corner_file(data_dir / "zhang1998" / "Model.txt", size=(640, 480))
    assert [len(view.observation(None).uv) for view in read.views] == [256] * 5
    first = read.views[0].observation(None)
    assert first.uv[0].tolist() == [63.43921044061905, 405.57679766845445]
    assert first.xy[4].tolist() == [0.888889, -0.5]


@pytest.mark.data
def test_bouguets_own_results_are_read(data_dir: Path) -> None:
    """The published calibration of 20 images: fc 657.46, 657.95."""
    folder = data_dir / "bouguet_calib_example" / "corners_and_results"
    read = read_corner_file(folder / "Calib_Results_20img__benJephunneh.mat")
    assert read.size == (640, 480)
    assert [len(view.observation(None).uv) for view in read.views] == [156] * 20


def write_sample(path: Path, **changed: object) -> Path:
    """The file of OpenCV's calibration sample with its option -op."""
    values = {
        "image_width": 640,
        "image_height": 480,
        "board_width": 4,
        "board_height": 3,
        "square_size": 0.025,
        "camera_matrix": np.eye(3),
        "distortion_coefficients": np.zeros((5, 1)),
        "image_points": _UV.astype(np.float32),
    } | changed
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for name, value in values.items():
        storage.write(name, value)
    storage.release()
    return path


@pytest.mark.parametrize("suffix", [".yml", ".xml"])
def test_the_points_of_opencvs_sample_are_read(tmp_path: Path, suffix: str) -> None:
    read = read_corner_file(write_sample(tmp_path / f"out{suffix}"), square=25.0)
    assert read.board.grid_size == (3, 4) and read.board.square == 25.0
    for view, uv in zip(read.views, _UV, strict=True):
        observed = view.observation(read.board)
        assert np.abs(observed.uv - uv).max() < 1e-4
        assert np.array_equal(
            observed.xy[:5], 25.0 * np.array([[0, 0], [1, 0], [2, 0], [3, 0], [0, 1]])
        )


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"board_width": 5}, "image_points.data is not a list of 330 entries"),
        ({"board_width": 0}, "is not the rows and columns of a board"),
        ({"image_width": 0.5}, "the images' width and height is not"),
    ],
)
def test_errors_of_the_sample_name_file_and_place(
    tmp_path: Path, changed: dict[str, object], message: str
) -> None:
    with pytest.raises(CalibrationError, match=message):
        read_corner_file(write_sample(tmp_path / "out.yml", **changed))
