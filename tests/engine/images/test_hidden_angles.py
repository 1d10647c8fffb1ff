"""What is lost, against angles known from the cameras' construction."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.camera.camera import Camera
from calibgui.engine.images.hidden_angles import describe_hidden_angles, measure_hidden_angles
from calibgui.engine.images.undistortion import choose_ideal_cameras
from tests.engine.scenes import barrel

DEGREE = np.pi / 180
ROUND = Camera((930, 930), [5 / DEGREE, 5 / DEGREE, 464.5, 464.5, 0, 0, 0, 0], "kannala-brandt")
"""Equidistant, 5 px a degree: 93 degrees to each side."""


def make_off_centre() -> Camera:
    """Equidistant, 5 px a degree: 93 degrees to the left, 90 to the right, 60 up and 40 down."""
    f = 5 / DEGREE
    params = [f, f, 93 * 5 - 0.5, 60 * 5 - 0.5, 0, 0, 0, 0]
    return Camera((183 * 5, 500), params, "kannala-brandt")


@pytest.mark.parametrize("degrees", [60, 120, 150])
def test_perspective_loses_what_is_beyond_its_edges(degrees: float) -> None:
    ideals = choose_ideal_cameras(ROUND, field_of_view=degrees * DEGREE)
    lost = measure_hidden_angles(ROUND, ideals.values())
    expected = (93 - degrees / 2) * DEGREE
    for side in (lost.left, lost.right, lost.top, lost.bottom):
        assert side == pytest.approx(expected, abs=0.11 * DEGREE)
    # In an equidistant image the perspective square's edge is where tan(theta) is tan(a) / cos.
    y, x = np.mgrid[:930, :930] / 5.0 - 92.9
    theta, phi = np.hypot(x, y) * DEGREE, np.arctan2(y, x)
    edge = np.tan(degrees / 2 * DEGREE) / np.maximum(abs(np.cos(phi)), abs(np.sin(phi)))
    is_shown = theta < np.arctan(edge)
    assert lost.share == pytest.approx(1 - is_shown.mean(), abs=0.03)


def test_every_side_is_told() -> None:
    camera = make_off_centre()
    ideals = choose_ideal_cameras(
        camera, projection="equirectangular", field_of_view=170 * DEGREE, size=(170, 90)
    )
    # 170 by 90 degrees around the axis, of which 45 down are more than the lens sees.
    assert describe_hidden_angles(camera, ideals) == (
        "Equirectangular of 170 degrees: the outer 8 degrees of the lens on the left, 5 degrees on "
        "the right and 15 degrees at the top are not shown."
    )


def test_what_is_whole_is_said_to_be() -> None:
    camera = barrel()
    for projection in ("perspective", "cylindrical", "equirectangular", "stereographic"):
        ideals = choose_ideal_cameras(camera, projection=projection)
        assert describe_hidden_angles(camera, ideals).endswith(
            "degrees: everything that the lens sees is shown."
        )
    camera = make_off_centre()
    assert describe_hidden_angles(camera, choose_ideal_cameras(camera, projection="cube")) == (
        "Cube of front, left, right, top and bottom: everything that the lens sees is shown."
    )


def test_a_missing_face_is_lost() -> None:
    camera = make_off_centre()
    faces = choose_ideal_cameras(camera, projection="cube")
    del faces["left"]
    lost = measure_hidden_angles(camera, faces.values())
    assert lost.left == pytest.approx(48 * DEGREE, abs=0.11 * DEGREE)
    assert (lost.right, lost.top, lost.bottom) == pytest.approx((0, 0, 0), abs=1e-9)


def test_corners_are_told_where_the_sides_are_whole() -> None:
    camera = Camera((640, 480), [650.0, 650, 319.5, 239.5, -0.25, 0.12, 0, 0, 0], "brown-conrady")
    ideals = choose_ideal_cameras(camera, "no-border", projection="stereographic")
    said = describe_hidden_angles(camera, ideals)
    assert said.endswith("of the photograph, in its corners, are not shown.")


def test_what_the_model_does_not_see_is_not_lost() -> None:
    """Of a model that ends within its image only what it sees counts."""
    camera = Camera((640, 480), [150.0, 150, 320, 240, 0.9, 1.0], "eucm")
    ideals = choose_ideal_cameras(camera, projection="equirectangular")
    lost = measure_hidden_angles(camera, ideals.values())
    assert np.isfinite([lost.left, lost.right, lost.top, lost.bottom, lost.share]).all()
