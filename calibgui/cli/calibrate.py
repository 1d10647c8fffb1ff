"""Calibrate a camera from photographs of a target, or from a corners.json file.

Of views that do not determine the camera it prints and writes what they do determine, a partial
calibration, says what to photograph, and ends with exit code 1.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from calibgui.app.outputs import check_outputs
from calibgui.app.redetection import calibrate_twice
from calibgui.app.settings import NAMES, Settings, held_in, names_in
from calibgui.cli.arguments import (
    add_images,
    add_search,
    is_corners_file,
    meant_files,
    positive,
    search,
)
from calibgui.cli.boards import add_target, pattern_of
from calibgui.cli.console import Console
from calibgui.dataset.corner_set import CornerSet
from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration import Cost, DegenerateError
from calibgui.engine.camera import MODELS
from calibgui.engine.errors import CalibrationError
from calibgui.engine.kernels import SOLVER_SECONDS, when_compiling
from calibgui.formats import EXPORTERS, export, find_exporter
from calibgui.formats.board_shape_json import read_board_shape, write_board_shape
from calibgui.formats.corners_json import read_corners
from calibgui.formats.result_json import result_record, write_result
from calibgui.report import tables
from calibgui.report.boards import learnt

T = TypeVar("T")


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_images(parser)
    add_search(parser)
    add_target(parser)
    parser.add_argument(
        "--square",
        type=positive,
        metavar="MM",
        help="side of a square, mm; needed for photographs",
    )
    parser.add_argument(
        "--cost",
        choices=[cost.value for cost in Cost],
        default=Cost.IMAGE.value,
        help="minimise the reprojection error in the image (default), the registration error on "
        "the reference plane, or the paper's formulation to the letter",
    )
    parser.add_argument(
        "--fix",
        type=_fixed,
        default={},
        metavar="NAMES",
        help="intrinsics to hold, as k3,p1=0,fx=650; coefficients at 0, the centre at the "
        f"image's and focal lengths at the closed form unless given. Names: {' '.join(NAMES)}",
    )
    parser.add_argument(
        "--free",
        type=_names,
        default=(),
        metavar="NAMES",
        help="intrinsics to estimate that are held by default "
        f"({', '.join(MODELS['lucchese'].held)})",
    )
    parser.add_argument(
        "--robust",
        action="store_true",
        help="leave out corners and views that do not fit, and name them",
    )
    parser.add_argument(
        "--once",
        action="store_true",
        help="leave out the search, once the camera is known, of images without a board and of "
        "boards found in part, and the second calibration from what that gains",
    )
    parser.add_argument(
        "--weigh-views",
        action="store_true",
        help="weigh every view by the noise that is found in it, so that poor views spoil less; "
        "best with an estimated plate",
    )
    parser.add_argument(
        "--plate",
        type=_board_shape,
        default=BoardShapeModel.NOMINAL,
        metavar="MODEL|FILE",
        help="the board's shape: nominal (default), or estimated as affine (sides and shear), "
        "bow (two bends) or free (every corner), or auto, whichever predicts unseen views best; "
        "or held as in a plate.json made before",
    )
    parser.add_argument(
        "--prior",
        type=_prior,
        metavar="XY,Z",
        help="what is known of a free plate: standard deviations of its corners in the plane "
        "and out of it, mm, as 0.1,0.3",
    )
    parser.add_argument(
        "--save-plate", type=Path, metavar="FILE", help="write the estimated plate as plate.json"
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="write result.json")
    parser.add_argument(
        "--export",
        type=_export,
        action="append",
        default=[],
        metavar="FORMAT=FILE",
        help=f"write another format as well, may be repeated: {', '.join(EXPORTERS)}",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Search, calibrate, write and print."""
    _check_usage(options)
    outputs = filter(None, [options.output, options.save_plate])
    check_outputs([*outputs, *(path for _, path in options.export)], meant_files(options.paths))
    settings = Settings(
        cost=Cost(options.cost),
        fixed=options.fix,
        freed=options.free,
        board_shape=options.plate,
        prior=options.prior,
        robust=options.robust,
        weigh_views=options.weigh_views,
        once=options.once,
    )
    corner_set = _corner_set(options, console)
    try:
        preparing = f"Preparing the solver for its first use (once, about {SOLVER_SECONDS} s)…"
        with when_compiling(lambda: console.notice(preparing)):
            search = not is_corners_file(options.paths)
            result = calibrate_twice(corner_set, settings, search=search)
    except CalibrationError:
        if unused := tables.unused(corner_set.views):
            console.problem(unused)
        raise
    written = []
    if options.output:
        write_result(result, options.output)
        written.append(f"Wrote {options.output}.")
    if options.save_plate and result.calibration.board_shape is not None:
        write_board_shape(result.calibration.board_shape, options.save_plate)
        written.append(f"Wrote {options.save_plate}.")
    diagnosis = result.calibration.diagnosis
    for name, path in options.export:
        if diagnosis is not None and not EXPORTERS[name].partial:
            written.append(f"{path} is not written: it could not say that this is partial.")
        else:
            written.append(f"Wrote {path}. {export(result, name, path).note}")
    console.answer(result_record(result))
    console.say(tables.report(result), otherwise=tables.unused(result.views))
    if written:
        console.say("\n" + "\n".join(map(tables.bullet, written)))
    if diagnosis is not None:  # not what was asked for
        raise DegenerateError(diagnosis.message, diagnosis.hint, result.calibration)


