"""No image makes the finder hang, crash or see a board that is not there."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from calibgui.engine.corner_fit import x_corner_fit
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.lattices import lattice_growth, pyramid_search
from calibgui.engine.lattices.x_junctions import MAX_CANDIDATES
from tests.engine.drawn_boards import random_squares
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions

SHAPE = (900, 1200)
V, U = np.mgrid[: SHAPE[0], : SHAPE[1]]


def checkers(period: float, angle: float = 0.0) -> NDArray[np.uint8]:
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    x, y = c * U + s * V, c * V - s * U
    return (255 * ((np.floor(x / period) + np.floor(y / period)) % 2)).astype(np.uint8)


def many_boards() -> NDArray[np.uint8]:
    image = np.full(SHAPE, 255, np.uint8)
    for row in range(10, 800, 110):
        for col in range(10, 1100, 110):
            image[row : row + 90, col : col + 90] = checkers(10 + row // 110)[:90, :90]
    return image


HOSTILE: dict[str, Callable[[], NDArray[Any]]] = {
    **{f"checkers {p}": lambda p=p: checkers(p) for p in (1, 2, 4, 8, 13)},
    "checkers turned": lambda: checkers(7.3, 5.0),
    "noise": lambda: np.random.default_rng(0).integers(0, 256, SHAPE).astype(np.uint8),
    "stripes": lambda: (255 * (U // 8 % 2)).astype(np.uint8),
    "ramp": lambda: (U * 50 + V).astype(np.uint16),
    "moire": lambda: (127 + 60 * np.sin(U * U / 2e3) + 60 * np.sin(V * V / 2e3)).astype(np.uint8),
    "sine grid": lambda: (127 + 120 * np.sin(U / 9) * np.sin(V / 9)).astype(np.uint8),
    "dot screen": lambda: (255 * (np.hypot(U % 12 - 6, V % 12 - 6) < 4)).astype(np.uint8),
    "random squares": lambda: random_squares(1, 10, SHAPE),
    "many boards": many_boards,
}


@pytest.mark.parametrize("name", HOSTILE)
def test_work_is_bounded(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """In candidates, rounds of growth and fitted corners, whatever is looked for."""
    candidates, rounds, fitted = [], [], []

    def counted(module: Any, function: str, note: Callable[[Any, Any], None]) -> None:
        original = getattr(module, function)

        def wrapper(*args: Any, **options: Any) -> Any:
            result = original(*args, **options)
            note(args, result)
            return result

        monkeypatch.setattr(module, function, wrapper)

    counted(pyramid_search, "find_saddles", lambda _, saddles: candidates.append(len(saddles.uv)))
    counted(lattice_growth, "_fill_places", lambda args, _: rounds.append(len(args[0])))
    counted(x_corner_fit, "fit_x_corners", lambda args, _: fitted.append(len(args[1])))
    for grid_size in (None, (6, 9)):
        with contextlib.suppress(NoBoardError):
            find_corners(HOSTILE[name](), grid_size)
    levels, coarser = 4, 2
    # All but the finest may be looked at again, and the coarsest once more with those beyond it.
    assert len(candidates) <= 2 * (2 * levels - 1 + 1 + coarser)
    assert max(candidates, default=0) <= MAX_CANDIDATES
    assert len(rounds) <= 200
    assert sum(fitted) <= 8 * MAX_CANDIDATES


@settings(max_examples=40)
@given(
    hnp.arrays(
        st.sampled_from([np.uint8, np.uint16]), st.tuples(st.integers(1, 48), st.integers(1, 48))
    ),
    st.integers(1, 8),
)
def test_any_image_gets_an_answer(image: NDArray[Any], zoom: int) -> None:
    with contextlib.suppress(NoBoardError):
        find_corners(np.kron(image, np.ones((zoom, zoom), image.dtype)))


@pytest.mark.parametrize("value", [0, 1, 255, 65535])
def test_nothing_to_see(value: int) -> None:
    with pytest.raises(NoBoardError):
        find_corners(np.full((300, 400), value, np.uint16))


@pytest.mark.parametrize("period", [1, 2, 3, 4])
@pytest.mark.parametrize("method", ["edges", "saddle"])
def test_endless_fine_checkers(period: int, method: str) -> None:
    with contextlib.suppress(NoBoardError):
        find_corners(checkers(period)[:300, :400], method=method)


@pytest.mark.parametrize("shape", [(16, 2000), (2000, 16), (17, 17)])
def test_odd_shapes(shape: tuple[int, int]) -> None:
    image = np.random.default_rng(0).integers(0, 255, shape).astype(np.uint8)
    with pytest.raises(NoBoardError):
        find_corners(image)


@pytest.mark.parametrize("shape", [(1, 1), (15, 4000), (0, 7)])
def test_an_image_too_small_is_told(shape: tuple[int, int]) -> None:
    with pytest.raises(NoBoardError, match="too small"):
        find_corners(np.zeros(shape, np.uint8))


def test_saturated_halves() -> None:
    image = np.zeros((200, 300), np.uint16)
    image[:, 150:] = 65535
    with pytest.raises(NoBoardError):
        find_corners(image)


@pytest.mark.parametrize(("period", "slant"), [(4.0, 0.0), (7.0, 0.1), (12.0, 0.2)])
def test_many_waves_are_not_fitted(
    period: float, slant: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(x_corner_fit, "fit_x_corners", None)
    image = 127 + 60 * np.sin(U / period + slant * V) + 60 * np.sin(V / period)
    with pytest.raises(NoBoardError):
        find_corners(image[:480, :640].astype(np.float32))


def test_many_squares_are_not_waves_however_blurred() -> None:
    scene = Conditions(
        grid_size=(14, 19), square=27.0, blur=0.15 * 27, tilt=15.0, shift=0.0, turn=5.0
    )
    assert find_corners(draw(scene, 0).photograph(0)).shape == (14, 19)
