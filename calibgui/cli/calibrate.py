"""Calibrate a camera from photographs of a board, or from a file of corners.

If the views do not determine the camera, the command prints and writes a partial calibration,
says what to photograph, and ends with exit code 1. If it breaks one of --limits, it is 3.
"""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from calibgui.app.calibrating.best_camera import calibrate_best
from calibgui.app.calibrating.settings import (
    AUTO_MODEL,
    DEFAULT_MODEL,
    MODEL_CHOICES,
    Settings,
    check_settings,
    get_own_model,
    parse_fixed,
    parse_names,
)
from calibgui.app.calibrating.true_board import GLASS, list_gains, measure_gain_of_glass
from calibgui.app.system.limit_presets import find_camera_limits
from calibgui.cli.arguments import (
    add_export_folder_option,
    add_export_option,
    add_hardware_option,
    add_reader_option,
    is_corners_file,
    parse_model,
    parse_positive,
    read_hardware_options,
)
from calibgui.cli.console import Console
from calibgui.cli.corners import add_corner_options, check_corner_options, read_or_search
from calibgui.cli.limits import BROKEN, add_limits_option
from calibgui.cli.notices import explain_solve
from calibgui.cli.outputs import (
    add_overwrite_option,
    check_corner_outputs,
    export_to_folder,
    refuse_other_format,
)
from calibgui.dataset import DEFAULT_SQUARE, Result
from calibgui.dataset.acceptance import list_broken_limits
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import CANDIDATES
from calibgui.engine.boards import BoardShape, BoardShapeModel, BoardShapePrior
from calibgui.engine.calibration import DEFAULT_METHOD, METHODS, Cost, DegenerateError
from calibgui.engine.camera import MODELS, PINHOLE, SplinedStereographic
from calibgui.engine.errors import CalibrationError
from calibgui.formats import EXPORTERS, export
from calibgui.formats.board_shape_json import read_board_shape, write_board_shape
from calibgui.formats.origin import BOARD_SHAPE, RESULT
from calibgui.formats.result_json import encode_result_with_findings, write_result
from calibgui.report import tables
from calibgui.report.summary import describe_lost_images


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_corner_options(
        parser, f"only lengths depend on it ({DEFAULT_SQUARE:g} if left out, which is then said)"
    )
    add_settings_options(parser, is_automatic=True)
    parser.add_argument(
        "--save-board-shape",
        "--save-plate",
        type=Path,
        metavar="FILE",
        help="write the estimated board shape, for later calibrations with the same board",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE",
        help="write the result as JSON, which other commands read; - for standard output",
    )
    add_limits_option(parser)
    add_export_option(parser, "write another format as well")
    add_export_folder_option(parser)
    add_hardware_option(parser)
    add_reader_option(parser)
    add_overwrite_option(parser)
    parser.add_argument(
        "-v",
        "--verbose",
        "--stage-one",
        action="store_true",
        help="print all that is known: each view by itself (the paper's Stage I), its residuals "
        "and pose, the camera in the paper's units, and how far each value is determined",
    )


