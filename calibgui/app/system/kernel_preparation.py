"""Kernels loaded before work is shared among processes, and compiled before they are needed.

Until a kernel is kept on disk the readable functions do its work (``engine.kernels``).
`compile_kernels` compiles all of them, for images of 8 and of 16 bits, which ``calibgui prepare``,
set-up scripts and the window ask for.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import Event

import numpy as np
import numpy.typing as npt

from calibgui.app.system.workers import map_in_processes
from calibgui.engine import (
    boards,
    calibration,
    camera,
    detection,
    geometry,
    images,
    kernels,
    uncertainty,
)

_SQUARE_PX = 20
"""Side of the squares of the drawn board, px."""
_PARTS = 4
"""Number of parts of a pixel, along either axis, that the board is drawn in."""
_CLOTH_COLUMNS = 6
"""Number of columns of squares that are drawn beside the board's border: enough for corners that
are not the board's to be seen there."""
_BARREL = 0.4
"""Distortion of the drawing at the diagonal: as much as it takes for a lens to be fitted."""
_SHADE = 0.3
"""Part of the light that is lost at the darkest places: as much as it takes for the light of single
corners to be fitted."""
_SOLVED_VIEWS = 12
"""Number of views that the prepared calibration has: enough for every kind of board shape."""
_TILT = 0.1
"""Turn of the rendered boards about both axes, rad: as much as it takes for no line to be straight
along the pixels."""


def prepare_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Find the corners of a small board drawn through a lens in uneven light, beside a chequered
    cloth, which loads the finder's kernels.

    Args:
        depth: type of the grey levels, np.uint8 or np.uint16.
    """
    rows, cols, parts = 9, 10, _SQUARE_PX * _PARTS  # a border of one square included
    size = np.array([rows, cols])
    width = cols + _CLOTH_COLUMNS
    place = np.moveaxis(np.indices((rows * parts, width * parts)), 0, -1) / parts - size / 2
    place *= 1 + _BARREL * np.sum(place**2, axis=-1, keepdims=True) / np.sum(size**2)
    row, col = np.moveaxis(np.floor(place + size / 2).astype(np.int64), -1, 0)
    is_printed = (row > 0) & (col > 0) & (row < rows - 1) & (col != cols - 1)
    shade = 1 - _SHADE * np.sin(place[..., 0]) ** 2 * np.sin(place[..., 1]) ** 2
    fine = np.where(is_printed & ((row + col) % 2 == 0), 40, 200) * shade
    levels = fine.reshape(rows * _SQUARE_PX, _PARTS, -1, _PARTS).mean(axis=(1, 3))
    detection.find_corners((levels * (np.iinfo(depth).max // 255)).astype(depth))


def prepare_circle_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Find the circles of a small grid; otherwise as `prepare_finder`."""
    _find_rendered(boards.Board(5, 6, 1.0, boards.Circles(diameter=0.5)), depth)


def prepare_tag_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Find the corners of small AprilGrids with and without dark squares between their tags;
    otherwise as `prepare_finder`."""
    prepare_finder(depth)
    for corner_squares in (True, False):
        pattern = boards.AprilGrid("t36h11", 0.3, 2, False, corner_squares)
        _find_rendered(boards.Board(6, 6, 1.0, pattern), depth)


def prepare_every_finder(depth: npt.DTypeLike = np.uint8) -> None:
    """Prepare the detectors of all kinds of boards, if their kernels are kept."""
    prepare_finder(depth)
    if not kernels.was_any_missed():
        prepare_tag_finder(depth)
        prepare_circle_finder(depth)


def prepare_solver() -> None:
    """Calibrate from views of a small board with each kind of lens and shape that has kernels, and
    ask how certain that is."""
    board = boards.Board(6, 7, 30.0)
    xy, middle = board.points(), np.array([90.0, 75.0])
    truth = camera.Camera((640, 480), np.array([650.0, 650.0, 320.0, 240.0, 0.2, *[0.0] * 5]))
    random = np.random.default_rng(1)
    views = []
    for turn in range(_SOLVED_VIEWS):
        tilt = 0.5 * np.array([np.cos(turn), np.sin(turn), 0.1])
        pose = geometry.Pose(tilt, np.array([*-middle, 400.0 + 10 * turn]))
        uv = camera.project_points(xy, truth, pose) + random.normal(0, 0.05, (len(xy), 2))
        views.append((uv, xy))
    observed = [calibration.make_observation(*view) for view in views]
    pixels = np.moveaxis(np.mgrid[200:440:6, 120:360:6], 0, -1)  # where there are corners
    for model in ("lucchese", "splined-stereographic-8x6-90"):
        found = calibration.calibrate(views, truth.size, model=model)
        camera.pixels_from_rays(camera.rays_from_pixels(pixels, found.camera), found.camera)
        uncertainty.estimate_projection_uncertainty(found, observed)
    for shape in (boards.BoardShapeModel.BOW, boards.BoardShapeModel.FREE):
        calibration.calibrate(views, truth.size, board_shape=shape)


def _find_rendered(board: boards.Board, depth: npt.DTypeLike) -> None:
    """Find the points of a `board` rendered through a lens, with a margin of a pitch."""
    points = board.points()
    span = float(np.ptp(points, axis=0).max()) + 2 * board.square
    side = round(span / board.square * _SQUARE_PX)
    params = [side, side, side / 2, side / 2, _BARREL, *[0.0] * 5]
    lens = camera.Camera((side, side), np.array(params))
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    pose = geometry.Pose(np.array([_TILT, _TILT, 0.0]), np.array([*-middle, span]))
    levels = images.render_view(lens, pose, board, blur=0.5)
    levels = levels.astype(depth) * (np.iinfo(depth).max // 255)
    detection.find_corners(levels, pattern=board.pattern)


def _prepare_deep_finder() -> None:
    prepare_finder(np.uint16)


def _prepare_deep_tag_finder() -> None:
    prepare_tag_finder(np.uint16)


def _prepare_deep_circle_finder() -> None:
    prepare_circle_finder(np.uint16)


_PREPARATIONS = {
    "circles": prepare_circle_finder,
    "asymmetric-circles": prepare_circle_finder,
    "aprilgrid": prepare_tag_finder,
}
"""Functions that prepare detectors which need other kernels than that of checkerboards, by the kind
of their boards."""
ALL_PREPARATIONS: tuple[Callable[[], None], ...] = (
    prepare_finder,
    prepare_solver,
    prepare_circle_finder,
    prepare_tag_finder,
    _prepare_deep_finder,
    _prepare_deep_circle_finder,
    _prepare_deep_tag_finder,
)
"""The preparations of all kernels, in an order in which two processes seldom need one at once."""


def choose_preparation(pattern: boards.Pattern) -> Callable[..., None]:
    """Return the function that prepares the detector of boards of a `pattern`."""
    return _PREPARATIONS.get(pattern.kind, prepare_finder)


def compile_kernels(
    progress: Callable[[int, int], None] | None = None, stop: Event | None = None
) -> None:
    """Compile the kernels that are not kept on disk yet, in two processes.

    Args:
        progress: called with the number of finished parts of the work, and of all.
        stop: ends the work within 0.2 s when set; what is compiled by then is kept.

    Raises:
        Cancelled: if `stop` was set.
    """
    for done, _ in enumerate(map_in_processes(_compile, ALL_PREPARATIONS, stop, count=2), 1):
        if progress is not None:
            progress(done, len(ALL_PREPARATIONS))


def _compile(prepare: Callable[[], None]) -> None:
    with kernels.compile_missing():
        prepare()
