"""The arguments of cameras and poses: what is accepted, converted and refused."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import MODEL_ALIASES, MODELS, find_model, resolve_model_id
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.pose import Pose

PARAMS = [600.0, 610.0, 320.0, 240.0, -0.2, 0.05, 1e-3, 2e-3, 0.01]


def test_a_camera_knows_its_parameters_by_name() -> None:
    camera = Camera((640, 480), [*PARAMS, 0.02], "brown-conrady")  # type: ignore[arg-type]
    assert camera.names == ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "skew")
    np.testing.assert_array_equal(camera.matrix, [[600, 0, 320], [0, 610, 240], [0, 0, 1]])
    np.testing.assert_array_equal(camera.coefficients, [*PARAMS[4:], 0.02])


@pytest.mark.parametrize(
    ("model", "given"),
    [("brown-conrady", PARAMS), ("brown-conrady-4", PARAMS[:8]), ("lucchese", PARAMS)],
)
def test_held_coefficients_may_be_left_out_at_the_end(model: str, given: list[float]) -> None:
    camera = Camera((640, 480), np.array(given), model)
    np.testing.assert_array_equal(camera.params, [*given, 0.0])
    assert camera.names[-1] in find_model(model).held


def test_the_size_is_two_whole_numbers_whatever_it_came_as() -> None:
    camera = Camera(np.array([640.0, 480.0]), PARAMS, "brown-conrady")  # type: ignore[arg-type]
    assert camera.size == (640, 480)
    assert all(type(length) is int for length in camera.size)


def test_its_parameters_are_its_own() -> None:
    given = np.array(PARAMS)
    camera = Camera((640, 480), given, "brown-conrady")
    given[0] = 0.0
    assert camera.params[0] == 600.0
    with pytest.raises(ValueError, match="read-only"):
        camera.params[0] = 0.0


@pytest.mark.parametrize(
    ("size", "count", "model", "says"),
    [
        ((640, 480), 9, "fisheye", "no lens model 'fisheye'"),
        ((640, 480), 4, "brown-conrady", "4 numbers do not make a camera"),
        ((640, 480), 8, "lucchese", "8 numbers do not make a camera"),
        ((640, 480), 9, "lucchese-pixels", "9 numbers do not make a camera"),
        ((640, 480), 8, "brown-conrady", "8 numbers do not make a camera"),
        ((640, 480), 5, "pinhole", "5 numbers do not make a camera"),
        ((0, 480), 9, "brown-conrady", "no image of 0 x 480"),
        ((640.5, 480), 9, "brown-conrady", r"no image of 640\.5 x 480"),
        ((640, float("nan")), 9, "brown-conrady", "no image of 640 x nan"),
        ((640, 10**400), 9, "brown-conrady", "no image of 640 x 1000"),
        ((640, 480, 3), 9, "brown-conrady", "no image of 640 x 480 x 3"),
    ],
)
def test_what_makes_no_camera_is_named(
    size: tuple[int, int], count: int, model: str, says: str
) -> None:
    with pytest.raises(CalibrationError, match=says):
        Camera(size, np.array(PARAMS[:count]), model)


@pytest.mark.parametrize(("place", "value"), [(0, 0.0), (1, -600.0), (2, np.nan), (5, np.inf)])
def test_numbers_that_no_camera_has_are_refused(place: int, value: float) -> None:
    params = np.array(PARAMS)
    params[place] = value
    with pytest.raises(CalibrationError, match="No camera has"):
        Camera((640, 480), params, "brown-conrady")


def test_a_pose_is_three_numbers_and_three() -> None:
    with pytest.raises(ValueError, match="shape"):
        Pose(np.zeros(2), np.zeros(3))


def test_an_id_of_an_earlier_version_means_the_present_model() -> None:
    assert Camera((640, 480), np.array(PARAMS), "opencv").model == "brown-conrady"
    assert find_model("opencv") is MODELS["brown-conrady"]
    assert not MODEL_ALIASES.keys() & MODELS.keys()
    for model in MODELS:
        assert resolve_model_id(model) == model


def test_every_model_has_a_title_of_its_own() -> None:
    assert len({lens.title for lens in MODELS.values()}) == len(MODELS)
