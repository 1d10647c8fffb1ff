"""Writing the pages of a fleet: one for all cameras, and one for each in a folder beside it."""

from __future__ import annotations

import os
from pathlib import Path
from urllib.parse import quote

from calibgui.app.outputs.output_files import make_folder
from calibgui.engine.files import write_atomically
from calibgui.report.fleet_overview import FleetOverview
from calibgui.report.fleet_page import FleetPages


def write_fleet_pages(overview: FleetOverview, ledger: Path, path: Path) -> Path:
    """Write the pages.

    Args:
        overview: the fleet.
        ledger: the file of its ledger, from which the paths of results count.
        path: the first page, which is written last.

    Returns:
        The folder of the cameras' pages: its name is the page's with ``-cameras``.

    Raises:
        CalibrationError: if a file cannot be written.
    """
    folder = path.with_name(f"{path.stem}-cameras")
    make_folder(folder)
    results = {
        one.camera.id: _find_address(ledger.parent / one.camera.result, folder)
        for one in overview.placed
        if one.camera.result
    }
    pages = FleetPages(overview, path.stem, folder.name, path.name, results)
    for name, page in pages.make_cameras():
        write_atomically(folder / name, page.encode())
    write_atomically(path, pages.make_first().encode())
    return folder


def _find_address(file: Path, folder: Path) -> str:
    """Return the address of a file in a page of a folder."""
    try:
        relative = os.path.relpath(file.resolve(), folder.resolve())
    except ValueError:  # on another drive
        return file.resolve().as_uri()
    return quote(Path(relative).as_posix())
