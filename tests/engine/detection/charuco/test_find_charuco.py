"""ChArUco boards against rendered truth and against OpenCV's own drawing of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.engine import opencv
from calibgui.engine.arrays import GreyImage
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.charuco import Charuco, MarkerLayout
from calibgui.engine.boards.pattern import Symmetry
from calibgui.engine.boards.printed_pattern import PrintedRectangles
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera.camera import Camera
from calibgui.engine.detection.charuco.markers import identify_board
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError, MirroredError, NoBoardError
from calibgui.engine.features.corners import Corners
from calibgui.engine.images.reading import read_image
from tests.engine.conftest import Scene
from tests.scenes.perspective import photograph_pattern
from tests.scenes.without_board import draw_without_board

BOARDS = [
    (Charuco("DICT_4X4_50", 0.75, False), (5, 8)),
    (Charuco("DICT_5X5_100", 0.5, True), (5, 8)),
    (Charuco("DICT_6X6_250", 0.7, False), (6, 6)),
]


@pytest.mark.parametrize(("pattern", "grid_size"), BOARDS)
@pytest.mark.parametrize("known", [True, False], ids=["stated", "inferred"])
def test_located_to_the_bound_and_identified(
    pattern: Charuco, grid_size: tuple[int, int], known: bool
) -> None:
    scene = Scene(Board(*grid_size, 20.0, pattern))
    corners = find_corners(
        scene.image(), grid_size if known else None, pattern=(pattern if known else Charuco())
    )
    assert corners.shape == grid_size
    assert corners.complete
    assert corners.ambiguity is Symmetry.NONE
    error = scene.error(corners)
    assert np.sqrt(np.mean(error**2)) < 0.006
    assert corners.cov is not None
    chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error)
    assert 0.5 < chi2.mean() / 2 < 1.6  # of 72 to 80 residuals
    seen = corners.pattern
    assert isinstance(seen, Charuco)
    assert str(seen.dictionary).startswith(str(pattern.dictionary)[:9])
    assert seen.legacy == pattern.legacy
    assert seen.marker == pytest.approx(pattern.marker, abs=0.03)


_CAMERA = Camera((640, 480), [560.0, 562.0, 322.0, 238.0, 0.1, 0.02, 0.0, 1e-4, 0.0, 0.0])
_WHITE_FIRST = Scene(
    Board(5, 8, 30.0, Charuco("DICT_4X4_100", 0.65, True)), _CAMERA, (0.2, -0.2, 0.1), 330.0
)


def _count_by_opencv(image: GreyImage, board: Board) -> int:
    """The corners that OpenCV finds, told everything of the board."""
    pattern = board.pattern
    assert isinstance(pattern, Charuco)
    assert pattern.dictionary is not None
    dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, pattern.dictionary))
    size = board.cols + 1, board.rows + 1
    drawn = cv2.aruco.CharucoBoard(size, 1.0, float(pattern.marker or 0), dictionary)
    drawn.setLegacyPattern(bool(pattern.legacy))
    _, ids, *_ = cv2.aruco.CharucoDetector(drawn).detectBoard(image)
    return 0 if ids is None else len(ids)


def _assert_right(scene: Scene, corners: Corners) -> None:
    assert corners.shape[1] == scene.board.cols
    assert np.abs(scene.error(corners)).max() < 0.3


@pytest.mark.parametrize("pattern", [BOARDS[0][0], _WHITE_FIRST.board.pattern])
def test_printed_bright_on_dark(pattern: Charuco) -> None:
    scene = replace(_WHITE_FIRST, board=Board(5, 8, 30.0, pattern))
    image = 255 - scene.image()
    corners = find_corners(image, pattern=Charuco())
    assert corners.complete
    assert np.sqrt(np.mean(scene.error(corners) ** 2)) < 0.02
    stated = find_corners(image, (5, 8), pattern=pattern)
    np.testing.assert_array_equal(stated.uv, corners.uv)
    with pytest.raises(NoBoardError, match="DICT_4X4"):
        find_corners(image, pattern=Charuco("DICT_6X6_50"))


@pytest.mark.parametrize(
    "aside", [(150.0, 0.0), (-150.0, 0.0), (0.0, 110.0), (0.0, -110.0)], ids=str
)
def test_cut_by_the_image_with_a_white_square_first(aside: tuple[float, float]) -> None:
    scene = replace(_WHITE_FIRST, aside=aside)
    image = scene.image()
    corners = find_corners(image, pattern=Charuco())
    assert len(corners) < len(scene.board.points())
    assert len(corners) >= _count_by_opencv(image, scene.board) >= 15
    _assert_right(scene, corners)


@pytest.mark.parametrize("rows", [5, 6])
@pytest.mark.parametrize("first_dark", [True, False])
def test_without_its_sides_a_board_is_not_numbered_by_guess(first_dark: bool, rows: int) -> None:
    """With an odd number of squares a row nothing but its ends tells the colours apart. An
    even number of rows, which a board with a white square first has, says nothing."""
    pattern = replace(BOARDS[0][0], legacy=not first_dark)
    scene = replace(_WHITE_FIRST, board=Board(5, 8, 30.0, pattern))
    u = (scene.board.points([(0, 1), (0, 6)])[:, 0] - scene.board.points()[:, 0].mean()) * 1.72
    image = scene.image()
    image[:, : round(322 + u[0])] = image[:, round(322 + u[1]) :] = 128
    if rows < 6:
        image[352:] = 128
    with pytest.raises(NoBoardError, match="do not tell which part"):
        find_corners(image, pattern=Charuco("DICT_4X4_100"))
    _assert_right(scene, find_corners(image, (5, 8), pattern=pattern))


def test_two_rows_of_squares_do_not_tell_how_long_they_are() -> None:
    scene = replace(_WHITE_FIRST, board=Board(5, 8, 30.0, BOARDS[0][0]))
    image = scene.image()
    image[:180] = image[300:] = 128
    image[:, :185] = image[:, 405:] = 128
    with pytest.raises(NoBoardError, match="how many squares"):
        find_corners(image, pattern=Charuco())
    _assert_right(scene, find_corners(image, (5, 8), pattern=BOARDS[0][0]))


def test_a_size_stated_without_the_dictionary_may_hold_more_markers_than_its_smallest() -> None:
    board = Board(8, 11, 1.0, Charuco("DICT_4X4_100", 0.7, False))
    image = photograph_pattern((1000, 750), board, 0.9, 0.8)
    corners = find_corners(image, (8, 11), pattern=Charuco())
    assert corners.complete
    assert isinstance(corners.pattern, Charuco)
    assert corners.pattern.dictionary == "DICT_4X4_100"


@pytest.mark.parametrize(("blur", "distance"), [(0.7, 760.0), (0.7, 400.0), (2.0, 400.0)])
def test_markers_do_not_pass_for_spread_ink(blur: float, distance: float) -> None:
    """They are in all white squares alike, and their blur reaches the profiles across the edges."""
    board = Board(5, 8, 30.0, Charuco("DICT_4X4_50", 0.75, False))
    chi2 = []
    for seed in range(2):
        scene = Scene(board, _CAMERA, (0.2 + 0.1 * seed, -0.2, 0.1), distance)
        corners = find_corners(scene.image(blur, seed=seed), pattern=Charuco())
        assert len(corners) >= 35
        assert corners.cov is not None
        error = scene.error(corners)
        chi2.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2)
        # With spread ink that is none the edges are described badly.
        assert np.median(corners.residual) < 2.0 + 3.0 * blur
    assert 0.7 < np.mean(np.concatenate(chi2)) < 1.3  # of 140 to 160 residuals


@pytest.mark.parametrize("family", ["16H5", "25H9", "36H10"])
def test_markers_of_any_family_of_apriltags_are_read_unstated(family: str) -> None:
    pattern = Charuco(f"DICT_APRILTAG_{family}", 0.75, False)
    scene = replace(_WHITE_FIRST, board=Board(5, 8, 30.0, pattern))
    corners = find_corners(scene.image(), pattern=Charuco())
    assert corners.complete
    assert isinstance(corners.pattern, Charuco)
    assert corners.pattern.dictionary == pattern.dictionary
    _assert_right(scene, corners)


@pytest.mark.parametrize("is_inverted", [False, True])
@pytest.mark.parametrize(
    ("pattern", "size"),
    [(Charuco(), None), (Charuco(), (5, 8)), (_WHITE_FIRST.board.pattern, (5, 8))],
)
def test_a_mirrored_board_is_told(
    pattern: Charuco, size: tuple[int, int] | None, is_inverted: bool
) -> None:
    image = _WHITE_FIRST.image()[:, ::-1]
    with pytest.raises(MirroredError, match="left is right"):
        find_corners(255 - image if is_inverted else image, size, pattern=pattern)


def _draw_numbered(size: tuple[int, int], first: int, is_legacy: bool = False) -> GreyImage:
    """Draw a board of inner corners of 50 px whose markers are numbered from another than 0."""
    rows, cols = size[0] + 1, size[1] + 1
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_250)
    numbers = first + np.arange(rows * cols // 2)
    drawn = cv2.aruco.CharucoBoard((cols, rows), 1.0, 0.72, dictionary, numbers)
    drawn.setLegacyPattern(is_legacy)
    image = drawn.generateImage((50 * cols + 80, 50 * rows + 80), marginSize=40)
    return cv2.GaussianBlur(image, (0, 0), 0.8)


@pytest.mark.parametrize("first", [24, 29])
@pytest.mark.parametrize(
    ("size", "is_legacy"), [((5, 7), False), ((5, 7), True), ((5, 6), False), ((5, 6), True)]
)
@pytest.mark.parametrize("is_stated", [False, True])
def test_numbers_that_do_not_begin_with_0(
    size: tuple[int, int], is_legacy: bool, first: int, is_stated: bool
) -> None:
    """Several boards of one dictionary are made so; OpenCV is told the numbers."""
    image = _draw_numbered(size, first, is_legacy)
    pattern = Charuco("DICT_4X4_250", 0.72, is_legacy) if is_stated else Charuco()
    corners = find_corners(image, size, pattern=pattern)
    assert corners.complete
    np.testing.assert_allclose(corners.uv, 89.5 + 50.0 * corners.grid[:, ::-1], atol=0.05)
    assert corners.remark == f"The board's markers are numbered from {first} on."


def test_a_part_that_may_begin_with_several_numbers_is_named() -> None:
    image = _draw_numbered((5, 7), 24)
    image[:180] = 255
    with pytest.raises(NoBoardError, match=r"36 to 47; .* 5 x 7 .* 0 to 23"):
        find_corners(image, (5, 7), pattern=Charuco())
    corners = find_corners(_draw_numbered((5, 7), 24), pattern=Charuco())  # as the hint says
    assert len(corners) == 35
    with pytest.raises(NoBoardError, match="exactly 7 columns"):
        find_corners(_draw_numbered((5, 7), 24), (5, 6), pattern=Charuco())


def test_dim_pictures_are_read() -> None:
    image = _WHITE_FIRST.image(noise=0.0) / 12 + 5
    image += np.random.default_rng(0).normal(0, 0.7, image.shape)
    corners = find_corners(np.rint(image).astype(np.uint8), pattern=Charuco())
    assert corners.complete
    _assert_right(_WHITE_FIRST, corners)


def test_far_markers_tell_layouts_apart_that_near_ones_do_not() -> None:
    """Marker 22 stands in the first square of row 5 if the first square is dark, in the last of
    row 4 if it is white; no marker near it was read."""
    layouts = [MarkerLayout(9, first_dark) for first_dark in (True, False)]
    numbers = np.array([10, 11, 15, 16, 22])
    corner = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    centres = 40.0 * layouts[0].locate_squares(numbers)[:, ::-1]
    corners = centres[:, None] + 13 * corner
    (board,) = identify_board(numbers, corners, layouts, layouts)
    assert board.layout == layouts[0]
    assert len(identify_board(numbers[:4], corners[:4], layouts, layouts)) == 2


@pytest.mark.parametrize(("pattern", "grid_size"), BOARDS)
def test_drawn_as_opencv_draws_it(pattern: Charuco, grid_size: tuple[int, int]) -> None:
    assert pattern.dictionary is not None
    assert pattern.marker is not None
    rows, cols = grid_size[0] + 1, grid_size[1] + 1
    dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, pattern.dictionary))
    drawn = cv2.aruco.CharucoBoard((cols, rows), 1.0, pattern.marker, dictionary)
    drawn.setLegacyPattern(bool(pattern.legacy))
    side = 160
    image = drawn.generateImage((cols * side, rows * side))
    ink = pattern.draw(grid_size)
    assert isinstance(ink, PrintedRectangles)
    x, y = (
        np.searchsorted(lines, (np.arange(n * side) + 0.5) / side - 1) - 1
        for lines, n in ((ink.x, cols), (ink.y, rows))
    )
    mine = np.where(ink.dark[np.ix_(y, x)], 0, 255)
    assert np.mean(mine != image) < 0.01  # lines between cells fall within a pixel
    found = find_corners(np.pad(image, 100, constant_values=255), None, pattern=Charuco())
    assert found.shape == grid_size
    assert found.complete
    places = np.array([(100, 100)]) + side * (found.grid[:, ::-1] + 1) - 0.5
    assert np.abs(found.uv - places).max() < 0.1


def test_parts_hidden_and_outside() -> None:
    pattern, grid_size = BOARDS[0]
    scene = Scene(Board(*grid_size, 20.0, pattern), aside=(70.0, 30.0))
    image = scene.image()
    image[300:430, 480:640] = 128
    corners = find_corners(image, None, pattern=Charuco())
    assert not corners.complete
    assert len(corners) > 10
    assert np.abs(scene.error(corners)).max() < 0.03
    known = find_corners(image, grid_size, pattern=pattern)
    assert known.shape == grid_size
    np.testing.assert_array_equal(known.uv, corners.uv)


_FISHEYE = Camera((640, 480), [210.0, 210.0, 321.0, 239.0, 0.05, -0.01, 0.0, 0.0], "kannala-brandt")


def test_a_fisheye_near_the_board() -> None:
    """Markers change their size by a third from one to the next."""
    board = Board(7, 10, 26.0, Charuco("DICT_4X4_50", 0.75, False))
    scene = Scene(board, _FISHEYE, (0.3, -0.2, 0.2), 90.0)
    corners = find_corners(scene.image(), pattern=Charuco())
    assert corners.complete
    assert np.abs(scene.error(corners)).max() < 0.1
    seen = corners.pattern
    assert isinstance(seen, Charuco)
    assert seen.marker == pytest.approx(0.75, abs=0.05)


def test_corners_too_slanted_to_be_seen_do_not_tell_where_a_board_ends() -> None:
    """Of its first column, at the edge of a fisheye's image, two corners are seen and four not."""
    lens = [210.0, 210.0, 319.5, 239.5, 0.02, -0.01, 0.0, 0.0]
    scene = Scene(
        Board(7, 10, 26.0, Charuco("DICT_4X4_50", 0.75, False)),
        Camera((640, 480), lens, "kannala-brandt"),
        (0.1751, 0.5561, 1.6541),
        69.801,
        (-23.0170, -11.1589),
    )
    with pytest.raises(NoBoardError, match="do not tell which part"):
        find_corners(scene.image(), (7, 10), pattern=Charuco())
    corners = find_corners(scene.image(), (7, 10), pattern=Charuco(legacy=False))
    assert len(corners) > 35
    assert np.abs(scene.error(corners)).max() < 0.5


