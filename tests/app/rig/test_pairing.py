"""Photographs are paired by what their names say, and what is left over is told."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

from calibgui.app.rig.camera_names import find_named_cameras
from calibgui.app.rig.pairing import pair_photographs
from calibgui.app.rig.time_pairing import pair_by_times
from calibgui.dataset import RigPairing
from calibgui.engine.errors import CalibrationError
from calibgui.formats.times_csv import read_times
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
    assert "Photographs of 2 cameras: left (2), right (3)." in said
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


def make_stamped(
    folder: Path, lags_ms: dict[str, int], count: int = 4, every_ms: int = 400
) -> None:
    """Files called by nanoseconds, as recorders of ROS call them."""
    for camera, lag in lags_ms.items():
        stamps = [1403636579763555584 + (k * every_ms + lag) * 10**6 for k in range(count)]
        make_files(folder / camera, *(f"{stamp}.png" for stamp in stamps))


def test_names_with_nanoseconds_pair_by_time(tmp_path: Path) -> None:
    make_stamped(tmp_path, {"cam0": 0, "cam1": 7, "cam2": -4})
    pairing = pair_photographs([str(tmp_path)])
    assert len(pairing.shared) == 4 and not pairing.left_over
    assert list(pairing.instants.values())[1] == "0.400 s"
    assert "by their times, which are at most 11 ms apart: 4 instants" in describe_pairing(pairing)
    first = pairing.cameras[1]
    assert [round(first.times[file], 3) for file in first.files.values()][:2] == [0.011, 0.411]


def stamp(instant: int, camera: int) -> int:
    """Nanoseconds since 1970, as of ROS, 3 ms later in each further camera."""
    return 1403636579763555584 + (400 * instant + 3 * camera) * 10**6 + 12345 * (instant % 7)


@pytest.mark.parametrize(
    ("write", "cameras"),
    [
        (lambda k, c: f"cam{c}_{stamp(k, c)}.png", "cam0 cam1"),
        (lambda k, c: f"{stamp(k, c)}_{('left', 'right')[c]}.png", "left right"),
        (lambda k, c: f"image_{c}_{1623 + 0.4 * k + 0.003 * c:.6f}.png", "image0 image1"),
        (lambda k, c: f"image_{c}_{1623 + 0.5 * k:.6f}.png", "image0 image1"),
        (lambda k, c: f"_rig_{'ab'[c]}_image_raw_{stamp(k, c) / 1e9:.6f}.png", "a b"),
        (lambda k, c: f"infra{c + 1}_image_rect_{stamp(k, c) // 1000}.png", "infra1 infra2"),
        (lambda k, c: f"cam_{c}_{stamp(k, c) // 10**9}_{stamp(k, c) % 10**9:09d}.png", "cam0 cam1"),
        (lambda k, c: f"cam{c}_{'xy'[c]}_{k:04d}_{stamp(k, c)}.png", "cam0 cam1"),
        (lambda k, c: f"2130456{c}-{stamp(k, c)}.png", "21304560 21304561"),
        (lambda k, c: f"2023-06-12-10-15-{2 * k:02d}-{300 + 7 * c}_cam{c}.png", "cam0 cam1"),
        (lambda k, c: f"{('left', 'right')[c]}-{k:04d}.png", "left right"),
        (lambda k, c: f"frame{k:06d}_cam{c}.jpg", "cam0 cam1"),
    ],
)
def test_names_of_recorders_single_the_cameras_out(
    tmp_path: Path, write: Callable[[int, int], str], cameras: str
) -> None:
    names = {camera: [write(k, c) for k in range(1, 9)] for c, camera in enumerate(cameras.split())}
    make_files(tmp_path, *(name for own in names.values() for name in own))
    pairing = pair_photographs([str(tmp_path)])
    assert list_pairs(pairing) == names
    assert len(pairing.shared) == 8 and not pairing.left_over
    assert list(find_named_cameras([str(tmp_path)])) == cameras.split()


@pytest.mark.parametrize(
    "names",
    [
        [f"{stamp(k, 0)}.png" for k in range(8)],
        [f"cam0_{stamp(k, 0)}.png" for k in range(8)],
        [f"IMG_20230612_1015{2 * k:02d}.jpg" for k in range(8)],
        [f"frame{k:06d}.png" for k in range(8)],
        [f"{where} {k}.jpg" for where in ("near", "far") for k in range(8)],
        [f"run{run}_{stamp(k + 20 * run, 0)}.png" for run in range(2) for k in range(8)],
        [f"DSC_{k:04d}{copy}.jpg" for k in range(4) for copy in ("", " copy")],
    ],
)
def test_names_of_one_camera_are_not_taken_for_those_of_several(
    tmp_path: Path, names: list[str]
) -> None:
    make_files(tmp_path, *names)
    assert not find_named_cameras([str(tmp_path)])


def test_a_tolerance_parts_what_is_too_far(tmp_path: Path) -> None:
    make_stamped(tmp_path, {"cam0": 0, "cam1": 30})
    make_files(tmp_path / "cam1", "1403636579764555584.png")
    pairing = pair_photographs([str(tmp_path)], tolerance=0.005)
    assert len(pairing.shared) == 1 and len(pairing.left_over) == 7
    with pytest.raises(
        CalibrationError, match=r"at most 0\.0005 s apart; the nearest are 0\.001 s"
    ):
        pair_photographs([str(tmp_path)], tolerance=0.0005)


def test_what_is_nearer_to_another_has_no_partner(tmp_path: Path) -> None:
    names = {"a": ["1700000000.000", "1700000000.030"], "b": ["1700000000.020", "1700000000.041"]}
    for camera, stamps in names.items():
        make_files(tmp_path / camera, *(f"{stamp}.png" for stamp in stamps))
    pairing = pair_photographs([str(tmp_path)], tolerance=0.05)
    (shared,) = pairing.shared
    assert [c.files[shared].stem for c in pairing.cameras] == ["1700000000.030", "1700000000.020"]


def test_exif_pairs_where_names_do_not(tmp_path: Path) -> None:
    for camera, lag in (("x", 0), ("y", 150)):
        (tmp_path / camera).mkdir()
        for k in range(3):
            exif = Image.Exif()
            exif.get_ifd(0x8769).update(
                {36867: f"2026:03:01 10:00:{10 * k:02d}", 37521: f"{lag:03d}"}
            )
            name = f"{camera}{k + (7 if lag else 0)}.jpg"
            Image.new("L", (64, 48)).save(tmp_path / camera / name, exif=exif)
    pairing = pair_photographs([str(tmp_path)])
    assert len(pairing.shared) == 3 and "at most 150 ms apart" in pairing.how


def test_photographs_without_times_cannot_be_paired_by_them(tmp_path: Path) -> None:
    make_files(tmp_path, "x/1.jpg", "x/2.jpg", "y/1.jpg", "y/2.jpg")
    with pytest.raises(CalibrationError, match="not known when the photographs of x and y were"):
        pair_photographs([str(tmp_path)], tolerance=0.1)


def test_a_table_tells_the_times(tmp_path: Path) -> None:
    files = {c: [Path(c) / f"{k}.png" for k in range(3)] for c in ("x", "y")}
    table = tmp_path / "times.csv"
    table.write_text("file,time_s\nx/0.png,0\nx/1.png,1\ny/0.png,1.01\ny/2.png,5\n,7\n")
    times = read_times(table, files)
    pairing = pair_by_times(files, times, 0.1)
    (shared,) = pairing.shared
    assert [c.files[shared].as_posix() for c in pairing.cameras] == ["x/1.png", "y/0.png"]
    table.write_text("file,time_s\n0.png,0\n")
    with pytest.raises(CalibrationError, match=r"line 2: several photographs are called 0\.png"):
        read_times(table, files)


def test_photographs_of_one_camera_are_refused(tmp_path: Path) -> None:
    make_files(tmp_path, "a.jpg", "b.jpg")
    with pytest.raises(CalibrationError, match="tell no two cameras"):
        pair_photographs([str(tmp_path)])
    make_files(tmp_path / "x", "1.jpg", "2.jpg")
    make_files(tmp_path / "y", "3.jpg", "4.jpg")
    with pytest.raises(CalibrationError, match="No two cameras have photographs of the same"):
        pair_photographs([str(tmp_path / "x"), str(tmp_path / "y")])
