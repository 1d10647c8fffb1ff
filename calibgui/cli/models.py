"""Compare lens models on photographs of a board, or on a file of corners, and recommend one.

Every model is calibrated from all views, and again without some of them to see how well it predicts
these. The recommended model is what `calibgui calibrate --model` takes, and `--fix` those of its
coefficients that are better held at 0.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from calibgui.app.calibrating.lens_comparison import compare_lenses
from calibgui.cli.console import Console
from calibgui.cli.corners import add_corner_options, check_corner_options, read_or_search
from calibgui.cli.notices import explain_solve
from calibgui.cli.outputs import add_overwrite_option, check_corner_outputs
from calibgui.dataset import DEFAULT_SQUARE
from calibgui.engine.assessment import LensChoice
from calibgui.formats.json_document import write_json
from calibgui.formats.origin import LENS_COMPARISON, make_mark
from calibgui.report import tables
from calibgui.report.lens_choice import (
    LensRow,
    describe_lens_choice,
    list_lens_rows,
    tabulate_lens_choice,
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_corner_options(parser, f"no model depends on it ({DEFAULT_SQUARE:g} if left out)")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="write the comparison as JSON"
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Search, compare, write and print."""
    check_corner_options(options)
    if options.output:
        check_corner_outputs(options, [(options.output, LENS_COMPARISON)])
    corner_set = read_or_search(options, console)
    with (
        explain_solve(console, corner_set),
        console.show_progress("comparing lens models", "model") as advance,
    ):
        choice = compare_lenses(corner_set, advance)
    answer = _encode_choice(choice)
    text = tabulate_lens_choice(choice, corner_set.board)
    if options.output:
        write_json(options.output, {"origin": make_mark(LENS_COMPARISON), **answer})
        text += f"\n\nWrote {options.output}."
    console.print_json(answer)
    console.print_line(describe_lens_choice(choice))
    console.print_text(text, otherwise=tables.list_unused_views(corner_set.views))


def _encode_choice(choice: LensChoice) -> dict[str, Any]:
    """Return the comparison for JSON, which writes null for what is not known."""
    return {
        "recommended": choice.model,
        "fixed": choice.chosen.fixed,
        "reason": describe_lens_choice(choice),
        "adequate": choice.errors,
        "models": [_encode_row(row) for row in list_lens_rows(choice)],
        "refused": choice.refused,
    }


def _encode_row(row: LensRow) -> dict[str, Any]:
    horizontal, vertical, diagonal = row.field_of_view
    return {
        "model": row.model,
        "parameters": row.parameters,
        "corners": row.corners,
        "rms_px": row.rms,
        "sigma_x_px": row.sigma_x,
        "sigma_y_px": row.sigma_y,
        "unseen_rms_px": row.unseen_rms,
        "unseen_median_px": row.unseen_median,
        "unseen_95_percent_px": row.unseen_p95,
        "bic": row.bic,
        "field_of_view_deg": {
            "horizontal": horizontal,
            "vertical": vertical,
            "diagonal": diagonal,
        },
        "largest_corner_angle_deg": row.largest_angle,
        "largest_difference_px": row.difference,
        "valid_share": row.valid_share,
        "held_at_0": row.held,
        "remarks": row.remarks,
    }
