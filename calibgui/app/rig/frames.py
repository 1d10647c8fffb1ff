"""Frames of the videos of a rig, which are paired by their numbers.

Videos of a rig begin at the same moment and have the same rate: frame k of one belongs to frame k
of the others. Whoever cannot start his cameras together knows it at the end (``engine/rig``).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from calibgui.app.outputs.output_files import make_folder
from calibgui.app.photographs.videos import ShowProgress
from calibgui.engine import opencv
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import write_image


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
