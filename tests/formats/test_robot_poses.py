"""Robots' poses are read from the files of controllers and other programs."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import scipy
from scipy.spatial.transform import Rotation

from calibgui.engine.errors import CalibrationError
from calibgui.formats.robot_poses import read_robot_poses

ROWS = np.arange(18.0).reshape(3, 6) / 8
R = Rotation.from_rotvec([[0.1, 0.2, 0.3], [0.3, -0.2, 0.1], [0.0, 0.1, -0.4]])
T = np.array([[1.0, 2, 3], [4, 5, 6], [7, 8, 9]])
MATRICES = np.tile(np.eye(4), (3, 1, 1))
MATRICES[:, :3, :3], MATRICES[:, :3, 3] = R.as_matrix(), T


def write(folder: Path, name: str, text: str) -> Path:
    file = folder / name
    file.write_text(text)
    return file


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", ", ", "   "])
def test_text_with_any_separator(separator: str, tmp_path: Path) -> None:
    lines = ["# x y z a b c", *(separator.join(map(str, row)) for row in ROWS.tolist()), ""]
    table = read_robot_poses(write(tmp_path, "poses.txt", "\n".join(lines)))
    np.testing.assert_array_equal(table.numbers, ROWS)
    assert table.names == ()


def test_names_and_a_head(tmp_path: Path) -> None:
    head = "time,image,x,y,z,a,b,c\n"
    rows = [f"{k}.5,view {k}.png,{','.join(map(str, row))}" for k, row in enumerate(ROWS.tolist())]
    table = read_robot_poses(write(tmp_path, "poses.csv", head + "\n".join(rows)))
    np.testing.assert_array_equal(table.numbers, ROWS)
    assert table.names == ("view 0.png", "view 1.png", "view 2.png")


def test_a_quaternions_columns_are_known_by_name(tmp_path: Path) -> None:
    rows = np.column_stack([R.as_quat()[:, [3, 0, 1, 2]], T])
    lines = ["qw,qx,qy,qz,x,y,z", *(",".join(map(repr, row)) for row in rows.tolist())]
    table = read_robot_poses(write(tmp_path, "poses.csv", "\n".join(lines)))
    np.testing.assert_array_equal(table.numbers, np.column_stack([T, R.as_quat()]))


@pytest.mark.parametrize("rows", [3, 4])
def test_a_matrix_in_several_lines(rows: int, tmp_path: Path) -> None:
    lines = [" ".join(map(repr, line)) for line in MATRICES[:, :rows].reshape(-1, 4).tolist()]
    table = read_robot_poses(write(tmp_path, "poses.txt", "\n\n".join(lines)))
    np.testing.assert_array_equal(table.numbers, MATRICES[:, :rows].reshape(3, -1))


def test_json_of_all_kinds(tmp_path: Path) -> None:
    matrices = MATRICES.tolist()
    quaternions = [dict(zip("xyzw", q, strict=True)) for q in R.as_quat().tolist()]
    places = [dict(zip("xyz", t, strict=True)) for t in T.tolist()]
    sixteen, seven = MATRICES.reshape(3, 16), np.column_stack([T, R.as_quat()])
    names = ["a.png", "b.png", "c.png"]
    kinds: list[tuple[object, np.ndarray, list[str]]] = [
        (matrices, sixteen, []),
        (ROWS.tolist(), ROWS, []),
        ({"poses": [{"matrix": m} for m in matrices]}, sixteen, []),
        (dict(zip(names, matrices, strict=True)), sixteen, names),
        (
            [
                {"image": name, "translation": t, "rotation": q}
                for name, t, q in zip(names, places, quaternions, strict=True)
            ],
            seven,
            names,
        ),
        (
            {
                name: {"R": m, "t": t}
                for name, m, t in zip(names, R.as_matrix().tolist(), T.tolist(), strict=True)
            },
            sixteen[:, :12],
            names,
        ),
        (
            {
                name: {"rvec": v, "tvec": t}
                for name, v, t in zip(names, R.as_rotvec().tolist(), T.tolist(), strict=True)
            },
            np.column_stack([T, R.as_rotvec()]),
            names,
        ),
    ]
    for content, numbers, named in kinds:
        table = read_robot_poses(write(tmp_path, "poses.json", json.dumps(content)))
        np.testing.assert_array_equal(table.numbers, numbers)
        assert list(table.names) == named


def test_mat_files_of_all_kinds(tmp_path: Path) -> None:
    cell = np.empty((1, 3), object)
    for k in range(3):
        cell[0, k] = MATRICES[k]
    for value in (MATRICES.reshape(3, 16), np.moveaxis(MATRICES, 0, 2), MATRICES, cell):
        for squeeze in (False, True):
            content = {"poses": value, "note": "robot"}
            scipy.io.savemat(tmp_path / "poses.mat", content, do_compression=squeeze)
            table = read_robot_poses(tmp_path / "poses.mat")
            np.testing.assert_array_equal(table.numbers, MATRICES.reshape(3, 16))


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", "", "holds no poses"),
        ("a.csv", "# nothing\n", "holds no poses"),
        ("a.csv", "1,2,3\n4,5,6\n", "poses of 3 numbers"),
        ("a.csv", "1,2,3,4,5,6\n1,2,3\n", "line 2: it has 3 entries, and the first one 6"),
        ("a.csv", "1,2,3,4,5,6\n1,2,x,4,5,6\n", "line 2: 'x' is not a number"),
        ("a.csv", "1,2,3,4,5,6\n1,2,1e999,4,5,6\n", "line 2: '1e999' is too large"),
        ("a.csv", "a,1,2,3,4,5,6\na,1,2,3,4,5,6\n", "two poses for a"),
        ("a.txt", "1 2 3 4\n5 6 7 8\n", "poses of 4 numbers"),
        ("a.json", "[]", "poses of no numbers"),
        ("a.json", "[[1, 2, 3, 4, 5, 6], [1, 2, 3, 4, 5, 6, 7]]", "poses of 6 and 7 numbers"),
        ("a.json", '[{"translation": [1, 2, 3]}]', r"\[0\] is not a pose"),
        ("a.json", '[{"image": "a", "matrix": [1]}, {"matrix": [1]}]', "some poses name their"),
        ("a.json", '[{"matrix": ["a"]}]', r"\[0\].matrix\[0\] is not a finite number"),
        ("a.json", "{", "a.json"),
        ("a.mat", "no MAT file", "it is not a MAT file"),
    ],
)
def test_what_is_no_table_of_poses_is_refused(
    name: str, text: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(CalibrationError, match=message) as refusal:
        read_robot_poses(write(tmp_path, name, text))
    assert name in refusal.value.message and refusal.value.hint


def test_mat_files_that_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "poses.mat"
    with pytest.raises(CalibrationError, match=r"poses\.mat"):
        read_robot_poses(file)
    scipy.io.savemat(file, {"poses": "none", "more": {"poses": ROWS}, "turn": 1j * ROWS})
    with pytest.raises(CalibrationError, match="poses of no numbers"):
        read_robot_poses(file)
    scipy.io.savemat(file, {"poses": np.full((2, 6), np.nan)})
    with pytest.raises(CalibrationError, match="poses of no numbers"):
        read_robot_poses(file)
    # A small file that would unfold to 180 MB.
    scipy.io.savemat(file, {"poses": np.zeros((4_000_000, 6))}, do_compression=True)
    with pytest.raises(CalibrationError, match="it holds too many numbers"):
        read_robot_poses(file)
    scipy.io.savemat(file, {"poses": ROWS})
    content = file.read_bytes()
    file.write_bytes(content[:124] + b"\x00\x02" + content[126:])  # the version of HDF5
    with pytest.raises(CalibrationError, match=r"it is of version 7\.3"):
        read_robot_poses(file)
    for count in range(128, len(content), 4):
        file.write_bytes(content[:count])
        with pytest.raises(CalibrationError):
            read_robot_poses(file)
