"""A rig of several cameras from photographs or a file, in one call."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from calibgui.app.calibrating.settings import AUTO_MODEL, Settings, read_model_choice
from calibgui.app.photographs.detection import Detection
from calibgui.app.photographs.videos import DEFAULT_CHOICE
from calibgui.app.rig.boards import StatedBoard, name_boards, search_boards
from calibgui.app.rig.calibrating import calibrate_photographs, require_times
from calibgui.app.rig.pairing import pair_photographs
from calibgui.dataset import RigResult, relate_cameras
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import Board, BoardShapeModel, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import Pose
from calibgui.engine.rig import (
    PlacedBoard,
    Rig,
    StereoPair,
    TriangulatedPoints,
    rectify_pair,
    triangulate_points,
)
from calibgui.formats import read_camera
from calibgui.formats.rig_files import find_rig_exporter
from calibgui.formats.rig_json import read_rig, write_rig
from calibgui.report.rig import format_rig
from calibgui.scripting.calibration import File, Progress, search_board


class CalibratedRig:
    """A calibrated rig, with what is done with one.

    Args:
        result: the rig with the views that it was made from.
    """

    def __init__(self, result: RigResult) -> None:
        self.result = result

    @property
    def rig(self) -> Rig:
        """The engine's record: cameras, poses, covariance."""
        return self.result.rig

    @property
    def boards(self) -> tuple[PlacedBoard, ...]:
        """The boards with their places and the shapes that were estimated; the standard deviations
        of the places are those of ``Rig.board_sigma``."""
        return self.rig.placed_boards

    @property
    def offsets(self) -> dict[str, tuple[float, float]]:
        """Delays of the cameras' clocks after the first one's, s, each with its standard deviation,
        by the names of the cameras; 0 where it was not estimated."""
        rig = self.rig
        sigmas = map(rig.offset_sigma, range(len(rig.names)))
        return dict(zip(rig.names, zip(rig.offsets.tolist(), sigmas, strict=True), strict=True))

    def __str__(self) -> str:
        """Return what the command line prints."""
        return format_rig(self.result)

    def save(self, path: File) -> None:
        """Save the rig; `load_rig` reads it again. Raises CalibrationError if it cannot."""
        write_rig(self.result, path)

    def export(self, name: str, path: File, pair: tuple[str, str] | None = None) -> str:
        """Write the rig in a format of another program, as opencv, ros, kalibr or colmap.

        Args:
            name: the format.
            path: the file.
            pair: the two cameras of a file that holds a pair; the first two if None.

        Returns:
            A sentence on what was written.

        Raises:
            CalibrationError: if the format or a camera does not exist, or the file cannot be
                written.
        """
        exporter = find_rig_exporter(name, Path(path))
        return exporter.write(self.result, Path(path), self._find_pair(pair))

    def triangulate(
        self, pixels: Mapping[str, npt.ArrayLike], sigma: float | None = None
    ) -> TriangulatedPoints:
        """Find points in space from their pixels (n, 2) in the cameras, by name.

        Args:
            pixels: NaN where a camera does not see a point.
            sigma: standard deviation of a pixel, px; that of the rig's corners if None.

        Raises:
            CalibrationError: as ``engine.rig.triangulate_points``.
        """
        seen = {self.result.find_camera(name): np.asarray(uv) for name, uv in pixels.items()}
        noise = self.rig.rms_alone / 2**0.5 if sigma is None else sigma
        return triangulate_points(self.rig, seen, noise)

    def rectify(
        self, pair: tuple[str, str] | None = None, zoom: float = 1.0, is_angular: bool = False
    ) -> StereoPair:
        """Find the rectified images of two cameras, see ``engine.rig.rectify_pair``."""
        related = relate_cameras(self.rig, *self._find_pair(pair))
        return rectify_pair(*related, zoom, is_angular)

    def _find_pair(self, pair: tuple[str, str] | None) -> tuple[int, int]:
        if pair is None:
            return 0, 1
        return self.result.find_camera(pair[0]), self.result.find_camera(pair[1])


