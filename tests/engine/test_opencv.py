"""OpenCV's functions against independent ones that take longer to import."""

from __future__ import annotations

import numpy as np
import scipy

from calibgui.engine.opencv import average_colours, label_parts, shrink_image


def test_parts_are_numbered_as_scipy_numbers_them() -> None:
    rng = np.random.default_rng(0)
    for _ in range(200):
        mask = rng.random(rng.integers(1, 40, 2)) < rng.uniform(0.1, 0.9)
        labels, count = label_parts(mask)
        truth, true_count = scipy.ndimage.label(mask)
        assert count == true_count
        np.testing.assert_array_equal(labels, truth)


def test_colours_are_averaged_as_in_double_precision() -> None:
    image = np.random.default_rng(1).integers(0, 256, (40, 50, 3)).astype(np.uint8)
    weights = np.array([0.2065, 0.587, 0.2065])
    assert np.array_equal(average_colours(image, weights), np.rint(image @ weights))


def test_a_shrunk_image_is_the_mean_of_whole_blocks() -> None:
    image = np.random.default_rng(2).integers(0, 256, (32, 47, 3)).astype(np.uint8)
    blocks = image[:30, :45].reshape(10, 3, 15, 3, 3)
    assert np.abs(shrink_image(image, 3) - blocks.mean(axis=(1, 3))).max() <= 0.5
