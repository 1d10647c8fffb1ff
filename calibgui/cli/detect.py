"""Locate the board's corners in photographs and write them as corners.json."""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.outputs import check_outputs
from calibgui.app.paths import find_images
from calibgui.cli.arguments import add_images, add_search, positive, search
from calibgui.cli.boards import add_target, pattern_of
from calibgui.cli.console import Console
from calibgui.engine.errors import CalibrationError
from calibgui.formats.corners_json import corners_record, write_corners
from calibgui.report import tables
from calibgui.report.boards import learnt


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_images(parser)
    add_search(parser)
    add_target(parser)
    parser.add_argument(
        "--square",
        type=positive,
        metavar="MM",
        help="side of a square, or distance of circles, mm; 1 if left out, to be given when "
        "calibrating",
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="write corners.json")


def run(options: argparse.Namespace, console: Console) -> None:
    """Search, write and print."""
    pattern = pattern_of(options)
    if options.output:
        check_outputs([options.output], find_images(options.paths))
    detection = search(console, options.paths, options.board, options.roi, options.corners, pattern)
    corner_set = detection.corner_set(options.square or 1.0)
    if not any(view.usable for view in corner_set.views):
        console.problem(tables.unused(corner_set.views))
        raise CalibrationError(
            "The board was found in none of the images.",
            "Photograph the whole board, sharp and evenly lit, or mark its corners with --roi.",
        )
    console.answer(corners_record(corner_set))
    console.say(tables.detection(corner_set.views), otherwise=tables.unused(corner_set.views))
    if words := learnt(pattern, corner_set.board):
        console.say(tables.bullet(words))
    if options.output:
        write_corners(corner_set, options.output)
        console.say(f"\nWrote {options.output}.")
        if options.square is None:
            console.say("Squares count as 1 mm: give --square when calibrating from this file.")
