"""What a view must be, and the arrays that views become."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observation, measure_pitch, pack_observations
from calibgui.engine.errors import CalibrationError
from tests.engine.scenes import barrel, scene

VIEW = scene(barrel(), 1).views[0]
UV, XY = np.array(VIEW.uv), np.array(VIEW.xy)


def changed(array: Array, index: object, value: float) -> Array:
    copy = array.copy()
    copy[index] = value  # type: ignore[call-overload]
    return copy


def test_views_are_padded_with_weightless_corners() -> None:
    packed = pack_observations([(UV, XY), (UV[:40], XY[:40])])
    assert packed.uv.shape == (2, 108, 2)
    assert packed.count == 148
    np.testing.assert_array_equal(packed.mask.sum(axis=1), [108, 40])
    np.testing.assert_array_equal(packed.uv[1, packed.corners_of(1)], UV[:40])
    assert packed.cov is None
    assert packed.select_views(slice(1, 2)).count == 40


def test_opencvs_shapes_are_taken() -> None:
    flat = np.column_stack([XY, 0 * XY[:, 0]])
    packed = pack_observations([(UV[:, None].astype(np.float32), flat[:, None])])
    np.testing.assert_allclose(packed.uv[0], UV, rtol=1e-6)
    np.testing.assert_array_equal(packed.xy[0], XY)


BAD = {
    "none of the same length": (UV[:9], XY, "do not match"),
    "three columns": (np.ones((9, 3)), np.zeros((9, 3)), "do not match"),
    "a board that is not flat": (UV, np.column_stack([XY, XY[:, 0]]), "not in one plane"),
    "NaN in the image": (changed(UV, (3, 0), np.nan), XY, "not a finite number"),
    "infinite in the image": (changed(UV, (3, 1), np.inf), XY, "not a finite number"),
    "NaN on the board": (UV, changed(XY, (3, 0), np.nan), "not a finite number"),
    "far from any image": (changed(UV, (3, 0), 1e200), XY, "corner farther than 1e.07 px"),
    "far from any board": (UV, changed(XY, (3, 0), -1e200), "point farther than 1e.09 mm"),
    "a board without extent": (UV, 1e-160 * XY, "at one place"),
    "all NaN": (np.full_like(UV, np.nan), XY, "not a finite number"),
    "three corners": (UV[[0, 1, 20]], XY[[0, 1, 20]], "at least 4"),
    "no corners": (UV[:0], XY[:0], "at least 4"),
    "one row": (UV[:12], XY[:12], "on one line"),
    "one row and a corner": (UV[:13], XY[:13], "on one line"),
    "a corner and one row": (UV[11:24], XY[11:24], "on one line"),
    "a row, interrupted": (UV[[0, 20, *range(1, 12)]], XY[[0, 20, *range(1, 12)]], "on one line"),
    "four corners, three in line": (UV[[0, 5, 11, 40]], XY[[0, 5, 11, 40]], "on one line"),
    "image on one line": (np.column_stack([UV[:, 0], UV[:, 0]]), XY, "on one line"),
    "a corner twice": (np.vstack([UV, UV[:1]]), np.vstack([XY, XY[:1]]), "twice"),
}


@pytest.mark.parametrize(("uv", "xy", "says"), BAD.values(), ids=BAD)
def test_a_view_that_cannot_be_used_is_named(uv: Array, xy: Array, says: str) -> None:
    with pytest.raises(CalibrationError, match=says) as caught:
        pack_observations([(UV, XY), (uv, xy)], names=("first.png", "second.png"))
    assert "second.png" in caught.value.message
    assert caught.value.hint


@pytest.mark.parametrize(
    ("cov", "says"),
    [
        (np.ones((108, 2)), "do not match"),
        (np.full((108, 2, 2), np.nan), "not a finite number"),
        (np.tile(np.diag([1.0, 0.0]), (108, 1, 1)), "not positive definite"),
        (np.tile(np.diag([1.0, -1.0]), (108, 1, 1)), "not positive definite"),
        (np.tile(np.diag([1.0, 1e-320]), (108, 1, 1)), "not positive definite"),
        (np.tile([[1.0, 0.5], [0.4, 1.0]], (108, 1, 1)), "not symmetric"),
    ],
)
def test_covariances_must_be_covariances(cov: Array, says: str) -> None:
    with pytest.raises(CalibrationError, match=says):
        pack_observations([(UV, XY, cov)])


def test_covariances_are_given_for_all_views_or_for_none() -> None:
    cov = np.tile(np.eye(2), (108, 1, 1))
    with pytest.raises(CalibrationError, match="2 has no corner covariances"):
        pack_observations([Observation(UV, XY, cov), Observation(UV, XY)])


def test_every_view_has_a_name() -> None:
    with pytest.raises(ValueError, match="1 names do not name 2 views"):
        pack_observations([VIEW, VIEW], names=["first.png"])


def test_no_views() -> None:
    with pytest.raises(CalibrationError, match="no views"):
        pack_observations([])


def test_pitch_is_the_distance_of_neighbours() -> None:
    assert measure_pitch(pack_observations([VIEW])) == pytest.approx(30.0)
    # Of parts of the board, in several views.
    assert measure_pitch(
        pack_observations([(UV[:40], XY[:40]), (UV[60:], XY[60:])])
    ) == pytest.approx(30.0)
    # Zhang's squares stand apart: the nearest corner belongs to the same square.
    squares = np.array([[0, 0], [0.5, 0], [0, 0.5], [0.5, 0.5], [0.9, 0], [1.4, 0], [1.4, 0.5]])
    assert measure_pitch(pack_observations([(UV[:7] + squares, squares)])) == pytest.approx(
        0.5, rel=0.2
    )
