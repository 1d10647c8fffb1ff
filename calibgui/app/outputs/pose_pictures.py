"""Pictures of a board's poses: its axes drawn into copies of the photographs, in a folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from calibgui.app.outputs.output_folder import OutputFolder
from calibgui.app.photographs.sensor_frame import choose_orientation
from calibgui.dataset import PoseSet
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import draw_axes, read_colour, read_image_header, write_image

RECORD_FILE = "drawn.json"
"""Name of the file with the record of the pictures in a folder."""
AXES_IN_SQUARES = 3
"""Length of a drawn axis, sides of a square."""


def draw_poses(
    poses: PoseSet,
    folder: Path,
    progress: Callable[[int, int], None] | None = None,
    overwrite: bool = False,
) -> tuple[Path, ...]:
    """Write a picture with the board's axes of every photograph in which it was located.

    Args:
        poses: the poses; their images are read where they are named.
        folder: to write to, created if missing.
        progress: called with the number of finished pictures and of all.
        overwrite: whether files in `folder` may be replaced that this program did not make.

    Raises:
        CalibrationError: as `OutputFolder`, or if a photograph cannot be read or a picture written.
        ForeignFilesError: as `OutputFolder`.
    """
    located = {Path(image): found for image, found in poses.located}
    length = AXES_IN_SQUARES * _find_square(poses)
    outputs = OutputFolder(folder / RECORD_FILE, list(located), overwrite=overwrite)
    written = []
    try:
        for done, (source, found) in enumerate(located.items(), start=1):
            (target,) = outputs.name_images(source).values()
            turned = choose_orientation(read_image_header(source), poses.camera.size, None)
            pixels = read_colour(source, turned)
            write_image(target, draw_axes(pixels, poses.camera, found.pose, length))
            outputs.record(target)
            written.append(target)
            if progress is not None:
                progress(done, len(located))
    finally:
        outputs.close()
    return tuple(written)


def _find_square(poses: PoseSet) -> float:
    """Return the side of a square, mm.

    Raises:
        CalibrationError: if the corners came without a board of known layout.
    """
    if poses.board is None:
        raise CalibrationError(
            "Axes cannot be drawn: the corners' file does not say what board they are of.",
            "Name the photographs themselves.",
        )
    return poses.board.square
