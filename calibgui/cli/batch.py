"""Calibrate many cameras from a list, and keep a ledger of all of them.

MANIFEST is a table in CSV or Parquet with the columns id and paths, and where they are known board,
model, serial, date and temperature; or a folder with a folder of photographs for each camera. What
the table does not say of a camera is taken from the options. Cameras that are done are not done
again, unless their photographs, the options or the program have changed. The exit code is 3 if a
camera fails: no calibration was possible or it is not usable, or it breaks a limit.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from calibgui.app.fleet import (
    BatchSummary,
    BoardSought,
    describe_trust,
    open_scheduler,
    read_manifest,
    run_batch,
)
from calibgui.app.outputs.output_files import check_outputs, check_writable
from calibgui.app.system.limit_presets import find_limits
from calibgui.cli.arguments import add_corner_method, add_grid_size_option, add_scale_option
from calibgui.cli.boards import add_board_options, is_pattern_open, read_pattern_options
from calibgui.cli.calibrate import add_settings_options, read_settings
from calibgui.cli.console import Console
from calibgui.cli.limits import BROKEN, add_limits_option
from calibgui.cli.outputs import add_overwrite_option
from calibgui.dataset.limits import NO_LIMITS
from calibgui.formats.fleet_ledger import open_ledger
from calibgui.formats.fleet_table import check_fleet_table, write_fleet_table
from calibgui.formats.origin import FLEET_TABLE
from calibgui.report.fleet import summarise_batch, tabulate_failures


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("manifest", type=Path, metavar="MANIFEST", help="table or folder")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="FLEET.db",
        help="the ledger: an SQLite file, made or continued; results and corners that were found "
        "are written to folders beside it",
    )
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        type=_parse_count,
        metavar="N",
        help="number of processes here (default: one for each processor)",
    )
    where.add_argument(
        "--scheduler",
        type=_parse_address,
        metavar="ADDRESS",
        help="of a scheduler of Dask, as tls://host:8786, whose workers see the same folders; "
        "whoever can reach it can run code as you, and you as its workers: with tls:// only who "
        "has a certificate (Dask's settings name yours), with tcp:// anyone",
    )
    add_limits_option(
        parser, ", or largest_change_px since the last calibration of its serial number"
    )
    parser.add_argument(
        "--parquet",
        type=Path,
        metavar="FILE",
        help="write the ledger as a table for analysis as well: .parquet (with pyarrow) or .csv",
    )
    add_overwrite_option(parser)
    add_grid_size_option(parser)
    add_corner_method(parser)
    add_board_options(parser)
    add_scale_option(parser, "needed unless the manifest says it of each camera")
    parser.set_defaults(roi=None)
    add_settings_options(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Calibrate what is not done, write and print; return the exit code."""
    settings, pattern = read_settings(options), read_pattern_options(options)
    board = BoardSought(
        options.square,
        options.board,
        None if is_pattern_open(options) else pattern,
        options.corners,
        square_sigma=options.square_sigma,
    )
    limits = NO_LIMITS if options.limits is None else find_limits(options.limits)
    check_writable(options.output)
    if options.parquet:
        check_fleet_table(options.parquet)
        read = [options.manifest, options.output]
        check_outputs([(options.parquet, FLEET_TABLE)], read, options.overwrite)
    tasks = read_manifest(options.manifest, board, settings)
    if options.scheduler is not None:
        console.print_text(describe_trust(options.scheduler))
    with (
        open_ledger(options.output.resolve(), create=True) as ledger,
        open_scheduler(options.workers, options.scheduler) as scheduler,
    ):
        with console.show_progress("calibrating", "camera") as advance:
            summary = run_batch(tasks, ledger, scheduler, limits, advance)
        if options.parquet:
            write_fleet_table(ledger.read(), options.parquet)
    _print_summary(summary, options, console)
    return BROKEN if summary.failed else 0


def _print_summary(summary: BatchSummary, options: argparse.Namespace, console: Console) -> None:
    """Print how many cameras were calibrated and which fail."""
    console.print_json(
        {
            "cameras": summary.cameras,
            "worked_on": summary.worked_on,
            "failed": {camera.id: list(camera.failures) for camera in summary.failed},
        }
    )
    text = summarise_batch(summary.cameras, summary.worked_on, len(summary.failed))
    console.print_line(text)
    if summary.failed:
        text += f"\n\n{tabulate_failures(summary.failed)}"
    written = [path for path in (options.output, options.parquet) if path]
    console.print_text("\n".join([text, "", *(f"Wrote {path}." for path in written)]))


def _parse_address(text: str) -> str:
    """Read the address of a scheduler."""
    if not re.fullmatch(r"(tcp|tls)://.+:\d+", text):
        raise argparse.ArgumentTypeError(f"{text!r} is no address such as tls://host:8786")
    return text


def _parse_count(text: str) -> int:
    """Read a number of processes."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes from 1 on")
    return int(text)
