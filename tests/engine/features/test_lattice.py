"""Which lattices are large enough for a board."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.features.lattice import Lattice, is_large_enough


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        (["###", "###", "###"], True),
        (["####", "###.", "###."], True),
        (["##.", "###", "###"], False),
        (["######", "######"], False),
        ([".###", "###.", ".###", "..#."], False),  # 10 corners of a houndstooth
        ([".####", "####.", ".####"], True),  # 12 may have gaps anywhere
    ],
)
def test_the_smallest_board_is_full(rows: list[str], expected: bool) -> None:
    found = np.array([[place == "#" for place in row] for row in rows])
    uv = np.where(found[..., None], np.indices(found.shape).transpose(1, 2, 0), np.nan)
    assert is_large_enough(Lattice(uv, dark=True)) is expected


def test_the_mask_of_the_corners_is_the_callers() -> None:
    uv = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0)), axis=2)
    uv[1, 2] = np.nan
    lattice = Lattice(uv, dark=True)
    found = lattice.found
    assert np.argwhere(~found).tolist() == [[1, 2]]
    found[:] = False
    assert np.argwhere(~lattice.found).tolist() == [[1, 2]]
    assert len(lattice) == 11
