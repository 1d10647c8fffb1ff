"""Interlaced frames are told from others, and named."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.photographs.board_recognition import recognise_pattern
from calibgui.app.photographs.detection import find_views, search_view
from calibgui.app.photographs.interlacing import INTERLACED, is_interlaced
from calibgui.dataset import View
from calibgui.engine.boards.board import Board
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.images.fields import Field
from calibgui.engine.images.reading import write_image
from calibgui.engine.images.rendering import render_view
from tests.engine.conftest import Scene
from tests.photographs import BOARD, CAMERA, draw_poses
from tests.scenes.without_board import KINDS, draw_without_board

SCENE = Scene(Board(6, 9, 25.0), distance=300.0)


@pytest.mark.parametrize("seed", range(6))
def test_a_board_that_moves_between_the_fields_is_told(seed: int) -> None:
    rng = np.random.default_rng(seed)
    direction = rng.uniform(0, 2 * np.pi)
    way = rng.uniform(1.0, 5.0) * np.array([np.cos(direction), np.sin(direction)])
    scene = replace(SCENE, rvec=tuple(rng.normal(0, 0.3, 3)))
    still, moved = scene.image(seed=1), replace(scene, aside=tuple(way)).image(seed=2)
    assert not is_interlaced(still)
    frame = still.copy()
    frame[seed % 2 :: 2] = moved[seed % 2 :: 2]
    assert is_interlaced(frame)


@pytest.mark.parametrize("seed", range(len(KINDS)))
def test_textures_and_noise_are_not_interlaced(seed: int) -> None:
    assert not is_interlaced(draw_without_board(seed))


def test_what_is_too_small_or_even_to_tell_is_not() -> None:
    for shape in ((1, 1), (5, 40), (40, 5), (64, 64)):
        assert not is_interlaced(np.full(shape, 7, np.uint8))


@pytest.mark.parametrize("shift", [0.0, 4.0])
def test_the_view_names_it(shift: float, tmp_path: Path) -> None:
    pose = draw_poses()[0]
    moved = replace(pose, tvec=pose.tvec + np.array([2 * shift, shift, 0.0]))
    fields = [render_view(CAMERA, each, BOARD, blur=0.7, noise=1.0) for each in (pose, moved)]
    frame = fields[0].copy()
    frame[1::2] = fields[1][1::2]
    write_image(tmp_path / "view.png", frame)
    view = search_view(View(str(tmp_path / "view.png")))
    assert (INTERLACED in f"{view.note} {view.reason}") == (shift > 0)


@pytest.mark.parametrize(("field", "first"), [(Field.ODD, 0), (Field.EVEN, 1)])
def test_a_field_is_searched_alone(field: Field, first: int, tmp_path: Path) -> None:
    """Its corners are those of the moment of that field, whatever came before or after."""
    poses = draw_poses()[:2]
    fields = [render_view(CAMERA, each, BOARD, blur=0.7, noise=1.0) for each in poses]
    frame = fields[0].copy()
    frame[1::2] = fields[1][1::2]
    write_image(tmp_path / "view.png", frame)
    found = find_views([tmp_path / "view.png"], field=field)
    (view,) = found.views
    assert view.corners is not None and view.field is field
    assert INTERLACED not in view.note
    expected = project_points(BOARD.points(), CAMERA, poses[first])
    distance = np.linalg.norm(view.corners.uv[:, None] - expected, axis=2).min(axis=1)
    assert distance.max() < 0.15
    assert recognise_pattern(found.views) is None
