"""Take the pictures that cameras are calibrated from, live: what to do with the board is said.

SOURCE is a camera (its number, 0 for the first, or its address, rtsp://...), a video, or a folder
that another program fills. Hold the board where it is asked for: as soon as it is still, sharp and
worth it, a picture is taken. Every fifth also tells how well a camera that is calibrated without
it predicts what it has not seen. It ends when the camera is known well enough, or with Ctrl-C. The
pictures and their corners, corners.json, are then in the folder; nothing that was taken is lost.

Several sources are the cameras of a rig, which take each picture at the same instant, into the
folders cam0, cam1, ... for 'calibgui rig'. It is said which two have too few common views and, from
the moving board, how far apart their clocks are.
"""

from __future__ import annotations

import argparse
from contextlib import closing
from pathlib import Path

from calibgui.app.photographs.recording import (
    BoardFinder,
    RecordedInstant,
    Recorder,
    begin_session,
    check_recording_folder,
    describe_pairs,
    describe_readouts,
    open_cameras,
)
from calibgui.cli.arguments import add_grid_size_option, add_square_option, parse_positive
from calibgui.cli.boards import add_board_options, is_pattern_open, read_pattern_options
from calibgui.cli.camera import parse_size
from calibgui.cli.console import Console
from calibgui.dataset import DEFAULT_SQUARE, CornerSet
from calibgui.engine.boards import Board
from calibgui.engine.capture import (
    CameraSettings,
    JointSession,
    PairedFrames,
)
from calibgui.engine.errors import CalibrationError
from calibgui.formats.corners_json import encode_corners, write_corners
from calibgui.report.numbers import format_count

DEFAULT_LIMIT = 0.1
"""Uncertainty of the worst pixel at which a capture ends, px, unless another is stated."""
_PATIENCE = 60.0
"""Time without a new photograph after which a folder is at its end, s, unless stated."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument(
        "sources",
        nargs="+",
        metavar="SOURCE",
        help="camera, video or folder; several cameras or videos are those of a rig",
    )
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
    finder = BoardFinder(pattern, options.board)
    session = begin_session(len(options.sources), finder, square, options.until)
    recorder, failure = Recorder(session, options.output), None
    wanted = CameraSettings(options.size, options.exposure, options.focus)
    with closing(open_cameras(options.sources, options.patience, wanted)) as frames:
        if frames.remark:
            console.print_text(frames.remark)
        try:
            _watch(recorder, session, frames, console)
        except KeyboardInterrupt:
            console.print_text("Stopped.")
        except CalibrationError as error:
            failure = error
    _finish(recorder, session, options, square, console)
    if failure is not None:
        raise failure


def _watch(
    recorder: Recorder, session: JointSession, frames: PairedFrames, console: Console
) -> None:
    """Look at frames to the end, and say what is new."""
    said, absent, readouts = "", list[str](), list[str]()
    for recorded in recorder.record(frames, lambda: False):
        if (told := recorder.describe_absent(frames)) != absent:
            absent = told
            for problem in absent:
                console.print_text(problem)
        if recorded.files:
            _tell_taken(recorded, session, console)
        instruction = recorded.state.instruction
        if instruction not in (said, "Taken.") and not session.is_complete:
            console.print_text(f"  {instruction}")
            said = instruction
        if len(found := describe_readouts(session)) > len(readouts):
            readouts = found
            console.print_text("\n".join(f"  {sentence}" for sentence in found))


def _tell_taken(recorded: RecordedInstant, session: JointSession, console: Console) -> None:
    """Print what an instant has brought."""
    state, name = recorded.state, recorded.files[0].name
    for c, picture in enumerate(state.taken):
        if picture is None:
            continue
        camera = session.cameras[c]
        known = (
            f"worst pixel ±{camera.worst:.2g} px"
            if camera.worst < float("inf")
            else "not determined yet"
        )
        place = f"{session.names[c]}/{name}" if len(session.names) > 1 else name
        aside = ", put aside" if picture.for_validation else ""
        console.print_text(f"{place}: {len(camera.pictures)} taken{aside}, {known}.")
    for sentence in describe_pairs(session):
        console.print_text(f"  {sentence}")
    leading = state.cameras[state.leading]
    if leading is not None and leading.wanted is not None and not session.is_complete:
        where = f"{session.names[state.leading]}: " if len(session.names) > 1 else ""
        console.print_text(f"  Next: {where}{leading.wanted.instruction}")


def _finish(
    recorder: Recorder,
    session: JointSession,
    options: argparse.Namespace,
    square: float,
    console: Console,
) -> None:
    """Write the corners of what was taken, and say what it is worth.

    Raises:
        CalibrationError: if nothing was taken, or the corners cannot be written.
    """
    if not session.instants:
        raise CalibrationError(
            f"{' and '.join(options.sources)} showed no board that was still and sharp.",
            "Hold the whole board in the picture, in good light, and keep it still for a moment.",
        )
    written = {}
    for c, name in enumerate(session.names):
        if not session.cameras[c].pictures:
            console.print_text(f"{name} took no picture of the board.")
            continue
        folder = options.output / name if len(session.names) > 1 else options.output
        corner_set = _make_corner_set(recorder, session, c, square, options.square is not None)
        write_corners(corner_set, folder / "corners.json")
        written[name] = encode_corners(corner_set)
    several = len(session.names) > 1
    console.print_json(written if several else written[session.names[0]])
    taken = format_count(len(session.instants), "picture")
    state = "All is known well enough" if several else "The camera is known well enough"
    if not session.is_complete:
        state = "More would help"
    console.print_text(f"\n{state}: {taken}, worst pixel ±{session.worst:.2g} px.")
    for sentence in describe_pairs(session):
        console.print_text(sentence)
    for c in range(len(session.names)):
        progress = recorder.measure_progress(c)
        if progress.unseen_corners:
            whose = f" of {session.names[c]}" if several else ""
            console.print_text(
                f"Pictures{whose} that were put aside are predicted to "
                f"{progress.unseen_error:.2g} px rms ({progress.unseen_corners} corners)."
            )
    command = "rig" if several else "calibrate"
    where = "" if several else f"Wrote {options.output / 'corners.json'}. "
    console.print_text(f"{where}Now: calibgui {command} {options.output}")
    console.print_line(f"{taken} in {options.output}.")


def _make_corner_set(
    recorder: Recorder, session: JointSession, c: int, square: float, is_measured: bool
) -> CornerSet:
    """Return the corners in a camera's pictures."""
    picture = session.cameras[c].pictures[0]
    height, width = picture.frame.image.shape[:2]
    return CornerSet(
        (width, height),
        recorder.list_views(c),
        Board(*picture.corners.shape, square, picture.corners.pattern),
        lengths_confirmed=is_measured,
    )
