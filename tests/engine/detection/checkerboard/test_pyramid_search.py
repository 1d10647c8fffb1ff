"""What bounds the time of a search in textures."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from calibgui.engine.detection.checkerboard import neighbour_graph, pyramid_search
from calibgui.engine.detection.checkerboard.lattice_growth import grow_lattice
from calibgui.engine.detection.checkerboard.pyramid_search import Candidate
from calibgui.engine.detection.lattice import Lattice, compute_filled_share
from tests.scenes.without_board import draw_without_board


def test_few_sparse_lattices_are_grown(monkeypatch: pytest.MonkeyPatch) -> None:
    """One level of these waves has four."""
    filled: list[float] = []

    def grow(seed: Lattice, *args: Any) -> Lattice:
        filled.append(compute_filled_share(seed))
        return grow_lattice(seed, *args)

    monkeypatch.setattr(pyramid_search, "grow_lattice", grow)
    list(pyramid_search.find_candidates(draw_without_board(47), plain=0.26))
    assert sum(share < 0.5 for share in filled) == 2


def test_components_without_a_cell_are_not_arranged(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 2838 crossings few hang together as squares do."""
    arranged: list[int] = []
    arrange = neighbour_graph._arrange_lattices
    monkeypatch.setattr(
        neighbour_graph,
        "_arrange_lattices",
        lambda *args: arranged.append(1) or arrange(*args),
    )
    list(pyramid_search.find_candidates(draw_without_board(47), plain=0.26))
    assert 0 < len(arranged) <= 20


def test_parts_of_what_is_known_are_not_carried_down() -> None:
    """A lattice seen again in a coarser level is refined only where it has corners of its own."""
    uv = 40.0 * np.stack(np.meshgrid(np.arange(6), np.arange(5)), axis=-1) + 60.0
    known = Candidate(Lattice(uv, dark=True), others=0)
    part = Candidate(Lattice((uv[:4, :4] + 0.5) / 2 - 0.5, dark=True), others=0)
    beside = Candidate(Lattice((uv[:4, :4] + 300.5) / 2 - 0.5, dark=True), others=0)
    image = np.full((600, 600), 127, np.uint8)
    (carried,) = pyramid_search._carry_down([part, beside], [known], [image])
    np.testing.assert_allclose(carried.lattice.uv, uv[:4, :4] + 300.0)
