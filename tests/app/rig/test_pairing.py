"""Photographs are paired by what their names say, and what is left over is told."""

from __future__ import annotations

from pathlib import Path

import pytest

from calibgui.app.rig.pairing import pair_photographs
from calibgui.dataset import RigPairing
from calibgui.engine.errors import CalibrationError
from calibgui.report.rig import describe_pairing


def make_files(folder: Path, *names: str) -> None:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(b"")


def list_pairs(pairing: RigPairing) -> dict[str, list[str]]:
    """The names of the photographs of each camera, by instants."""
    return {
        camera.name: [file.name for file in camera.files.values()] for camera in pairing.cameras
    }


@pytest.mark.parametrize(
    ("names", "cameras"),
    [
        (("left1.jpg", "left2.jpg", "right1.jpg", "right2.jpg"), "left right"),
        (("cam0_07.png", "cam0_08.png", "cam1_07.png", "cam1_08.png", "cam2_08.png"),
         "cam0 cam1 cam2"),
        (("0001-L.png", "0002-L.png", "0003-L.png", "0001-R.png", "0002-R.png"), "L R"),
        (("a7 left.png", "a8 left.png", "a7 right.png", "a8 right.png"), "left right"),
    ],
)  # fmt: skip
def test_one_folder_that_mixes_cameras(
    tmp_path: Path, names: tuple[str, ...], cameras: str
) -> None:
    make_files(tmp_path, *names)
    pairing = pair_photographs([str(tmp_path)])
    assert " ".join(camera.name for camera in pairing.cameras) == cameras
    assert {file for each in list_pairs(pairing).values() for file in each} == set(names)
    first, second = pairing.cameras[:2]
    shared = set(first.files) & set(second.files)
    assert len(shared) >= 2
    for instant in shared:
        digits = ["".join(filter(str.isdigit, c.files[instant].stem)) for c in (first, second)]
        assert digits[0][-1] == digits[1][-1]


def test_numbers_are_those_of_the_files(tmp_path: Path) -> None:
    make_files(tmp_path, "left3.jpg", "left16.jpg", "right3.jpg", "right16.jpg", "right20.jpg")
    pairing = pair_photographs([str(tmp_path)])
    assert list(pairing.instants) == [3, 16, 20]
    assert pairing.shared == (3, 16)
    assert [file.name for file in pairing.left_over] == ["right20.jpg"]
    said = describe_pairing(pairing)
    assert "left (2 photographs), right (3 photographs)" in said
    assert "2 instants" in said and "left3.jpg, right3.jpg" in said and "right20.jpg" in said


def test_a_folder_for_each_camera_below_one(tmp_path: Path) -> None:
    make_files(tmp_path, *(f"cam{c}/frame_{k:03d}.png" for c in range(3) for k in range(4)))
    together = pair_photographs([str(tmp_path)])
    apart = pair_photographs([str(tmp_path / f"cam{c}") for c in range(3)])
    for pairing in (together, apart):
        assert [camera.name for camera in pairing.cameras] == ["cam0", "cam1", "cam2"]
        assert len(pairing.shared) == 4 and not pairing.left_over


def test_patterns_and_files_of_a_shell(tmp_path: Path) -> None:
    make_files(tmp_path, *(f"{side}{k}.jpg" for side in ("left", "right") for k in range(5)))
    patterns = pair_photographs([str(tmp_path / "left*.jpg"), str(tmp_path / "right*.jpg")])
    expanded = pair_photographs([str(path) for path in sorted(tmp_path.iterdir())])
    for pairing in (patterns, expanded):
        assert [camera.name for camera in pairing.cameras] == ["left", "right"]
        assert len(pairing.shared) == 5


def test_names_pair_where_numbers_do_not(tmp_path: Path) -> None:
    for side in ("a", "b"):
        make_files(tmp_path / side, "near 1.png", "far 1.png", "tilted.png")
    pairing = pair_photographs([str(tmp_path / "a"), str(tmp_path / "b")])
    assert pairing.how == "names"
    assert len(pairing.shared) == 3
    for instant in pairing.shared:
        assert len({camera.files[instant].name for camera in pairing.cameras}) == 1


def test_photographs_of_one_camera_are_refused(tmp_path: Path) -> None:
    make_files(tmp_path, "a.jpg", "b.jpg")
    with pytest.raises(CalibrationError, match="tell no two cameras"):
        pair_photographs([str(tmp_path)])
    make_files(tmp_path / "x", "1.jpg", "2.jpg")
    make_files(tmp_path / "y", "3.jpg", "4.jpg")
    with pytest.raises(CalibrationError, match="No two cameras have photographs of the same"):
        pair_photographs([str(tmp_path / "x"), str(tmp_path / "y")])
