"""The drawn scene against poses and perspective worked out directly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from calibgui import engine
from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.features.corners import Corners
from calibgui.report.rig import tabulate_boards
from calibgui.report.scene3d import (
    Observer,
    PolygonKind,
    SceneCentre,
    build_rig_scene,
    build_scene,
    draw_scene,
    find_view_at,
    fit_zoom,
    make_axes,
    project_into_scene,
    project_to_plane,
)
from tests.engine import scenes
from tests.formats.rigs import make_result_of_boards

observers = st.builds(Observer, st.floats(-3, 3), st.floats(-1.5, 1.5), st.floats(0.5, 2.0))


@pytest.fixture(scope="module")
def result() -> Result:
    seen = scenes.scene(scenes.barrel(), 6, seed=2)
    grid_size = scenes.BOARD
    grid = np.indices((grid_size.rows, grid_size.cols)).reshape(2, -1).T
    shape = (grid_size.rows, grid_size.cols)
    views = tuple(
        View(f"{k}.png", ViewStatus.FOUND, corners=Corners(shape, grid, v.uv, v.uv))
        for k, v in enumerate(seen.views)
    )
    return Result(engine.calibrate(seen.views, seen.size), views, grid_size)


def test_boards_stand_where_their_poses_say(result: Result) -> None:
    boards = [p for p in build_scene(result, SceneCentre.CAMERA) if p.kind is PolygonKind.BOARD]
    assert [p.view for p in boards] == list(range(6))
    pose, side = result.calibration.poses[4], 30.0
    R = Rotation.from_rotvec(np.array(pose.rvec)).as_matrix()
    outer = np.array([12 * side, 9 * side, 0.0])
    np.testing.assert_allclose(boards[4].points[0], R @ [-side, -side, 0] + pose.tvec)
    np.testing.assert_allclose(boards[4].points[2], R @ outer + pose.tvec)


def test_cameras_stand_at_their_centres(result: Result) -> None:
    sides = [p for p in build_scene(result, SceneCentre.BOARD) if p.kind is PolygonKind.CAMERA]
    assert {p.view for p in sides} == set(range(6))
    pose = result.calibration.poses[3]
    R = Rotation.from_rotvec(np.array(pose.rvec)).as_matrix()
    apexes = [p.points[0] for p in sides if p.view == 3 and len(p.points) == 3]
    np.testing.assert_allclose(apexes, np.tile(-R.T @ pose.tvec, (4, 1)), atol=1e-9)


def test_unknown_target_is_outlined_by_its_corners(result: Result) -> None:
    points = tuple(
        View(v.image, v.status, points=v.observation(scenes.BOARD)) for v in result.views
    )
    grid_size = build_scene(Result(result.calibration, points), SceneCentre.BOARD)[0]
    assert grid_size.points.max(axis=0).tolist() == [330.0, 240.0, 0.0]
    assert grid_size.points.min(axis=0).tolist() == [0.0, 0.0, 0.0]


@given(observer=observers)
def test_everything_fits_and_is_painted_back_to_front(result: Result, observer: Observer) -> None:
    polygons = build_scene(result, SceneCentre.CAMERA)
    drawn = draw_scene(polygons, observer)
    assert len(drawn) == len(polygons)
    assert all(np.linalg.norm(d.points, axis=1).max() <= observer.zoom * (1 + 1e-9) for d in drawn)
    depths = [d.depth for d in drawn]
    assert depths == sorted(depths, reverse=True)


@given(observer=observers)
def test_a_fitted_scene_fills_the_square(result: Result, observer: Observer) -> None:
    polygons = build_scene(result, SceneCentre.BOARD)
    there = fit_zoom(polygons, observer)
    assert (there.azimuth, there.elevation) == (observer.azimuth, observer.elevation)
    axes = [project_into_scene(polygons, a.points, there)[0] for a in make_axes(polygons)]
    drawn = [d.points for d in draw_scene(polygons, there)]
    assert max(np.abs(points).max() for points in (*drawn, *axes)) == pytest.approx(1.0)


def test_straight_ahead_is_the_cameras_own_view() -> None:
    """From behind, unturned: x to the right, y down, the nearer the larger."""
    points, depth = project_to_plane(
        np.array([[0.5, 0, -0.5], [0.5, 0, 0.5], [0, 0.5, 0]]), Observer(0, 0)
    )
    assert points[0, 0] > points[1, 0] > 0 and depth[0] < depth[1]
    assert points[2, 0] == 0 and points[2, 1] > 0


def test_dragging_to_the_right_turns_the_near_side_to_the_right() -> None:
    near = np.array([[0.0, 0.0, -1.0]])
    before, _ = project_to_plane(near, Observer(0, 0))
    after, _ = project_to_plane(near, Observer(0, 0).turned(0.3, 0.0))
    assert after[0, 0] > before[0, 0]
    lowered, _ = project_to_plane(near, Observer(0, 0).turned(0.0, 0.3))
    assert lowered[0, 1] > before[0, 1]


def test_from_above_what_is_up_is_near() -> None:
    """Positive elevation looks down on the scene: -Y is up in the camera's frame."""
    _, depth = project_to_plane(np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]), Observer(0, 0.5))
    assert depth[0] < depth[1]


