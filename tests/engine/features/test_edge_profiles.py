"""What profiles across the edges tell, at any size of the squares."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.features import edge_profiles
from tests.engine.drawn_boards import Draw


@pytest.mark.parametrize("step", [20.0, 60.0, 240.0])
@pytest.mark.parametrize("blur", [0.7, 2.0])
def test_the_blur_is_that_of_the_image(draw: Draw, step: float, blur: float) -> None:
    size = (1280, 960) if step > 100 else (640, 480)
    scene = draw((3, 4), size, step=step, turn=10.0, blur=blur)
    along, across = scene.uv[1, 2] - scene.uv[1, 1], scene.uv[2, 1] - scene.uv[1, 1]
    inner = scene.uv[1, 1:3]
    sign = np.array([1.0, -1.0])
    for s in (sign, -sign):  # one of the two is the colours' own order
        seen = edge_profiles.measure_edge_profiles(
            scene.image,
            inner,
            np.tile(along, (2, 1)),
            np.tile(across, (2, 1)),
            np.full(2, step),
            s,
        )
        if np.isfinite(seen.spread).all():
            break
    np.testing.assert_allclose(seen.blur, np.hypot(blur, np.sqrt(1 / 12)), rtol=0.35)
    np.testing.assert_allclose([seen.low, seen.high], [[40, 40], [210, 210]], atol=3)
