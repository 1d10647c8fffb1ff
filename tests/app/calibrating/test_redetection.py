"""A damaged photograph that only the camera calibrated from the others makes sense of."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.calibrating.calibration import ChosenLens, calibrate_views
from calibgui.app.calibrating.redetection import calibrate_twice, redetect_view, redetect_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.detection import find_views
from calibgui.app.system.workers import Crashed
from calibgui.dataset import CornerSet, Result, View, ViewStatus
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.result import Cost
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.features.corners import Corners
from calibgui.engine.images.reading import read_image, write_image
from calibgui.engine.images.rendering import render_view
from tests import photographs
from tests.engine import scenes
from tests.photographs import BOARD, CAMERA

SHAPE = (BOARD.rows, BOARD.cols)
UV = scenes.imaged(CAMERA, photographs.draw_poses()[0], BOARD.points()).reshape(*SHAPE, 2)
HIDDEN = [(m, n) for m in range(6) for n in range(7) if m == 2 or n in (2, 5)]
"""A row and two columns of the first photograph: six parts are left, none a board."""


@pytest.fixture(scope="module")
def damaged(tmp_path_factory: pytest.TempPathFactory) -> CornerSet:
    folder = tmp_path_factory.mktemp("damaged")
    photographs.write_photographs(folder)
    first = folder / "view1.png"
    image = read_image(first).pixels.copy()
    v, u = np.indices(image.shape)
    for place in HIDDEN:
        image[np.hypot(u - UV[place][0], v - UV[place][1]) < 8] = 120
    write_image(first, image)
    return find_views(sorted(folder.glob("*.png")), SHAPE).corner_set(BOARD.square)


def test_gains_the_view_and_calibrates_from_it(damaged: CornerSet) -> None:
    assert [view.usable for view in damaged.views] == [False] + [True] * 5
    once = calibrate_views(damaged)
    twice = calibrate_twice(damaged)
    assert len(twice.used) == len(once.used) + 1
    gained = twice.views[0]
    assert gained.corners is not None
    assert gained.note.startswith("Found with the camera known")
    assert not gained.reason
    assert "view1.png for the first time" in twice.calibration.warnings[-1]
    assert twice.views[1:] == damaged.views[1:]  # nothing to gain there
    assert twice.calibration.residuals[0].rms < 3 * twice.calibration.noise
    assert not {tuple(place) for place in gained.corners.grid.tolist()} & set(HIDDEN)


def test_an_image_of_another_size_is_not_searched(damaged: CornerSet, tmp_path: Path) -> None:
    """Images without a board may have it: none of them tells the camera's."""
    result = calibrate_views(damaged)
    pixels = read_image(damaged.views[2].image).pixels
    view = View(str(tmp_path / "cropped.png"), ViewStatus.NO_BOARD)
    write_image(view.image, pixels[:-2])
    assert redetect_view(view, result.calibration, SHAPE) is view
    write_image(view.image, pixels)
    assert redetect_view(view, result.calibration, SHAPE).status is ViewStatus.FOUND


def test_missed_corners_are_gained_and_noted(damaged: CornerSet) -> None:
    whole = damaged.views[2]
    found = whole.corners
    assert found is not None
    assert found.cov is not None
    few = Corners(
        SHAPE, found.grid[:20], found.uv[:20], found.uv[:20], found.cov[:20], method="edges"
    )
    views = tuple(replace(v, corners=few) if v is whole else v for v in damaged.views)
    partly = replace(damaged, views=views)
    more, sentences = redetect_views(partly, calibrate_views(partly))
    assert more.views[2].corners is not None
    assert more.views[2].corners.complete
    assert more.views[2].note == "Searched again with the camera known: 22 corners more."
    assert len(sentences) == 1


def test_nothing_to_gain_leaves_everything_as_it_was(damaged: CornerSet) -> None:
    complete = replace(damaged, views=damaged.views[1:])
    result = calibrate_views(complete)
    assert redetect_views(complete, result) == (complete, ())
    registered = calibrate_views(damaged, Settings(cost=Cost.REFERENCE))
    assert redetect_views(damaged, registered) == (damaged, ())


def test_a_whole_view_is_searched_again_where_few_corners_have_bent_edges(
    damaged: CornerSet, tmp_path: Path
) -> None:
    board = Board(rows=3, cols=4, square=60.0)
    pose = scenes.looking(CAMERA, np.random.default_rng(1), fill=(0.6, 0.6), board=board)
    file = tmp_path / "few.png"
    write_image(file, render_view(CAMERA, pose, board, blur=0.7, noise=1.0, seed=0))
    corners = find_corners(read_image(file).pixels, (3, 4))
    off = replace(corners, uv=corners.uv + np.array([0.03, 0.0]))
    view = View(str(file), ViewStatus.FOUND, corners=off)
    calibration = replace(calibrate_views(damaged).calibration, poses=(pose,))
    result = Result(calibration, (view,), board)
    more, sentences = redetect_views(CornerSet(CAMERA.size, (view,), board), result)
    again = more.views[0]
    assert again.corners is not None
    np.testing.assert_allclose(again.corners.uv, corners.uv, atol=0.01)
    assert "corners moved by up to 0.03" in again.note
    assert "corners placed better in 1 image" in sentences[0]