def test_zoom_and_elevation_are_bounded() -> None:
    assert Observer().zoomed(1e9).zoom == 20.0
    assert Observer().turned(0.0, 100.0).elevation == pytest.approx(np.pi / 2)


def test_the_nearest_board_under_a_point_is_found(result: Result) -> None:
    drawn = draw_scene(build_scene(result, SceneCentre.CAMERA), Observer())
    nearest = [d for d in drawn if d.polygon.view >= 0][-1]
    assert find_view_at(drawn, nearest.points.mean(axis=0)) == nearest.polygon.view
    assert find_view_at(drawn, np.array([5.0, 5.0])) == -1


def test_axes_measure_the_scene(result: Result) -> None:
    polygons = build_scene(result, SceneCentre.CAMERA)
    reach = np.concatenate([p.points for p in polygons]).max(axis=0)
    axes = make_axes(polygons)
    assert [axis.name for axis in axes] == ["X", "Y", "Z"]
    step = axes[0].numbers[1]
    assert f"{step:.0e}"[0] in "125"
    assert 2 <= reach.max() / step <= 4
    for k, axis in enumerate(axes):
        np.testing.assert_allclose(np.diff(axis.numbers), step)
        np.testing.assert_array_equal(axis.points[:, k], axis.numbers)
        assert not np.delete(axis.points, k, axis=1).any()
        assert axis.numbers[-1] <= max(reach[k], step) < axis.numbers[-1] + step + 1e-9


def test_points_fall_where_the_polygons_they_belong_to_are_drawn(result: Result) -> None:
    polygons, observer = build_scene(result, SceneCentre.BOARD), Observer(0.3, -0.2, 1.4)
    for item in draw_scene(polygons, observer):
        points, depth = project_into_scene(polygons, item.polygon.points, observer)
        np.testing.assert_allclose(points, item.points, atol=1e-12)
        assert np.isclose(depth.mean(), item.depth)


def test_a_rig_is_drawn_with_every_board_where_it_is() -> None:
    result = make_result_of_boards()
    rig = result.rig
    polygons = [each for each in build_rig_scene(result) if each.kind is PolygonKind.BOARD]
    assert len(polygons) == len({(view.instant, view.board) for view in rig.views})
    by_instant = [[each for each in polygons if each.view == k] for k in range(len(rig.instants))]
    first, second = by_instant[0]
    # Both are rectangles as large as the corners, and as far apart as the boards.
    for each in (first, second):
        sides = np.linalg.norm(np.diff(each.points, axis=0), axis=1)
        np.testing.assert_allclose(sides[:2], [270.0, 180.0])
    apart = np.linalg.norm(second.points[0] - first.points[0])
    assert apart == pytest.approx(np.linalg.norm(rig.placed_boards[1].pose.tvec))


def test_boards_of_a_rig_are_tabulated() -> None:
    text = tabulate_boards(make_result_of_boards())
    assert "board 2  board 1  mm" in text
    assert text.count("±") == 6
    assert "Board 1 deviates from its drawing by" in text
    rig = make_result_of_boards().rig
    apart = tuple(
        replace(board, reference=b, shape=None) for b, board in enumerate(rig.placed_boards)
    )
    result = replace(make_result_of_boards(), rig=replace(rig, placed_boards=apart))
    assert "Where board 2 stands beside board 1 is open" in " ".join(
        tabulate_boards(result).split()
    )
