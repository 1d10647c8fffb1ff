"""Frames of videos as photographs: sharp ones that show the board in different poses.

A video is decoded once. Of each of its stretches of equal length the sharpest frame is kept, so
that neither memory nor disk holds more than a few frames for each that is wanted, and these are
searched for the board. Those that are taken are, one by one, whichever adds most: the frame whose
board is farthest from all boards taken before, over the uncertainty of its corners, which blur and
motion enlarge. A frame that adds less than that uncertainty is the same pose again, and is not
taken. What is taken is written without loss as PNG, so that views name files that exist.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from calibgui.app.photographs.detection import Detection
from calibgui.app.photographs.paths import find_images
from calibgui.dataset import View
from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import apply_homography, fit_homography
from calibgui.engine.images import is_video, write_image

DEFAULT_FRAMES = 30
"""Number of frames that are taken of a video, unless another is stated."""
_CANDIDATES_PER_FRAME = 3
"""Number of frames that are searched for each that is taken, at least, and up to twice that."""
DecodingProgress = Callable[[int, int], None]
"""Function that is told the number of decoded frames, and of all (0 if that is not known)."""
ShowProgress = Callable[[str, str], AbstractContextManager[DecodingProgress]]
"""Function that is told what is done and of what units, and gives a place to report it to."""


@dataclass(frozen=True, slots=True)
class FrameChoice:
    """The frames that are taken of each video, and where they are written."""

    count: int = DEFAULT_FRAMES
    """Number of frames of each video."""
    folder: Path = Path()
    """Folder in which the frames of each video have one of their own."""


DEFAULT_CHOICE = FrameChoice()


@dataclass(frozen=True, eq=False, slots=True)
class _Candidate:
    """A frame that may be taken."""

    number: int
    """Its place in the video, from 0."""
    sharpness: float
    file: Path


def search_photographs(
    names: Sequence[str],
    choice: FrameChoice,
    search: Callable[[Sequence[Path]], Detection],
    show_progress: ShowProgress,
) -> Detection:
    """Search photographs, and frames of videos, for the board.

    Args:
        names: files, folders and patterns, as for `find_images`; videos among them as files.
        choice: what is taken of videos.
        search: searches image files.
        show_progress: shows the progress of decoding.

    Returns:
        What was found, of videos in the frames that are taken and written; a video without a board
        has all that were searched. The remark says what was taken.

    Raises:
        CalibrationError: as `find_images`; if a video cannot be decoded, or a frame not be written.
    """
    videos = [path for path in map(Path, names) if path.is_file() and is_video(path)]
    if not videos:
        return search(find_images(names))
    others = [name for name in names if Path(name) not in videos]
    photographs = find_images(others) if others else ()
    with tempfile.TemporaryDirectory(prefix="calibgui-") as place:
        candidates: list[tuple[_Candidate, ...]] = []
        counts = []
        for k, video in enumerate(videos):
            folder = Path(place) / str(k)
            folder.mkdir()
            with show_progress(f"decoding {video.name}", "frame") as advance:
                kept, count = sample_video(
                    video, folder, _CANDIDATES_PER_FRAME * choice.count, advance
                )
            candidates.append(kept)
            counts.append(count)
        files = [each.file for kept in candidates for each in kept]
        detection = search([*photographs, *files])
        views = list(detection.views[: len(photographs)])
        found = {view.image: view for view in detection.views[len(photographs) :]}
        remarks = [detection.remark] if detection.remark else []
        for video, kept, count in zip(videos, candidates, counts, strict=True):
            searched = [found[str(each.file)] for each in kept]
            shown = [view for view in searched if view.usable]
            chosen = {view.image for view in choose_views(shown, choice.count)}
            target = choice.folder / f"{video.stem}-frames"
            taken = [
                replace(view, image=str(_write_frame(each, target)))
                for each, view in zip(kept, searched, strict=True)
                if view.image in chosen
            ]
            views += taken or searched
            remarks.append(
                f"{video} has {count} frames. {len(kept)} were searched, each the sharpest of its "
                f"stretch: {len(shown)} show the board, and the {len(taken)} in which it differs "
                f"most are taken{f' and written to {target}' if taken else ''}."
            )
    return replace(detection, views=tuple(views), remark=" ".join(remarks))


def take_frames(
    videos: Sequence[Path],
    search: Callable[[Sequence[Path]], Detection],
    show_progress: ShowProgress,
) -> tuple[tuple[Path, ...], str]:
    """Take frames of videos, and write those of each into a folder beside it.

    Args:
        videos: files.
        search, show_progress: as for `search_photographs`.

    Returns:
        The frames, and sentences on what was taken.

    Raises:
        CalibrationError: as `search_photographs`; if no frame of a video shows the board.
    """
    frames: list[Path] = []
    remarks = []
    for video in videos:
        choice = FrameChoice(folder=video.parent)
        detection = search_photographs([str(video)], choice, search, show_progress)
        taken = [Path(view.image) for view in detection.views if view.usable]
        if not taken:
            raise CalibrationError(
                f"No frame of {video} shows the board.",
                "Show the whole board, sharp and evenly lit; state what is printed on it, if it is "
                "no checkerboard.",
            )
        frames += taken
        remarks.append(detection.remark)
    return tuple(frames), "\n".join(remarks)


def sample_video(
    video: Path, folder: Path, count: int, progress: DecodingProgress
) -> tuple[tuple[_Candidate, ...], int]:
    """Write the sharpest frame of each of `count` stretches of a video, or up to twice as many.

    Returns:
        The frames in their order, and the number of all frames.

    Raises:
        CalibrationError: if no frame can be decoded.
    """
    total, frames = opencv.decode_video(str(video))
    length = max(1, total // count)
    kept: list[_Candidate] = []
    best, number = None, -1
    for number, frame in enumerate(frames):
        sharpness = opencv.measure_sharpness(frame)
        if best is None or sharpness > best[1]:
            best = number, sharpness, frame
        if (number + 1) % length == 0:
            kept.append(_keep(*best, folder))
            best = None
        if len(kept) == 2 * count:  # the video is longer than it says
            kept, length = _merge_pairs(kept), 2 * length
        progress(number + 1, max(total, number + 1))
    if best is not None:
        kept.append(_keep(*best, folder))
    if not kept:
        raise CalibrationError(
            f"{video} cannot be decoded: it is damaged, or packed in a way that OpenCV does not "
            "know.",
            "Save it as MP4 with H.264, or frames of it as PNG.",
        )
    return tuple(kept), number + 1


def choose_views(views: Sequence[View], count: int) -> list[View]:
    """Choose up to `count` views with corners, each the one that adds most to those before."""
    if not views:
        return []
    outlines = np.array([_outline_board(view, views) for view in views])
    noise = np.array([_measure_noise(view) for view in views])
    chosen = [int(np.argmin(noise))]
    nearest = np.full(len(views), np.inf)
    while len(chosen) < count:
        apart = np.linalg.norm(outlines - outlines[chosen[-1]], axis=-1)
        nearest = np.minimum(nearest, np.sqrt(np.mean(apart**2, axis=-1)))
        gain = nearest / noise
        if not gain.max() > 1:
            break
        chosen.append(int(np.argmax(gain)))
    return [views[k] for k in chosen]


def _outline_board(view: View, views: Iterable[View]) -> Array:
    """Return the four outermost corners (4, 2), px, of the largest board seen, in a view."""
    sizes = [each.corners.shape for each in views if each.corners is not None]
    rows, cols = max(size[0] for size in sizes), max(size[1] for size in sizes)
    assert view.corners is not None
    grid = view.corners.grid.astype(np.float64)
    H = fit_homography(grid, view.corners.uv, np.ones(len(grid)))
    ends = np.array([[0, 0], [0, cols - 1], [rows - 1, cols - 1], [rows - 1, 0]], float)
    return apply_homography(H, ends)


def _measure_noise(view: View) -> float:
    """Return the standard deviation of a view's median corner, px; 1 where it is not known."""
    if view.corners is None or view.corners.cov is None:
        return 1.0
    return float(np.sqrt(np.median(np.trace(view.corners.cov, axis1=1, axis2=2)) / 2))


