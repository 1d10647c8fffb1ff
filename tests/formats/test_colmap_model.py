"""COLMAP's models with poses and points, read by pycolmap where it is installed."""

from __future__ import annotations

import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.boards.shape import BoardShape, BoardShapeModel
from calibgui.engine.errors import CalibrationError
from calibgui.formats import export, read_camera
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.colmap_model import EXPORTER
from tests.formats.cameras import seen_points
from tests.formats.readers import in_other_python

_COLMAP = """
import json, sys
import numpy as np
import pycolmap

model = pycolmap.Reconstruction(sys.argv[1])
images = []
for number, image in sorted(model.images.items()):
    camera, motion = model.cameras[image.camera_id], image.cam_from_world()
    points = [model.points3D[point.point3D_id] for point in image.points2D]
    images.append({
        "name": image.name,
        "corners": [point.xy.tolist() for point in image.points2D],
        "seen": [camera.img_from_cam(motion * point.xyz).tolist() for point in points],
        "tracked": all(
            [number, k] in [[seen.image_id, seen.point2D_idx] for seen in point.track.elements]
            for k, point in enumerate(points)
        ),
    })
print(json.dumps({
    "images": images,
    "error": float(np.mean([p.error for p in model.points3D.values() for _ in p.track.elements])),
}))
"""


@pytest.mark.parametrize("name", ["images.txt", "images.bin"])
def test_colmap_sees_the_board_where_we_do(tmp_path: Path, result: Result, name: str) -> None:
    report = export(result, "colmap-model", tmp_path / name)
    assert "are beside it" in report.note
    read = in_other_python(_COLMAP, tmp_path, needs="import pycolmap")
    calibration = express_in_format(result, EXPORTER).calibration
    names = [view.image for view in result.used]
    if name == "images.txt":  # COLMAP ends names at a blank there
        assert "names with blanks from images.bin only" in report.note
        names = [each.split()[0] for each in names]
    assert [image["name"] for image in read["images"]] == names
    for image, view, (_, uv) in zip(
        read["images"], result.observations(), seen_points(result, calibration), strict=True
    ):
        assert np.abs(np.array(image["corners"]) - 0.5 - view.uv).max() < 1e-9
        assert np.abs(np.array(image["seen"]) - 0.5 - uv).max() < 1e-6
        assert image["tracked"]
    residuals = np.concatenate([view.image for view in calibration.residuals])
    assert read["error"] == pytest.approx(np.linalg.norm(residuals, axis=1).mean())


def test_points_lie_where_the_board_was_found_to_be(tmp_path: Path, weighted: Result) -> None:
    nominal = np.unique(np.concatenate([view.xy for view in weighted.observations()]), axis=0)
    deviation = np.random.default_rng(3).normal(scale=0.2, size=(len(nominal), 3))
    shape = BoardShape(BoardShapeModel.FREE, nominal, deviation, np.full_like(deviation, 0.01))
    calibration = replace(weighted.calibration, board_shape=shape)
    known = replace(calibration, camera=express_in_format(weighted, EXPORTER).calibration.camera)
    export(replace(weighted, calibration=known), "colmap-model", tmp_path / "images.txt")
    lines = (tmp_path / "points3D.txt").read_text().splitlines()
    found = np.array([line.split()[1:4] for line in lines if line[0] != "#"], dtype=float)
    expected = (np.pad(nominal, ((0, 0), (0, 1))) + deviation) * 1e-3
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_files_of_others_beside_it_are_kept(tmp_path: Path, result: Result) -> None:
    (tmp_path / "cameras.txt").write_text("1 PINHOLE 640 480 300 300 320 240\n")
    with pytest.raises(CalibrationError, match=r"cameras\.txt exists, and calibgui did not"):
        export(result, "colmap-model", tmp_path / "images.txt")
    assert [path.name for path in tmp_path.iterdir()] == ["cameras.txt"]
    (tmp_path / "cameras.txt").unlink()
    for _ in range(2):  # the second time over its own
        export(result, "colmap-model", tmp_path / "images.txt")


def test_a_binary_camera_is_read_as_the_text_is(tmp_path: Path, result: Result) -> None:
    for suffix in (".txt", ".bin"):
        export(result, "colmap", tmp_path / f"cameras{suffix}")
    text, binary = (read_camera(tmp_path / f"cameras{suffix}") for suffix in (".txt", ".bin"))
    assert np.array_equal(text.camera.params, binary.camera.params)
    content = (tmp_path / "cameras.bin").read_bytes()
    (tmp_path / "cut.bin").write_bytes(content[:60])
    with pytest.raises(CalibrationError, match=r"cut\.bin is not .* it ends within a camera"):
        read_camera(tmp_path / "cut.bin")
    pinhole = struct.pack("<IiQQ4d", 1, 1, 640, 480, 300, 300, 320, 240)
    unknown = struct.pack("<IiQQ", 2, 99, 640, 480)
    (tmp_path / "new.bin").write_bytes(struct.pack("<Q", 2) + pinhole + unknown)
    with pytest.raises(CalibrationError, match="camera 2 has the unknown lens model 99"):
        read_camera(tmp_path / "new.bin")
