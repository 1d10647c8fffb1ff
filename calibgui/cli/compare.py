"""Compare methods of calibration on photographs of a board, or on a file of corners.

Every method calibrates from all views, and again without some of them to see how well it predicts
these. Every camera is compared with that of the default method. The methods are also what
`calibgui calibrate --method` takes.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from calibgui.app.calibrating.method_comparison import compare_methods
from calibgui.app.outputs.output_files import check_figure_name, save_figure
from calibgui.cli.arguments import is_corners_file
from calibgui.cli.console import Console
from calibgui.cli.corners import add_corner_options, check_corner_options, read_or_search
from calibgui.cli.notices import explain_solve
from calibgui.cli.outputs import add_overwrite_option, check_corner_outputs
from calibgui.dataset import DEFAULT_SQUARE
from calibgui.engine.assessment import MethodComparison
from calibgui.formats.board_poses_json import read_board_poses
from calibgui.formats.json_document import write_json
from calibgui.formats.origin import FIGURE, METHOD_COMPARISON, make_mark
from calibgui.report import tables
from calibgui.report.methods import (
    QUANTITIES,
    MethodRow,
    describe_method_comparison,
    list_method_rows,
    tabulate_methods,
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    add_corner_options(parser, f"only --board-poses need it ({DEFAULT_SQUARE:g} if left out)")
    parser.add_argument(
        "--board-poses",
        type=Path,
        metavar="FILE",
        help="poses of the board in one fixed frame, as JSON {image: {rvec: [x, y, z] in rad, "
        "tvec: [x, y, z] in mm}}: the direct linear transformation needs them",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="write the comparison as JSON"
    )
    add_overwrite_option(parser)
    parser.add_argument(
        "--figure",
        type=Path,
        metavar="FILE",
        help="draw where the methods differ, and their errors on unseen views (PNG, SVG or PDF)",
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Search, compare, write, draw and print."""
    check_corner_options(options)
    if options.board_poses and options.square is None and not is_corners_file(options.paths):
        options.usage_error("--board-poses are in mm: add --square MM")
    outputs = [(options.output, METHOD_COMPARISON)] if options.output else []
    if options.figure:
        check_figure_name(options.figure)
        outputs.append((options.figure, FIGURE))
    check_corner_outputs(options, outputs, filter(None, [options.board_poses]))
    poses = read_board_poses(options.board_poses) if options.board_poses else None
    corner_set = read_or_search(options, console)
    with (
        explain_solve(console, corner_set),
        console.show_progress("comparing methods", "method") as advance,
    ):
        comparison = compare_methods(corner_set, poses, advance)
    answer = _encode_comparison(comparison)
    text = tabulate_methods(comparison, corner_set.board)
    if options.output:
        write_json(options.output, {"origin": make_mark(METHOD_COMPARISON), **answer})
        text += f"\n\nWrote {options.output}."
    if options.figure:
        from calibgui.report import method_figures  # matplotlib takes a while to import

        save_figure(method_figures.draw_method_comparison(comparison), options.figure)
        text += f"\n\nWrote {options.figure}."
    console.print_json(answer)
    console.print_line(describe_method_comparison(comparison))
    console.print_text(text, otherwise=tables.list_unused_views(corner_set.views))


def _encode_comparison(comparison: MethodComparison) -> dict[str, Any]:
    """Return the comparison for JSON, which writes null for what is not known."""
    chosen = comparison.chosen
    return {
        "summary": describe_method_comparison(comparison),
        "chosen_camera": {
            "model": chosen.model,
            "size": chosen.size,
            "params": dict(zip(chosen.names, chosen.params.tolist(), strict=True)),
        },
        "methods": [_encode_row(row, comparison) for row in list_method_rows(comparison)],
    }


def _encode_row(row: MethodRow, comparison: MethodComparison) -> dict[str, Any]:
    unknown = (math.nan, math.nan)
    values = {name: row.values.get(name, unknown) for name in QUANTITIES}
    shift, shift_sigma = row.shift or unknown
    return {
        "name": row.name,
        "title": row.title,
        "source": row.source,
        "limits": row.limits,
        "kind": row.kind,
        "values_px": {name: value for name, (value, _) in values.items()},
        "sigma_px": {name: sigma for name, (_, sigma) in values.items()},
        "shift_px": shift,
        "sigma_shift_px": shift_sigma,
        "shift_at_radius_px": row.radius,
        "rms_px": row.rms,
        "unseen_rms_px": row.unseen,
        "seconds": row.seconds,
        "iterations": row.iterations,
        "difference_rms_px": row.difference_rms,
        "difference_worst_px": row.difference_worst,
        "remarks": row.remarks,
        "lens": _encode_lens(row, comparison),
        "difference": _encode_difference(row, comparison),
    }


def _encode_lens(row: MethodRow, comparison: MethodComparison) -> dict[str, Any] | None:
    """Return the lens model of a method with all coefficients; sigma is null where held."""
    if row.kind == "refused":
        return None
    if row.kind == "lines":
        trial = comparison.lines[row.name]
        return {
            "model": "n = d (1 + k1 r^2 + k2 r^4) px, r^2 = (x / aspect)^2 + y^2",
            "names": trial.lines.names,
            "params": trial.params,
            "sigma": trial.lines.sigma,
        }
    found = comparison.trials[row.name].calibration
    sigma = [
        math.nan if name in found.fixed else float(s)
        for name, s in zip(found.camera.names, found.sigma, strict=True)
    ]
    return {
        "model": found.camera.model,
        "names": found.camera.names,
        "params": found.camera.params,
        "sigma": sigma,
    }


def _encode_difference(row: MethodRow, comparison: MethodComparison) -> dict[str, Any] | None:
    """Return the map of a method's difference from the chosen camera, if it is known."""
    if row.kind == "lines":
        found: Any = comparison.lines[row.name]
    elif row.kind == "camera":
        found = comparison.trials[row.name].difference
    else:
        found = None
    return None if found is None else {"u": found.u, "v": found.v, "vector_px": found.vector}
