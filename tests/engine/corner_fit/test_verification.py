"""Each rule of the verification, broken alone and just kept, by painted squares."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from calibgui.engine.corner_fit import verification
from calibgui.engine.corner_fit.robust_fit import list_cells
from calibgui.engine.features.lattice import Lattice, drop_isolated_and_crop, estimate_steps
from tests.engine.painted_squares import (
    BRIGHT,
    SQUARE,
    Array,
    Image,
    alternate,
    drop,
    invert,
    move,
    paint,
    place,
)
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions


def mark_square(image: Image, cell: tuple[int, int]) -> None:
    """Paint most of the square after a corner bright."""
    u, v = np.rint(place(6, 9).uv[cell] + SQUARE / 2).astype(int)
    image[v - 6 : v + 6, u - 6 : u + 6] = BRIGHT


class TestSoundCorners:
    def test_a_corner_too_far_from_others_to_know_its_steps_does_not_pass(self) -> None:
        scene = draw(Conditions(grid_size=(6, 12), square=24.0, size=(400, 240), turn=0.0), 2)
        first = scene.uv[0, 0] - (scene.uv[1, 1] - scene.uv[0, 0]) / 2
        u, v = np.rint(first).astype(int)
        seen = np.zeros((6, 12), dtype=bool)
        seen[:, :4] = seen[0, :8] = seen[3:, 8:] = True
        lattice = Lattice(scene.uv, dark=bool(scene.clean[v, u] < 127)).select(seen)
        good = verification.find_sound_corners(lattice, scene.photograph(0))
        assert not good[0, 7]
        seen[0, 7] = False
        np.testing.assert_array_equal(good, seen)

    def test_a_corner_that_looks_otherwise_does_not_pass(self) -> None:
        image = paint(alternate(6, 9))
        assert verification.find_sound_corners(place(6, 9), image).all()
        u, v = np.rint(place(6, 9).uv[2, 4]).astype(int)
        image[v - 6 : v + 6, u - 6 : u + 6] = 125
        good = verification.find_sound_corners(place(6, 9), image)
        np.testing.assert_array_equal(np.argwhere(~good), [(2, 4)])

    def test_corners_of_the_opposite_colours_do_not_pass(self) -> None:
        levels = alternate(6, 9)
        levels[:, 6:] = invert(levels[:, 6:])
        good = verification.find_sound_corners(place(6, 9), paint(levels))
        assert good[:, :5].all()
        assert not good[:, 5:].any()

    @pytest.mark.parametrize(("offset", "passes"), [(0.19, True), (0.21, False)])
    @pytest.mark.parametrize("along", [0, 1])
    def test_a_corner_lies_where_its_neighbours_expect_it(
        self, along: int, offset: float, passes: bool, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """Whatever it looks like: the template matches everything here."""

        def match(_: Image, uv: Array, *__: Any) -> tuple[NDArray[np.bool_], Array]:
            return np.ones(len(uv), dtype=np.bool_), np.zeros(len(uv))

        monkeypatch.setattr(
            verification, "estimate_template_of", lambda *_: SimpleNamespace(match=match)
        )
        moved = move(place(6, 9), (3, 4), (0.0, offset) if along else (offset, 0.0))
        good = verification.find_sound_corners(moved, paint(alternate(6, 9)))
        assert good[3, 4] == passes
        assert np.count_nonzero(~good) == (not passes)

    def test_what_does_not_look_like_a_corner_moves_no_prediction(self) -> None:
        image = paint(alternate(6, 9))
        moved = move(place(6, 9), (0, 4), (0.45, 0.0))
        good = verification.find_sound_corners(moved, image)
        np.testing.assert_array_equal(np.argwhere(~good), [(0, 4)])

    @pytest.mark.parametrize("marked", [[(2, 4)], [(0, 2), (2, 2), (2, 4), (4, 4)]])
    def test_what_lies_beside_corners_is_no_harm_to_them(
        self, marked: list[tuple[int, int]]
    ) -> None:
        """Beside a few of them, or beside more than may fail, though no board's end is seen."""
        image, lattice = paint(alternate(6, 9)), place(6, 9)
        for cell in marked:
            mark_square(image, cell)
        part = lattice.select(np.indices((6, 9))[1] > 0)
        assert verification.find_sound_corners(part, image)[:, 1:].all()


