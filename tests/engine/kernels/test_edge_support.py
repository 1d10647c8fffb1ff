"""The compiled bands hold the same pixels as the readable ones, in the room set aside for them."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.detection.checkerboard.edge_support import Bands
from calibgui.engine.kernels import edge_support as compiled


@pytest.mark.parametrize("bent", [0.0, 0.002, 0.02])
@pytest.mark.parametrize("longest", [1.0, 8.0, 60.0])
def test_every_pixel_once_and_within_its_room(bent: float, longest: float) -> None:
    rng = np.random.default_rng(0)
    n = 200
    angle = (
        rng.uniform(0, np.pi, (n, 1)) + np.array([0, np.pi / 2]) + rng.uniform(-0.7, 0.7, (n, 2))
    )
    tangent = np.stack([np.cos(angle), np.sin(angle)], axis=2)
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=2)
    arm = longest * rng.uniform(0.2, 1, (n, 2))
    bands = Bands(
        uv=rng.uniform(0, 300, (n, 2)),
        tangent=tangent,
        normal=normal,
        curvature=rng.normal(0, bent, (n, 2)),
        arm=arm,
        width=rng.uniform(0.7, np.maximum(arm / 2, 1.0)),
    )
    image = rng.integers(0, 256, (300, 300), dtype=np.uint8)
    lengths = np.stack([bands.curvature, bands.arm, bands.width], axis=2)
    packed = np.concatenate([bands.tangent, bands.normal, lengths], axis=2)
    readable, _, counts = bands.read(image)
    for i in range(n):
        most, reach = compiled.room(packed[i : i + 1]), compiled.reach(packed[i : i + 1])
        offset, grey = np.zeros((2, most), np.int32), np.zeros(most, np.float32)
        number = compiled.read(image, bands.uv[i], packed[i], offset, grey)
        assert number <= most
        assert abs(offset).max() <= reach
        pixels = offset[:, :number].T + np.rint(bands.uv[i]).astype(np.int64)
        np.testing.assert_array_equal(grey[:number], image[pixels[:, 1], pixels[:, 0]])
        seen = set(map(tuple, pixels.tolist()))
        assert len(seen) == number
        if not bent:  # the readable ones in float32
            others = set(map(tuple, readable[i][counts[i] > 0].tolist()))
            assert len(seen ^ others) <= 1