def test_markers_stand_for_neighbours_where_lines_bend() -> None:
    """Of few large squares the lines do not tell where they go on."""
    board = Board(4, 6, 40.0, Charuco("DICT_6X6_250", 0.6, False))
    scene = Scene(board, _FISHEYE, (0.4, 0.5, 0.1), 70.0)
    corners = find_corners(scene.image(), board.grid_size, pattern=board.pattern)
    assert len(corners) > 15
    assert np.abs(scene.error(corners)).max() < 0.1


def test_a_false_marker_is_left_out() -> None:
    """A misread or foreign number agrees with no neighbour."""
    pattern, grid_size = BOARDS[0]
    scene = Scene(Board(*grid_size, 20.0, pattern), rvec=(0.0, 0.0, 0.0))
    image = scene.image(noise=0.0)
    first = np.rint(find_corners(image, grid_size, pattern=pattern).uv).astype(int)
    (u, v), (w, _) = first[0], first[1]
    side = w - u
    # The square right of the first corner gets the marker of the one below its right neighbour.
    inside = np.s_[v - side + 3 : v - 2, u + 3 : u + side - 2]
    image[inside] = image[v + 3 : v + side - 2, u + side + 3 : u + 2 * side - 2]
    corners = find_corners(image, grid_size, pattern=pattern)
    assert np.abs(scene.error(corners)).max() < 0.05


