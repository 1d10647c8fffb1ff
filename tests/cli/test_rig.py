"""calibgui rig, triangulate and stereo, from photographs of two cameras to points in space."""

from __future__ import annotations

import csv
import json
import re
import shutil
from functools import partial
from pathlib import Path

import cv2
import numpy as np
import pytest

import calibgui
from calibgui.cli.main import main
from calibgui.engine import find_corners
from calibgui.engine.boards import Board
from calibgui.engine.camera import Camera, pixels_from_rays
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose, rotation_from_vector, vector_from_rotation
from calibgui.engine.images import read_colour, render_view, write_image
from calibgui.formats.rig_json import read_rig

Capture = pytest.CaptureFixture[str]
BOARD = Board(rows=5, cols=8, square=30.0)
LEFT = Camera((480, 360), [420, 420, 240, 180, -0.1, 0.02, 0, 0, 0], "brown-conrady")
RIGHT = Camera((480, 360), [430, 430, 236, 184, -0.12, 0.03, 0, 0, 0], "brown-conrady")
POSE = Pose([0.01, -0.08, 0.02], [-70.0, 2.0, 4.0])
INSTANTS = 9


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Photographs left1.png and so on of two cameras."""
    folder = tmp_path_factory.mktemp("rig")
    rng = np.random.default_rng(2)
    R, middle = rotation_from_vector(POSE.rvec), BOARD.points().mean(axis=0)
    for k in range(INSTANTS):
        tilt = 0.45 * np.array([np.cos(2.4 * k), np.sin(2.4 * k), 0.1])
        turn = rotation_from_vector(tilt)
        at = np.array([35.0 + 20 * np.cos(k), 15 * np.sin(2 * k), 520.0 + 15 * k])
        board = Pose(tilt, at - turn[:, :2] @ middle)
        there = Pose(vector_from_rotation(R @ turn), R @ board.tvec + POSE.tvec)
        for name, camera, pose in (("left", LEFT, board), ("right", RIGHT, there)):
            image = render_view(camera, pose, BOARD, blur=0.7)
            noisy = np.clip(image + rng.normal(0, 2, image.shape), 0, 255).astype(np.uint8)
            write_image(folder / f"{name}{k + 1}.png", noisy)
    return folder


@pytest.fixture(scope="session")
def rig_file(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("out") / "rig.json"
    assert calibrate(folder, "-o", str(file), "-q") == 0
    return file


def calibrate(folder: Path, *options: str) -> int:
    return main(
        [
            "rig",
            str(folder),
            "--square",
            "30",
            "--board",
            "5x8",
            "--model",
            "brown-conrady",
            *options,
        ]
    )


def test_a_shifted_pairing_is_refused(folder: Path, tmp_path: Path, capsys: Capture) -> None:
    for k in range(1, INSTANTS + 1):
        shutil.copy(folder / f"left{k}.png", tmp_path / f"left{k}.png")
        shutil.copy(folder / f"right{k}.png", tmp_path / f"right{k + 1}.png")
    file = tmp_path / "rig.json"
    assert calibrate(tmp_path, "-o", str(file)) == 1
    said = " ".join(capsys.readouterr().err.split())
    assert "The photographs of right belong to those of left of 1 instant earlier" in said
    assert "Nothing was written" in said
    assert not file.exists()


def test_a_rig_of_photographs(rig_file: Path) -> None:
    rig = read_rig(rig_file).rig
    assert rig.names == ("left", "right")
    sigma = rig.pose_sigma(1)
    assert (np.abs(rig.poses[1].tvec - POSE.tvec) < 4 * sigma[3:]).all()
    assert (np.abs(rig.poses[1].rvec - POSE.rvec) < 4 * sigma[:3]).all()
    assert rig.rms < 1.1 * rig.rms_alone < 0.2
    assert not rig.left_out


def test_what_is_printed_and_written(folder: Path, tmp_path: Path, capsys: Capture) -> None:
    """One photograph is exchanged, and its instant is named."""
    for path in folder.iterdir():
        number = {"right3": "right7", "right7": "right3"}.get(path.stem, path.stem)
        (tmp_path / f"{number}.png").write_bytes(path.read_bytes())
    (tmp_path / "left10.png").write_bytes((folder / "left1.png").read_bytes())
    out = tmp_path / "out"
    out.mkdir()
    files = [f"opencv={out}/stereo.yaml", f"ros={out}/rig.yaml", f"kalibr={out}/chain.yaml"]
    exports = [word for file in files for word in ("--export", file)]
    assert calibrate(tmp_path, "-o", f"{out}/rig.json", *exports) == 0
    printed = capsys.readouterr().out
    before, _, after = printed.partition("cameras at")
    before = " ".join(before.split())
    assert "Without a partner: left10.png" in before
    assert "9 instants" in before
    assert re.search(r"Left out.*(left|right)3\.png.*(left|right)7\.png", after, re.DOTALL)
    assert "by the calibration" in after and "±" in after
    names = {path.name for path in out.iterdir()}
    assert names == {"rig.json", "stereo.yaml", "rig-left.yaml", "rig-right.yaml", "chain.yaml"}
    left = {view.instant for view in read_rig(out / "rig.json").rig.left_out}
    assert left == {3, 7}


def test_points_in_space(rig_file: Path, tmp_path: Path, capsys: Capture) -> None:
    rig = read_rig(rig_file).rig
    X = np.array([[20.0, 10.0, 500.0], [60.0, -30.0, 700.0]])
    lines = ["point,camera,u,v"]
    for c, name in enumerate(rig.names):
        there = X @ rotation_from_vector(rig.poses[c].rvec).T + rig.poses[c].tvec
        pixels = pixels_from_rays(there, rig.cameras[c]).tolist()
        lines += [f"P{k},{name},{u},{v}" for k, (u, v) in enumerate(pixels)]
    table, out = tmp_path / "points.csv", tmp_path / "out.csv"
    table.write_text("\n".join([*lines, "P2,left,10,10"]))
    assert main(["triangulate", str(rig_file), str(table), "-o", str(out)]) == 0
    assert "1 of 3 points are seen by fewer than two cameras" in capsys.readouterr().out
    rows = list(csv.DictReader(out.read_text().splitlines()))
    for row, point in zip(rows, X, strict=False):
        np.testing.assert_allclose([float(row[f"{a}_mm"]) for a in "xyz"], point, atol=1e-6)
        assert float(row["sigma_z_mm"]) > 0
    assert rows[2]["x_mm"] == "" and rows[2]["cameras"] == "1" and rows[2]["reason"]
    assert main(["triangulate", str(rig_file), str(table), "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["xyz_mm"]) == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("u,v\n1,2\n", "no columns point, camera, u and v"),
        ("point,camera,u,v\nA,middle,1,2\n", "no camera 'middle'"),
        ("point,camera,u,v\nA,left,1,2\nA,left,3,4\n", "line 3: left sees A twice"),
        ("point,camera,u,v\nA,left,1,x\n", "line 2: 'x' in the column v"),
        ("point,camera,u,v\nA,left,1,2\n", "at least two cameras"),
    ],
)
def test_wrong_points_are_named(
    rig_file: Path, tmp_path: Path, capsys: Capture, text: str, message: str
) -> None:
    table = tmp_path / "points.csv"
    table.write_text(text)
    assert main(["triangulate", str(rig_file), str(table)]) == 1
    assert message in " ".join(capsys.readouterr().err.split())


def test_rectified_photographs(rig_file: Path, tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "stereo"
    assert main(["stereo", str(rig_file), "-o", str(out), "--depth", "400", "2000"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "The rows of the same corners differ by 0.0" in printed and "disparities" in printed
    for k in (1, INSTANTS):
        seen = [
            find_corners(read_colour(out / side / f"{k}.png"), BOARD.grid_size).uv
            for side in ("left", "right")
        ]
        assert np.abs(seen[0][:, 1] - seen[1][:, 1]).max() < 0.1
    joined = read_colour(out / "pairs" / "1.png")
    assert joined.shape == (360, 960, 3)
    matrices = cv2.FileStorage(str(out / "stereo.yaml"), cv2.FILE_STORAGE_READ)
    assert matrices.getNode("Q").mat()[3, 2]
    assert main(["stereo", str(rig_file), "-o", str(out)]) == 1
    assert "exists" in capsys.readouterr().err
    assert main(["stereo", str(rig_file), "-o", str(out), "--overwrite", "--angles", "-q"]) == 0


def test_a_known_camera_is_held(folder: Path, rig_file: Path, tmp_path: Path) -> None:
    assert main(["rig", str(folder), "--square", "30", "--board", "5x8", "-q", "--export",
                 f"ros={tmp_path}/known.yaml", "--model", "brown-conrady"]) == 0  # fmt: skip
    known, out = tmp_path / "known-left.yaml", tmp_path / "rig.json"
    assert calibrate(folder, "--known", f"left={known}", "-o", str(out), "-q") == 0
    rig, before = read_rig(out).rig, read_rig(rig_file).rig
    assert not rig.camera_sigma(0).any()
    np.testing.assert_allclose(rig.cameras[0].params[:9], before.cameras[0].params[:9])
    assert calibrate(folder, "--known", f"middle={known}", "-q") == 1


def test_the_python_face(folder: Path, rig_file: Path, tmp_path: Path) -> None:
    rig = calibgui.calibrate_rig(folder, square=30, board=(5, 8), model="brown-conrady")
    stored = calibgui.load_rig(rig_file)
    np.testing.assert_allclose(rig.rig.poses[1].tvec, stored.rig.poses[1].tvec)
    assert "Translation and rotation vector from left" in str(rig)
    rig.save(tmp_path / "rig.json")
    assert "stereo.yaml" in rig.export("opencv", tmp_path / "stereo.yaml", ("right", "left"))
    found = rig.triangulate({"left": [[240.0, 180.0]], "right": [[185.0, 184.0]]})
    assert found.points.shape == (1, 3) and (found.sigma > 0).all()
    assert rig.rectify(zoom=0.5).baseline == pytest.approx(np.linalg.norm(POSE.tvec), rel=1e-3)


def test_a_rig_of_videos(tmp_path: Path, folder: Path) -> None:
    for side in ("left", "right"):
        video = cv2.VideoWriter(
            str(tmp_path / f"{side}.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 10, LEFT.size
        )
        video.set(cv2.VIDEOWRITER_PROP_QUALITY, 100)
        for k in range(INSTANTS):
            video.write(cv2.imread(str(folder / f"{side}{k + 1}.png")))
        video.release()
    out = tmp_path / "rig.json"
    videos = [str(tmp_path / f"{side}.avi") for side in ("left", "right")]
    code = main(["rig", *videos, "--square", "30", "--board", "5x8", "--hold", "--model", "pinhole",
                 "-o", str(out), "-q"])  # fmt: skip
    assert code == 0
    rig = read_rig(out).rig
    assert len(rig.instants) == INSTANTS
    assert np.linalg.norm(rig.poses[1].tvec - POSE.tvec) < 20
    assert len(list((tmp_path / "left-frames").iterdir())) == INSTANTS


def test_offsets_are_asked_of_photographs_in_succession(
    folder: Path, tmp_path: Path, capsys: Capture
) -> None:
    """These boards were held still: offsets are estimated, and are nothing."""
    times = tmp_path / "times.csv"
    rows = [f"{side},{k},{k}" for side in ("left", "right") for k in range(1, INSTANTS + 1)]
    times.write_text("\n".join(["camera,number,time_s", *rows]))
    out = tmp_path / "rig.json"
    assert calibrate(folder, "--offsets", "--times", str(times), "-o", str(out)) == 0
    assert re.search(r"right is .* ms (later|earlier) than left", capsys.readouterr().out)
    rig = read_rig(out).rig
    assert abs(rig.offsets[1]) < 5 * rig.offset_sigma(1)
    assert len(rig.instants) == INSTANTS - 2
    times.write_text("camera,number,time_s\nleft,1,0\n")
    assert calibrate(folder, "--offsets", "--times", str(times), "-q") == 1
    assert "has no times of right" in capsys.readouterr().err
    assert calibrate(folder, "--offsets", "-q") == 1
    assert "--times FILE" in capsys.readouterr().err


def test_a_folder_that_mixes_stamped_photographs(
    folder: Path, tmp_path: Path, capsys: Capture
) -> None:
    """Its names tell cameras, instants and times; whoever calibrates one camera is told so."""
    for c, side in enumerate(("left", "right")):
        for k in range(1, INSTANTS + 1):
            name = f"cam{c}_{1403636579763555584 + (400 * k + 7 * c) * 10**6}.png"
            shutil.copy(folder / f"{side}{k}.png", tmp_path / name)
    command = ["calibrate", str(tmp_path), "--square", "30", "--board", "5x8"]
    assert main([*command, "--as-asked"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "photographs are of several cameras: cam0 (9), cam1 (9)" in said
    assert f"`calibgui rig {tmp_path} --square MM`" in said
    out = tmp_path / "rig.json"
    assert calibrate(tmp_path, "--offsets", "-o", str(out)) == 0
    assert "at most 7 ms apart: 9 instants" in " ".join(capsys.readouterr().out.split())
    rig = read_rig(out).rig
    assert rig.names == ("cam0", "cam1")  # and the boards stood where they were for cam0
    assert abs(rig.offsets[1] + 7e-3) < 5 * rig.offset_sigma(1)
    assert main(["detect", *map(str, sorted(folder.glob("left*.png"))), "--board", "5x8"]) == 0
    assert "several cameras" not in capsys.readouterr().out


def test_another_board_before_a_camera_is_named(
    folder: Path, tmp_path: Path, capsys: Capture
) -> None:
    other = Board(rows=4, cols=6, square=30.0)
    for k in range(1, 4):
        shutil.copy(folder / f"left{k}.png", tmp_path / f"left{k}.png")
        pose = Pose([0.1 * k, -0.2, 0.02 * k], [-80.0, -50.0, 400.0])
        write_image(tmp_path / f"right{k}.png", render_view(RIGHT, pose, other, blur=0.7))
    assert main(["rig", str(tmp_path), "--square", "30"]) == 1
    said = " ".join(capsys.readouterr().err.split())
    assert "right shows no board of 5x8 in any photograph, and left does" in said


def test_offsets_in_python(folder: Path, tmp_path: Path) -> None:
    for side in ("left", "right"):
        (tmp_path / side).mkdir()
        for k in range(1, INSTANTS + 1):
            shutil.copy(folder / f"{side}{k}.png", tmp_path / side / f"17000000{k:02}.png")
    make = partial(
        calibgui.calibrate_rig, square=30, board=(5, 8), model="pinhole", hold=True, offsets=True
    )
    rig = make(tmp_path, within=0.1)
    assert list(rig.offsets) == ["left", "right"]
    assert rig.offsets["left"] == (0.0, 0.0)
    late, sigma = rig.offsets["right"]
    assert late == rig.rig.offsets[1]
    assert 0 < sigma == rig.rig.offset_sigma(1)
    with pytest.raises(CalibrationError, match="not known when the photographs were"):
        make(folder)
