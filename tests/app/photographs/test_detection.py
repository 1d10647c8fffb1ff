"""Views from photographs: what is found, and what each kind of bad image becomes."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from threading import Event

import numpy as np
import pytest

from calibgui.app.photographs import detection
from calibgui.app.photographs.detection import Detection, find_views, search_view
from calibgui.app.photographs.paths import find_images
from calibgui.app.photographs.shared_board import infer_grid_size
from calibgui.app.system import workers
from calibgui.dataset import View, ViewStatus
from calibgui.engine.arrays import GridSize, freeze_array
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Pattern, Symmetry
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.features.corners import Corners
from calibgui.engine.images.reading import read_image, write_image
from calibgui.engine.images.rendering import render_view
from tests.engine import scenes
from tests.engine.lattices.test_prefilter import draw_heated
from tests.photographs import BOARD, CAMERA, COUNT, draw_poses
from tests.scenes.troubles import TROUBLES


@pytest.fixture(scope="module")
def spoilt(photographs: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The photographs with every kind of image that cannot be used among them."""
    folder = tmp_path_factory.mktemp("spoilt")
    shutil.copytree(photographs, folder, dirs_exist_ok=True)
    first = (photographs / "view1.png").read_bytes()
    pixels = read_image(photographs / "view1.png").pixels
    (folder / "a-text.png").write_text("no image")
    (folder / "b-truncated.png").write_bytes(first[: len(first) // 2])
    (folder / "c-empty.png").write_bytes(b"")
    write_image(folder / "d-smaller.png", pixels[:200])
    write_image(folder / "e-turned.png", np.ascontiguousarray(pixels.T))
    write_image(folder / "f-blank.png", np.full_like(pixels, 128))
    write_image(folder / "h-larger.png", np.full((480, 640), 99, np.uint8))
    write_image(folder / "g-16bit.png", pixels.astype(np.uint16) * 16)
    return folder


@pytest.fixture(scope="module")
def found(spoilt: Path) -> Detection:
    return find_views(find_images([str(spoilt)]))


def test_every_image_has_a_view_in_the_images_order(spoilt: Path, found: Detection) -> None:
    assert [view.image for view in found.views] == [str(p) for p in find_images([str(spoilt)])]
    assert found.size == CAMERA.size


@pytest.mark.parametrize(
    ("name", "status", "reason"),
    [
        ("a-text", ViewStatus.UNREADABLE, "not an image"),
        ("b-truncated", ViewStatus.UNREADABLE, "cut short"),
        ("c-empty", ViewStatus.UNREADABLE, "empty"),
        ("d-smaller", ViewStatus.WRONG_SIZE, "320 x 200 pixels, most have 320 x 240"),
        ("e-turned", ViewStatus.WRONG_SIZE, "as the camera wrote it"),
        ("h-larger", ViewStatus.WRONG_SIZE, "640 x 480 pixels, most have 320 x 240"),
        ("f-blank", ViewStatus.NO_BOARD, "No checkerboard"),
    ],
)
def test_a_bad_image_is_named_with_the_reason(
    found: Detection, name: str, status: ViewStatus, reason: str
) -> None:
    (view,) = (view for view in found.views if Path(view.image).stem == name)
    assert view.status is status
    assert reason in view.reason
    assert not view.usable and view.corners is None


def test_the_board_is_inferred_and_its_corners_are_right(found: Detection) -> None:
    assert found.grid_size == (BOARD.rows, BOARD.cols)
    views = {Path(view.image).stem: view for view in found.views}
    for number, pose in enumerate(draw_poses(), start=1):
        view = views[f"view{number}"]
        assert view.corners is not None and view.corners.complete
        expected = project_points(BOARD.points(), CAMERA, pose)
        distance = np.linalg.norm(view.corners.uv[:, None] - expected, axis=2).min(axis=1)
        assert distance.max() < 0.15


def test_sixteen_bits_give_the_same_corners(found: Detection) -> None:
    views = {Path(view.image).stem: view.corners for view in found.views}
    fine, coarse = views["g-16bit"], views["view1"]
    assert fine is not None and coarse is not None
    np.testing.assert_allclose(fine.uv, coarse.uv, atol=1e-3)


def test_the_size_is_that_of_the_photographs_that_show_the_board(
    photographs: Path, tmp_path: Path
) -> None:
    """Those of another size are more: depth maps, and some photographs of another camera."""
    for k in (1, 2, 3):
        shutil.copy(photographs / f"view{k}.png", tmp_path)
    for k in (4, 5):
        larger = np.kron(read_image(photographs / f"view{k}.png").pixels, np.ones((2, 2), np.uint8))
        write_image(tmp_path / f"larger{k}.png", larger)
    for k in range(4):
        write_image(tmp_path / f"depth{k}.png", np.full((480, 640), 128, np.uint8))
    told: list[tuple[int, int]] = []
    with workers.do_tasks_here():
        found = find_views(
            find_images([str(tmp_path)]), progress=lambda done, total, _: told.append((done, total))
        )
    assert found.size == CAMERA.size
    assert told[:10] == [*((k, 6) for k in range(1, 7)), *((k, 9) for k in range(6, 10))]
    for view in found.views:
        if view.name.startswith("view"):
            assert view.status is ViewStatus.FOUND
        else:
            assert view.status is ViewStatus.WRONG_SIZE and view.corners is None
            assert view.reason.startswith("640 x 480 pixels, others have 320 x 240.")


def test_where_no_image_shows_the_board_the_most_frequent_size_counts(tmp_path: Path) -> None:
    """All of them are searched: another board may be in any."""
    for k, width in enumerate((64, 80, 80)):
        write_image(tmp_path / f"{k}.png", np.full((60, width), 128, np.uint8))
    with workers.do_tasks_here():
        found = find_views(find_images([str(tmp_path)]))
    assert found.size == (80, 60)
    assert [view.status for view in found.views] == [ViewStatus.NO_BOARD] * 3


def test_progress_counts_every_search(photographs: Path) -> None:
    told: list[tuple[int, int, str]] = []
    images = find_images([str(photographs)])
    find_views(
        images,
        (BOARD.rows, BOARD.cols),
        progress=lambda done, total, view: told.append((done, total, view.image)),
    )
    assert [(done, total) for done, total, _ in told] == [(k, COUNT) for k in range(1, COUNT + 1)]
    assert sorted(image for *_, image in told) == [str(path) for path in images]


def test_a_set_event_abandons_the_search(photographs: Path) -> None:
    stop = Event()
    stop.set()
    with pytest.raises(Cancelled):
        find_views(find_images([str(photographs)]), stop=stop)


def test_a_region_shows_which_of_two_boards_is_meant(photographs: Path, tmp_path: Path) -> None:
    left, right = (read_image(photographs / f"view{k}.png").pixels for k in (1, 2))
    write_image(tmp_path / "two.png", np.hstack([left, right]))
    width = CAMERA.size[0]
    corners = project_points(BOARD.points(), CAMERA, draw_poses()[1]).reshape(
        BOARD.rows, BOARD.cols, 2
    )
    region = corners[[0, 0, -1, -1], [0, -1, -1, 0]] + [width, 0]
    view = search_view(View(str(tmp_path / "two.png"), roi=freeze_array(region)), (6, 7))
    assert view.corners is not None
    assert (view.corners.uv[:, 0] > width).all()


def corners(shape: tuple[int, int], count: int) -> View:
    grid = np.indices(shape).reshape(2, -1).T[:count]
    found = Corners(shape, grid, grid * 10.0, grid * 10.0, ambiguity=Symmetry.NONE)
    return View("x.png", ViewStatus.FOUND, corners=found)


def test_the_usual_board_is_the_most_frequent_complete_one() -> None:
    whole, part, larger = corners((6, 7), 42), corners((5, 7), 30), corners((7, 8), 56)
    assert infer_grid_size([part, part, part, whole, larger, whole]) == (6, 7)
    assert infer_grid_size([whole, larger]) == (7, 8)
    assert infer_grid_size([part, View("blank.png", ViewStatus.NO_BOARD)]) is None


def test_larger_parts_in_more_pictures_belie_a_smaller_board() -> None:
    """The image's dark edge hides the last column of one board, and a corner of the others."""
    whole, part, turned = corners((6, 7), 42), corners((6, 8), 47), corners((8, 5), 40)
    assert infer_grid_size([whole, part, part]) is None
    assert infer_grid_size([whole, part, turned]) is None
    assert infer_grid_size([whole, whole, part, part]) == (6, 7)
    assert infer_grid_size([whole, corners((7, 6), 40), corners((7, 5), 30)]) == (6, 7)
    larger = corners((8, 9), 72)
    assert infer_grid_size([whole, whole, larger, part, part]) == (8, 9)


def test_a_grid_of_circles_tells_its_size_though_one_is_covered() -> None:
    seen = corners((6, 7), 41)
    assert seen.corners is not None
    circles = replace(seen.corners, pattern=Circles(diameter=0.5))
    view = replace(seen, corners=circles)
    assert infer_grid_size([view]) == (6, 7)
    assert infer_grid_size([replace(view, corners=replace(circles, relative=True))]) is None


def test_a_partly_seen_board_is_counted_on_the_usual_one(photographs: Path, tmp_path: Path) -> None:
    shutil.copytree(photographs, tmp_path, dirs_exist_ok=True)
    # The right-most column of the first view is outside the image.
    pixels = read_image(photographs / "view1.png").pixels
    uv = project_points(BOARD.points(), CAMERA, draw_poses()[0]).reshape(BOARD.rows, BOARD.cols, 2)
    shift = CAMERA.size[0] - int(uv[:, -2, 0].max()) - 8
    moved = np.roll(pixels, shift, axis=1)
    moved[:, :shift] = pixels[:, :1].mean()
    write_image(tmp_path / "view1.png", moved)
    with workers.do_tasks_here():
        found = find_views(find_images([str(tmp_path)]))
    view = found.views[0]
    assert found.grid_size == (6, 7)
    assert view.corners is not None
    assert view.corners.shape == (6, 7) and not view.corners.complete


@pytest.mark.parametrize(("count", "grid_size"), [(3, (6, 7)), (2, None)])
def test_a_part_that_many_pictures_share_counts_as_the_board(
    count: int, grid_size: tuple[int, int] | None, photographs: Path, tmp_path: Path
) -> None:
    """A grey patch covers a corner in the middle of each."""
    middle = BOARD.points().reshape(BOARD.rows, BOARD.cols, -1)[2, 3]
    for k, pose in enumerate(draw_poses()[:count]):
        pixels = read_image(photographs / f"view{k + 1}.png").pixels.copy()
        u, v = np.rint(project_points(middle[None], CAMERA, pose)[0]).astype(int)
        pixels[v - 9 : v + 10, u - 9 : u + 10] = 120
        write_image(tmp_path / f"view{k}.png", pixels)
    with workers.do_tasks_here():
        found = find_views(find_images([str(tmp_path)]))
    parts = [view.corners for view in found.views if view.corners is not None]
    assert len(parts) == count and not any(corners.complete for corners in parts)
    assert found.grid_size == grid_size
    assert found.remark == (
        "No picture shows every corner of the board. It counts as 6 x 7, the largest part seen, "
        "which several pictures share; state its size if it has more."
        if grid_size
        else ""
    )


def test_a_crash_is_the_images_own(photographs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def spread(_: object, items: list[View], *__: object) -> list[tuple[int, object]]:
        return [(k, workers.Crashed()) for k in range(len(items))]

    monkeypatch.setattr(detection, "map_in_processes", spread)
    found = find_views(find_images([str(photographs)]))
    assert {view.status for view in found.views} == {ViewStatus.UNREADABLE}
    assert {view.reason for view in found.views} == {
        "The process that searched it died. Search it again, or leave it out."
    }
    assert found.grid_size is None


def test_no_readable_image_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_text("no image")
    found = find_views(find_images([str(tmp_path)]))
    with pytest.raises(CalibrationError, match="None of the files"):
        found.corner_set(30.0)


def test_a_file_that_ends_in_zeros_is_pointed_out(photographs: Path, tmp_path: Path) -> None:
    """The board may be seen all the same, in what was copied."""
    pixels = read_image(photographs / "view1.png").pixels
    black = np.zeros((240, pixels.shape[1]), np.uint8)
    write_image(tmp_path / "seen.pgm", np.concatenate([pixels, black]))
    write_image(tmp_path / "cut.pgm", np.concatenate([pixels[:10], black, black]))
    seen = search_view(View(str(tmp_path / "seen.pgm")))
    assert seen.status is ViewStatus.FOUND
    assert seen.note.startswith("The last 50 % of the file are zeros: if the photograph is not")
    cut = search_view(View(str(tmp_path / "cut.pgm")))
    assert cut.status is ViewStatus.NO_BOARD
    assert "The last 98 % of the file are zeros" in cut.reason


@pytest.mark.parametrize(
    ("pattern", "points", "remedy"),
    [
        (CHECKERBOARD, "inner corners", "else count its inner corners."),
        (Circles(), "circles", "take pictures that show its whole border"),
    ],
)
def test_parts_alone_do_not_tell_the_size(pattern: Pattern, points: str, remedy: str) -> None:
    """Two pictures that each show a part of the board."""
    views = []
    for rows, cols in ((4, 7), (5, 6)):
        grid = np.argwhere(np.ones((rows, cols), dtype=np.bool_))[1:]
        uv = 20.0 * grid[:, ::-1] + 50
        corners = Corners((rows, cols), grid, uv, uv)
        views.append(View(f"{rows}.png", ViewStatus.FOUND, corners=corners))
    with pytest.raises(CalibrationError, match=f"largest part seen has 5 x 7 {points}") as caught:
        Detection(tuple(views), (640, 480), None, pattern).corner_set(30.0)
    assert remedy in caught.value.hint
    assert Detection(tuple(views), (640, 480), (5, 7)).corner_set(30.0).board == Board(5, 7, 30.0)


def test_a_board_cut_at_a_crease_is_pointed_out(tmp_path: Path) -> None:
    path = tmp_path / "corner.png"
    write_image(path, TROUBLES["crease"](1).image)
    view = search_view(View(str(path)))
    assert "cut where two boards seem to meet" in view.note
    assert search_view(view).note == view.note


@pytest.mark.parametrize(
    ("kinds", "grid_size", "usable"),
    [
        (["cut", "cut"], None, 2),
        (["tight", "tight"], None, 2),
        (["tight", "tight", "tight"], (4, 5), 3),
        (["cut", "cut", "tight", "whole"], (4, 5), 4),
    ],
)
def test_a_grid_of_circles_that_its_picture_may_cut_does_not_tell_the_size(
    kinds: list[str], grid_size: GridSize | None, usable: int, tmp_path: Path
) -> None:
    """The last column, or the one that would be next, is outside of the picture; once others tell
    the size, the place of the columns that are seen is known."""
    v, u = np.indices((240, 320))
    ends = {"whole": 5, "tight": 5, "cut": 4}
    for k, kind in enumerate(kinds):
        left = 80 if kind == "whole" else 330 - 36 * ends[kind]
        pixels = np.full((240, 320), 220.0)
        for m, n in np.ndindex(4, 5):
            distance = np.hypot(u - left - 36 * n, v - 60 - 36 * m)
            pixels -= 180 * np.clip(9.3 - distance, 0, 1)
        write_image(tmp_path / f"{k}.png", pixels.astype(np.uint8))
    with workers.do_tasks_here():
        found = find_views(find_images([str(tmp_path)]), pattern=Circles())
    assert found.grid_size == grid_size
    assert sum(view.usable for view in found.views) == usable
    if grid_size is None:
        with pytest.raises(CalibrationError, match="No picture shows where the grid ends on all"):
            found.corner_set(30.0)
        return
    assert not any(view.note or (view.corners and view.corners.relative) for view in found.views)
    assert found.corner_set(30.0).board is not None
    assert bool(found.remark) == ("whole" not in kinds)


@pytest.mark.parametrize("stated", [None, (6, 8)])
def test_the_first_tag_that_most_photographs_tell_is_that_of_all(
    stated: GridSize | None, tmp_path: Path
) -> None:
    """One photograph shows the upper two rows of tags only, which do not tell it."""
    board = Board(6, 8, 25.0, AprilGrid("t36h11", 0.3, 2, False, True, 24))
    rng = np.random.default_rng(5)
    poses = [scenes.looking(CAMERA, rng, fill=(0.5, 0.6), board=board) for _ in range(3)]
    for k, pose in enumerate(poses):
        image = render_view(CAMERA, pose, board, blur=0.6, noise=1.0, seed=k)
        if k == 2:
            uv = project_points(board.points(), CAMERA, pose)
            image = image[: int(uv[4 * 8 :, 1].min())]
            image = np.pad(image, ((0, CAMERA.size[1] - len(image)), (0, 0)), mode="edge")
        write_image(tmp_path / f"view{k}.png", image)
    with workers.do_tasks_here():
        found = find_views(find_images([str(tmp_path)]), stated, pattern=AprilGrid())
    assert found.grid_size == (6, 8)
    assert isinstance(found.pattern, AprilGrid)
    assert found.pattern.first_tag == 24
    for k, view in enumerate(found.views):
        assert view.corners is not None
        uv = project_points(board.points(view.corners.grid), CAMERA, poses[k])
        assert np.abs(view.corners.uv - uv).max() < 0.5


def test_a_size_that_other_photographs_show_overrules_uneven_squares(tmp_path: Path) -> None:
    """By itself the first is refused, as its squares differ in size like printed dots."""
    images = []
    for seed in (0, 1, 3, 4):
        images.append(tmp_path / f"{seed}.png")
        write_image(images[-1], draw_heated(seed)[0])
    assert search_view(View(str(images[0]))).status is ViewStatus.NO_BOARD
    found = find_views(images)
    assert found.grid_size == (6, 8)
    assert [view.status for view in found.views] == [ViewStatus.FOUND] * 4
