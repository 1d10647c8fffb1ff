"""What is printed beside corners, taken out of an image."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.detection.blurred_print import subtract_change


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_a_change_is_subtracted_where_there_is_one(dtype: type) -> None:
    image = np.full((6, 5), 100, dtype)
    change = np.zeros((6, 5))
    assert subtract_change(image, change) is not image
    np.testing.assert_array_equal(subtract_change(image, change), image)
    change[2, 1], change[4, 3] = 30.3, -1e6
    cleaned = subtract_change(image, change)
    assert cleaned.dtype == dtype
    assert cleaned[2, 1] == 70
    assert cleaned[4, 3] == np.iinfo(dtype).max
    assert np.count_nonzero(cleaned != image) == 2
    assert (image == 100).all()
