"""Calibrate the bundled sample, whose true camera is known, and write all results and figures."""

from __future__ import annotations

import argparse
from pathlib import Path

from matplotlib.figure import Figure

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.outputs.output_files import check_outputs, make_folder, save_figure
from calibgui.app.system.resources import find_resource, read_sample_truth
from calibgui.cli.arguments import search_images
from calibgui.cli.console import Console
from calibgui.cli.notices import explain_solve
from calibgui.cli.outputs import add_overwrite_option
from calibgui.dataset import Result
from calibgui.engine.images import compute_board_extent, read_image, rectify_image, undistort_image
from calibgui.formats import export
from calibgui.formats.origin import FIGURE
from calibgui.formats.result_json import encode_result_with_findings
from calibgui.report import figures, tables

_EXPORT_FILES = {
    "result": "result.json",
    "opencv": "opencv.yaml",
    "ros": "ros.yaml",
    "corners": "corners.json",
    "corners-csv": "corners.csv",
}

_FIGURE_FILES = (
    "convergence.png",
    "corners.png",
    "distortion.png",
    "residuals.png",
    "histograms.png",
    "undistorted.png",
)


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        default=Path("calibgui-demo"),
        metavar="DIR",
        help="folder to write to (default ./calibgui-demo)",
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Search, calibrate, compare, write and print."""
    out: Path = options.output
    make_folder(out)
    outputs = [(out / file, name) for name, file in _EXPORT_FILES.items()]
    outputs += [(out / file, FIGURE) for file in _FIGURE_FILES]
    check_outputs(outputs, [], options.overwrite)
    sample = find_resource("sample")
    truth = read_sample_truth()
    square = truth["target"]["square_mm"].number()
    corner_set = search_images(console, [str(sample)]).corner_set(square)
    with explain_solve(console, corner_set):
        result = calibrate_views(corner_set)
    for name, file in _EXPORT_FILES.items():
        export(result, name, out / file)
    for file, figure in _draw_figures(result).items():
        save_figure(figure, out / file)
    params = truth["camera"]["params"]
    names = result.calibration.camera.names
    if console.json:
        console.print_json(encode_result_with_findings(result))
        return
    console.print_text(tables.format_report(result))
    console.print_text(
        "\n"
        + tables.tabulate_errors(
            result.calibration, {name: params[name].number() for name in names}
        )
        + f"\n\nWrote the results in {len(_EXPORT_FILES)} formats, and figures, to {out.resolve()}."
    )


def _draw_figures(result: Result) -> dict[str, Figure]:
    """Draw the figures, by the names of their files."""
    calibration, view, board = result.calibration, result.used[0], result.board
    assert view.corners is not None and board is not None, "they have been searched"
    camera, pose = calibration.camera, calibration.poses[0]
    photograph = read_image(view.image).pixels
    extent, scale = compute_board_extent(board), calibration.reference_scale
    drawn = (
        figures.draw_convergence(calibration.history, "px"),
        figures.draw_corners(photograph, view.corners),
        figures.draw_distortion(camera),
        figures.draw_residual_scatter(calibration, on_reference=False),
        figures.draw_residual_histograms(calibration, on_reference=False),
        figures.draw_image_pair(
            undistort_image(photograph, camera).image,
            rectify_image(photograph, camera, pose, extent, scale).image,
            ("undistorted", "rectified"),
        ),
    )
    return dict(zip(_FIGURE_FILES, drawn, strict=True))