def _keep(number: int, sharpness: float, frame: GreyImage, folder: Path) -> _Candidate:
    """Write a frame to a folder of candidates."""
    file = folder / f"frame-{number:06d}.png"
    write_image(file, frame)
    return _Candidate(number, sharpness, file)


def _merge_pairs(kept: Sequence[_Candidate]) -> list[_Candidate]:
    """Return the sharper one of each two neighbours, and remove the other's file."""
    merged = []
    for pair in zip(kept[::2], kept[1::2], strict=True):
        less, more = sorted(pair, key=lambda each: each.sharpness)
        less.file.unlink()
        merged.append(more)
    return merged


def _write_frame(candidate: _Candidate, folder: Path) -> Path:
    """Copy a frame to its folder, and return its file there.

    Raises:
        CalibrationError: if another picture has its name, or it cannot be written.
    """
    file = folder / candidate.file.name
    content = candidate.file.read_bytes()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not file.exists():
            write_atomically(file, content)
        elif file.read_bytes() != content:
            raise CalibrationError(
                f"{file} exists and is another picture.",
                "State another folder for the frames: --frames-folder.",
            )
    except OSError as error:
        raise CalibrationError(
            f"{folder} cannot be written: {error.strerror or error}.",
            "State another folder for the frames: --frames-folder.",
        ) from error
    return file
