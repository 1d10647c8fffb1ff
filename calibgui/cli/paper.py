"""Reproduce the paper from its 25 images: tables 1 to 3, figures 4 to 16, one page to compare."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from calibgui.app.calibration import calibrate_views
from calibgui.app.outputs import make_folder, save_figure
from calibgui.app.settings import Settings
from calibgui.app.synthetic import synthetic_check
from calibgui.cli.arguments import add_method, search
from calibgui.cli.console import Console
from calibgui.dataset.result import Result
from calibgui.engine.calibration import Cost
from calibgui.engine.files import write_atomically
from calibgui.formats.result_json import result_record, write_result
from calibgui.report import tables
from calibgui.report.paper_figures import paper_figures
from calibgui.report.paper_page import paper_page

_BOARD = (12, 13)
_SQUARE = 30.0
"""Of the paper's plate: inner corners, and side of a square, mm."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("folder", metavar="DIR", type=Path, help="of Image1.tif to Image25.tif")
    add_method(parser)
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="OUT", help="folder to write to"
    )


def run(options: argparse.Namespace, console: Console) -> None:
    """Calibrate, render, calibrate again; write results, figures and the page."""
    out: Path = options.output
    make_folder(out)
    real, image_cost = _calibrated(options, console)
    with console.progress("synthetic views") as advance:
        check = synthetic_check(real, progress=advance)
    write_result(real, out / "real.json")
    write_result(image_cost, out / "image-cost.json")
    write_result(check.synthetic, out / "synthetic.json")
    pictures = {}
    for caption, figure in paper_figures(real, check.synthetic, check.extrinsic_errors).items():
        pictures[caption] = f"{re.sub(' ', '-', caption.split(':')[0].lower())}.png"
        save_figure(figure, out / pictures[caption])
    page = paper_page(
        real.calibration,
        check.synthetic.calibration,
        image_cost.calibration,
        check.extrinsic_errors,
        pictures,
    )
    write_atomically(out / "index.html", page.encode())
    console.answer(result_record(real))
    console.say(tables.report(real))
    console.say(f"\nWrote tables, figures and results to {out}; open {out / 'index.html'}.")


def _calibrated(options: argparse.Namespace, console: Console) -> tuple[Result, Result]:
    """The paper's formulation and the default one, on the images named Image<number>."""
    images = [str(options.folder / "Image[0-9]*")]
    detection = search(console, images, _BOARD, corners=options.corners)
    corner_set = detection.corner_set(_SQUARE)
    return calibrate_views(corner_set, Settings(cost=Cost.PAPER)), calibrate_views(corner_set)
