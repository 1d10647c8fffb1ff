"""Pictures of a capture on the disk, each written without loss as soon as it is taken."""

from __future__ import annotations

import itertools
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from math import isfinite, isnan
from pathlib import Path
from queue import SimpleQueue
from typing import NamedTuple

from calibgui.app.photographs.board_recognition import find_any_board
from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.system.workers import do_tasks_here
from calibgui.dataset import View, ViewStatus
from calibgui.engine.arrays import Array, GreyImage, GridSize
from calibgui.engine.boards import Pattern
from calibgui.engine.capture import (
    CameraSettings,
    CaptureSession,
    Frame,
    FrameSource,
    Instant,
    JointSession,
    JointState,
    PairedFrames,
    Picture,
    open_source,
)
from calibgui.engine.detection import find_corners
from calibgui.engine.errors import CalibrationError, NoBoardError, OtherSizeError
from calibgui.engine.features import Corners
from calibgui.engine.images import write_image
from calibgui.report.numbers import format_count
from calibgui.report.rig import describe_offset

_NAME = "picture-{:03d}.png"
TIMES = "times.csv"
"""Name of the table of the times at which pictures of several cameras were taken."""
_PATIENCE = 1.0
"""Time for which a camera that sends nothing is waited for before the others go on, s: a choice."""


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


class RecordedInstant(NamedTuple):
    """The frames of an instant that were looked at, and where they were written if taken."""

    state: JointState
    files: tuple[Path, ...]
    """The files of the cameras that sent a frame; none if it was not taken."""


@dataclass(frozen=True, eq=False, slots=True)
class CaptureProgress:
    """The pictures that a camera took, and how far it is known by them."""

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
    remarks: tuple[str, ...]
    """Sentences on what moved told: of how long cameras take for their rows, and of their clocks;
    and on pairs of cameras."""


def check_recording_folder(folder: Path) -> None:
    """Refuse a folder that holds pictures of a capture.

    Raises:
        CalibrationError: naming it.
    """
    name = _NAME.format(0).replace("000", "*")
    if folder.is_dir() and any(itertools.chain(folder.glob(name), folder.glob(f"*/{name}"))):
        raise CalibrationError(
            f"{folder} holds pictures of another capture.", "State another folder: -o."
        )


def open_cameras(names: Sequence[str], patience: float, wanted: CameraSettings) -> PairedFrames:
    """Open the sources that names mean, all or none. Args and errors are those of `open_source`."""
    with ExitStack() as stack:
        sources: list[FrameSource] = []
        for name in names:
            source = open_source(name, patience, wanted)
            stack.callback(source.close)
            sources.append(source)
        frames = PairedFrames(sources, _PATIENCE)
        stack.pop_all()
    return frames


def begin_session(count: int, finder: BoardFinder, square: float, limit: float) -> JointSession:
    """Begin a capture with so many cameras.

    Args:
        count: number of cameras.
        finder: finds the board, the same one in all cameras.
        square: side of a square, mm.
        limit: uncertainty of the worst pixel at which it is complete, px.
    """
    cameras = [CaptureSession(finder, square, limit) for _ in range(count)]
    return JointSession(cameras, [f"cam{c}" for c in range(count)])