def test_a_quarter_of_the_corners_may_fail() -> None:
    assert verification.is_credible(3, 12)
    assert not verification.is_credible(4, 12)
    assert verification.is_credible(0, 0)


@pytest.mark.parametrize(("amplitude", "passes"), [(0.095, True), (0.105, False)])
def test_corners_lie_on_a_smooth_grid_map(amplitude: float, passes: bool) -> None:
    lattice = place(12, 12)
    row, col = np.indices(lattice.shape)
    uv = lattice.uv.copy()
    uv[..., 1] += np.where((row // 2 + col) % 2, 1, -1) * amplitude * SQUARE
    assert verification.lies_on_smooth_map(Lattice(uv, True)) == passes


def test_a_border_line_in_part_needs_a_corner_that_is_as_good_as_most() -> None:
    lattice = drop(place(4, 7), *((0, col) for col in range(3, 7)))
    even, off = np.ones(len(lattice)), np.zeros(len(lattice))
    residual, displacement = even.copy(), off.copy()
    residual[:2], displacement[2] = 3.0, 1.5
    assert not verification.find_doubtful_lines(lattice, even, off).any()
    doubtful = verification.find_doubtful_lines(lattice, residual, displacement)
    assert doubtful[:3].all()
    assert not doubtful[3:].any()
    assert not verification.find_doubtful_lines(lattice, residual, off).any()
    assert not verification.find_doubtful_lines(lattice, even, displacement).any()


def test_a_full_border_line_may_be_described_worse_than_the_others() -> None:
    """As where bands of print run along it."""
    lattice = place(4, 7)
    residual = np.ones(len(lattice))
    residual[:7] = 3.0
    assert not verification.find_doubtful_lines(lattice, residual, np.zeros(len(lattice))).any()


def test_residuals_are_compared_in_proportion_to_the_light() -> None:
    residual, contrast = np.ones(20), np.full(20, 30.0)
    residual[:5], contrast[:5] = 6.0, 180.0
    compared = verification.compare_residuals(residual, contrast)
    assert not verification.find_suspect_corners(compared).any()
    contrast[:5] = 44.0
    compared = verification.compare_residuals(residual, contrast)
    assert np.array_equal(compared, residual)


def pretend_fit(lattice: Lattice, **changes: Any) -> Any:
    """Return a perfect fit of the edge model at a lattice's corners, but for some changes.

    Args:
        lattice: corners in rows and columns along the image's.
        changes: values (n, ...) instead of those of the perfect fit, or for one corner
            ``name=(k, value)``.
    """
    n = len(lattice)
    values: dict[str, Array] = {
        "uv": lattice.uv[lattice.found].copy(),
        "residual": np.ones(n),
        "contrast": np.full(n, 100.0),
        "bright": np.full(n, 160.0),
        "covariance": np.tile(1e-4 * np.eye(2), (n, 1, 1)),
        "normals": np.tile([[0.0, 1.0], [-1.0, 0.0]], (n, 1, 1)),
        "blur": np.full((n, 2), 1.0),
    }
    for name, change in changes.items():
        if isinstance(change, tuple):
            values[name][change[0]] = change[1]
        else:
            values[name] = change
    normals, unknowns = values.pop("normals"), np.zeros((n, 9))
    unknowns[:, 4:6] = values.pop("blur")
    square_height = np.full((n, 1), float(SQUARE))
    model = SimpleNamespace(normals=lambda: normals, unknowns=unknowns, square_height=square_height)
    return SimpleNamespace(model=model, **values)


def turn_normals(degrees: float) -> Array:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[-s, c], [-c, -s]])


K = 22
"""The corner, of 6 x 9, at which fits are changed: row 2, column 4."""


def is_described(lattice: Lattice, **changes: Any) -> bool:
    """Return whether the changed corner is described, as all others are."""
    fit = pretend_fit(lattice, **changes)
    good = verification.find_described_corners(fit, lattice)
    assert np.delete(good, K).all()
    return bool(good[K])


