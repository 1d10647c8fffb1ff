"""The compiled samples around corners against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels, opencv
from calibgui.engine.features import corner_template


@pytest.mark.parametrize("dtype", [np.uint8, np.int16, np.uint16])
def test_the_same_grey_levels_around_corners(dtype: type, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(5)
    smooth, _ = opencv.blur_image(rng.integers(0, 255, (60, 80)).astype(np.uint8), 2.0)
    image = smooth.astype(dtype)
    uv = rng.uniform(0, (79, 59), (300, 2))
    right, down = rng.uniform(-20, 20, (2, 300, 2))
    arguments = image, uv, right, down, rng.random(300) < 0.5

    def seen() -> tuple[np.ndarray, ...]:
        around = corner_template.sample_around(*arguments[:4], corner_template.PATCH_POSITIONS)
        return (
            around,
            *corner_template.compare_sectors(*arguments),
            corner_template._compute_patches(
                *arguments, corner_template.PATCH_POSITIONS, corner_template._LINEAR_LIGHT
            ),
        )

    compiled = seen()
    monkeypatch.setattr(kernels, "COMPILED", False)
    for one, other in zip(compiled, seen(), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-7, atol=1e-9 * abs(other).max())


def test_no_grey_level_where_there_is_no_place() -> None:
    nowhere, step = np.array([[np.nan, 5.0], [5.0, np.nan]]), np.ones((2, 2))
    around = corner_template.sample_around(
        np.ones((9, 9)), nowhere, step, step, corner_template.PATCH_POSITIONS
    )
    assert np.isnan(around).all()
