"""Which dark parts of an image are taken for discs."""

from __future__ import annotations

import numpy as np

from calibgui.engine.detection.circles.blobs import find_blobs, find_faint_difference


def test_discs_that_shrink_towards_the_border_are_taken() -> None:
    """A fisheye shows them 50 times smaller; what is small beside large ones is none of them."""
    v, u = np.indices((320, 420))
    image = np.full(u.shape, 220.0)
    radius = 26 * 0.75 ** np.arange(8)
    centre = 36 + np.concatenate([[0.0], np.cumsum(2.8 * (radius[:-1] + radius[1:]) / 2)])
    rows = np.array([-4.5, -1.5, 1.5, 4.5])
    discs = [(x, 160 + y * r, r) for x, r in zip(centre, radius, strict=True) for y in rows]
    for x, y, r in [*discs, (centre[0] + 32, 160, 3.0), (centre[0] + 32, 230, 3.0)]:
        image -= 180 * np.clip(r + 0.5 - np.hypot(u - x, v - y), 0, 1)
    levels = image.clip(0, 255).astype(np.uint8)
    few = find_blobs(levels, 100, 100)
    assert len(few) < 32
    taken = find_blobs(levels, 100, 100, are_of_any_size=True)
    distance = np.linalg.norm(taken[:, None] - np.array(discs)[:, :2], axis=2)
    assert len(taken) == 32 and (distance.min(axis=0) < 0.3).all()


def test_the_faintest_difference_follows_the_noise() -> None:
    rng = np.random.default_rng(0)
    for noise, expected in ((0.1, 2), (1.0, 3), (2.0, 6)):
        image = 100 + rng.normal(0, noise, (480, 640))
        image[100:140, 200:300] = 20
        found = find_faint_difference(np.rint(image).astype(np.uint8))
        assert abs(found - expected) <= 1
