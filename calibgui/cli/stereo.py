"""Write pairs of photographs of a rig with the same points in the same rows.

RIG is rig.json of calibgui rig -o. The rectified photographs of each camera are written into a
folder of its name, both beside each other with lines along their rows into the folder pairs, and
OpenCV's matrices, Q among them, into stereo.yaml. Of cameras above each other it is columns that
agree.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.outputs.output_files import check_outputs, make_folder
from calibgui.app.photographs.paths import find_photograph
from calibgui.app.rig.stereo_images import write_stereo_images
from calibgui.cli.arguments import parse_positive
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.dataset import RigResult, relate_cameras
from calibgui.engine.errors import CalibrationError
from calibgui.engine.rig import rectify_pair
from calibgui.formats.rig_files import write_opencv_stereo
from calibgui.formats.rig_json import read_rig
from calibgui.report.numbers import format_count
from calibgui.report.rig import describe_stereo, measure_row_error
from calibgui.report.tables import fill_lines


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("rig", type=Path, metavar="RIG", help="rig.json")
    parser.add_argument(
        "--pair", nargs=2, metavar="CAMERA", help="the two cameras (the rig's first two)"
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="DIR", help="folder to write the images to"
    )
    parser.add_argument(
        "--zoom",
        type=parse_positive,
        default=1.0,
        metavar="FACTOR",
        help="factor of the focal length: below 1 more is seen, and smaller (default 1)",
    )
    parser.add_argument(
        "--angles",
        action="store_true",
        help="show angles about the line of both cameras in place of a perspective image, for "
        "lenses of 120 degrees and more",
    )
    parser.add_argument(
        "--depth",
        type=parse_positive,
        nargs=2,
        metavar="MM",
        help="nearest and farthest points: the disparities that they have are printed",
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read, rectify, write and print."""
    result = read_rig(options.rig)
    first, second = (0, 1)
    if options.pair:
        first, second = (result.find_camera(name) for name in options.pair)
    pair = rectify_pair(*relate_cameras(result.rig, first, second), options.zoom, options.angles)
    error = measure_row_error(result, first, second)
    messages = []
    if options.output:
        make_folder(options.output)
        names = result.rig.names[first], result.rig.names[second]
        matrices = options.output / "stereo.yaml"
        check_outputs([(matrices, "rig-opencv")], [options.rig], options.overwrite)
        photographs = _find_pairs(result, first, second, options.rig)
        with console.show_progress("rectifying", "pair") as advance:
            write_stereo_images(
                pair, names, photographs, options.output, advance, options.overwrite
            )
        messages.append(f"Wrote {format_count(len(photographs), 'pair')} to {options.output}.")
        if not options.angles:
            messages.append(write_opencv_stereo(result, matrices, (first, second), options.zoom))
    console.print_json(
        {
            "row_error_px": error,
            "baseline_mm": pair.baseline,
            "R1": pair.rotations[0],
            "R2": pair.rotations[1],
            "P1": pair.projections[0],
            "P2": pair.projections[1],
            "Q": pair.disparity_to_depth,
        }
    )
    for text in (describe_stereo(pair, error, options.depth), *messages):
        console.print_text(fill_lines(text, "", "  "))


def _find_pairs(
    result: RigResult, first: int, second: int, file: Path
) -> list[tuple[str, Path, Path]]:
    """Find the photographs of both cameras, by instants.

    Raises:
        CalibrationError: if one is not where it was, nor beside the rig's file, or there is none.
    """
    pairs = []
    seen = {(view.camera, view.instant) for view in result.rig.views}
    for instant in result.rig.instants:
        if not {(first, instant), (second, instant)} <= seen:
            continue
        paths = []
        for camera in (first, second):
            image = result.images[camera, instant]
            found = find_photograph(file, image)
            if found is None:
                raise CalibrationError(
                    f"{image}, a photograph of {file}, is not to be found from here.",
                    "Run the command in the folder in which the rig was calibrated.",
                )
            paths.append(found)
        pairs.append((result.instants[instant], paths[0], paths[1]))
    if not pairs:
        raise CalibrationError("Both cameras have no instant in common.", "Name another pair.")
    return pairs
