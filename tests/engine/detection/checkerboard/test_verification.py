"""Which corners of a lattice pass."""

from __future__ import annotations

import numpy as np

from calibgui.engine.detection.checkerboard import verification
from calibgui.engine.detection.lattice import Lattice, axes, supported
from tests.benchmarks.corner_scenes import Conditions, draw


def test_a_corner_too_far_from_others_to_know_its_steps_does_not_pass() -> None:
    scene = draw(Conditions(grid_size=(6, 12), square=24.0, size=(400, 240), turn=0.0), 2)
    first = scene.uv[0, 0] - (scene.uv[1, 1] - scene.uv[0, 0]) / 2
    u, v = np.rint(first).astype(int)
    seen = np.zeros((6, 12), dtype=bool)
    seen[:, :4] = seen[0, :8] = seen[3:, 8:] = True
    lattice = Lattice(scene.uv, dark=bool(scene.clean[v, u] < 127)).under(seen)
    good = verification.sound(lattice, scene.photograph(0))
    assert not good[0, 7]
    seen[0, 7] = False
    np.testing.assert_array_equal(good, seen)


def test_gaps_are_tried_only_where_the_steps_are_known() -> None:
    row, col = np.indices((10, 14))
    uv = 20.0 * np.stack([col + 2, row + 2], axis=-1)
    rng = np.random.default_rng(0)
    for _ in range(300):
        ragged = supported(Lattice(uv, dark=True).under(rng.random((10, 14)) < 0.2))
        tried = verification.filled(ragged, (480, 640))
        assert tried.found[ragged.found].all()
        assert np.isfinite(np.sum(axes(tried.uv), axis=0)[tried.found]).all()
