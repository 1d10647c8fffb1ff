"""Locate the corners of the board in photographs and write them as corners.json."""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.cli.console import Console
from calibgui.cli.corners import add_photograph_options, search_board
from calibgui.cli.outputs import add_overwrite_option, check_corner_outputs, refuse_other_format
from calibgui.dataset import DEFAULT_SQUARE
from calibgui.formats.corners_json import encode_corners, write_corners
from calibgui.formats.origin import CORNERS
from calibgui.report import tables


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_photograph_options(parser, "may be given to 'calibgui calibrate' instead")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FILE",
        help="write corners.json; - for standard output",
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Search, write and print."""
    options.output = console.take_output(options.output)
    if options.output:
        refuse_other_format(options.output)
        check_corner_outputs(options, [(options.output, CORNERS)])
    corner_set, remarks = search_board(options, console)
    console.print_json(encode_corners(corner_set))
    console.print_line(tables.count_boards(corner_set.views))
    console.print_text(
        tables.tabulate_detection(corner_set.views, corner_set.board),
        otherwise=tables.list_unused_views(corner_set.views),
    )
    for remark in remarks:
        console.print_text(tables.format_bullet(remark))
    if options.output:
        write_corners(corner_set, options.output)
        console.print_text(f"\nWrote {options.output}.")
        if not corner_set.lengths_confirmed:
            console.print_text(
                f"Squares count as {DEFAULT_SQUARE:g} mm until --square states their side, here or "
                "when calibrating from this file."
            )
