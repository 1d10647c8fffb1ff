"""The Python face: one call from photographs to a camera that can be kept, read and drawn."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

import calibgui
from calibgui.dataset import CornerSet
from calibgui.engine.boards import BoardShapePrior, Charuco
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import read_image
from calibgui.formats.corners_json import write_corners

pytestmark = pytest.mark.usefixtures("search_here")  # tests/test_manual.py has workers


@pytest.fixture(scope="module")
def camera(photographs: Path, search_here: None) -> calibgui.CalibratedCamera:  # noqa: ARG001
    return calibgui.calibrate(photographs, square=30)


def test_photographs_give_the_camera_that_the_command_line_gives(
    camera: calibgui.CalibratedCamera, photographs: Path
) -> None:
    told: list[tuple[str, int, int]] = []
    files = sorted(photographs.glob("*.png"))
    again = calibgui.calibrate(files, square=30, progress=lambda *each: told.append(each))
    assert again.values == camera.values
    assert {what for what, *_ in told} == {"searching", "looking for the best camera"}
    assert ("searching", 6, 6) in told
    assert camera.sigmas["fx"] > 0 and camera.sigmas["p3"] == 0
    assert abs(camera.values["fx"] - 330) < 4 * camera.sigmas["fx"]


def test_a_camera_is_printed_on_one_screen(camera: calibgui.CalibratedCamera) -> None:
    for text in (repr(camera), str(camera), repr(camera.calibration)):
        assert len(text) < 2000 and "RMS" in text
    assert str(camera).startswith(camera.verdict.grade.value.upper())
    html = camera._repr_html_()
    assert f"<td>fx</td><td>{camera.values['fx']:.6g}</td>" in html and "<td>held</td>" in html


def test_a_camera_is_saved_and_loaded(camera: calibgui.CalibratedCamera, tmp_path: Path) -> None:
    camera.save(tmp_path / "camera.json")
    for load in (calibgui.load, calibgui.CalibratedCamera.load):
        assert load(tmp_path / "camera.json").values == camera.values
    assert "refitted" in camera.export("ros", tmp_path / "camera.yaml")
    assert "plumb_bob" in (tmp_path / "camera.yaml").read_text()
    with pytest.raises(CalibrationError, match="There is no export format 'rosy'"):
        camera.export("rosy", tmp_path / "camera.yaml")


def test_opencv_projects_as_the_camera_does(camera: calibgui.CalibratedCamera) -> None:
    K, D = camera.to_opencv()
    points = np.concatenate([view.xy for view in camera.result.observations()])
    points = np.column_stack([points - points.mean(axis=0), np.full(len(points), 500.0)])
    theirs = cv2.projectPoints(points, np.zeros(3), np.zeros(3), K, D)[0][:, 0]
    np.testing.assert_allclose(theirs, camera.find_pixels(points), atol=0.1)
    with pytest.raises(CalibrationError, match=r"not of cv2\.fisheye's functions"):
        camera.to_opencv(fisheye=True)
    rays = camera.find_rays([[100.0, 80.0], [160.0, 120.0]])
    np.testing.assert_allclose(camera.find_pixels(700 * rays), [[100, 80], [160, 120]])
    assert 0 < camera.estimate_length_error(50.0, at=600.0, uv=[160, 120]).sigma[0] < 0.1


def test_images_are_undistorted(camera: calibgui.CalibratedCamera, photographs: Path) -> None:
    image = read_image(next(photographs.glob("*.png")))
    grey = camera.undistort(image)
    assert grey.shape == image.pixels.shape
    colour = camera.undistort(np.repeat(image.pixels[..., None], 3, axis=2))
    np.testing.assert_array_equal(colour[..., 1], grey)


def test_corners_may_have_opencvs_shapes(camera: calibgui.CalibratedCamera) -> None:
    views = camera.result.observations()
    pairs = [(view.uv[:, None], np.column_stack([view.xy, 0 * view.xy[:, 0]])) for view in views]
    found = calibgui.calibrate_corners(pairs, camera.camera.size, model="brown-conrady")
    assert found.camera.model == "brown-conrady"
    lifted = [(uv, xyz + np.array([0, 0, 5])) for uv, xyz in pairs]
    with pytest.raises(CalibrationError, match="view 1: board points are not in one plane"):
        calibgui.calibrate_corners(lifted, camera.camera.size)


def test_corners_are_read_from_a_file(camera: calibgui.CalibratedCamera, tmp_path: Path) -> None:
    file = tmp_path / "corners.json"
    write_corners(CornerSet(camera.camera.size, camera.result.views, camera.result.board), file)
    found = calibgui.calibrate(file, square=60, improve=False, model="lucchese")
    np.testing.assert_allclose(
        found.calibration.poses[0].tvec, 2 * camera.calibration.poses[0].tvec, rtol=1e-3
    )


def test_what_is_stated_is_kept(photographs: Path) -> None:
    stated = calibgui.calibrate(
        photographs,
        model="brown-conrady",
        board=(6, 7),
        fix={"k3": 0.0},
        prior=BoardShapePrior(0.01, 0.01),
    )
    assert (stated.camera.model, stated.values["k3"]) == ("brown-conrady", 0.0)
    assert stated.calibration.board_shape is None
    free = calibgui.calibrate(photographs, board_shape="free", model="lucchese")
    assert free.calibration.board_shape is not None
    calibgui.plot_board_shape(free)


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        ({"model": "bron-conrady"}, "no lens model 'bron-conrady'"),
        ({"board_shape": "round"}, "round"),
        ({"pattern": Charuco()}, "ChArUco"),
        ({"fix": {"k9": 0.0}, "model": "lucchese"}, "k9"),
    ],
)
def test_what_cannot_be_is_refused(
    photographs: Path, stated: dict[str, object], message: str
) -> None:
    with pytest.raises(CalibrationError, match=message):
        calibgui.calibrate(photographs, **stated)  # type: ignore[arg-type]


def test_figures_are_drawn(camera: calibgui.CalibratedCamera, tmp_path: Path) -> None:
    for plot in (
        calibgui.plot_residuals,
        calibgui.plot_distortion,
        calibgui.plot_uncertainty,
        calibgui.plot_convergence,
    ):
        plot(camera).savefig(tmp_path / f"{plot.__name__}.png")
    with pytest.raises(CalibrationError, match="The board counts as drawn"):
        calibgui.plot_board_shape(camera)


def test_a_progress_that_raises_abandons_the_work(photographs: Path) -> None:
    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        calibgui.calibrate(photographs, progress=stop)


def test_a_camera_writes_its_report(camera: calibgui.CalibratedCamera, tmp_path: Path) -> None:
    camera.report(tmp_path / "c.html", layout="certificate", operator="N. N.")
    page = (tmp_path / "c.html").read_text(encoding="utf-8")
    assert "Calibration certificate" in page and "N. N." in page
    with pytest.raises(CalibrationError, match="no 'operater'"):
        camera.report(tmp_path / "d.html", operater="N. N.")