@pytest.mark.parametrize(
    ("stated", "grid_size", "says"),
    [
        (Charuco(), (8, 5), "at least 5 rows and exactly 8 columns"),
        (Charuco(), (4, 8), "at least 5 rows"),
        (Charuco("DICT_6X6_50"), None, "DICT_4X4_50, not"),
        (Charuco(marker=0.5), None, "of a square"),
        (Charuco(legacy=True), (5, 8), "first square of this board is dark"),
    ],
)
def test_what_is_wrongly_stated_is_told(
    stated: Charuco, grid_size: tuple[int, int] | None, says: str
) -> None:
    scene = Scene(Board(5, 8, 20.0, BOARDS[0][0]))
    with pytest.raises(NoBoardError, match=says):
        find_corners(scene.image(), grid_size, pattern=stated)


def test_a_wall_is_not_read_for_markers_of_a_stated_dictionary(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """OpenCV takes 0.7 s for its thousands of dark quadrilaterals, none of which fits a marker."""

    def fail(*_: object) -> None:
        raise AssertionError("nothing need be read")

    monkeypatch.setattr(opencv, "detect_markers", fail)
    wall = draw_without_board(12, (750, 1000), 0.625)
    with pytest.raises(NoBoardError):
        find_corners(wall, (7, 10), pattern=Charuco("DICT_4X4_50", 0.75, False))


def test_no_board() -> None:
    noise = np.random.default_rng(0).integers(0, 255, (300, 400)).astype(np.uint8)
    checkerboard = Scene(Board(5, 8, 20.0)).image()
    for image in (noise, checkerboard[::2, ::2].copy()):
        with pytest.raises(NoBoardError, match="No ChArUco"):
            find_corners(image, None, pattern=Charuco("DICT_4X4_50"))


@pytest.mark.parametrize(
    ("pattern", "grid_size"),
    [(Charuco("DICT_4X4_50", 0.7), (9, 12)), (Charuco("DICT_4X4_50"), (4, 5)), (Charuco(), (4, 5))],
)
def test_cannot_be_drawn(pattern: Charuco, grid_size: tuple[int, int]) -> None:
    with pytest.raises(CalibrationError):
        pattern.draw(grid_size)


def test_bad_statements() -> None:
    with pytest.raises(CalibrationError, match="DICT_3X3"):
        Charuco("DICT_3X3")
    with pytest.raises(CalibrationError, match="must be above 0 and below 1"):
        Charuco(marker=1.5)


def test_images_together_tell_more() -> None:
    seen = [
        Charuco("DICT_4X4_50", 0.70, False),
        Charuco("DICT_4X4_100", 0.72, False),
        Charuco("DICT_5X5_50", 0.74, False),
    ]
    assert Charuco().complete_from(seen) == Charuco("DICT_4X4_100", 0.72, False)
    assert Charuco("DICT_4X4_250", 0.75).complete_from(seen) == Charuco("DICT_4X4_250", 0.75, False)
    assert Charuco().complete_from([]) == Charuco()


@pytest.mark.data
def test_real_photographs(data_dir: Path) -> None:
    """iPhone pictures of a board of 6 x 8 inner corners; two show only a part of its markers."""
    folder = data_dir / "charuco_iphone_yzz"
    views = []
    for path in sorted(folder.glob("*.jpg")):
        corners = find_corners(
            read_image(path).pixels, (6, 8), pattern=Charuco("DICT_4X4_100", 0.5)
        )
        assert len(corners) >= 37
        views.append((corners.uv, Board(6, 8, 40.0).points(corners.grid), corners.cov))
    assert len(views) == 7
    result = calibrate(views, (1024, 768))
    assert [residual.rms < 0.6 for residual in result.residuals] == 7 * [True]
    assert np.abs(result.camera.focal - 795).max() < 10


@pytest.mark.parametrize("square", [30, 50])
def test_corners_of_a_drawing_have_usable_covariances(square: int) -> None:
    """OpenCV's own drawing of a board shows no noise, which would be a covariance of 0."""
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    board = cv2.aruco.CharucoBoard((8, 7), 30.0, 22.0, dictionary)
    image = board.generateImage((8 * square + 40, 7 * square + 40), marginSize=20)
    corners = find_corners(image, (6, 7), pattern=Charuco("DICT_4X4_50"))
    assert corners.complete
    assert corners.cov is not None
    assert np.linalg.eigvalsh(corners.cov).min() > 1e-9
