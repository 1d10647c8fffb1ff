"""What bounds the time of a search in textures."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from calibgui.engine.arrays import GreyImage
from calibgui.engine.detection.checkerboard import board_ends, neighbour_graph, pyramid_search
from calibgui.engine.detection.checkerboard.lattice_growth import grow_lattice
from calibgui.engine.detection.checkerboard.pyramid_search import Candidate
from calibgui.engine.detection.checkerboard.x_junctions import Junctions
from calibgui.engine.detection.lattice import Lattice, compute_filled_share, is_large_enough
from tests.engine.detection.checkerboard.conftest import Draw
from tests.scenes.perspective import photograph_board
from tests.scenes.without_board import draw_without_board


def count_sparse(monkeypatch: pytest.MonkeyPatch, seed: int, plain: float) -> int:
    """Count the sparse lattices that are grown in a picture without a board."""
    filled: list[float] = []

    def grow(seed: Lattice, *args: Any) -> Lattice | None:
        filled.append(compute_filled_share(seed))
        return grow_lattice(seed, *args)

    monkeypatch.setattr(pyramid_search, "grow_lattice", grow)
    list(pyramid_search.find_candidates(draw_without_board(seed), plain=plain))
    assert filled
    return sum(share < 0.5 for share in filled)


def test_few_sparse_lattices_are_grown(monkeypatch: pytest.MonkeyPatch) -> None:
    """One level of this halftone has three that chance does not explain."""
    assert count_sparse(monkeypatch, 62, plain=0.5) == 2


def test_a_lattice_that_a_level_shows_again_is_not_grown_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The coarsest level of these waves has the same 990 crossings under both tolerances."""
    grown: list[Lattice] = []

    def grow(seed: Lattice, *args: Any) -> Lattice | None:
        grown.append(seed)
        return grow_lattice(seed, *args)

    monkeypatch.setattr(pyramid_search, "grow_lattice", grow)
    list(pyramid_search.find_candidates(draw_without_board(2), plain=0.26))
    assert [len(lattice) for lattice in grown].count(990) == 1


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
    """This halftone has two lattices that wind through it, and no board."""
    grown: list[Lattice | None] = []

    def grow(*args: Any) -> Lattice | None:
        grown.append(grow_lattice(*args))
        return grown[-1]

    monkeypatch.setattr(pyramid_search, "grow_lattice", grow)
    list(pyramid_search.find_candidates(draw_without_board(8), plain=0.26))
    assert grown[:2] == [None, None]


def test_lattices_that_chance_explains_are_not_grown(monkeypatch: pytest.MonkeyPatch) -> None:
    """One level of these waves has four, all of them ragged."""
    assert count_sparse(monkeypatch, 47, plain=0.26) == 0


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
    list(pyramid_search.find_candidates(draw_without_board(38), plain=0.26))
    assert sum(not is_large_enough(lattice) for lattice in grown) == 12


def test_faint_crossings_beside_a_lattice_do_not_count() -> None:
    """Noise where nothing is printed has any number of them."""
    places = np.argwhere(np.ones((3, 4))).astype(np.float64)[:, ::-1]
    uv = np.full((7, 4, 2), np.nan)
    uv[:3], uv[6, 0] = 20 * places.reshape(3, 4, 2), (7.0, 120.0)
    lattice = Lattice(uv, dark=True)
    noise = np.random.default_rng(0).uniform(200, 900, (2000, 2))
    for faint, is_chance in ((0.1, False), (0.9, True)):
        junctions = Junctions(
            np.concatenate([uv[lattice.found], noise]),
            np.zeros((2013, 2)),
            np.repeat([100.0, 100.0 * faint], [13, 2000]),
        )
        assert pyramid_search._is_chance(lattice, junctions) == is_chance


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


def test_a_lattice_that_exceeds_a_known_one_by_strays_is_not_grown_again() -> None:
    """A line of the board that a finer level did not show would have more corners."""
    places = np.stack(np.meshgrid(np.arange(7.0), np.arange(6.0)), axis=-1)
    known = Candidate(Lattice(40.0 * places[:, :6] + 60.0, dark=True), others=0)
    uv = (40.0 * places + 60.5) / 2 - 0.5
    for beyond, is_missed in ((1, False), (2, True), (6, True)):
        uv[beyond:, 6] = np.nan
        lattice = Lattice(uv.copy(), dark=True)
        uv[:, 6] = (40.0 * places[:, 6] + 60.5) / 2 - 0.5
        assert bool(pyramid_search._select_missed([lattice], 1, [known])) == is_missed


def test_squares_that_are_too_small_in_a_level_are_not_judged_there(
    monkeypatch: pytest.MonkeyPatch, draw: Draw
) -> None:
    """The finer level shows all of them: no profiles are read in the coarser one."""
    judged: list[tuple[int, ...]] = []
    monkeypatch.setattr(
        pyramid_search, "_refuse", lambda _, content: bool(judged.append(content.image.shape))
    )
    assert len(next(iter(pyramid_search.find_candidates(draw(step=20.0).image)))) == 1
    assert judged == [(240, 320)]


def test_fragments_of_what_a_coarser_level_shows_are_not_grown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """One of 19 corners grew in 13 rounds to the most of the 634 that were known, which took longer
    than all else."""
    sizes: list[int] = []

    def grow(seed: Lattice, *args: Any) -> Lattice | None:
        sizes.append(len(seed))
        return grow_lattice(seed, *args)

    monkeypatch.setattr(pyramid_search, "grow_lattice", grow)
    list(pyramid_search.find_candidates(draw_without_board(11), plain=1 / 8))
    assert min(sizes) > 500


@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.float32])
def test_the_range_of_grey_levels_is_that_of_percentiles(kind: type) -> None:
    rng = np.random.default_rng(0)
    for image in (rng.normal(90, 12, (60, 83)).astype(kind), np.full((20, 20), 7, kind)):
        low, high = pyramid_search._measure_percentiles(image)
        expected = np.percentile(image, pyramid_search._RANGE_PERCENTILES)
        np.testing.assert_allclose([low, high], expected, rtol=1e-6)
