"""The compiled search for filled ellipses against the readable one."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.engine.detection.circles.blobs import _find_round_parts


@pytest.mark.parametrize("seed", range(12))
def test_the_same_parts_are_round(seed: int) -> None:
    """Discs, also at the borders, among rings and what noise connects in many ways, in images of
    any width."""
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(30, 200, 2).tolist())
    levels = rng.normal(0, 1, shape)
    image = 128 + 60 * cv2.GaussianBlur(levels, (0, 0), rng.choice([0.3, 1.0, 2.5]))
    for _ in range(20):
        u, v, a, b = (rng.uniform(0, 1, 4) * [*shape[::-1], 12, 12]).astype(int).tolist()
        around, inside = (float(each) for each in rng.uniform(0, 255, 2))
        cv2.ellipse(image, (u, v), (a + 4, b + 4), 30.0, 0, 360, around, -1)
        cv2.ellipse(image, (u, v), (a, b), 30.0, 0, 360, inside, -1)
    upper = np.clip(image, 0, 255).astype(np.uint8)
    lower = cv2.blur(upper, (21, 21))
    limits = [(8, (12, 900), 0.1, (0.85, 1.1)), (-3, (1, np.inf), 0.0, (0.0, np.inf))]
    for each in limits:
        expected = _find_round_parts.reference(upper, lower, *each)
        found = _find_round_parts.kernel(upper, lower, *each)
        assert len(expected)
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("width", [1, 7, 8, 9, 16])
def test_the_same_parts_fill_rows_of_any_width(width: int) -> None:
    """Where every pixel begins or ends a run there are as many parts as the table has places."""
    v, u = np.indices((6, width))
    for inside in (np.ones_like(u), (u + v) % 2, u % 2, (u == width - 1) + 0):
        upper = inside.astype(np.uint8)
        limits = (1, (1.0, np.inf), 0.0, (0.0, np.inf))
        expected = _find_round_parts.reference(upper, np.zeros_like(upper), *limits)
        found = _find_round_parts.kernel(upper, np.zeros_like(upper), *limits)
        np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_nothing_is_found_where_nothing_differs() -> None:
    upper = np.full((40, 50), 7, np.uint8)
    for find in (_find_round_parts.reference, _find_round_parts.kernel):
        assert find(upper, upper, 1, (12.0, 100.0), 0.1, (0.85, 1.1)).shape == (0, 4)