def calibrate_rig(
    photographs: File | Iterable[File],
    *,
    square: float | None = None,
    board: GridSize | None = None,
    pattern: Pattern | None = None,
    model: str = AUTO_MODEL,
    known: Mapping[str, File] | None = None,
    hold: bool = False,
    robust: bool = False,
    within: float | None = None,
    offsets: bool = False,
    boards: Sequence[Board] = (),
    places: Mapping[int, Pose] | None = None,
    board_shape: str = BoardShapeModel.NOMINAL,
    progress: Progress | None = None,
) -> CalibratedRig:
    """Calibrate a rig of several cameras from photographs of a board that they take together.

    Args:
        photographs: a folder or pattern for each camera, or one folder of all.
        square: side of a square, or distance of circles, mm; lengths are not confirmed if None.
        board: rows and columns of inner corners or circles; the photographs tell them if None.
        pattern: what is printed on the board; the photographs tell if None.
        model: the lens model of all cameras; "auto" for the one that each one's photographs demand.
        known: files of cameras that are known beforehand, by the names of the cameras.
        hold: True to hold all cameras as each alone is, or as it is known.
        robust: True to leave out corners and views that no camera explains.
        within: largest time between photographs of one instant, s, which are paired by the times
            that their names or EXIF tell; None to pair by what pairs most.
        offsets: True to estimate how late the clock of each camera is, from a board that moves
            before cameras whose photographs tell their times.
        boards: several boards that stand fast to each other, in place of square, board and pattern,
            as ``engine.boards.Board(5, 7, 30, engine.boards.Charuco("DICT_4X4_50"))``; photographs
            tell them apart by their markers.
        places: poses first_from_board of those of them that are known, by their numbers from 1 on;
            the others are estimated.
        board_shape: the shape of the boards: "nominal", or "affine", "bow" or "free" to estimate
            it with the rig.
        progress: a function that is told of the progress.

    Raises:
        CalibrationError: if the photographs cannot be paired, show no board, or do not determine
            the rig.

    Example:
        rig = calibgui.calibrate_rig(["left", "right"], square=25)
        print(rig)
    """
    tell = progress or (lambda *_: None)
    paths = [photographs] if isinstance(photographs, str | os.PathLike) else list(photographs)
    pairing = pair_photographs([os.fspath(path) for path in paths], within)
    if offsets:
        require_times(pairing)

    stated = [StatedBoard(board, pattern, square)]
    if boards:
        stated = [
            StatedBoard(each.grid_size, each.pattern, each.square, (places or {}).get(b))
            for b, each in enumerate(boards)
        ]

    def search(files: Sequence[str], wanted: StatedBoard) -> Detection:
        size, is_only = wanted.grid_size, len(stated) == 1
        return search_board(files, size, wanted.pattern, DEFAULT_CHOICE, tell, is_only=is_only)

    settings = Settings(model=read_model_choice(model), robust=robust)
    return CalibratedRig(
        calibrate_photographs(
            pairing,
            search_boards(pairing, stated, search),
            settings,
            {name: read_camera(file) for name, file in (known or {}).items()},
            hold,
            offsets,
            tell=lambda name: tell(f"calibrating {name}", 0, 0),
            boards=name_boards(stated, _read_shape(board_shape)),
        )
    )


def _read_shape(name: str) -> BoardShapeModel:
    """Return a model of the boards' shape by its name."""
    if name not in list(BoardShapeModel):
        raise CalibrationError(
            f"There is no board shape {name!r} of rigs.",
            f"Choose from {', '.join(BoardShapeModel)}.",
        )
    return BoardShapeModel(name)


def load_rig(path: File) -> CalibratedRig:
    """Load a rig that `CalibratedRig.save` or the command line has written.

    Raises:
        CalibrationError: if the file cannot be read, or is not a rig.json.
    """
    return CalibratedRig(read_rig(path))
