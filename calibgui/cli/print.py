"""Write a board to print, in true size: the first step of every calibration.

Print it without scaling, measure the bar below it with a ruler, and glue it onto something flat.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.outputs.output_files import check_outputs
from calibgui.app.outputs.printable_board import (
    PAPER_SIZES_MM,
    choose_square,
    complete_pattern,
    lay_out_page,
    write_page,
)
from calibgui.cli.arguments import add_square_option, parse_grid_size
from calibgui.cli.boards import add_board_options, read_pattern_options
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.engine.boards import Board
from calibgui.formats.origin import FIGURE
from calibgui.report.boards import describe_board


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument(
        "board",
        type=parse_grid_size,
        nargs="?",
        metavar="BOARD",
        help="rows and columns of inner corners or circles, as 6x9; of an AprilGrid two for each "
        "tag. One odd and one even number let all views of a checkerboard find the same origin. "
        "Left out with --layout",
    )
    add_board_options(parser, "Properties that are not given are as usual.")
    add_square_option(parser, "as large as the paper allows, in whole mm, if left out")
    parser.add_argument(
        "--paper",
        choices=list(PAPER_SIZES_MM),
        default="A4",
        metavar="NAME",
        help=f"one of {', '.join(PAPER_SIZES_MM)} (default: A4)",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="FILE",
        help="the file: .pdf or .svg, or .png of 600 dots an inch",
    )
    add_overwrite_option(parser)
    parser.set_defaults(corners="edges")


def run(options: argparse.Namespace, console: Console) -> None:
    """Write the board, and say what it is and how to print it."""
    check_outputs([(options.output, FIGURE)], [], options.overwrite)
    pattern = read_pattern_options(options)
    if options.board is None:
        options.usage_error("BOARD is needed, as 6x9")
    pattern = complete_pattern(pattern, options.board)
    square = options.square or choose_square(pattern, options.board, options.paper)
    rows, cols = options.board
    board = Board(rows, cols, square, pattern)
    page = lay_out_page(board, options.paper)
    write_page(page, options.output)
    console.print_json({"file": str(options.output), "square_mm": square, "paper": options.paper})
    console.print_text(
        f"Wrote {describe_board(board)} with {square:g} mm for {options.paper} to "
        f"{options.output}. Print it without scaling: the bar must be {page.bar:g} mm long."
    )
