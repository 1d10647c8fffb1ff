"""Frame sources: where live images come from, behind one door.

A source gives frames until there is none, each with the time at which it was taken, and is closed
by whoever opened it.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Protocol, Self

from calibgui.engine import opencv
from calibgui.engine.arrays import GreyImage
from calibgui.engine.capture.camera_settings import CameraSettings, adjust_camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.reading import FORMATS, is_video, read_image

AS_IT_IS = CameraSettings()
"""No wishes."""
LOOK_SECONDS = 0.2
"""Time after which is looked anew, into a folder that is being filled, or for the whole board in a
film, s: a choice; the board costs a tenth to a quarter of a core."""
_SCHEMES = ("http://", "https://", "rtsp://")
"""How the addresses of cameras in a network begin."""


class Frame(NamedTuple):
    """An image of a source."""

    image: GreyImage
    """(h, w) grey levels, or (h, w, 3) RGB, of 8 bits."""
    time: float
    """When it was taken, s from some moment on."""


class FrameSource(Protocol):
    """A camera, a video or a folder from which frames come one after the other."""

    title: str
    """What it is called in messages."""
    is_continuous: bool
    """True if frames follow each other as in a film; False if each is a photograph by itself."""
    is_live: bool
    """True if a frame that nobody reads in time is lost, as those of cameras are."""
    remark: str
    """Sentences on the source's settings and what is wrong with them; empty if it has none."""

    def read(self) -> Frame | None:
        """Return the next frame, or None if there is none any more.

        Raises:
            CalibrationError: if the source has failed.
        """

    def close(self) -> None:
        """Release the device or the file."""


class _Opened:
    """A source that closes itself at the end of a `with` statement."""

    remark = ""

    def close(self) -> None:
        """Release nothing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()


class VideoSource(_Opened):
    """Every frame of a video file, with the times at which it shows them."""

    is_continuous, is_live = True, False

    def __init__(self, path: Path) -> None:
        self.title = str(path)
        self._stream = opencv.open_stream(str(path), is_live=False)

    def read(self) -> Frame | None:
        frame = self._stream.read()
        return None if frame is None else Frame(frame, self._stream.time)

    def close(self) -> None:
        self._stream.close()


class CameraSource(_Opened):
    """A camera at this computer, by its number, or in the network, by its address.

    Raises:
        CalibrationError: if it cannot be opened.
    """

    is_continuous = is_live = True

    def __init__(self, which: int | str, wanted: CameraSettings = AS_IT_IS) -> None:
        self.title = f"camera {which}" if isinstance(which, int) else which
        self._stream = opencv.open_stream(which, is_live=True)
        self._has_begun = False
        if not self._stream.is_open:
            raise CalibrationError(
                f"{self.title} cannot be opened.",
                "Check that it is connected and that no other program uses it; a camera at this "
                "computer has a number, counted from 0.",
            )
        if isinstance(which, int):
            self.remark = adjust_camera(self._stream, wanted)

    def read(self) -> Frame | None:
        frame = self._stream.read()
        if frame is None:
            raise CalibrationError(
                f"{self.title} {'stopped sending' if self._has_begun else 'sends no'} images.",
                "Check its cable or network, and start again. What was taken before is kept.",
            )
        self._has_begun = True
        return Frame(frame, time.monotonic())

    def close(self) -> None:
        self._stream.close()


class FolderSource(_Opened):
    """A folder that another program fills with photographs, each as soon as it is whole.

    Args:
        folder: the folder.
        patience: time without a new photograph after which no more is expected, s.
    """

    is_continuous = is_live = False

    def __init__(self, folder: Path, patience: float) -> None:
        self.title = str(folder)
        self._folder, self._patience = folder, patience
        self._is_closed = False
        self._files = self._wait_for_files()

    def read(self) -> Frame | None:
        file = next(self._files, None)
        return None if file is None else Frame(read_image(file).pixels, time.monotonic())

    def close(self) -> None:
        self._is_closed = True

    def _wait_for_files(self) -> Iterator[Path]:
        """Wait for files whose size no longer changes."""
        sizes: dict[Path, int] = {}
        given: set[Path] = set()
        last = time.monotonic()
        while time.monotonic() - last < self._patience and not self._is_closed:
            for file in sorted(self._folder.iterdir()):
                if file in given or file.suffix.lower() not in FORMATS:
                    continue
                size = file.stat().st_size
                if size and sizes.get(file) == size:
                    given.add(file)
                    last = time.monotonic()
                    yield file
                sizes[file] = size
            time.sleep(LOOK_SECONDS)


Opened = VideoSource | CameraSource | FolderSource


def open_source(name: str, patience: float, wanted: CameraSettings = AS_IT_IS) -> Opened:
    """Open what a name means: a camera's number or address, a video, or a folder.

    Args:
        name: the name.
        patience: for how long no photograph may come into a folder before it is at its end, s.
        wanted: how a camera at this computer is to be set.

    Raises:
        CalibrationError: if there is no such thing, it cannot be opened, or has no settings.
    """
    if name.isdecimal():
        return CameraSource(int(name), wanted)
    if wanted != AS_IT_IS:
        raise CalibrationError(
            f"{name} is no camera at this computer: it has no settings here.",
            "Set the size of its images, its exposure and its focus where they are made.",
        )
    if name.startswith(_SCHEMES):
        return CameraSource(name)
    path = Path(name)
    if path.is_dir():
        return FolderSource(path, patience)
    if path.is_file() and is_video(path):
        return VideoSource(path)
    raise CalibrationError(
        f"{name} is no camera, video or folder.",
        "Name a camera by its number (0 for the first) or address (rtsp://...), a video file, or "
        "the folder that a camera's program fills.",
    )
