"""Show a fleet: distributions, outliers, drift and a page for each camera, from its ledger.

The ledger is what calibgui batch wrote. Cameras are compared with the median of their kind by where
they image far points, not by their parameters.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from calibgui.app.fleet.pages import write_fleet_pages
from calibgui.app.outputs.output_files import check_outputs
from calibgui.cli.console import Console
from calibgui.cli.outputs import add_overwrite_option
from calibgui.dataset.fleet import FleetStatus
from calibgui.formats.fleet_ledger import open_ledger
from calibgui.formats.origin import FLEET_PAGE
from calibgui.report.fleet import tabulate_failures
from calibgui.report.fleet_overview import make_overview
from calibgui.report.numbers import format_count


def configure(parser: argparse.ArgumentParser) -> None:
    """Describe the arguments."""
    parser.add_argument("ledger", metavar="FLEET.db", type=Path, help="ledger of the fleet")
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="FILE.html",
        help="page to write; the cameras' pages go to a folder beside it",
    )
    add_overwrite_option(parser)


def run(options: argparse.Namespace, console: Console) -> None:
    """Read the ledger, compare the cameras, write the pages."""
    check_outputs([(options.output, FLEET_PAGE)], [options.ledger], options.overwrite)
    with open_ledger(options.ledger) as ledger:
        cameras = tuple(ledger.read())
    unreadable = [camera for camera in cameras if camera.status is FleetStatus.UNREADABLE]
    overview = make_overview(cameras)
    folder = write_fleet_pages(overview, options.ledger, options.output)
    counts = {
        "cameras": len(overview.placed),
        "failed": [one.camera.id for one in overview.failed],
        "outliers": [
            {"id": one.camera.id, "rms_px": one.difference, "z": one.z} for one in overview.outliers
        ],
        "changed": [one.camera.id for one in overview.changed],
        "unreadable": {camera.id: camera.problem for camera in unreadable},
    }
    console.print_json(counts)
    if unreadable and not console.json:
        console.print_problem(tabulate_failures(unreadable))
    console.print_text(
        f"{format_count(len(overview.placed), 'camera')}. Failing: {len(overview.failed)}. Unlike "
        f"the others: {len(overview.outliers)}. Changed: {len(overview.changed)}.\n"
        f"Wrote {options.output} and {folder}."
    )
