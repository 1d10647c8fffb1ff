"""The table of exporters, and the text of each format, kept in tests/golden.

A difference from a kept file is a change that other programs see: it needs a reason and a
line in the changelog.
"""

from __future__ import annotations

import importlib
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.dataset import Result
from calibgui.engine.assessment.verdict import Grade
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.result import Calibration, ViewResiduals
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS, export, find_exporter
from calibgui.formats.adobe_lcp import format_profile as format_lcp
from calibgui.formats.anipose_toml import format_calibration as format_anipose
from calibgui.formats.basalt_json import format_calibration
from calibgui.formats.bouguet_results import format_results, list_values
from calibgui.formats.caliscope_toml import format_array
from calibgui.formats.colmap_cameras import format_cameras
from calibgui.formats.gyroflow_json import format_profile
from calibgui.formats.kalibr_camchain import format_camchain
from calibgui.formats.lensfun_xml import format_database
from calibgui.formats.matlab_script import format_script
from calibgui.formats.metashape_xml import format_calibration as format_metashape
from calibgui.formats.mrcal_model import format_camera_model
from calibgui.formats.nerfstudio_json import format_transforms
from calibgui.formats.opencv_file import format_storage
from calibgui.formats.openvins_yaml import format_chain
from calibgui.formats.orb_slam_yaml import format_settings
from calibgui.formats.origin import is_own
from calibgui.formats.result_json import read_result
from calibgui.formats.ros_yaml import format_camera_info
from tests.formats.records import same

_GOLDEN = Path(__file__).parents[1] / "golden"


@pytest.mark.parametrize("name", EXPORTERS)
def test_every_exporter_writes_what_it_lists(tmp_path: Path, name: str, result: Result) -> None:
    """What it writes is known again as a file of its kind."""
    exporter = EXPORTERS[name]
    assert exporter.name == name
    for suffix in exporter.suffixes:
        file = tmp_path / f"{exporter.stem or 'file'}{suffix.upper()}"
        report = export(result, name, file)
        assert report.path.read_bytes().strip()
        assert report.note
        assert [kind for kind in EXPORTERS if is_own(report.path, kind)] == [name]
        if report.largest_error_px is not None:
            assert 0 < report.largest_error_px < 1


@pytest.mark.parametrize("name", EXPORTERS)
def test_every_format_names_reader_convention_and_limits(name: str) -> None:
    module = importlib.import_module(EXPORTERS[name].write.__module__)
    assert all(word in (module.__doc__ or "") for word in ("Reader:", "ixels", "Cannot hold:"))


def test_what_cannot_be_exported_is_refused_beforehand() -> None:
    with pytest.raises(CalibrationError, match=r"no export format 'word'.*Choose from result"):
        find_exporter("word", "a.doc")
    with pytest.raises(CalibrationError, match=r"a\.txt is not named as .*\.yaml or \.yml"):
        find_exporter("ros", "a.txt")
    with pytest.raises(CalibrationError, match=r"Name it images\.txt or images\.bin"):
        find_exporter("colmap-model", "cameras.txt")


@pytest.mark.parametrize("name", EXPORTERS)
def test_a_file_that_cannot_be_written_is_named_and_nothing_is_left(
    tmp_path: Path, name: str, result: Result
) -> None:
    file = tmp_path / EXPORTERS[name].file_name
    file.mkdir()
    with pytest.raises(CalibrationError, match="cannot be written") as caught:
        export(result, name, file)
    assert str(file) in caught.value.message
    assert list(tmp_path.iterdir()) == [file]


@pytest.fixture(scope="module")
def golden() -> Result:
    """The first result file ever released: it stays readable."""
    return read_result(_GOLDEN / "result-1.json")


def _forward(calibration: Calibration) -> Calibration:
    """A camera in OpenCV's model with awkward numbers."""
    params = [650.25, 649.5, 303.0, 243.125, -0.25, 0.12, 1e-05, -5e-4, 1e-17]
    return replace(
        calibration,
        camera=Camera((640, 480), params, "brown-conrady"),
        sigma=np.array([*[0.5] * 9, 0.0]),
        covariance=np.diag([*[1.0] * 9, 0.0]),
        residuals=(ViewResiduals([[3.0, 4.0]], [[0.0, 0.0]]),),
    )