def add_settings_options(parser: argparse.ArgumentParser, is_automatic: bool = False) -> None:
    """Add the options on how to calibrate, which `read_settings` reads.

    Args:
        parser: the parser of a command.
        is_automatic: True if what is not stated is chosen by what the photographs say.
    """
    group = parser.add_argument_group("calibration", "What is estimated, and how.")
    parser.set_defaults(as_asked=not is_automatic)
    if is_automatic:
        group.add_argument(
            "--as-asked",
            action="store_true",
            help="choose nothing, and make nothing better by itself",
        )
    group.add_argument(
        "--cost",
        choices=[cost.value for cost in Cost],
        default=Cost.IMAGE.value,
        help="minimise the reprojection error in the image (default), the registration error on "
        "the reference plane, or the paper's formulation to the letter",
    )
    group.add_argument(
        "--model",
        type=parse_model,
        default=argparse.SUPPRESS,  # None is the automatic choice
        metavar="NAME",
        help=f"the lens model to estimate; if left out, {'auto, or ' * is_automatic}the "
        f"method's own. {_describe_models('' if is_automatic else DEFAULT_MODEL)}",
    )
    group.add_argument(
        "--method",
        choices=METHODS,
        default=DEFAULT_METHOD,
        metavar="NAME",
        help="the method of calibration, with the lens models that it takes in brackets; "
        f"calibgui compare shows all side by side. {_describe_methods()}",
    )
    group.add_argument(
        "--fix",
        metavar="NAMES",
        help="parameters of the lens model to hold, as k3,p1=0,fx=650; without a value "
        "coefficients are held at 0, the centre at the middle of the image and focal lengths at "
        f"their first estimate. {_describe_parameters()}",
    )
    group.add_argument(
        "--free",
        metavar="NAMES",
        help="parameters of the lens model to estimate that are held by default: "
        + _describe_held_parameters(),
    )
    group.add_argument(
        "--robust",
        action="store_true",
        help="leave out corners and views that do not fit, and name them",
    )
    group.add_argument(
        "--once",
        action="store_true",
        help="leave out the second search, with the camera known, of images without a whole board",
    )
    group.add_argument(
        "--weigh-views",
        action="store_true",
        help="weigh every view by the noise that is found in it; best with an estimated board "
        "shape",
    )
    group.add_argument(
        "--board-shape",
        "--plate",
        type=_read_board_shape,
        default=argparse.SUPPRESS,  # None is the automatic choice
        metavar="MODEL|FILE",
        help="the board's shape: nominal (flat and as drawn"
        + (")" if is_automatic else ", default)")
        + "; estimated as affine (sides "
        "and shear), bow (two bends) or free (every corner); auto, whichever of these predicts "
        "unseen views best"
        + (" (default)" if is_automatic else "")
        + "; or a file written by --save-board-shape, whose shape is held",
    )
    group.add_argument(
        "--prior",
        type=_parse_prior,
        metavar="XY,Z",
        help="what is known of the board: standard deviations of its corners in the plane (the "
        "print) and out of it (flatness), mm, as 0.1,0.3; without it some 0.03 %% of the board's "
        "size, which yields to what the views show. It counts in every ±, and in a free board "
        "shape",
    )


def run(options: argparse.Namespace, console: Console) -> int:
    """Search, calibrate, write and print; return the exit code."""
    settings = read_settings(options)
    _check_usage(options, settings)
    limits = None if options.limits is None else find_camera_limits(options.limits)
    if options.reader:
        options.export = [*options.export, options.reader]
    options.output = console.take_output(options.output)
    if options.output:
        refuse_other_format(options.output)
    outputs = [(options.output, RESULT), (options.save_board_shape, BOARD_SHAPE)]
    exported = [(path, name) for name, path in options.export]
    check_corner_outputs(options, [*(pair for pair in outputs if pair[0]), *exported])
    corner_set = read_or_search(options, console)
    search = not is_corners_file(options.paths)
    with (
        explain_solve(console, corner_set),
        console.show_progress("looking for the best camera", "step") as advance,
    ):
        count = itertools.count(1)

        def tell(*_: int) -> None:
            advance(next(count), 0)

        steps = calibrate_best(corner_set, settings, search=search, progress=tell, check=tell)
        *_, (_, _, result) = steps
        judge_result(result, check=tell)
    result = replace(result, limits=limits)
    messages, errors = _write_files(result, options)
    _print_report(result, messages, options, console)
    diagnosis = result.calibration.diagnosis
    if diagnosis is not None:  # the user wanted a whole calibration
        hint = describe_lost_images(result) or diagnosis.hint
        errors.append(DegenerateError(diagnosis.message, hint, result.calibration))
    for error in errors[:-1]:
        console.print_problem(f"calibgui: {error}")
    if errors:
        raise errors[-1]
    return BROKEN if result.limits and list_broken_limits(result, result.limits) else 0


