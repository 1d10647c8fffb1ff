"""Where a lens model holds: at its fold, at its limit, and over a whole image."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.validity import find_valid_pixels, measure_angles
from tests.engine.scenes import LENSES, example

ROW = np.column_stack([np.linspace(0, 639, 640), np.full(640, 239.5)])


def test_a_fold_ends_the_valid_region() -> None:
    """r (1 - 0.3 r^2) grows up to r = 1 / sqrt(0.9) = 1.054."""
    camera = Camera((640, 480), [200, 200, 319.5, 239.5, -0.3, 0, 0, 0, 0, 0])
    radius = np.abs(ROW[:, 0] - 319.5) / 200
    expected = radius < 1 / np.sqrt(0.9)
    np.testing.assert_array_equal(find_valid_pixels(ROW, camera), expected)
    assert not expected.all()


def test_the_circle_of_a_fisheye_ends_it() -> None:
    """An equidistant lens images 180 degrees at pi f; beyond there is no ray."""
    camera = Camera((640, 480), [90, 90, 319.5, 239.5, 0, 0, 0, 0], "kannala-brandt")
    radius = np.abs(ROW[:, 0] - 319.5) / 90
    np.testing.assert_array_equal(find_valid_pixels(ROW, camera), radius < np.pi)
    angles = measure_angles(ROW, camera)
    np.testing.assert_allclose(angles[radius < np.pi], radius[radius < np.pi], atol=1e-12)
    assert np.isnan(angles[radius > np.pi]).all()


@pytest.mark.parametrize("model", list(LENSES))
def test_a_sound_lens_holds_over_its_image(model: str) -> None:
    camera = example(model)
    assert find_valid_pixels(ROW, camera).all()
