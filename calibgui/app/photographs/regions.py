"""Regions of interest from a file: {"Image1.tif": [[u, v], [u, v], [u, v], [u, v]], ...}.

Four points, px, at or just outside the board's outermost corners, in order around it.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.lattices import check_outline
from calibgui.formats.json_document import read_json


def read_regions(file: str | Path, images: Sequence[Path]) -> dict[Path, Array]:
    """Read the regions (4, 2) px of some of `images`.

    The file names images with or without their folder.

    Raises:
        CalibrationError: if the file cannot be read, a region is not four points around a
            convex area, or a name is that of no image or of several.
    """
    node = read_json(file)
    if not isinstance(node.value, dict):
        node.fail("an object with a member for each image")
    regions = {}
    for name in node.value:
        meant = [path for path in images if path == Path(name)]
        meant = meant or [path for path in images if path.name == name]
        if len(meant) != 1:
            many = "several images" if meant else "none of the images"
            raise CalibrationError(
                f"{file}: {name} is the name of {many}.", "Name images as they are listed."
            )
        region = node[name].numbers(4, 2)
        try:
            check_outline(region)
        except ValueError as error:
            raise CalibrationError(
                f"{file}: the region of {name} cannot be used: {error}.", "Correct the four points."
            ) from error
        regions[meant[0]] = region
    return regions
