"""Reproduce the paper from its 25 images: tables 1 to 3, figures 4 to 16, one page to compare.

The images are searched twice, as Table 1 sets corners that are located by saddle points (the
paper's) beside those located by edges. All else is made from those that `--corners` names.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from calibgui.app.calibrating.calibration import calibrate_views
from calibgui.app.calibrating.settings import Settings
from calibgui.app.calibrating.synthetic import run_synthetic_check
from calibgui.app.outputs.output_files import check_figures, check_outputs, make_folder, save_figure
from calibgui.cli.arguments import add_corner_method, search_images
from calibgui.cli.console import Console
from calibgui.cli.notices import explain_solve
from calibgui.cli.outputs import add_overwrite_option
from calibgui.dataset import CornerSet
from calibgui.engine.calibration import Cost
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import METHODS
from calibgui.engine.files import write_atomically
from calibgui.formats.origin import PAPER_PAGE, RESULT
from calibgui.formats.result_json import encode_result_with_findings, write_result
from calibgui.report import tables
from calibgui.report.figures import LOCATED_BY
from calibgui.report.paper_figures import draw_paper_figures
from calibgui.report.paper_page import make_paper_page
from calibgui.report.paper_tables import Reproduction

_GRID_SIZE = (12, 13)
"""Rows and columns of inner corners of the paper's board."""
_SQUARE_MM = 30.0
"""Side of a square of the paper's board, mm."""
_IMAGES = tuple(f"Image{number}" for number in range(1, 26))
"""Names of the images without their endings, in the order of Table 1."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument(
        "folder", metavar="DIR", type=Path, help="folder of Image1.tif to Image25.tif"
    )
    add_corner_method(parser)
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="OUT", help="folder to write to"
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Calibrate the photographs and their renderings; write results, figures and the page."""
    out: Path = options.output
    make_folder(out)
    results = {name: out / f"{name}.json" for name in ("real", "image-cost", "synthetic")}
    page = out / "index.html"
    outputs = [(page, PAPER_PAGE), *((path, RESULT) for path in results.values())]
    check_outputs(outputs, [], options.overwrite)
    reproduction = _reproduce(options.folder, options.corners, console)
    real, synthetic = reproduction.real, reproduction.synthetic
    figures = draw_paper_figures(real, synthetic, reproduction.extrinsic_errors)
    pictures = {c: f"{re.sub(' ', '-', c.split(':')[0].lower())}.png" for c in figures}
    check_figures([out / name for name in pictures.values()], [], options.overwrite)
    write_result(real, results["real"])
    write_result(reproduction.image_cost, results["image-cost"])
    write_result(synthetic, results["synthetic"])
    for caption, figure in figures.items():
        save_figure(figure, out / pictures[caption])
    write_atomically(page, make_paper_page(reproduction, pictures).encode())
    if console.json:
        console.print_json(encode_result_with_findings(real))
        return
    console.print_text(tables.format_report(real, verbose=True))
    console.print_text(f"\nWrote tables, figures and results to {out}; open {page}.")


def _reproduce(folder: Path, method: str, console: Console) -> Reproduction:
    """Calibrate from corners located by each method; do all else with those of `method`."""
    found = {name: _search(folder, name, console) for name in METHODS}
    papers = Settings(cost=Cost.PAPER)
    with explain_solve(console, found[method]):
        by_method = {name: calibrate_views(corners, papers) for name, corners in found.items()}
    with console.show_progress("synthetic views") as advance:
        check = run_synthetic_check(by_method[method], progress=advance)
    return Reproduction(
        by_method, method, calibrate_views(found[method]), check.synthetic, check.extrinsic_errors
    )


def _search(folder: Path, method: str, console: Console) -> CornerSet:
    """Find the corners of all of the paper's images.

    Raises:
        CalibrationError: if one is missing, is there twice, or shows no board that is found.
    """
    console.print_notice(f"Corners located by {LOCATED_BY[method]}:")
    if not folder.is_dir():
        raise CalibrationError(f"There is no folder {folder}.", "Check its spelling.")
    images = [str(path) for path in sorted(folder.glob("Image[0-9]*"))]
    if not images:
        raise CalibrationError(
            f"{folder} has none of the paper's images, Image1 to Image25.",
            "Name the folder of Bouguet's 25 example images; 'calibgui calibrate' is for other "
            "photographs.",
        )
    detection = search_images(console, images, _GRID_SIZE, corners=method)
    names = [Path(view.image).stem for view in detection.views if view.usable]
    doubtful = [name for name in _IMAGES if names.count(name) != 1]
    if doubtful:
        raise CalibrationError(
            f"Missing, there twice, or without a board that is found: {', '.join(doubtful)}.",
            "The views are compared with the paper's one by one: name the folder of its 25 images.",
        )
    return detection.corner_set(_SQUARE_MM)
