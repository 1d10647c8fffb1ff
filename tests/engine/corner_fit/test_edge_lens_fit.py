"""Arms of edges clipped to the image."""

from __future__ import annotations

import numpy as np

from calibgui.engine.corner_fit.edge_lens_fit import clip_arms

SIZE = (200, 100)
TANGENTS = np.array([[0.8, 0.6], [-0.6, 0.8]])


def test_an_arm_ends_with_what_is_read_of_the_image() -> None:
    uv = np.array([[191.0, 50.0], [100.0, 50.0]])
    middle, half = clip_arms(uv, np.tile(TANGENTS, (2, 1, 1)), np.full((2, 2), 20.0), SIZE)
    # The last column that is read is 198: 7 px on, 8.75 px along the first edge, and 11.67 px
    # against the direction of the second.
    np.testing.assert_allclose(middle[0], [(8.75 - 20) / 2, (20 - 35 / 3) / 2])
    np.testing.assert_allclose(half[0], [(8.75 + 20) / 2, (20 + 35 / 3) / 2])
    np.testing.assert_array_equal(middle[1], 0.0)
    np.testing.assert_array_equal(half[1], 20.0)


def test_arms_inside_the_image_are_whole_whatever_the_others_are() -> None:
    rng = np.random.default_rng(0)
    uv = rng.uniform((40, 40), (160, 60), (20, 2))
    angle = rng.uniform(-np.pi, np.pi, (20, 2))
    tangents = np.stack([np.cos(angle), np.sin(angle)], axis=2)
    arm = rng.uniform(5, 35, (20, 2))
    middle, half = clip_arms(uv, tangents, arm, SIZE)
    np.testing.assert_array_equal(middle, np.zeros((20, 2)))
    np.testing.assert_array_equal(half, arm)
    uv, tangents = np.vstack([uv, [[3.0, 3.0]]]), np.concatenate([tangents, TANGENTS[None]])
    arm = np.vstack([arm, [[20.0, 20.0]]])
    among_others = clip_arms(uv, tangents, arm, SIZE)
    np.testing.assert_allclose(among_others[0][:-1], middle, atol=1e-12)
    np.testing.assert_allclose(among_others[1][:-1], half)
    assert (among_others[1][-1] < 20).all()
