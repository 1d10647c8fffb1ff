"""Write the board in calibrated photographs as seen from straight above."""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.outputs.resampling import rectify_files
from calibgui.app.photographs.paths import find_images, find_photograph
from calibgui.cli.arguments import add_image_paths, parse_positive
from calibgui.cli.console import Console
from calibgui.cli.resampled import add_output_folder, report_written
from calibgui.cli.result import read_result_and_warn
from calibgui.dataset import Result
from calibgui.engine.errors import CalibrationError


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument(
        "result", type=Path, metavar="RESULT", help="result.json with the photographs' poses"
    )
    add_image_paths(parser, nargs="*")
    add_output_folder(parser)
    parser.add_argument(
        "--scale",
        type=parse_positive,
        metavar="PX_PER_MM",
        help="pixels per millimetre on the board; about as in the photographs if left out",
    )


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, rectify and write; return the exit code."""
    result = read_result_and_warn(options.result, console)
    images = find_images(options.paths or _find_photographs(options.result, result))
    with console.show_progress("rectifying") as advance:
        written = rectify_files(
            result,
            images,
            options.output,
            options.scale,
            progress=lambda done, total, _: advance(done, total),
            overwrite=options.overwrite,
        )
    return report_written(written, options.output, console)


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