def test_results_are_written_as_they_always_were(tmp_path: Path, golden: Result) -> None:
    """Sums, which processors round differently, to 12 digits."""
    export(golden, "result", tmp_path / "result.json")
    written = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert written.pop("lens_error_px", 0.0) == 0.0, "later versions have added it"
    assert "solve_seconds" in written, "later versions have added it"
    assert "matrix_by_noise" in written["covariance"], "later versions have added it"
    assert isinstance(written.pop("findings"), list), "later versions have added it"
    assert written.pop("verdict")["grade"] in list(Grade), "later versions have added it"
    assert written.pop("lengths_confirmed"), "later versions have added it"
    del written["solve_seconds"], written["covariance"]["matrix_by_noise"]
    kept = json.loads((_GOLDEN / "result-1.json").read_text(encoding="utf-8"))
    assert same(written, kept, tolerance=1e-12)


@pytest.mark.parametrize(
    ("name", "kept"),
    [("corners", "corners.json"), ("corners-csv", "corners.csv"), ("corners-vnl", "corners.vnl")],
)
def test_corners_are_written_as_they_always_were(
    tmp_path: Path, name: str, kept: str, golden: Result
) -> None:
    export(golden, name, tmp_path / kept)
    assert (tmp_path / kept).read_bytes() == (_GOLDEN / kept).read_bytes()


def test_other_programs_files_are_written_as_they_always_were(golden: Result) -> None:
    calibration = _forward(golden.calibration)
    xml = format_storage(calibration, ".xml", "How it was refitted.")
    assert xml == (_GOLDEN / "opencv.xml").read_text()
    info = format_camera_info(calibration.camera, "camera", "How it was refitted.")
    assert info == (_GOLDEN / "camera_info.yaml").read_text()
    region = np.array([[0.0, 0.5], [600.0, 1.0], [20.0, 470.25]])
    model = format_camera_model(calibration.camera, region, "How it was refitted.")
    assert model == (_GOLDEN / "camera.cameramodel").read_text()
    listed = format_cameras(calibration.camera, "How it was refitted.")
    assert listed == (_GOLDEN / "cameras.txt").read_text()
    images = [f"photographs/{k}.png" for k, _ in enumerate(calibration.poses)]
    transforms = format_transforms(calibration, images, "How it was refitted.")
    kept = json.loads((_GOLDEN / "transforms.json").read_text(encoding="utf-8"))
    assert same(json.loads(transforms), kept, tolerance=1e-12), "products of matrices"
    results = format_results(list_values(calibration), "How it was refitted.")
    assert results == (_GOLDEN / "Calib_Results.m").read_text()
    lcp = format_lcp(calibration.camera, "How it was refitted.")
    assert lcp == (_GOLDEN / "camera.lcp").read_text()
    anipose = format_anipose([calibration.camera], "How it was refitted.")
    assert anipose == (_GOLDEN / "anipose.toml").read_text()
    array = format_array([calibration.camera], "How it was refitted.")
    assert array == (_GOLDEN / "camera_array.toml").read_text()
    metashape = format_metashape(calibration.camera, "How it was refitted.")
    assert metashape == (_GOLDEN / "metashape.xml").read_text()
    script = format_script(calibration.camera, "How it was refitted.")
    assert script == (_GOLDEN / "camera.m").read_text()
    fisheye = Camera(
        (640, 480), [*calibration.camera.params[:4], -0.05, 1e-5, 0, 0], "kannala-brandt"
    )
    camchain = format_camchain(fisheye, "How it was refitted.")
    assert camchain == (_GOLDEN / "camchain.yaml").read_text()
    chain = format_chain(fisheye, "How it was refitted.")
    assert chain == (_GOLDEN / "openvins.yaml").read_text()
    settings = format_settings(calibration.camera, "How it was refitted.")
    assert settings == (_GOLDEN / "orb_slam.yaml").read_text()
    basalt = format_calibration(fisheye, "How it was refitted.")
    assert basalt == (_GOLDEN / "basalt.json").read_text()
    profile = format_profile([(24.0, fisheye), (35.5, fisheye)], "How it was refitted.")
    assert profile == (_GOLDEN / "gyroflow.json").read_text()
    lens = format_database("fisheye", [fisheye], [24.0], 12.0, "How it was fitted.")
    assert lens == (_GOLDEN / "lensfun.xml").read_text()


@pytest.mark.parametrize("name", ["kalibr", "python", "mrcal"])
def test_files_say_what_their_lengths_rest_on(name: str, tmp_path: Path, golden: Result) -> None:
    path = tmp_path / f"file{EXPORTERS[name].suffixes[0]}"
    board = Board(rows=6, cols=8, square=25.0)
    for confirmed in (False, True):
        export(replace(golden, board=board, lengths_confirmed=confirmed), name, path)
        said = "Lengths hold if squares are 25 mm." in path.read_text(encoding="utf-8")
        assert said is not confirmed
