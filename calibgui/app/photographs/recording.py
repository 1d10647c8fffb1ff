"""Pictures of a capture on the disk, each written without loss as soon as it is taken."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import isnan
from pathlib import Path
from queue import SimpleQueue
from typing import NamedTuple

from calibgui.app.photographs.board_recognition import find_any_board
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.system.workers import do_tasks_here
from calibgui.dataset import View, ViewStatus
from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards import Pattern
from calibgui.engine.capture import CaptureSession, CaptureState, Frame, FrameSource, Picture
from calibgui.engine.detection import find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError, OtherSizeError
from calibgui.engine.features import Corners
from calibgui.engine.images import write_image

_NAME = "picture-{:03d}.png"


class BoardFinder:
    """Finds a board in images; what is not stated of it, the first image that shows one tells.

    A plain board may have shown but a part of itself there: an image with a larger one tells anew.

    Args:
        pattern: what is printed on the board; None if the images are to tell.
        grid_size: rows and columns of its corners or circles; None if the images are to tell.
    """

    def __init__(self, pattern: Pattern | None, grid_size: GridSize | None) -> None:
        self._pattern = pattern
        self._grid_size = grid_size
        self._is_size_stated = grid_size is not None

    def __call__(self, image: GreyImage) -> Corners:
        """Find the board.

        Raises:
            NoBoardError: if the image shows none.
        """
        if self._pattern is None:
            self._pattern = self._recognise(image)
        try:
            corners = find_corners(image, self._grid_size, pattern=self._pattern)
        except OtherSizeError as error:
            if self._is_size_stated or self._grid_size is None:
                raise
            corners = find_corners(image, pattern=self._pattern)
            if not _contains(corners.shape, self._grid_size):
                raise error from None
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

            with do_tasks_here():  # a process for a single image would only be waited for
                found = find_any_board(search, self._grid_size)
        (view,) = found.views
        if not view.usable:
            raise NoBoardError(view.reason)
        return found.pattern


def _contains(size: GridSize, part: GridSize) -> bool:
    """Return whether a board of a size may have a part, one way or the other."""
    return all(most >= seen for most, seen in zip(sorted(size), sorted(part), strict=True))


class RecordedFrame(NamedTuple):
    """A frame that was looked at, and where it was written if it was taken."""

    state: CaptureState
    file: Path | None


@dataclass(frozen=True, eq=False, slots=True)
class CaptureProgress:
    """The pictures that were taken, and how far the camera is known by them."""

    pictures: Mapping[Path, Picture]
    """The pictures that count, by the files that they were written to."""
    worst: float
    """Uncertainty of the worst pixel's projection, px; infinite while it is not known."""
    is_complete: bool
    """True if the camera is known as well as was asked for."""
    tilts: Array
    """(n, 3) normals of the boards towards the camera, in its frame."""
    unseen_error: float
    """Rms distance, px, of corners that were put aside from where a camera expects them that is
    calibrated without; NaN if there are none."""
    unseen_corners: int
    """Number of such corners."""
    readout: str
    """The sentence on how long the camera takes for its rows; empty if nothing moved told."""


def check_recording_folder(folder: Path) -> None:
    """Refuse a folder that holds pictures of a capture.

    Raises:
        CalibrationError: naming it.
    """
    if folder.is_dir() and any(folder.glob(_NAME.format(0).replace("000", "*"))):
        raise CalibrationError(
            f"{folder} holds pictures of another capture.", "State another folder: -o."
        )


class Recorder:
    """Looks at frames of a source, and writes those that are taken.

    What is asked of it, from any thread, is done between two frames.

    Args:
        session: looks at them; it keeps what was taken when the source ends or fails.
        folder: where the pictures are written; it is made if there is none.
    """

    def __init__(self, session: CaptureSession, folder: Path) -> None:
        self._session, self._folder = session, folder
        self._files: dict[Path, Frame] = {}
        """The frames of all pictures that were written, also of those that were taken back."""
        self._taken_back: dict[Path, Picture] = {}
        self._is_wanted = False
        self._toggled: SimpleQueue[Path] = SimpleQueue()

    def ask_for_picture(self) -> None:
        """Take the next frame that shows a sharp board, whatever it adds."""
        self._is_wanted = True

    def ask_to_toggle(self, file: Path) -> None:
        """Take a picture back, or again; its file stays."""
        self._toggled.put(file)

    def record(
        self, source: FrameSource, should_stop: Callable[[], bool]
    ) -> Iterator[RecordedFrame]:
        """Look at frames until the capture is complete.

        Args:
            source: where the frames come from.
            should_stop: says whether the user wants it to end.

        Raises:
            CalibrationError: if the source fails, its images change their size, or a picture
                cannot be written.
        """
        while not (self._session.is_complete or should_stop()):
            frame = source.read()
            if frame is None:
                return
            self._toggle_pictures()
            yield self._look_at(frame, source)

    def measure_progress(self) -> CaptureProgress:
        """Measure how far the camera is known; between two frames."""
        session = self._session
        aside = [each for each in session.pictures if each.for_validation]
        unseen_error = session.measure_unseen_error()
        return CaptureProgress(
            {file: each for file in self._files if (each := self._get_picture(file)) is not None},
            session.worst,
            session.is_complete,
            session.compute_tilts(),
            unseen_error,
            0 if isnan(unseen_error) else sum(len(each.corners) for each in aside),
            session.describe_readout(),
        )

    def list_views(self) -> tuple[View, ...]:
        """List the views of the pictures that count, with their corners."""
        return tuple(
            View(image=str(file), status=ViewStatus.FOUND, corners=picture.corners)
            for file, picture in self.measure_progress().pictures.items()
        )

    def _look_at(self, frame: Frame, source: FrameSource) -> RecordedFrame:
        session, is_wanted = self._session, self._is_wanted
        self._is_wanted = False
        state = (
            session.observe(frame, is_live=source.is_live)
            if source.is_continuous
            else session.examine(frame)
        )
        if is_wanted and state.taken is None:
            state = session.examine(frame)
        if state.taken is None:
            return RecordedFrame(state, None)
        file = self._folder / _NAME.format(len(self._files) + 1)
        _write(state.taken, file)
        self._files[file] = state.taken.frame
        return RecordedFrame(state, file)

    def _toggle_pictures(self) -> None:
        """Take pictures back, or again, as was asked for."""
        while not self._toggled.empty():
            file = self._toggled.get()
            if (picture := self._get_picture(file)) is not None:
                self._session.remove(picture)
                self._taken_back[file] = picture
            elif file in self._taken_back:
                self._session.restore(self._taken_back.pop(file))

    def _get_picture(self, file: Path) -> Picture | None:
        """Return the picture that a file holds; None if it does not count."""
        frame = self._files[file]
        return next((each for each in self._session.pictures if each.frame is frame), None)


def _write(picture: Picture, file: Path) -> None:
    """Write a picture.

    Raises:
        CalibrationError: if the disk refuses it.
    """
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CalibrationError(
            f"{file.parent} cannot be made: {error.strerror or error}.", "State another folder."
        ) from error
    write_image(file, picture.frame.image)
