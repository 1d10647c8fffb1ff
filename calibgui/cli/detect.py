"""Locate the corners of the board in photographs and write them as corners.json."""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.outputs import check_outputs
from calibgui.app.paths import find_images
from calibgui.cli.arguments import (
    add_image_paths,
    add_search_options,
    parse_positive,
    search_images,
)
from calibgui.cli.boards import add_board_options, read_pattern_options
from calibgui.cli.console import Console
from calibgui.engine.errors import CalibrationError
from calibgui.formats.corners_json import encode_corners, write_corners
from calibgui.report import tables
from calibgui.report.boards import describe_recognised_board


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_image_paths(parser)
    add_search_options(parser)
    add_board_options(parser)
    parser.add_argument(
        "--square",
        type=parse_positive,
        metavar="MM",
        help="side of a square, or distance of circles, mm; 1 if left out: then give it to "
        "'calibgui calibrate'",
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="write corners.json")


def run(options: argparse.Namespace, console: Console) -> None:
    """Search, write and print."""
    pattern = read_pattern_options(options)
    if options.output:
        check_outputs([options.output], find_images(options.paths))
    detection = search_images(
        console, options.paths, options.board, options.roi, options.corners, pattern
    )
    corner_set = detection.corner_set(options.square or 1.0)
    if not any(view.usable for view in corner_set.views):
        console.print_problem(tables.list_unused_views(corner_set.views))
        raise CalibrationError(
            "The board was found in none of the images.",
            "Photograph the whole board, sharp and evenly lit, or mark its corners with --roi.",
        )
    console.print_json(encode_corners(corner_set))
    console.print_text(
        tables.tabulate_detection(corner_set.views),
        otherwise=tables.list_unused_views(corner_set.views),
    )
    if words := describe_recognised_board(pattern, corner_set.board):
        console.print_text(tables.format_bullet(words))
    if options.output:
        write_corners(corner_set, options.output)
        console.print_text(f"\nWrote {options.output}.")
        if options.square is None:
            console.print_text(
                "Squares count as 1 mm: give --square when calibrating from this file."
            )
