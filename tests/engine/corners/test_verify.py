"""Which corners of a lattice pass."""

from __future__ import annotations

import numpy as np

from calibgui.engine.corners import verify
from calibgui.engine.corners.lattice import Lattice
from tests.benchmarks.corner_scenes import Conditions, draw


def test_a_corner_too_far_from_others_to_know_its_steps_does_not_pass() -> None:
    scene = draw(Conditions(board=(6, 12), square=24.0, size=(400, 240), turn=0.0), 2)
    first = scene.uv[0, 0] - (scene.uv[1, 1] - scene.uv[0, 0]) / 2
    u, v = np.rint(first).astype(int)
    seen = np.zeros((6, 12), dtype=bool)
    seen[:, :4] = seen[0, :8] = seen[3:, 8:] = True
    lattice = Lattice(scene.uv, dark=bool(scene.clean[v, u] < 127)).under(seen)
    good = verify.sound(lattice, scene.photograph(0))
    assert not good[0, 7]
    seen[0, 7] = False
    np.testing.assert_array_equal(good, seen)
