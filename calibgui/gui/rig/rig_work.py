"""The work of a rig's page that runs beside the window."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import cast

from PySide6.QtCore import QCoreApplication

from calibgui.app.calibrating.settings import Settings
from calibgui.app.photographs.board_recognition import explain_missing_board, find_any_board
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.photographs.videos import DecodingProgress
from calibgui.app.rig.boards import StatedBoard, name_boards, search_boards
from calibgui.app.rig.calibrating import calibrate_photographs
from calibgui.app.rig.frames import find_videos, read_frame_times, write_frames
from calibgui.app.rig.pairing import pair_files, pair_photographs, state_times
from calibgui.app.rig.rig_setup import RigSetup, SearchedBoards
from calibgui.dataset import DEFAULT_SQUARE, CornerSet, RigPairing, RigResult, relate_cameras
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import Pattern
from calibgui.engine.images import Pixels, read_colour
from calibgui.engine.rig import rectify_pair, rectify_stereo_image
from calibgui.gui.jobs.job import Job

translate = QCoreApplication.translate

Shown = tuple[list[Pixels], list[str], int | None]
"""Photographs, their names, and the number of columns that they stand in, if it matters."""


def pair_names(names: Sequence[str], tolerance: float | None, every: int, job: Job) -> RigPairing:
    """Pair photographs, or frames of videos, which are written beside the first of them.

    Args:
        names: a folder or a video for each camera, or one folder of all of them.
        tolerance: largest time between photographs of one instant, s; None by what pairs most.
        every: number of frames from one that is taken to the next.
        job: that is told of the progress, and may be stopped.
    """
    videos = find_videos(names)
    if not videos:
        return pair_photographs(names, tolerance)
    frames = write_frames(videos, videos[0].parent, every, partial(_show_progress, job))
    return state_times(pair_files(frames), read_frame_times(videos, frames))


@contextmanager
def _show_progress(job: Job, what: str, _unit: str) -> Iterator[DecodingProgress]:
    """Give what tells a job of the progress of decoding."""
    job.rename(what[:1].upper() + what[1:])
    yield job.advance


def search_and_calibrate(
    setup: RigSetup, found: SearchedBoards, job: Job
) -> tuple[SearchedBoards, RigResult]:
    """Search photographs that were not searched, and calibrate the rig.

    Args:
        setup: what is stated of the rig.
        found: what was found in photographs before.
        job: that is told of the progress, and may be stopped.
    """
    pairing, boards = setup.pairing, setup.boards
    if not found.answers(setup):
        job.rename(translate("RigPage", "Searching"))
        sets = search_boards(pairing, boards, partial(_search, job, len(boards) == 1))
        found = SearchedBoards(boards, tuple(sets))
    found = SearchedBoards(
        boards,
        tuple(
            {name: _state_square(each, board.square) for name, each in corner_set.items()}
            for board, corner_set in zip(boards, found.corner_sets, strict=True)
        ),
    )
    result = calibrate_photographs(
        pairing,
        [_keep_paired(corner_set, pairing) for corner_set in found.corner_sets],
        Settings(robust=setup.robust),
        estimate_offsets=setup.estimate_offsets,
        tell=lambda name: job.rename(translate("RigPage", "Calibrating {0}").format(name)),
        boards=name_boards(boards, setup.shape),
    )
    return found, result


def _search(job: Job, is_only: bool, files: Sequence[str], board: StatedBoard) -> Detection:
    """Search photographs of one camera for a board; the only one has to be there."""
    images = [Path(file) for file in files]

    def find(pattern: Pattern, grid_size: GridSize | None) -> Detection:
        return find_views(
            images,
            grid_size,
            progress=lambda done, total, _: job.advance(done, total),
            stop=job.cancelling,
            pattern=pattern,
        )

    if board.pattern is None:
        detection = find_any_board(find, board.grid_size)
    else:
        detection = find(board.pattern, board.grid_size)
    if is_only:
        error, _ = explain_missing_board(detection, board.grid_size, board.pattern is None)
        if error is not None:
            raise error
    return detection


def _state_square(corner_set: CornerSet, square: float | None) -> CornerSet:
    """Return corners on a board of squares of another length; None if it is not measured."""
    if corner_set.board is None:
        return corner_set
    board = replace(corner_set.board, square=square or DEFAULT_SQUARE)
    return replace(corner_set, board=board, lengths_confirmed=square is not None)


def _keep_paired(found: Mapping[str, CornerSet], pairing: RigPairing) -> dict[str, CornerSet]:
    """Return the corners of photographs that are not left out of the pairing."""
    kept = {}
    for camera in pairing.cameras:
        files, corner_set = {str(file) for file in camera.files.values()}, found[camera.name]
        views = tuple(view for view in corner_set.views if view.image in files)
        kept[camera.name] = replace(corner_set, views=views)
    return kept


def rectify_photographs(
    result: RigResult, second: int, both: list[Path], names: list[str]
) -> Shown:
    """Rectify a pair of photographs."""
    pair = rectify_pair(*relate_cameras(result.rig, 0, second))
    images = [
        cast(Pixels, rectify_stereo_image(read_colour(path), pair, which).image)
        for which, path in enumerate(both)
    ]
    return images, names, 1 if pair.is_upright else 2