class TestDescribedCorners:
    @pytest.mark.parametrize(("shift", "passes"), [(1.9, True), (2.1, False)])
    def test_the_fit_stays_within_a_tenth_of_a_square(self, shift: float, passes: bool) -> None:
        lattice = place(6, 9)
        uv = lattice.uv[2, 4] + (0.0, shift)
        assert is_described(lattice, uv=(K, uv)) == passes

    @pytest.mark.parametrize("high", [(1, 2), (2, 1)])
    def test_of_the_shorter_side(self, high: tuple[int, int]) -> None:
        lattice = Lattice(place(6, 9).uv * high, dark=True)
        assert not is_described(lattice, uv=(K, lattice.uv[2, 4] + (0.0, 2.1)))

    @pytest.mark.parametrize(("shift", "passes"), [(0.95, True), (1.05, False)])
    def test_or_within_a_pixel_where_squares_are_small(self, shift: float, passes: bool) -> None:
        small = Lattice(place(6, 9).uv / 4, dark=True)
        assert is_described(small, uv=(K, small.uv[2, 4] + (shift, 0.0))) == passes

    @pytest.mark.parametrize(
        ("degrees", "residual", "passes"),
        [(2.9, 2.6, True), (3.1, 2.4, True), (3.1, 2.6, False), (-3.1, 2.6, False)],
    )
    @pytest.mark.parametrize("edge", [0, 1])
    def test_of_more_residual_its_edges_point_to_the_neighbours(
        self, edge: int, degrees: float, residual: float, passes: bool
    ) -> None:
        normals = np.tile(turn_normals(0.0), (54, 1, 1))
        normals[K, edge] = turn_normals(degrees)[edge]
        assert is_described(place(6, 9), normals=normals, residual=(K, residual)) == passes

    @pytest.mark.parametrize(("degrees", "passes"), [(9.5, True), (10.5, False)])
    def test_edges_may_be_askew_where_those_of_the_board_are(
        self, degrees: float, passes: bool
    ) -> None:
        normals = np.tile(turn_normals(1.0), (54, 1, 1))
        normals[K] = turn_normals(degrees)
        assert is_described(place(6, 9), normals=normals, residual=(K, 2.6)) == passes

    @pytest.mark.parametrize(("contrast", "passes"), [(21.0, True), (19.0, False)])
    def test_its_edges_are_as_strong_as_a_fifth_of_the_board_s(
        self, contrast: float, passes: bool
    ) -> None:
        assert is_described(place(6, 9), contrast=(K, contrast)) == passes

    @pytest.mark.parametrize(("bright", "passes"), [(20.0, True), (160.0, False)])
    def test_in_shade_contrast_may_be_as_much_less_as_the_light(
        self, bright: float, passes: bool
    ) -> None:
        changes = {"contrast": (K, 12.0), "bright": (K, bright)}
        assert is_described(place(6, 9), **changes) == passes

    @pytest.mark.parametrize(
        ("contrast", "residual", "passes"),
        [(100.0, 14.5, True), (100.0, 15.5, False), (22.0, 3.9, True), (22.0, 4.1, False)],
    )
    def test_little_is_left_unexplained(
        self, contrast: float, residual: float, passes: bool
    ) -> None:
        changes = {"contrast": (K, contrast), "residual": (K, residual)}
        assert is_described(place(6, 9), **changes) == passes

    @pytest.mark.parametrize(("displacement", "passes"), [(0.0, False), (0.1, True)])
    @pytest.mark.parametrize("residual", [15.5, 22.5])
    def test_more_is_tolerated_where_it_is_known_how_far_the_corner_is_drawn_aside(
        self, displacement: float, passes: bool, residual: float
    ) -> None:
        displacements = np.zeros(54)
        displacements[K] = displacement
        lattice, changes = place(6, 9), {"contrast": (K, 100.0), "residual": (K, residual)}
        fit = pretend_fit(lattice, **changes)
        good = verification.find_described_corners(fit, lattice, displacements)
        assert good[K] == (passes and residual < 22)
        assert np.delete(good, K).all()

    def test_its_covariance_is_known(self) -> None:
        assert not is_described(place(6, 9), covariance=(K, np.nan))