def test_what_other_processes_return_unchanged_is_no_gain(
    damaged: CornerSet, monkeypatch: pytest.MonkeyPatch
) -> None:
    def copy_views(_: object, items: list[View], __: object) -> Iterator[tuple[int, View]]:
        yield from enumerate(pickle.loads(pickle.dumps(items)))

    monkeypatch.setattr("calibgui.app.calibrating.redetection._process_views", copy_views)
    assert redetect_views(damaged, calibrate_views(damaged)) == (damaged, ())


def test_a_search_that_breaks_off_is_said_with_the_result(
    damaged: CornerSet, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lose_views(_: object, items: list[View], __: object) -> Iterator[tuple[int, Crashed]]:
        yield from ((k, Crashed()) for k in range(len(items)))

    monkeypatch.setattr("calibgui.app.calibrating.redetection._process_views", lose_views)
    result = calibrate_twice(damaged)
    (said,) = [w for w in result.calibration.warnings if "broke off" in w]
    assert damaged.views[0].name in said and "Calibrate again" in said
    once = calibrate_views(damaged).calibration.camera.params
    np.testing.assert_array_equal(result.calibration.camera.params, once)


def test_an_image_that_is_gone_stays_as_it_was(damaged: CornerSet, tmp_path: Path) -> None:
    gone = View(str(tmp_path / "gone.png"), ViewStatus.NO_BOARD, "No board.")
    calibration = calibrate_views(damaged).calibration
    assert redetect_view(gone, calibration, SHAPE) is gone


def test_boards_numbered_from_the_wrong_end_are_named() -> None:
    """By the deviations of an estimated board, and where these say nothing by its place."""
    camera, grid_size, turned = scenes.barrel(), Board(6, 9, 30.0), (2, 5)

    def result(deviation: float, board_shape: BoardShapeModel) -> Result:
        made = scenes.uneven(camera, grid_size, 10, deviation, turned)
        views = tuple(
            View(f"{k}.png", ViewStatus.FOUND, points=view) for k, view in enumerate(made)
        )
        settings = Settings(board_shape=board_shape, robust=True)
        return calibrate_twice(CornerSet(camera.size, views), settings)

    found = result(0.3, BoardShapeModel.FREE)
    named = [text for text in found.calibration.warnings if "wrong end" in text]
    assert len(named) == 1
    assert "wrong end in 2.png, 5.png, as its deviations" in named[0]
    for k, view in enumerate(found.views):
        assert (view.note != "") == (k in turned)
    clean = calibrate(scenes.uneven(camera, grid_size, 10, 0.3), camera.size, board_shape="free")
    apart = np.abs(found.calibration.camera.params - clean.camera.params)
    # The variances of the board's deviations are learnt from another first solution.
    assert (apart <= 1e-3 * np.maximum(clean.sigma, 1.0)).all()

    for board_shape in (BoardShapeModel.NOMINAL, BoardShapeModel.FREE):
        named = [
            text for text in result(0.0, board_shape).calibration.warnings if "wrong end" in text
        ]
        assert len(named) == 1
        assert "upside down in 2.png, 5.png" in named[0]


def test_a_lens_model_is_chosen_anew_where_corners_were_gained_only(
    damaged: CornerSet, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Labels do not matter to the camera, and the choice takes long."""
    asked: list[int] = []

    def choose(views: CornerSet, *_: object) -> ChosenLens:
        asked.append(sum(view.usable for view in views.views))
        return ChosenLens("brown-conrady", "It is wanted.")

    monkeypatch.setattr("calibgui.app.calibrating.calibration._choose_lens", choose)
    gained = calibrate_twice(damaged, Settings(model=None))
    assert asked == [5, 6]
    assert gained.calibration.camera.model == "brown-conrady"
    asked.clear()
    camera = scenes.barrel()
    made = scenes.uneven(camera, Board(6, 9, 30.0), 10, 0.3, (2, 5))
    views = tuple(View(f"{k}.png", ViewStatus.FOUND, points=view) for k, view in enumerate(made))
    settings = Settings(model=None, board_shape=BoardShapeModel.FREE)
    turned = calibrate_twice(CornerSet(camera.size, views), settings)
    assert any("wrong end" in text for text in turned.calibration.warnings)
    assert asked == [10]
    for result in (gained, turned):
        assert result.calibration.warnings[0] == "It is wanted."
        assert result.calibration.settings.model_reason == "It is wanted."