def _print_report(
    result: Result, messages: list[str], options: argparse.Namespace, console: Console
) -> None:
    """Print the verdict, the camera and the files that were written; with --quiet one line."""
    if console.json:
        console.print_json(encode_result_with_findings(result))
        return
    if console.quiet:
        console.print_line(tables.summarise_in_a_line(result))
        if unused := tables.list_unused_views(result.views):
            console.print_problem(unused)
        return
    console.print_text(tables.format_report(result, verbose=options.verbose))
    if narrower := measure_gain_of_glass(result):
        messages = [_offer_glass(narrower), *messages]
    if result.condition:
        messages = [f"Lengths hold {result.condition}. --square MM states it.", *messages]
    if messages:
        console.print_text("\n" + "\n".join(map(tables.format_bullet, messages)))
    if not options.verbose:
        console.print_text("\n-v shows each view by itself, and all that is known of each value.")


def _offer_glass(narrower: Mapping[str, float]) -> str:
    """Return a sentence on what it brings to state that the board is of glass."""
    return (
        f"If the board is of glass, printed true to {GLASS.in_plane:g} mm and flat to "
        f"{GLASS.out_of_plane:g} mm, say --prior {GLASS.in_plane:g},{GLASS.out_of_plane:g}: "
        f"{list_gains(narrower)} px."
    )


def _write_files(
    result: Result, options: argparse.Namespace
) -> tuple[list[str], list[CalibrationError]]:
    """Write all files that the options name.

    Returns:
        A sentence on each file, and the reasons why some could not be exported.

    Raises:
        CalibrationError: if the result or the board's shape cannot be written.
    """
    calibration = result.calibration
    result = replace(result, hardware=read_hardware_options(options))
    messages, errors = [], []
    if options.output:
        write_result(result, options.output)
        messages.append(f"Wrote {options.output}.")
    if options.save_board_shape and calibration.board_shape is not None:
        write_board_shape(calibration.board_shape, options.save_board_shape)
        messages.append(f"Wrote {options.save_board_shape}.")
    elif options.save_board_shape:
        messages.append(
            f"{options.save_board_shape} is not written: nothing shows that the board is not flat "
            "and printed true. --board-shape free estimates its shape all the same."
        )
    if options.export_all is not None:
        messages.append(export_to_folder(result, options))
    for name, path in options.export:
        if calibration.diagnosis is not None and not EXPORTERS[name].partial:
            messages.append(
                f"{path} is not written: the format cannot state that a calibration is partial."
            )
            continue
        try:
            messages.append(f"Wrote {path}. {export(result, name, path).note}")
        except CalibrationError as error:
            errors.append(error)
    return messages, errors


def read_settings(options: argparse.Namespace) -> Settings:
    """Return the settings that the options state, or end the program if they are impossible."""
    is_default = options.method == DEFAULT_METHOD and options.cost == Cost.IMAGE
    improve = is_default and not options.as_asked
    # Names of parameters, and a prior, are of the paper's model and of the board as drawn.
    is_lens_open = improve and options.fix is None and options.free is None
    is_board_open = improve and options.prior is None
    model = None if is_lens_open else get_own_model(options.method)
    model = options.model if "model" in options else model
    board_shape = None if is_board_open else BoardShapeModel.NOMINAL
    board_shape = options.board_shape if "board_shape" in options else board_shape
    try:
        settings = Settings(
            cost=Cost(options.cost),
            model=model,
            candidates=_list_candidates(options, model),
            method=options.method,
            fixed={} if options.fix is None else parse_fixed(options.fix, model),
            freed=() if options.free is None else parse_names(options.free, model),
            board_shape=board_shape,
            prior=options.prior,
            robust=options.robust,
            weigh_views=options.weigh_views,
            once=options.once,
            improve=improve,
        )
        check_settings(settings)
    except CalibrationError as error:
        options.usage_error(str(error))
    return settings