def _check_usage(options: argparse.Namespace) -> None:
    """End the program if options do not go together."""
    if both := options.fix.keys() & set(options.free):
        options.usage_error(f"{', '.join(sorted(both))} cannot be both held and freed")
    if options.save_plate and options.plate is BoardShapeModel.NOMINAL:
        options.usage_error("--save-plate needs a plate that is estimated: add --plate free")
    if options.weigh_views and options.cost != Cost.IMAGE:
        options.usage_error("--weigh-views is for the cost 'image'")
    if options.prior and options.plate not in (BoardShapeModel.FREE, None):
        options.usage_error("--prior is of a free plate: add --plate free or auto")
    if is_corners_file(options.paths):
        if options.board or options.roi or options.target != "checkerboard":
            options.usage_error(
                "--board, --roi and --target are for photographs, not for a corners file"
            )
    elif any(is_corners_file([path]) for path in options.paths):
        options.usage_error("a corners file is calibrated by itself")
    elif options.square is None:
        options.usage_error("--square MM, side of a square or distance of circles, is needed")


def _corner_set(options: argparse.Namespace, console: Console) -> CornerSet:
    """The views to calibrate from, searched or read."""
    if is_corners_file(options.paths):
        return _from_corners_file(options)
    pattern = pattern_of(options)
    detection = search(console, options.paths, options.board, options.roi, options.corners, pattern)
    corner_set = detection.corner_set(options.square)
    if words := learnt(pattern, corner_set.board):
        console.say(words + "\n")
    return corner_set


def _from_corners_file(options: argparse.Namespace) -> CornerSet:
    """The views of a corners.json; with --square, of a board of squares of that side."""
    corner_set = read_corners(options.paths[0])
    if options.square is None:
        return corner_set
    if corner_set.board is None:
        raise CalibrationError(
            f"{options.paths[0]} states its own millimetres.", "Leave out --square."
        )
    return replace(corner_set, board=replace(corner_set.board, square=options.square))


def _fixed(text: str) -> dict[str, float | None]:
    return _usable(held_in, text)


def _names(text: str) -> tuple[str, ...]:
    return _usable(names_in, text)


def _usable(read: Callable[[str], T], text: str) -> T:
    """What `read` takes from an argument; what it refuses is an error of usage."""
    try:
        return read(text)
    except CalibrationError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _board_shape(text: str) -> BoardShapeModel | BoardShape | None:
    """A model of the plate, None for the best, or a plate from a file."""
    if text == "auto":
        return None
    if text in list(BoardShapeModel):
        return BoardShapeModel(text)
    try:
        return read_board_shape(text)
    except CalibrationError as error:
        models = ", ".join([*BoardShapeModel, "auto"])
        raise argparse.ArgumentTypeError(f"{text!r} is none of {models}: {error}") from error


def _prior(text: str) -> BoardShapePrior:
    """Standard deviations from "0.1,0.3"."""
    try:
        in_plane, out_of_plane = map(positive, text.split(","))
    except (ValueError, argparse.ArgumentTypeError) as error:
        raise argparse.ArgumentTypeError(f"{text!r} is not XY,Z in mm, as 0.1,0.3") from error
    return BoardShapePrior(in_plane, out_of_plane)


def _export(text: str) -> tuple[str, Path]:
    name, equals, file = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text!r} is not FORMAT=FILE")
    try:
        find_exporter(name, file)
    except CalibrationError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return name, Path(file)
