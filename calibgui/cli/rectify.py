"""Write the board in photographs as seen from straight above.

The photographs of a calibration have their poses in its result.json. In others, or with the camera
file of another program, the board is located first, as calibgui pose does.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from calibgui.app.calibrating.board_poses import locate_boards
from calibgui.app.outputs.resampling import (
    WrittenImage,
    collect_poses,
    rectify_files,
    rectify_located,
)
from calibgui.app.photographs.paths import find_images, find_photograph
from calibgui.cli.arguments import parse_positive
from calibgui.cli.camera import CAMERA_FILE, add_camera_options, read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.corners import add_photograph_options, search_board
from calibgui.cli.resampled import add_output_folder, report_written
from calibgui.cli.result import read_result_and_warn
from calibgui.cli.sensor_mode import adapt_to_images
from calibgui.dataset import Result
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("result", type=Path, metavar="CAMERA", help=CAMERA_FILE)
    add_camera_options(parser)
    add_photograph_options(parser, "for photographs that were not calibrated", nargs="*")
    add_output_folder(parser)
    parser.add_argument(
        "--scale",
        type=parse_positive,
        metavar="PX_PER_MM",
        help="pixels per millimetre on the board; about as in the photographs if left out",
    )


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, locate where that is needed, rectify and write; return the exit code."""
    found = read_camera_and_warn(options.result, console, options.camera, options.size)
    if found.title == EXPORTERS["result"].title:
        result = read_result_and_warn(options.result, console)
        images = find_images(options.paths or _find_photographs(options.result, result))
        known = collect_poses(result)
        if all(str(path) in known or path.name in known for path in images):
            written = _rectify_calibrated(result, images, options, console)
            return report_written(written, options.output, console)
    if not options.paths:
        options.usage_error(f"{options.result} names no photographs: name them after it")
    corner_set, _ = search_board(options, console)
    camera = adapt_to_images(found, None, console, corner_set.size)
    located = locate_boards(camera.camera, corner_set, camera.covariance)
    if not located.located:
        raise CalibrationError(
            "The board was located in none of the photographs.",
            "Photograph the whole board, sharp and evenly lit, or mark its corners with --roi.",
        )
    with console.show_progress("rectifying") as advance:
        written = rectify_located(
            located,
            options.output,
            options.scale,
            lambda done, total, _: advance(done, total),
            options.overwrite,
        )
    return report_written(written, options.output, console)


def _rectify_calibrated(
    result: Result, images: Sequence[Path], options: argparse.Namespace, console: Console
) -> tuple[WrittenImage, ...]:
    """Rectify photographs of the calibration."""
    with console.show_progress("rectifying") as advance:
        return rectify_files(
            result,
            images,
            options.output,
            options.scale,
            progress=lambda done, total, _: advance(done, total),
            overwrite=options.overwrite,
        )


def _find_photographs(path: Path, result: Result) -> list[str]:
    """Find the photographs of the used views of a result, read from `path`.

    Raises:
        CalibrationError: if one is not where it was, nor beside the result.
    """
    found = [find_photograph(path, view.image) for view in result.used]
    for view, photograph in zip(result.used, found, strict=True):
        if photograph is None:
            raise CalibrationError(
                f"{view.image}, a photograph of {path}, is not to be found from here.",
                f"Name the photographs or their folder after {path}.",
            )
    return [str(photograph) for photograph in found]