class Recorder:
    """Looks at frames of cameras, and writes those that are taken.

    Those of one camera are written into the folder itself, of several into a folder for each, with
    a table of their times, as 'calibgui rig' reads them. What is asked of it, from any thread, is
    done between two instants.

    Args:
        session: looks at the frames; it keeps what was taken when the sources end or fail.
        folder: where the pictures are written; it is made if there is none.
    """

    def __init__(self, session: JointSession, folder: Path) -> None:
        self._session, self._folder = session, folder
        several = len(session.names) > 1
        self._folders = [folder / name if several else folder for name in session.names]
        self._taken: dict[Path, tuple[Instant, tuple[Path, ...]]] = {}
        """The frames of all instants that were written, also of those that were taken back, with
        their files, by the first of these."""
        self._taken_back: dict[Path, list[Picture | None]] = {}
        self._is_wanted = False
        self._toggled: SimpleQueue[Path] = SimpleQueue()

    def ask_for_picture(self) -> None:
        """Take the next instant that shows a sharp board, whatever it adds."""
        self._is_wanted = True

    def ask_to_toggle(self, file: Path) -> None:
        """Take the instant of a file back, or again; its files stay."""
        self._toggled.put(file)

    def record(
        self, frames: PairedFrames, should_stop: Callable[[], bool]
    ) -> Iterator[RecordedInstant]:
        """Look at frames until the capture is complete.

        Args:
            frames: the cameras' frames.
            should_stop: says whether the user wants it to end.

        Raises:
            CalibrationError: if all sources fail, the images of one change their size, or a picture
                cannot be written.
        """
        while not (self._session.is_complete or should_stop()):
            instant = frames.read()
            if instant is None:
                return
            self._toggle_pictures()
            yield self._look_at(instant, frames)

    def describe_absent(self, frames: PairedFrames) -> list[str]:
        """Say what is wrong with cameras that send nothing, or images of another size."""
        absent = frames.list_absent() | self._session.changed
        return [f"{self._session.names[c]}: {problem}" for c, problem in absent.items()]

    def measure_progress(self, c: int = 0) -> CaptureProgress:
        """Measure how far a camera is known; between two instants."""
        camera = self._session.cameras[c]
        aside = [each for each in camera.pictures if each.for_validation]
        unseen_error = camera.measure_unseen_error()
        return CaptureProgress(
            self._list_pictures(c),
            camera.worst,
            camera.is_complete,
            camera.compute_tilts(),
            unseen_error,
            0 if isnan(unseen_error) else sum(len(each.corners) for each in aside),
            (*describe_readouts(self._session), *describe_pairs(self._session)),
        )

    def list_views(self, c: int = 0) -> tuple[View, ...]:
        """List the views of a camera's pictures that count, with their corners."""
        return tuple(
            View(image=str(file), status=ViewStatus.FOUND, corners=picture.corners)
            for file, picture in self._list_pictures(c).items()
        )

    def _list_pictures(self, c: int) -> dict[Path, Picture]:
        """List the pictures of a camera that count, by their files."""
        found = {}
        for instant, files in self._taken.values():
            picture = self._session.find_pictures(instant)[c]
            if picture is not None:
                sent = sum(frame is not None for frame in instant[:c])
                found[files[sent]] = picture
        return found

    def _look_at(self, instant: Instant, frames: PairedFrames) -> RecordedInstant:
        session, is_wanted = self._session, self._is_wanted
        self._is_wanted = False
        instant = session.leave_out_changed(instant)
        state = (
            session.observe(instant, is_live=frames.is_live)
            if frames.is_continuous
            else session.examine(instant)
        )
        if is_wanted and not state.is_taken:
            state = session.examine(instant)
        if not state.is_taken:
            return RecordedInstant(state, ())
        name = _NAME.format(len(self._taken) + 1)
        written = {
            folder / name: frame
            for folder, frame in zip(self._folders, instant, strict=True)
            if frame is not None
        }
        for file, frame in written.items():
            _write(frame, file)
        if len(self._folders) > 1:
            self._write_times(written)
        files = tuple(written)
        self._taken[files[0]] = instant, files
        return RecordedInstant(state, files)

    def _write_times(self, written: Mapping[Path, Frame]) -> None:
        """Add the times of frames to the table.

        Raises:
            CalibrationError: if the disk refuses it.
        """
        table = self._folder / TIMES
        lines = [] if self._taken else ["file,time_s"]
        lines += [f"{f.parent.name}/{f.name},{frame.time:.6f}" for f, frame in written.items()]
        try:
            with table.open("a", encoding="utf-8") as file:
                file.writelines(f"{line}\n" for line in lines)
        except OSError as error:
            raise CalibrationError(
                f"{table} cannot be written: {error.strerror or error}.", "Check the disk."
            ) from error

    def _toggle_pictures(self) -> None:
        """Take instants back, or again, as was asked for."""
        while not self._toggled.empty():
            file = self._toggled.get()
            if file in self._taken_back:
                self._session.restore(self._taken_back.pop(file))
            elif file in self._taken:
                self._taken_back[file] = self._session.remove(self._taken[file][0])


def describe_readouts(session: JointSession) -> list[str]:
    """Say how long cameras take for their rows, of those that something moved told it of."""
    return [
        f"{name}: {readout}" if len(session.names) > 1 else readout
        for name, camera in zip(session.names, session.cameras, strict=True)
        if (readout := camera.describe_readout())
    ]


def describe_pairs(session: JointSession) -> list[str]:
    """Say how well it is known how cameras stand to each other, and how late they are."""
    names, sentences = session.names, []
    for link in session.links:
        known = f", the worst place to ±{link.worst:.2g} px" if isfinite(link.worst) else ""
        shared = format_count(link.shared, "common view")
        sentences.append(f"{names[link.first]} and {names[link.second]}: {shared}{known}.")
    for (a, b), (late, sigma) in session.list_offsets().items():
        sentences.append(describe_offset(names[b], names[a], late, sigma))
    return sentences


def _write(frame: Frame, file: Path) -> None:
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
    write_image(file, frame.image)
