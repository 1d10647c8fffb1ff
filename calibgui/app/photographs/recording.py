"""Pictures of a capture on the disk, each written without loss as soon as it is taken."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from calibgui.app.photographs.board_recognition import find_any_board
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.dataset import View, ViewStatus
from calibgui.engine.arrays import GreyImage, GridSize
from calibgui.engine.boards import Pattern
from calibgui.engine.capture import CaptureSession, CaptureState, FrameSource, Picture
from calibgui.engine.detection import find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.features import Corners
from calibgui.engine.images import write_image

_NAME = "picture-{:03d}.png"


class BoardFinder:
    """Finds a board in images; what is not stated of it, the first image that shows one tells.

    Args:
        pattern: what is printed on the board; None if the images are to tell.
        grid_size: rows and columns of its corners or circles; None if the images are to tell.
    """

    def __init__(self, pattern: Pattern | None, grid_size: GridSize | None) -> None:
        self._pattern = pattern
        self._grid_size = grid_size

    def __call__(self, image: GreyImage) -> Corners:
        """Find the board.

        Raises:
            NoBoardError: if the image shows none.
        """
        if self._pattern is None:
            self._pattern = self._recognise(image)
        corners = find_corners(image, self._grid_size, pattern=self._pattern)
        if not corners.relative:
            self._grid_size = corners.shape
            self._pattern = corners.pattern
        return corners

    def _recognise(self, image: GreyImage) -> Pattern:
        """Recognise what is printed on the board in an image.

        Raises:
            NoBoardError: if the image shows none.
        """
        with tempfile.TemporaryDirectory(prefix="calibgui-") as folder:
            file = Path(folder) / "frame.png"
            write_image(file, image)

            def search(pattern: Pattern, grid_size: GridSize | None) -> Detection:
                return find_views([file], grid_size, pattern=pattern)

            found = find_any_board(search, self._grid_size)
        (view,) = found.views
        if not view.usable:
            raise NoBoardError(view.reason)
        return found.pattern


class RecordedFrame(NamedTuple):
    """A frame that was looked at, and where it was written if it was taken."""

    state: CaptureState
    file: Path | None


def check_recording_folder(folder: Path) -> None:
    """Refuse a folder that holds pictures of a capture.

    Raises:
        CalibrationError: naming it.
    """
    if folder.is_dir() and any(folder.glob(_NAME.format(0).replace("000", "*"))):
        raise CalibrationError(
            f"{folder} holds pictures of another capture.", "State another folder: -o."
        )


def record_pictures(
    source: FrameSource,
    session: CaptureSession,
    folder: Path,
    should_stop: Callable[[], bool],
) -> Iterator[RecordedFrame]:
    """Look at the frames of a source until the capture is complete, and write what is taken.

    Args:
        source: where the frames come from.
        session: looks at them; it keeps what was taken when this ends or fails.
        folder: where the pictures are written; it is made if there is none.
        should_stop: says whether the user wants it to end.

    Raises:
        CalibrationError: if the source fails, its images change their size, or a picture cannot be
            written.
    """
    while not (session.is_complete or should_stop()):
        frame = source.read()
        if frame is None:
            return
        state = session.observe(frame) if source.is_continuous else session.examine(frame)
        number = len(session.pictures)
        file = None if state.taken is None else _write(state.taken, folder, number)
        yield RecordedFrame(state, file)


def list_recorded_views(session: CaptureSession, folder: Path) -> tuple[View, ...]:
    """List the views of the pictures that were written, with their corners."""
    return tuple(
        View(
            image=str(folder / _NAME.format(k)),
            status=ViewStatus.FOUND,
            corners=picture.corners,
        )
        for k, picture in enumerate(session.pictures, 1)
    )


def _write(picture: Picture, folder: Path, number: int) -> Path:
    """Write a picture.

    Raises:
        CalibrationError: if the disk refuses it.
    """
    file = folder / _NAME.format(number)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CalibrationError(
            f"{folder} cannot be made: {error.strerror or error}.", "State another folder: -o."
        ) from error
    write_image(file, picture.frame.image)
    return file
