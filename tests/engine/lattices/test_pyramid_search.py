"""What bounds the time of a search in textures."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from calibgui.engine.arrays import GreyImage
from calibgui.engine.features.lattice import Lattice, compute_filled_share, is_large_enough
from calibgui.engine.lattices import board_ends, neighbour_graph, pyramid_search
from calibgui.engine.lattices.lattice_growth import grow_lattice
from calibgui.engine.lattices.pyramid_search import Candidate
from tests.scenes.perspective import photograph_board
from tests.scenes.without_board import draw_without_board


def count_sparse(monkeypatch: pytest.MonkeyPatch, seed: int, bare_reach: float) -> int:
    """Count the sparse lattices that are grown in a picture without a board."""
    filled: list[float] = []

    def grow(seed: Lattice, *args: Any) -> Lattice | None:
        filled.append(compute_filled_share(seed))
        return grow_lattice(seed, *args)

    monkeypatch.setattr(pyramid_search, "grow_lattice", grow)
    list(pyramid_search.find_candidates(draw_without_board(seed), bare_reach=bare_reach))
    assert filled
    return sum(share < 0.5 for share in filled)


def test_few_sparse_lattices_are_grown(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of this halftone's sparse lattices four are grown."""
    assert count_sparse(monkeypatch, 62, bare_reach=0.5) == 4


def test_a_lattice_that_waits_for_finer_levels_is_judged_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """One level of this halftone has several of small squares, of which two wait."""
    judged: list[Lattice] = []
    refuse = pyramid_search._refuse

    def keep(lattice: Lattice, content: Any) -> bool:
        judged.append(lattice)
        return refuse(lattice, content)

    monkeypatch.setattr(pyramid_search, "_refuse", keep)
    list(pyramid_search.find_candidates(draw_without_board(26)))
    assert judged
    assert len(set(map(id, judged))) == len(judged)


def test_what_grows_by_single_corners_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """This halftone has a lattice that winds through it, and no board."""
    grown: list[Lattice | None] = []

    def grow(*args: Any) -> Lattice | None:
        grown.append(grow_lattice(*args))
        return grown[-1]

    monkeypatch.setattr(pyramid_search, "grow_lattice", grow)
    list(pyramid_search.find_candidates(draw_without_board(8), bare_reach=0.26))
    assert None in grown


def test_no_ends_are_looked_for_around_lattices_too_small_for_a_board(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """These waves have twelve of few crossings, and to drop some makes none larger."""
    grown: list[Lattice] = []

    def grow(*args: Any) -> Lattice | None:
        lattice = grow_lattice(*args)
        assert lattice is not None
        grown.append(lattice)
        return lattice

    def drop(lattice: Lattice, _: GreyImage) -> Lattice:
        assert is_large_enough(lattice)
        return lattice

    monkeypatch.setattr(pyramid_search, "grow_lattice", grow)
    monkeypatch.setattr(board_ends, "drop_stray_lines", drop)
    list(pyramid_search.find_candidates(draw_without_board(38), bare_reach=0.26))
    assert sum(not is_large_enough(lattice) for lattice in grown) == 12


def test_components_without_a_cell_are_not_arranged(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 2838 crossings few hang together as squares do."""
    arranged: list[int] = []
    arrange = neighbour_graph._arrange_lattices
    monkeypatch.setattr(
        neighbour_graph,
        "_arrange_lattices",
        lambda *args: arranged.append(1) or arrange(*args),
    )
    list(pyramid_search.find_candidates(draw_without_board(47), bare_reach=0.26))
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


def test_a_large_lattice_of_another_board_is_not_grown(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is judged in full resolution, with squares of 14 px, and told as it is seen."""
    image = photograph_board((640, 480), (21, 29), 14.0, 0.8)
    asked: list[tuple[float, int]] = []

    def is_other(lattice: Lattice, depth: int) -> bool:
        asked.append((float(np.nanmedian(lattice.spacing())), depth))
        return True

    monkeypatch.setattr(pyramid_search, "grow_lattice", lambda *_: pytest.fail("it was grown"))
    found = next(iter(pyramid_search.find_candidates(image, is_other=is_other)))
    assert [each.is_other for each in found] == [True]
    assert len(found[0].lattice) > 0.9 * 21 * 29
    assert asked
    assert all(abs(spacing - 14) < 1.5 for spacing, _ in asked)


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_the_range_of_grey_levels_is_that_of_percentiles(kind: type) -> None:
    rng = np.random.default_rng(0)
    for image in (rng.normal(90, 12, (60, 83)).astype(kind), np.full((20, 20), 7, kind)):
        low, high = pyramid_search._measure_percentiles(image)
        expected = np.percentile(image, pyramid_search._RANGE_PERCENTILES)
        np.testing.assert_allclose([low, high], expected, rtol=1e-6)
