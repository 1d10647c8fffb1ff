"""PuzzleBoards against rendered truth."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from calibgui.engine.arrays import GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.detection.puzzleboard import dot_removal, find_puzzleboard
from calibgui.engine.detection.puzzleboard.dot_removal import remove_blurred_dots
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.features.lattice import Lattice
from calibgui.engine.lattices import grid_map
from tests.engine.conftest import Scene
from tests.scenes.perspective import photograph_board
from tests.scenes.without_board import draw_without_board

_CAMERA = Camera((480, 400), [480.0, 482.0, 240.0, 200.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])
_PATTERN = PuzzleBoard((50, 101))
_BOARD = Board(8, 10, 20.0, _PATTERN)
_SCENE = Scene(_BOARD, _CAMERA, (0.4, 0.25, 0.2), 330.0)


def _find_anywhere(image: GreyImage, scene: Scene = _SCENE) -> Corners:
    """The corners as found without any statement, counted from the board's first corner."""
    corners = find_corners(image, pattern=PuzzleBoard())
    pattern = scene.board.pattern
    assert isinstance(pattern, PuzzleBoard)
    return replace(corners, grid=corners.grid - pattern.origin)


@pytest.mark.parametrize(
    ("square", "distance", "blur", "noise", "most"),
    [
        (20.0, 330.0, 0.7, 2.0, 0.012),
        (20.0, 330.0, 2.0, 2.0, 0.02),
        (6.0, 330.0, 0.7, 2.0, 0.02),  # squares of 8 px
        (20.0, 330.0, 0.7, 10.0, 0.04),
    ],
    ids=["plain", "blurred", "small", "noisy"],
)
def test_located_and_identified(
    square: float, distance: float, blur: float, noise: float, most: float
) -> None:
    scene = replace(_SCENE, board=Board(8, 10, square, _PATTERN), distance=distance)
    corners = _find_anywhere(scene.image(blur, noise), scene)
    assert len(corners) == 80
    assert corners.ambiguity is Symmetry.NONE
    assert not corners.relative
    error = scene.error(corners)
    assert np.sqrt(np.mean(error**2)) < most
    assert corners.cov is not None
    chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error)
    assert 0.6 < chi2.mean() / 2 < 1.7  # of 160 residuals


@pytest.mark.parametrize("quarters", range(4))
def test_a_turned_board_keeps_its_numbers(quarters: int) -> None:
    upright = _find_anywhere(_SCENE.image())
    image = np.ascontiguousarray(np.rot90(_SCENE.image(), quarters))
    turned = find_corners(image, (8, 10), pattern=_PATTERN)
    assert turned.complete
    u, v = upright.uv.T
    w, h = _CAMERA.size
    expected = [(u, v), (v, w - 1 - u), (w - 1 - u, h - 1 - v), (h - 1 - v, u)][quarters]
    order = np.lexsort(upright.grid.T[::-1])
    np.testing.assert_array_equal(upright.grid[order], turned.grid)
    np.testing.assert_allclose(turned.uv, np.column_stack(expected)[order], atol=0.03)


def test_every_part_of_5_x_5_corners_is_identified() -> None:
    """The rest of the board is covered."""
    image = _SCENE.image()
    uv = _find_anywhere(image).uv.reshape(8, 10, 2)
    for row in range(0, 4):
        for col in range(0, 6, 2):
            ends = uv[[row, row, row + 4, row + 4], [col, col + 4, col + 4, col]]
            around = ends + 0.11 * (ends - ends.mean(axis=0))
            mask = cv2.fillConvexPoly(np.zeros_like(image), np.rint(around).astype(np.int32), 1)
            corners = _find_anywhere(np.where(mask == 0, np.uint8(128), image))
            assert len(corners) == 25
            assert np.abs(_SCENE.error(corners)).max() < 0.1


def test_mirrored_inverted_and_without_dots() -> None:
    image = _SCENE.image()
    with pytest.raises(NoBoardError, match="mirrored"):
        find_corners(np.ascontiguousarray(image[:, ::-1]), pattern=PuzzleBoard())
    inverted = find_corners(255 - image, (8, 10), pattern=_PATTERN)
    assert inverted.complete
    assert np.abs(_SCENE.error(inverted)).max() < 0.05
    checkerboard = replace(_SCENE, board=Board(8, 10, 20.0, CHECKERBOARD)).image()
    with pytest.raises(NoBoardError, match="dots"):
        find_corners(checkerboard, pattern=PuzzleBoard())
    with pytest.raises(NoBoardError, match="No PuzzleBoard"):
        find_corners(np.full((200, 300), 128, np.uint8), pattern=PuzzleBoard())