class TestDisplacedCorners:
    def test_a_strong_lens_displaces_none_of_few_corners(self) -> None:
        """Not even one that the others do not surround."""
        scene = draw(Conditions(grid_size=(3, 4), square=110.0, distortion=0.43), 0)
        cells, uv = list_cells(Lattice(scene.uv, True)), scene.uv.reshape(-1, 2)
        for corner in range(len(uv)):
            off = verification.measure_displacements(uv, cells, np.arange(len(uv)) != corner)
            assert off.max() < 0.02 * 110.0

    @pytest.mark.parametrize(
        ("residual", "shift", "displaced"),
        [(2.6, 0.029, False), (2.6, 0.031, True), (2.6, np.nan, True), (2.4, 1.0, False)],
    )
    def test_of_more_residual_it_is_where_the_others_expect_it(
        self, residual: float, shift: float, displaced: bool
    ) -> None:
        """All are a pixel from where the fit started; the first has more residual too."""
        lattice, residuals = place(6, 9), np.ones(54)
        uv = lattice.uv[lattice.found] + (1.0, 0.0)
        uv[K] += (shift, 0.0)
        residuals[[0, K]] = 2.6, residual
        fit = pretend_fit(lattice, uv=uv, residual=residuals)
        suspect = verification.find_suspect_corners(fit.residual)
        found = verification.find_displaced_corners(fit, list_cells(lattice), suspect)
        np.testing.assert_array_equal(np.flatnonzero(found), [K] * displaced)

    @pytest.mark.parametrize(("shift", "displaced"), [(5.5, False), (6.5, True)])
    def test_or_as_near_as_the_others_are(self, shift: float, displaced: bool) -> None:
        """Corners of large squares, 0.05 px off by noise, which the grid map cannot follow."""
        lattice = place(10, 14)
        k = 5 * 14 + 7
        row, col = np.argwhere(lattice.found).T
        uv = lattice.uv[lattice.found]
        uv[:, 0] += 0.05 * np.where((row // 2 + col) % 2, 1, -1)
        uv[k] = lattice.uv[5, 7] + (0.0, 0.05 * shift)
        fit = pretend_fit(lattice, uv=uv, residual=(k, 2.6))
        suspect = verification.find_suspect_corners(fit.residual)
        found = verification.find_displaced_corners(fit, list_cells(lattice), suspect)
        np.testing.assert_array_equal(np.flatnonzero(found), [k] * displaced)


class TestStepEdges:
    @pytest.mark.parametrize("edge", [0, 1])
    @pytest.mark.parametrize(("blur", "passes"), [(0.175, True), (0.185, False)])
    def test_edges_are_narrow(self, blur: float, passes: bool, edge: int) -> None:
        lattice, blurs = place(6, 9), np.ones((54, 2))
        blurs[:30, edge] = blur * SQUARE
        assert verification.has_step_edges(pretend_fit(lattice, blur=blurs)) == passes

    @pytest.mark.parametrize(("misfit", "passes"), [(0.24, True), (0.26, False)])
    def test_steps_describe_them(self, misfit: float, passes: bool) -> None:
        lattice, residual = place(6, 9), np.ones(54)
        residual[:30] = 100 * misfit
        assert verification.has_step_edges(pretend_fit(lattice, residual=residual)) == passes


class TestGaps:
    def test_gaps_are_tried_only_where_the_steps_are_known(self) -> None:
        row, col = np.indices((10, 14))
        uv = 20.0 * np.stack([col + 2, row + 2], axis=-1)
        rng = np.random.default_rng(0)
        for _ in range(300):
            found = rng.random((10, 14)) < 0.2
            ragged = drop_isolated_and_crop(Lattice(uv, dark=True).select(found))
            tried = verification.fill_gaps(ragged, (480, 640))
            assert tried.found[ragged.found].all()
            assert np.isfinite(np.sum(estimate_steps(tried.uv), axis=0)[tried.found]).all()

    @pytest.mark.parametrize(("margin", "filled"), [(4.4, True), (3.6, False)])
    def test_gaps_are_tried_only_off_the_border_of_the_image(
        self, margin: float, filled: bool
    ) -> None:
        uv = place(6, 9).uv
        lattice = drop(Lattice(uv - uv[0, 0] + margin, dark=True), (0, 3), (2, 4))
        tried = verification.fill_gaps(lattice, (400, 400))
        assert tried.found[0, 3] == filled
        np.testing.assert_allclose(tried.uv[2, 4], lattice.uv[2, 3] + (SQUARE, 0.0))
