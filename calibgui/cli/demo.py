"""Calibrate the bundled sample, whose truth is known, and write everything there is to see."""

from __future__ import annotations

import argparse
from pathlib import Path

from matplotlib.figure import Figure

from calibgui.app.calibration import calibrate_views
from calibgui.app.outputs import make_folder, save_figure
from calibgui.app.resources import resource, sample_truth
from calibgui.cli.arguments import search
from calibgui.cli.console import Console
from calibgui.dataset.result import Result
from calibgui.engine.images import board_extent, read_image, rectify_image, undistort_image
from calibgui.formats import export
from calibgui.formats.result_json import result_record
from calibgui.report import figures, tables

_EXPORTS = {
    "result": "result.json",
    "opencv": "opencv.yaml",
    "ros": "ros.yaml",
    "corners": "corners.json",
    "corners-csv": "corners.csv",
}


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


def run(options: argparse.Namespace, console: Console) -> None:
    """Search, calibrate, compare, write and print."""
    out: Path = options.output
    make_folder(out)
    sample = resource("sample")
    truth = sample_truth()
    square = truth["target"]["square_mm"].number()
    result = calibrate_views(search(console, [str(sample)]).corner_set(square))
    for name, file in _EXPORTS.items():
        export(result, name, out / file)
    for file, figure in _figures(result).items():
        save_figure(figure, out / file)
    params = truth["camera"]["params"]
    names = result.calibration.camera.names
    console.answer(result_record(result))
    console.say(tables.report(result))
    console.say(
        "\n"
        + tables.comparison(result.calibration, {name: params[name].number() for name in names})
        + f"\n\nWrote the results in {len(_EXPORTS)} formats, and figures, to {out.resolve()}."
    )


def _figures(result: Result) -> dict[str, Figure]:
    """What there is to see, by file name."""
    calibration, view = result.calibration, result.used[0]
    camera, pose = calibration.camera, calibration.poses[0]
    photograph = read_image(view.image).pixels
    drawn = {
        "convergence.png": figures.convergence(calibration.history, "px"),
        "distortion.png": figures.distortion(camera),
        "residuals.png": figures.residual_scatter(calibration, on_reference=False),
        "histograms.png": figures.residual_histograms(calibration, on_reference=False),
    }
    if view.corners is not None:
        drawn["corners.png"] = figures.corners(photograph, view.corners)
    if result.board is not None:
        extent, scale = board_extent(result.board), calibration.reference_scale
        drawn["undistorted.png"] = figures.image_pair(
            undistort_image(photograph, camera).image,
            rectify_image(photograph, camera, pose, extent, scale).image,
            ("undistorted", "rectified"),
        )
    return drawn
