"""Take the pictures that a camera is calibrated from, live: what to do with the board is said.

SOURCE is a camera (its number, 0 for the first, or its address, rtsp://...), a video, or a folder
that another program fills. Hold the board where it is asked for: as soon as it is still, sharp and
worth it, a picture is taken. Every fifth also tells how well a camera that is calibrated without
it predicts what it has not seen. It ends when the camera is known well enough, or with Ctrl-C. The
pictures and their corners, corners.json, are then in the folder; nothing that was taken is lost.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.photographs.recording import (
    BoardFinder,
    RecordedFrame,
    Recorder,
    check_recording_folder,
)
from calibgui.cli.arguments import add_grid_size_option, add_square_option, parse_positive
from calibgui.cli.boards import add_board_options, is_pattern_open, read_pattern_options
from calibgui.cli.camera import parse_size
from calibgui.cli.console import Console
from calibgui.dataset import DEFAULT_SQUARE, CornerSet
from calibgui.engine.boards import Board
from calibgui.engine.capture import CameraSettings, CaptureSession, open_source
from calibgui.engine.errors import CalibrationError
from calibgui.formats.corners_json import encode_corners, write_corners
from calibgui.report.numbers import format_count

DEFAULT_LIMIT = 0.1
"""Uncertainty of the worst pixel at which a capture ends, px, unless another is stated."""
_PATIENCE = 60.0
"""Time without a new photograph after which a folder is at its end, s, unless stated."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("source", metavar="SOURCE", help="camera, video or folder")
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="DIR", help="folder for the pictures"
    )
    add_grid_size_option(parser)
    add_board_options(parser)
    add_square_option(parser, "may be given to 'calibgui calibrate' instead")
    parser.set_defaults(roi=None, corners="edges")
    parser.add_argument(
        "--until",
        type=parse_positive,
        default=DEFAULT_LIMIT,
        metavar="PX",
        help="end when the camera puts no pixel farther off than this, one standard deviation "
        f"({DEFAULT_LIMIT:g})",
    )
    parser.add_argument(
        "--size",
        type=parse_size,
        metavar="WxH",
        help="size of the camera's images, px (as the camera has it)",
    )
    parser.add_argument(
        "--exposure",
        type=float,
        metavar="E",
        help="exposure, the same in all pictures, in the camera's own unit (as the camera has it)",
    )
    parser.add_argument(
        "--focus",
        type=float,
        metavar="F",
        help="focus, the same in all pictures, in the camera's own unit (as the camera has it)",
    )
    parser.add_argument(
        "--patience",
        type=parse_positive,
        default=_PATIENCE,
        metavar="S",
        help=f"end when no photograph comes into a folder for so many seconds ({_PATIENCE:g})",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Look at frames, say what to do, and write what is taken."""
    check_recording_folder(options.output)
    pattern = None if is_pattern_open(options) else read_pattern_options(options)
    square = DEFAULT_SQUARE if options.square is None else options.square
    session = CaptureSession(BoardFinder(pattern, options.board), square, options.until)
    recorder, failure = Recorder(session, options.output), None
    wanted = CameraSettings(options.size, options.exposure, options.focus)
    with open_source(options.source, options.patience, wanted) as source:
        if source.remark:
            console.print_text(source.remark)
        try:
            said = readout = ""
            for recorded in recorder.record(source, lambda: False):
                said = _tell(recorded, session, said, console)
                if not readout and (readout := session.describe_readout()):
                    console.print_text(f"  {readout}")
        except KeyboardInterrupt:
            console.print_text("Stopped.")
        except CalibrationError as error:
            failure = error
    _finish(recorder, session, options, square, console)
    if failure is not None:
        raise failure


def _tell(recorded: RecordedFrame, session: CaptureSession, said: str, console: Console) -> str:
    """Print what is new, and return what was said last."""
    state = recorded.state
    if recorded.file is not None:
        known = (
            f"worst pixel ±{session.worst:.2g} px"
            if session.worst < float("inf")
            else "not determined yet"
        )
        aside = ", put aside" if session.pictures[-1].for_validation else ""
        console.print_text(f"{recorded.file.name}: {len(session.pictures)} taken{aside}, {known}.")
        if session.is_complete:
            return said
        wanted = state.wanted
        if wanted is not None:
            console.print_text(f"  Next: {wanted.instruction}")
    if state.instruction not in (said, "Taken."):
        console.print_text(f"  {state.instruction}")
        return state.instruction
    return said


def _finish(
    recorder: Recorder,
    session: CaptureSession,
    options: argparse.Namespace,
    square: float,
    console: Console,
) -> None:
    """Write the corners of what was taken, and say what it is worth.

    Raises:
        CalibrationError: if nothing was taken, or the corners cannot be written.
    """
    if not session.pictures:
        raise CalibrationError(
            f"{options.source} showed no board that was still and sharp.",
            "Hold the whole board in the picture, in good light, and keep it still for a moment.",
        )
    corners = session.pictures[0].corners
    height, width = session.pictures[0].frame.image.shape[:2]
    corner_set = CornerSet(
        (width, height),
        recorder.list_views(),
        Board(*corners.shape, square, corners.pattern),
        lengths_confirmed=options.square is not None,
    )
    file = options.output / "corners.json"
    write_corners(corner_set, file)
    console.print_json(encode_corners(corner_set))
    taken = format_count(len(session.pictures), "picture")
    state = "The camera is known well enough" if session.is_complete else "More would help"
    console.print_text(f"\n{state}: {taken}, worst pixel ±{session.worst:.2g} px.")
    progress = recorder.measure_progress()
    if progress.unseen_corners:
        console.print_text(
            f"Pictures that were put aside are predicted to {progress.unseen_error:.2g} px rms "
            f"({progress.unseen_corners} corners)."
        )
    console.print_text(f"Wrote {file}. Now: calibgui calibrate {options.output}")
    console.print_line(f"{taken} in {options.output}.")
