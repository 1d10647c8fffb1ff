"""Calibrate a rig of several cameras from photographs of a board that they take together.

Each CAM is the folder, quoted pattern or video of one camera; one folder may hold a folder for each
camera, or the photographs of all, as left01, right01 or cam0_1403636579763555584. Which photographs
belong together is printed before anything is searched. Each camera is calibrated alone, then all
together; what contradicts the others is left out and named. Several boards that stand fast to each
other are stated one by one (--another); how they stand is found with the rig.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from calibgui.app.calibrating.settings import Settings
from calibgui.app.outputs.output_files import check_outputs, check_suffix
from calibgui.app.photographs.detection import Detection
from calibgui.app.rig.boards import (
    StatedBoard,
    list_boardless_views,
    name_boards,
    search_boards,
)
from calibgui.app.rig.calibrating import calibrate_photographs, require_times
from calibgui.app.rig.frames import find_videos, read_frame_times, write_frames
from calibgui.app.rig.pairing import find_cameras, pair_files, state_times
from calibgui.app.rig.time_pairing import Times, pair_by_times, read_file_times
from calibgui.cli.arguments import (
    add_corner_method,
    add_grid_size_option,
    add_square_option,
    parse_model,
    parse_positive,
    require_board,
    search_images,
)
from calibgui.cli.boards import add_board_options
from calibgui.cli.camera import read_camera_and_warn
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.cli.rig_boards import add_another_option, read_stated_boards
from calibgui.dataset import DEFAULT_SQUARE, RigPairing, RigResult
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import is_video
from calibgui.engine.rig import Mistake
from calibgui.formats import ImportedCamera
from calibgui.formats.origin import RIG
from calibgui.formats.rig_files import RIG_EXPORTERS, find_rig_exporter
from calibgui.formats.rig_json import encode_rig, write_rig
from calibgui.formats.times_csv import read_times
from calibgui.report.rig import describe_fit, describe_mistake, describe_pairing, format_rig
from calibgui.report.tables import fill_lines, format_bullet, list_unused_views


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.set_defaults(usage_error=parser.error)
    parser.add_argument(
        "cameras",
        nargs="+",
        metavar="CAM",
        help="photographs of one camera: folder, quoted pattern or video; or one folder of all",
    )
    add_grid_size_option(parser)
    add_board_options(parser)
    add_corner_method(parser)
    add_square_option(parser, f"all lengths depend on it ({DEFAULT_SQUARE:g} if left out)")
    add_another_option(parser)
    parser.add_argument(
        "--board-shape",
        type=BoardShapeModel,
        choices=list(BoardShapeModel),
        default=BoardShapeModel.NOMINAL,
        metavar="SHAPE",
        help="the shape of the boards: nominal (flat and as drawn, the default), affine, bow or "
        "free, estimated with the rig and shared by all cameras",
    )
    parser.add_argument(
        "--model",
        type=parse_model,
        metavar="NAME",
        help="the lens model of all cameras; if left out, each has the one that its photographs "
        "demand",
    )
    parser.add_argument(
        "--known",
        type=_parse_known,
        action="append",
        default=[],
        metavar="CAMERA=FILE",
        help="a camera that is known from result.json or the file of another program; it is "
        "estimated with the errors in the file as a prior, and held if there are none; may be "
        "repeated",
    )
    parser.add_argument(
        "--hold", action="store_true", help="hold all cameras as each alone is, or as it is known"
    )
    parser.add_argument(
        "--robust", action="store_true", help="leave out corners and views that no camera explains"
    )
    parser.add_argument(
        "--offsets",
        action="store_true",
        help="estimate by how much each camera is later than the first one, from a board that "
        "moves: of videos, or photographs in quick succession, whose --times must be known",
    )
    parser.add_argument(
        "--times",
        type=Path,
        metavar="FILE",
        help="CSV table of times with the columns file and time_s, or camera, number (of the "
        "photograph or frame) and time_s",
    )
    parser.add_argument(
        "--within",
        type=parse_positive,
        metavar="SECONDS",
        help="pair photographs that were taken at most so far apart, by --times, by names with "
        "seconds or nanoseconds since 1970 as of ROS, or by EXIF",
    )
    parser.add_argument(
        "--every",
        type=_parse_step,
        default=1,
        metavar="N",
        help="take every Nth frame of videos (default 1); they are written beside the output, in "
        "folders VIDEO-frames",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="write the rig as JSON; - for stdout"
    )
    parser.add_argument(
        "--export",
        type=_parse_export,
        action="append",
        default=[],
        metavar="FORMAT=FILE",
        help="write another format as well, may be repeated: "
        + "; ".join(f"{each.name} ({each.title})" for each in RIG_EXPORTERS.values()),
    )
    parser.add_argument(
        "--pair",
        nargs=2,
        metavar="CAMERA",
        help="the two cameras of files that hold a pair (the first two)",
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Pair, search, calibrate, write and print."""
    output = console.take_output(options.output)
    if output:
        check_suffix(output, (".json",), "JSON")
    pairing = _pair(options, console, output)
    if options.offsets:
        require_times(pairing)
    console.print_text(fill_lines(describe_pairing(pairing), "", "  ") + "\n")
    known = _read_known(options, pairing, console)
    if output:
        read = [file for camera in pairing.cameras for file in camera.files.values()]
        check_outputs([(output, RIG)], read, options.overwrite)
    boards = read_stated_boards(options)
    is_only = len(boards) == 1
    corner_sets = search_boards(pairing, boards, partial(_search, options, console, is_only))
    for camera in pairing.cameras:
        if unused := list_unused_views(list_boardless_views(corner_sets, camera.name)):
            console.print_text(f"{camera.name}: {unused}\n", otherwise=f"{camera.name}: {unused}")
    settings = Settings(model=options.model, robust=options.robust)
    with console.show_progress("calibrating", "camera") as advance:
        done = iter(range(len(pairing.cameras) + 1))
        result = calibrate_photographs(
            pairing,
            corner_sets,
            settings,
            known,
            options.hold,
            options.offsets,
            tell=lambda _: advance(next(done), len(pairing.cameras)),
            boards=name_boards(boards, options.board_shape),
        )
    if shifted := [m for m in result.rig.mistakes if m.kind is Mistake.SHIFTED]:
        console.print_text(format_rig(result) + "\n")
        raise CalibrationError(
            describe_mistake(result, shifted[0]),
            "Rename the photographs, or move them in the window (File, Several cameras). Nothing "
            "was written.",
        )
    messages = _write(result, options, output)
    console.print_json(encode_rig(result))
    console.print_line(describe_fit(result.rig))
    console.print_text(format_rig(result))
    if messages:
        console.print_text("\n" + "\n".join(map(format_bullet, messages)))


