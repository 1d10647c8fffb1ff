"""Reproduce the paper from its 25 images: tables 1 to 3, figures 4 to 16, one page to compare."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from calibgui.app.calibration import calibrate_views
from calibgui.app.outputs import make_folder, save_figure
from calibgui.app.settings import Settings
from calibgui.app.synthetic import run_synthetic_check
from calibgui.cli.arguments import add_corner_method, search_images
from calibgui.cli.console import Console
from calibgui.dataset import Result
from calibgui.engine.calibration import Cost
from calibgui.engine.files import write_atomically
from calibgui.formats.result_json import encode_result, write_result
from calibgui.report import tables
from calibgui.report.paper_figures import draw_paper_figures
from calibgui.report.paper_page import make_paper_page

_GRID_SIZE = (12, 13)
"""Rows and columns of inner corners of the paper's board."""
_SQUARE_MM = 30.0
"""Side of a square of the paper's board, mm."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument(
        "folder", metavar="DIR", type=Path, help="folder of Image1.tif to Image25.tif"
    )
    add_corner_method(parser)
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="OUT", help="folder to write to"
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Calibrate the photographs and their renderings; write results, figures and the page."""
    out: Path = options.output
    make_folder(out)
    real, image_cost = _calibrate_both(options, console)
    with console.show_progress("synthetic views") as advance:
        check = run_synthetic_check(real, progress=advance)
    write_result(real, out / "real.json")
    write_result(image_cost, out / "image-cost.json")
    write_result(check.synthetic, out / "synthetic.json")
    pictures = {}
    for caption, figure in draw_paper_figures(
        real, check.synthetic, check.extrinsic_errors
    ).items():
        pictures[caption] = f"{re.sub(' ', '-', caption.split(':')[0].lower())}.png"
        save_figure(figure, out / pictures[caption])
    page = make_paper_page(
        real.calibration,
        check.synthetic.calibration,
        image_cost.calibration,
        check.extrinsic_errors,
        pictures,
    )
    write_atomically(out / "index.html", page.encode())
    console.print_json(encode_result(real))
    console.print_text(tables.format_report(real))
    console.print_text(f"\nWrote tables, figures and results to {out}; open {out / 'index.html'}.")


def _calibrate_both(options: argparse.Namespace, console: Console) -> tuple[Result, Result]:
    """Calibrate the images Image<number> in the paper's formulation and in the default one."""
    images = [str(options.folder / "Image[0-9]*")]
    detection = search_images(console, images, _GRID_SIZE, corners=options.corners)
    corner_set = detection.corner_set(_SQUARE_MM)
    return calibrate_views(corner_set, Settings(cost=Cost.PAPER)), calibrate_views(corner_set)
