"""Homographies: exact recovery, padding, inverse."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from calibgui.engine.arrays import Array
from calibgui.engine.geometry import homography
from tests.engine.scenes import BOARD

homographies = st.builds(
    lambda a, angle, squeeze, bx, by, c1, c2: np.array(
        [
            [a * np.cos(angle), -a * np.sin(angle) * squeeze, bx],
            [a * np.sin(angle), a * np.cos(angle) * squeeze, by],
            [c1, c2, 1.0],
        ]
    ),
    st.floats(0.3, 5),
    st.floats(-np.pi, np.pi),
    st.floats(0.5, 2.0),
    st.floats(-500, 500),
    st.floats(-500, 500),
    st.floats(-1e-3, 1e-3),
    st.floats(-1e-3, 1e-3),
)


@given(homographies)
def test_inverse_returns_every_point(H: Array) -> None:
    xy = BOARD.points()
    back = homography.apply_homography(
        homography.invert_homography(H), homography.apply_homography(H, xy)
    )
    np.testing.assert_allclose(back, xy, atol=1e-8)
    np.testing.assert_allclose(
        homography.invert_homography(homography.invert_homography(H)), H, rtol=1e-8, atol=1e-8
    )


@given(homographies)
def test_dlt_recovers_a_homography(H: Array) -> None:
    xy = BOARD.points()
    found = homography.fit_homography(xy, homography.apply_homography(H, xy), np.ones(len(xy)))
    # Squaring the equations halves the digits that a homography this oblique leaves.
    np.testing.assert_allclose(
        homography.apply_homography(found, xy),
        homography.apply_homography(H, xy),
        rtol=1e-7,
        atol=1e-6,
    )


def test_dlt_of_four_points_is_exact() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    image = np.array([[10.0, 20.0], [110.0, 25.0], [105.0, 140.0], [5.0, 120.0]])
    H = homography.fit_homography(square, image, np.ones(4))
    np.testing.assert_allclose(homography.apply_homography(H, square), image, atol=1e-6)


def test_dlt_of_a_stack_ignores_padding() -> None:
    rng = np.random.default_rng(0)
    xy = np.broadcast_to(BOARD.points(), (3, 108, 2)).copy()
    uv = rng.uniform(0, 640, size=xy.shape)
    mask = np.ones((3, 108))
    mask[1, 60:] = 0.0
    H = homography.fit_homography(xy, uv, mask)
    alone = homography.fit_homography(xy[1, :60], uv[1, :60], np.ones(60))
    np.testing.assert_allclose(H[1], alone, rtol=1e-9)
    np.testing.assert_allclose(
        H[2], homography.fit_homography(xy[2], uv[2], np.ones(108)), rtol=1e-9
    )


def test_normalised_to_a_unit_last_entry() -> None:
    H = np.array([[2.0, 0.0, 1.0], [0.0, 4.0, 2.0], [0.0, 0.0, 2.0]])
    assert homography.scale_to_unit_last(H)[2, 2] == pytest.approx(1.0)
    assert homography.scale_to_unit_last(H)[1, 1] == pytest.approx(2.0)
