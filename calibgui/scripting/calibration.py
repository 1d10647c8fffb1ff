"""A camera from photographs, corners or a file, in one call."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TypedDict, Unpack

import numpy.typing as npt

from calibgui.app.calibrating.best_camera import calibrate_best
from calibgui.app.calibrating.settings import (
    AUTO_MODEL,
    Settings,
    check_settings,
    read_model_choice,
)
from calibgui.app.photographs.board_recognition import explain_missing_board, find_any_board
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.photographs.videos import (
    DEFAULT_FRAMES,
    DecodingProgress,
    FrameChoice,
    search_photographs,
)
from calibgui.dataset import CornerSet, View, ViewStatus
from calibgui.engine.arrays import GridSize, Size
from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior, Pattern
from calibgui.engine.calibration import make_observation
from calibgui.engine.errors import parse_choice
from calibgui.engine.images import Field
from calibgui.formats.corner_import import SUFFIXES, read_corner_file
from calibgui.scripting.calibrated_camera import CalibratedCamera

File = str | os.PathLike[str]
Progress = Callable[[str, int, int], None]
"""Function that is told what is being done, how many steps of it are done, and of how many (0 if
that is not known). It may raise an error to abandon the work."""


class Choices(TypedDict, total=False):
    """The choices that may be stated of a calibration; all else is as the photographs demand."""

    model: str
    """The lens model; "auto", the default, for the one that the photographs demand."""
    board_shape: BoardShape | str
    """The board's shape: "nominal", "affine", "bow", "free", a known shape, or "auto", the default,
    for the model that the photographs demand."""
    prior: BoardShapePrior
    """What is known of the board beforehand."""
    fix: Mapping[str, float | None]
    """Parameters to hold, with their values, or None for their defaults."""
    free: Sequence[str]
    """Parameters to estimate that are held by default."""
    improve: bool
    """False to carry nothing out that was not asked for."""


def calibrate(
    photographs: File | Iterable[File],
    *,
    square: float | None = None,
    square_sigma: float = 0.0,
    board: GridSize | None = None,
    pattern: Pattern | None = None,
    size: Size | None = None,
    frames: int = DEFAULT_FRAMES,
    frames_folder: File = "",
    field: str | None = None,
    progress: Progress | None = None,
    **choices: Unpack[Choices],
) -> CalibratedCamera:
    """Calibrate a camera from photographs of a board, as well as they allow.

    Args:
        photographs: a folder, files, patterns or videos; or a file of corners: corners.json, as
            ``calibgui detect`` writes it, mrcal's corners.vnl, or a table in CSV.
        square: side of a square, or distance of circles, mm; lengths are not confirmed if None.
        square_sigma: standard deviation of `square`, mm, common to all squares: the board's scale,
            which enters every length.
        board: rows and columns of inner corners or circles; the photographs tell them if None.
        pattern: what is printed on the board, as ``engine.Charuco()``; the photographs tell if
            None.
        size: width and height of the images, px, for a file of corners that does not state them.
        frames: number of frames to take of each video.
        frames_folder: where a video's frames are written, in a folder of their own; the current one
            by default.
        field: "odd" or "even" to use one field of interlaced frames.
        progress: a function that is told of the progress.
        choices: what is stated of the calibration, see `Choices`.

    Raises:
        CalibrationError: if the photographs show no board, or do not determine a camera.

    Example:
        camera = calibgui.calibrate("photographs", square=25)
        print(camera)
    """
    settings = _make_settings(**choices)
    tell = progress or (lambda *_: None)
    paths = [photographs] if isinstance(photographs, str | os.PathLike) else list(photographs)
    if len(paths) == 1 and Path(paths[0]).suffix.lower() in SUFFIXES:
        corner_set, search = read_corner_file(paths[0], board, square, size, square_sigma), False
    else:
        choice = FrameChoice(frames, Path(frames_folder))
        found = search_board(
            paths,
            board,
            pattern,
            choice,
            tell,
            None if field is None else parse_choice(Field, field, "field"),
        )
        corner_set, search = found.corner_set(square, square_sigma), True
    return _calibrate(corner_set, settings, search, tell)


def calibrate_corners(
    views: Iterable[tuple[npt.ArrayLike, npt.ArrayLike]],
    size: Size,
    *,
    names: Sequence[str] = (),
    progress: Progress | None = None,
    **choices: Unpack[Choices],
) -> CalibratedCamera:
    """Calibrate a camera from corners that were found before, as well as they allow.

    Args:
        views: pairs of corners (n, 2) px and their places on the board (n, 2) mm, or as OpenCV has
            them, (n, 1, 2) and (n, 3) with Z = 0.
        size: width and height of the images, px.
        names: names of the views; numbers by default.
        progress, choices: as for `calibrate`.

    Raises:
        CalibrationError: if the corners do not determine a camera.
    """
    settings = _make_settings(**choices)
    given = list(views)
    called = list(names) or [f"view {k + 1}" for k in range(len(given))]
    located = tuple(
        View(name, ViewStatus.FOUND, points=make_observation(*view, name=name))
        for name, view in zip(called, given, strict=True)
    )
    return _calibrate(CornerSet(size, located), settings, False, progress or (lambda *_: None))


def load(path: File) -> CalibratedCamera:
    """Load a camera that `CalibratedCamera.save`, the window or the command line has written.

    For the camera files of other programs see ``calibgui.formats.read_camera``.

    Raises:
        CalibrationError: if the file cannot be read, or is not a result.json.
    """
    return CalibratedCamera.load(path)


def _calibrate(
    corner_set: CornerSet, settings: Settings, search: bool, tell: Progress
) -> CalibratedCamera:
    """Calibrate, and tell of each step."""
    count = 0

    def advance(*_: int) -> None:
        nonlocal count
        count += 1
        tell("looking for the best camera", count, 0)

    steps = calibrate_best(corner_set, settings, search=search, progress=advance, check=advance)
    *_, best = steps
    return CalibratedCamera(best.result)


def _make_settings(**choices: Unpack[Choices]) -> Settings:
    """Make the settings. Raises CalibrationError if they do not go together."""
    model, prior = choices.get("model", AUTO_MODEL), choices.get("prior")
    # A prior is of the board as drawn, unless its shape is stated.
    shape = choices.get("board_shape", AUTO_MODEL if prior is None else BoardShapeModel.NOMINAL)
    held: BoardShapeModel | BoardShape | None = shape if isinstance(shape, BoardShape) else None
    if isinstance(shape, str) and shape != AUTO_MODEL:
        held = parse_choice(BoardShapeModel, shape, "board shape")
    settings = Settings(
        model=read_model_choice(model),
        board_shape=held,
        prior=prior,
        fixed=dict(choices.get("fix", {})),
        freed=tuple(choices.get("free", ())),
        improve=choices.get("improve", True),
    )
    check_settings(settings)
    return settings


def search_board(
    paths: Sequence[File],
    board: GridSize | None,
    pattern: Pattern | None,
    choice: FrameChoice,
    tell: Progress,
    field: Field | None = None,
    is_only: bool = True,
) -> Detection:
    """Search photographs for the board. Raises CalibrationError if none shows the only one."""

    def search_files(images: Sequence[Path]) -> Detection:
        def search(pattern: Pattern, grid_size: GridSize | None) -> Detection:
            return find_views(
                images,
                grid_size,
                progress=lambda done, total, _: tell("searching", done, total),
                pattern=pattern,
                field=field,
            )

        return search(pattern, board) if pattern else find_any_board(search, board)

    @contextmanager
    def tell_decoding(what: str, _unit: str) -> Iterator[DecodingProgress]:
        yield lambda done, total: tell(what, done, total)

    names = [os.fspath(path) for path in paths]
    found = search_photographs(names, choice, search_files, tell_decoding)
    error, _ = explain_missing_board(found, board, pattern is None)
    if error is not None and is_only:
        raise error
    return found