def _list_candidates(options: argparse.Namespace, model: str | None) -> tuple[str, ...]:
    """List the lens models that the reader of --for has; end the program if none can be chosen."""
    if not getattr(options, "reader", None):
        return ()
    name, _ = options.reader
    if model is not None:
        options.usage_error(f"--for chooses the lens model: with --model say --export {name}=FILE")
    held = tuple(each for each in CANDIDATES if each in EXPORTERS[name].models)
    if not held:
        options.usage_error(f"{name} has none of our lens models: say --export {name}=FILE")
    return held


def _check_usage(options: argparse.Namespace, settings: Settings) -> None:
    """End the program if options do not go together."""
    if options.save_board_shape and settings.board_shape is BoardShapeModel.NOMINAL:
        options.usage_error(
            "--save-board-shape needs a shape that is estimated: add --board-shape free"
        )
    if options.prior and settings.board_shape in (BoardShapeModel.AFFINE, BoardShapeModel.BOW):
        options.usage_error("--prior is for a board as drawn or of free shape: leave it out")
    check_corner_options(options)
    in_mm = "--prior" if options.prior else "--save-board-shape" if options.save_board_shape else ""
    if in_mm and options.square is None and not is_corners_file(options.paths):
        options.usage_error(f"{in_mm} is in mm: add --square MM")


def _describe_models(default: str) -> str:
    """List the lens models to choose from with their titles, the default one, if any, marked."""
    models = (
        f"{name}{' (default)' if name == default else ''}: {MODELS[name].title}"
        for name in MODEL_CHOICES
    )
    return (
        f"{AUTO_MODEL}: the paper's (lucchese) unless the views demand another; calibgui models "
        f"compares all. {'; '.join(models)}; or with other numbers, such as "
        "splined-stereographic-40x30-120 for 40 x 30 control points over 120 degrees"
    )


def _describe_methods() -> str:
    """List the methods with their titles and the lens models that they estimate."""
    methods = (
        f"{name}{' (default)' if name == DEFAULT_METHOD else ''}, {method.title}"
        + ("" if name == DEFAULT_METHOD else f" ({', '.join(method.lens_models)})")
        for name, method in METHODS.items()
    )
    return "; ".join(methods)


def _describe_parameters() -> str:
    """List the parameters of the lens models to choose from, but for the splined one's hundreds."""
    models = [
        f"{name} {' '.join(MODELS[name].names)}"
        for name in MODEL_CHOICES
        if MODELS[name].names and not isinstance(MODELS[name], SplinedStereographic)
    ]
    return f"All models have {' '.join(PINHOLE)}; {'; '.join(models)}"


def _describe_held_parameters() -> str:
    """List the parameters that are held by default, with the lens models that hold them."""
    models: dict[str, list[str]] = {}
    for name in MODEL_CHOICES:
        models.setdefault(" ".join(MODELS[name].held), []).append(name)
    return "; ".join(f"{held} of {', '.join(names)}" for held, names in models.items() if held)


def _read_board_shape(text: str) -> BoardShapeModel | BoardShape | None:
    """Return a model of the board's shape, None for the best one, or the shape in a file."""
    if text == "auto":
        return None
    if text in list(BoardShapeModel):
        return BoardShapeModel(text)
    try:
        return read_board_shape(text)
    except CalibrationError as error:
        models = ", ".join([*BoardShapeModel, "auto"])
        raise argparse.ArgumentTypeError(f"{text!r} is none of {models}: {error}") from error


def _parse_prior(text: str) -> BoardShapePrior:
    """Read two standard deviations such as "0.1,0.3", mm."""
    try:
        in_plane, out_of_plane = map(parse_positive, text.split(","))
    except (ValueError, argparse.ArgumentTypeError) as error:
        raise argparse.ArgumentTypeError(f"{text!r} is not XY,Z in mm, as 0.1,0.3") from error
    return BoardShapePrior(in_plane, out_of_plane)
