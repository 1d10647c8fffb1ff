"""Listed circles are found, each as the one that it is, with covariances that hold."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.listed_circles import ListedCircles, list_circles
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.corners import Corners
from tests.engine.conftest import Scene
from tests.scenes.circle_lists import Places, list_rows_by_turns, strew
from tests.scenes.without_board import draw_without_board


def stage(places: Places, rvec: tuple[float, float, float], distance: float = 330.0) -> Scene:
    pattern, pitch = list_circles(places, diameter=9.0)
    return Scene(Board(*pattern.grid_size, pitch, pattern), rvec=rvec, distance=distance)


def search(scene: Scene, image: GreyImage) -> Corners:
    """Search for circles whose size is not stated."""
    assert isinstance(scene.board.pattern, ListedCircles)
    return find_corners(image, pattern=ListedCircles(scene.board.pattern.places))


def check(scene: Scene, corners: Corners) -> None:
    """Check places, covariances and the diameter."""
    error = scene.error(corners)
    assert abs(error).max() < 0.05
    assert corners.cov is not None
    z2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
    assert 0.7 < np.sqrt(np.mean(z2)) < 1.35
    assert isinstance(corners.pattern, ListedCircles) and corners.pattern.diameter is not None
    assert corners.pattern.diameter * scene.board.square == pytest.approx(9.0, abs=0.02)
    assert not corners.relative


@pytest.mark.parametrize("seed", range(4))
def test_rows_by_turns_are_found(seed: int) -> None:
    """Thermal boards: rows of two lengths by turns; every second one is bright on dark."""
    rng = np.random.default_rng(seed)
    places = list_rows_by_turns(8 + seed % 3, 12 + seed % 2, first=seed % 2)
    scene = stage(places, tuple(rng.normal(0, 0.3, 3)))
    image = scene.image(seed=seed)
    corners = search(scene, 255 - image if seed % 2 else image)
    assert len(corners) == len(places)
    check(scene, corners)


@pytest.mark.parametrize("seed", range(4))
def test_strewn_circles_are_found_however_they_are_turned(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = stage(strew(60, seed), (*rng.normal(0, 0.25, 2), rng.uniform(-3, 3)), 360.0)
    corners = search(scene, scene.image(seed=seed))
    assert len(corners) > 55
    check(scene, corners)


def test_a_square_layout_is_found_as_well() -> None:
    scene = stage([(20.0 * c, 20.0 * r) for r in range(8) for c in range(11)], (0.3, 0.2, 0.1))
    check(scene, search(scene, scene.image()))


def test_covered_circles_are_left_out_and_the_others_keep_their_places() -> None:
    scene = stage(list_rows_by_turns(8, 12), (0.2, -0.3, 0.1))
    image = scene.image()
    image[300:400, 420:560] = 120
    corners = search(scene, image)
    assert 80 < len(corners) < len(scene.board.pattern.grid)  # type: ignore[attr-defined]
    check(scene, corners)


def test_a_part_that_may_lie_elsewhere_is_said_to() -> None:
    """With its first and last columns covered a regular layout has no ends."""
    scene = stage(list_rows_by_turns(8, 12), (0.0, 0.0, 0.0))
    image = scene.image()
    u = scene.pose.tvec[0] * 860 / 330 + 500
    image[:, : int(u + 20)] = image[-1, -1]
    corners = search(scene, image)
    assert corners.relative and "does not show which" in corners.remark


def test_another_layout_and_textures_are_refused() -> None:
    scene = stage(strew(60, 0), (0.1, 0.1, 0.1))
    with pytest.raises(NoBoardError, match="60 circles of the list were not found"):
        search(scene, stage(strew(60, 1), (0.1, 0.1, 0.1)).image())
    mirrored = scene.image()[:, ::-1]
    with pytest.raises(NoBoardError, match="were not found"):
        search(scene, mirrored)
    with pytest.raises(NoBoardError):
        search(scene, draw_without_board(8))
    with pytest.raises(NoBoardError, match="not known where"):
        find_corners(mirrored, pattern=ListedCircles())