def test_a_board_without_dots_is_verified_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every level of the image shows it again."""
    verified = []
    refine = find_puzzleboard.refine_board
    monkeypatch.setattr(
        find_puzzleboard, "refine_board", lambda *args: verified.append(1) or refine(*args)
    )
    image = photograph_board((1600, 1200), (6, 9), 96, 1.0)
    with pytest.raises(NoBoardError, match="dots of the 6 x 9 corners"):
        find_corners(image, pattern=PuzzleBoard())
    assert len(verified) == 1


@pytest.mark.parametrize(("seed", "count"), [(285, 0), (281, 1), (2, 1)])
def test_crossings_of_waves_are_not_verified(
    seed: int, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """There are thousands of them, without dots; of one part of them is asked whether it is a
    board, if it is not sparse."""
    verified: list[Lattice] = []
    refine = find_puzzleboard.refine_board
    monkeypatch.setattr(
        find_puzzleboard,
        "refine_board",
        lambda *args: verified.append(args[1]) or refine(*args),
    )
    with pytest.raises(NoBoardError, match="No PuzzleBoard"):
        find_corners(draw_without_board(seed), pattern=PuzzleBoard())
    assert len(verified) == count
    assert all(max(lattice.shape) <= 8 for lattice in verified)


def test_a_board_without_dots_whose_middle_is_hidden() -> None:
    image = photograph_board((900, 900), (24, 24), 30, 0.7)
    cv2.circle(image, (450, 450), 290, 128, -1)
    assert find_corners(image).shape == (24, 24)
    with pytest.raises(NoBoardError, match="No PuzzleBoard"):
        find_corners(image, pattern=PuzzleBoard())


def test_only_what_may_be_dots_is_removed() -> None:
    """Waves have thousands of places for dots, and to compute these takes long."""
    uv = project_points(_BOARD.points(), _CAMERA, _SCENE.pose).reshape(8, 10, 2)
    image = _SCENE.image(2.0)
    assert remove_blurred_dots(image, Lattice(uv, dark=False)) is not image
    v, u = np.indices((400, 480))
    waves = 127 + 80 * np.sin(np.pi * (u - 60) / 30) * np.sin(np.pi * (v - 60) / 30)
    crossings = 60.0 + 30 * np.stack(np.meshgrid(np.arange(10), np.arange(8)), axis=-1)
    assert remove_blurred_dots(waves, Lattice(crossings, dark=True)) is waves


def test_blurred_dots_are_placed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Contrast and blur are measured again without them, but the corners stay."""
    fitted: list[Lattice] = []
    fit = grid_map.fit_grid_map

    def count(lattice: Lattice) -> grid_map.GridMap:
        fitted.append(lattice)
        return fit(lattice)

    monkeypatch.setattr(grid_map, "fit_grid_map", count)
    uv = project_points(_BOARD.points(), _CAMERA, _SCENE.pose).reshape(8, 10, 2)
    remove_blurred_dots(_SCENE.image(2.0), Lattice(uv, dark=False))
    assert len(fitted) == 1


def test_half_discs_are_divided_finely_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    """Finer cells change no grey level by more than 0.5 % of what is taken out."""
    uv = project_points(_BOARD.points(), _CAMERA, _SCENE.pose).reshape(8, 10, 2)
    image = _SCENE.image(1.0, noise=0.0).astype(np.uint16) * np.uint16(257)
    cleaned = remove_blurred_dots(image, Lattice(uv, dark=False))
    monkeypatch.setattr(dot_removal, "_RINGS", 20)
    points, areas = dot_removal._divide_half_disc()
    monkeypatch.setattr(dot_removal, "_POINTS", points)
    monkeypatch.setattr(dot_removal, "_AREAS", areas)
    finer = remove_blurred_dots(image, Lattice(uv, dark=False))
    coarse, fine, levels = (each.astype(np.float64) for each in (cleaned, finer, image))
    assert abs(coarse - fine).max() < 0.005 * abs(coarse - levels).max()


def test_a_wrong_statement_is_told() -> None:
    image = _SCENE.image()
    with pytest.raises(NoBoardError, match=r"rows 50 to 57 and columns 101 to 110"):
        find_corners(image, (8, 10), pattern=PuzzleBoard())
    with pytest.raises(NoBoardError, match=r"rows 50 to 57 .* has 7 x 9"):
        find_corners(image, (7, 9), pattern=_PATTERN)


def test_dots_hidden_and_wrong() -> None:
    """Three dots of ten are painted over in the other colour, in their true shape."""
    rng = np.random.default_rng(3)
    image = _SCENE.image(noise=0.0)
    uv = _find_anywhere(image).uv.reshape(8, 10, 2)
    middles = np.concatenate(
        [((uv[:, 1:] + uv[:, :-1]) / 2).reshape(-1, 2), ((uv[1:] + uv[:-1]) / 2).reshape(-1, 2)]
    )
    step = float(np.linalg.norm(uv[0, 1] - uv[0, 0]))
    white, dark = 220, 30
    wrong = rng.permutation(len(middles))[: round(0.3 * len(middles))]
    for u, v in middles[wrong]:
        bright = image[round(v), round(u)] > 125
        cv2.circle(image, (round(u), round(v)), round(step / 6), dark if bright else white, -1)
    corners = find_corners(image, (8, 10), pattern=_PATTERN)
    assert np.abs(_SCENE.error(corners)).max() < 0.5
    assert len(corners) > 50


def test_by_saddle_points() -> None:
    corners = find_corners(_SCENE.image(), (8, 10), method="saddle", pattern=_PATTERN)
    assert corners.complete
    assert corners.cov is None
    assert np.abs(_SCENE.error(corners)).max() < 0.15
