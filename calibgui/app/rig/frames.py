"""Frames of the videos of a rig, which are paired by their numbers.

Videos of a rig begin at the same moment and have the same rate: frame k of one belongs to frame k
of the others. Whoever cannot start his cameras together knows it at the end (``engine/rig``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from calibgui.app.outputs.output_files import make_folder
from calibgui.app.photographs.videos import ShowProgress
from calibgui.engine import opencv
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import FORMATS, is_video, list_suffixes, write_image


def find_videos(names: Sequence[str]) -> list[Path]:
    """Return the videos of several cameras: files, or those of one folder without photographs.

    The list is empty if some names are of something else.
    """
    paths = [Path(name) for name in names]
    if len(paths) == 1 and paths[0].is_dir():
        files = sorted(path for path in paths[0].iterdir() if path.is_file())
        if any(file.suffix.lower() in (*FORMATS, *list_suffixes()) for file in files):
            return []
        paths = [file for file in files if is_video(file)]
    is_of_videos = len(paths) > 1 and all(path.is_file() and is_video(path) for path in paths)
    return paths if is_of_videos else []


def write_frames(
    videos: Sequence[Path], folder: Path, every: int, show_progress: ShowProgress
) -> dict[str, list[Path]]:
    """Write frames of videos as PNG, into a folder NAME-frames for each.

    Args:
        videos: one for each camera.
        folder: where these folders are made.
        every: number of frames from one that is written to the next.
        show_progress: shows the progress of decoding.

    Returns:
        The frames of each video, by its name without the suffix.

    Raises:
        CalibrationError: if two videos have one name, a video cannot be decoded, or a frame cannot
            be written.
    """
    if len({video.stem for video in videos}) < len(videos):
        raise CalibrationError(
            "Two videos have the same name.", "Name each video after its camera."
        )
    written: dict[str, list[Path]] = {}
    for video in videos:
        target = folder / f"{video.stem}-frames"
        make_folder(target)
        total, frames = opencv.decode_video(str(video))
        written[video.stem] = files = []
        with show_progress(f"decoding {video.name}", "frame") as advance:
            for number, frame in enumerate(frames):
                if number % every == 0:
                    files.append(target / f"frame-{number:06d}.png")
                    if not files[-1].exists():
                        write_image(files[-1], frame)
                advance(number + 1, max(total, number + 1))
        if not files:
            raise CalibrationError(
                f"{video} cannot be decoded: it is damaged, or packed in a way that OpenCV does "
                "not know.",
                "Save it as MP4 with H.264, or frames of it as PNG.",
            )
    return written


def read_frame_times(
    videos: Sequence[Path], frames: Mapping[str, Sequence[Path]]
) -> dict[str, dict[Path, float]]:
    """Return the time of each frame from the beginning of its video, s, where its rate is known.

    Args:
        videos: the videos.
        frames: their frames as `write_frames` has written them.
    """
    rates = {video.stem: opencv.read_frame_rate(str(video)) for video in videos}
    return {
        name: {file: int(file.stem.rpartition("-")[2]) / rates[name] for file in files}
        for name, files in frames.items()
        if rates[name]
    }