def _pair(options: argparse.Namespace, console: Console, output: Path | None) -> RigPairing:
    """Pair the photographs, or the frames of videos, of the cameras."""
    videos = find_videos(options.cameras)
    times: Times = {}
    groups: Mapping[str, Sequence[Path]]
    if videos:
        folder = output.parent if output else Path()
        groups = write_frames(videos, folder, options.every, console.show_progress)
        times = read_frame_times(videos, groups)
    elif any(is_video(name) for name in options.cameras if Path(name).is_file()):
        raise CalibrationError(
            "A rig is of videos of all cameras, or of photographs.", "Name a video for each camera."
        )
    else:
        groups = find_cameras(options.cameras)
    if options.times:
        times = read_times(options.times, groups)
    if options.within is not None:
        return pair_by_times(groups, times or read_file_times(groups), options.within)
    pairing = pair_files(groups)
    return state_times(pairing, times) if times else pairing


def _search(
    options: argparse.Namespace,
    console: Console,
    is_only: bool,
    files: Sequence[str],
    board: StatedBoard,
) -> Detection:
    """Search photographs of one camera for a board; the only one has to be there."""
    detection = search_images(console, files, board.grid_size, None, options.corners, board.pattern)
    if is_only:
        require_board(detection, board.grid_size, console, board.pattern is None)
    return detection


def _read_known(
    options: argparse.Namespace, pairing: RigPairing, console: Console
) -> Mapping[str, ImportedCamera]:
    """Read the cameras that are known beforehand."""
    names = [camera.name for camera in pairing.cameras]
    known = {}
    for name, file in options.known:
        if name not in names:
            raise CalibrationError(
                f"--known names no camera of the rig: {name}.", f"Choose from {', '.join(names)}."
            )
        known[name] = read_camera_and_warn(file, console)
    return known


def _write(result: RigResult, options: argparse.Namespace, output: Path | None) -> list[str]:
    """Write all files that the options name; return a sentence on each."""
    messages = []
    pair = (0, 1)
    if options.pair:
        pair = (result.find_camera(options.pair[0]), result.find_camera(options.pair[1]))
    files = []
    for name, path in options.export:
        listed = RIG_EXPORTERS[name].list_files(result, path, pair)
        files += [(file, f"rig-{name}") for file in listed]
    check_outputs(files, list(result.images.values()), options.overwrite)
    if output:
        write_rig(result, output)
        messages.append(f"Wrote {output}.")
    messages += [RIG_EXPORTERS[name].write(result, path, pair) for name, path in options.export]
    return messages


def _parse_known(text: str) -> tuple[str, Path]:
    """Read the name of a camera and a file such as "left=left.json"."""
    name, equals, file = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text!r} is not CAMERA=FILE")
    return name, Path(file)


def _parse_export(text: str) -> tuple[str, Path]:
    """Read the name of a format and a file such as "opencv=stereo.yaml"."""
    name, equals, file = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text!r} is not FORMAT=FILE")
    try:
        find_rig_exporter(name, Path(file))
    except CalibrationError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return name, Path(file)


def _parse_step(text: str) -> int:
    """Read a whole number above 0."""
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number above 0")
    return int(text)
