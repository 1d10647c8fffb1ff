"""A printed PuzzleBoard is read back as the part of the pattern that it must be, in mm."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from scipy.ndimage import gaussian_filter

from calibgui.app.outputs.printable_board import Page, lay_out_page, write_page
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.puzzleboard import PuzzleBoard
from calibgui.engine.detection.find_corners import find_corners

_PER_MM = 4
_BOARD = Board(6, 8, 18.0, PuzzleBoard((50, 100)))
_SVG = "{http://www.w3.org/2000/svg}"


def _rasterise(page: Page) -> np.ndarray:
    """The SVG's shapes, group by group, as an image of 4 pixels a mm."""
    root = ElementTree.fromstring(page.svg())
    width, height = (float(root.attrib[k].removesuffix("mm")) for k in ("width", "height"))
    image = np.full((round(_PER_MM * height), round(_PER_MM * width)), 255, np.uint8)
    v, u = np.indices(image.shape)
    for group in root.iter(_SVG + "g"):
        level = {"black": 0, "white": 255}[group.attrib["fill"]]
        for shape in group:
            if shape.tag == _SVG + "rect":
                x, y, w, h = (
                    round(_PER_MM * float(shape.attrib[k])) for k in ("x", "y", "width", "height")
                )
                image[y : y + h, x : x + w] = level
            else:
                x, y, r = (_PER_MM * float(shape.attrib[k]) for k in ("cx", "cy", "r"))
                image[np.hypot(u + 0.5 - x, v + 0.5 - y) < r] = level
    return image


def test_found_on_its_sheet() -> None:
    page = lay_out_page(_BOARD, "A4")
    corners = find_corners(gaussian_filter(_rasterise(page), 1.5), pattern=PuzzleBoard())
    assert corners.grid.min(axis=0).tolist() == [50, 100]
    assert corners.grid.max(axis=0).tolist() == [55, 107]
    size = np.linalg.norm(np.ptp(corners.uv, axis=0))
    true = _PER_MM * np.linalg.norm(np.ptp(_BOARD.points(), axis=0))
    np.testing.assert_allclose(size, true, rtol=0.002)
    assert "PuzzleBoard of 6 × 8 inner corners from corner 50 × 100 on" in page.lines[1]


def test_white_dots_are_painted_over_the_squares(tmp_path: Path) -> None:
    """In PDF, that draws in order: black paths, white ones, and black again for the text."""
    page = lay_out_page(_BOARD, "A4")
    write_page(page, tmp_path / "board.pdf")
    drawing = (tmp_path / "board.pdf").read_bytes().decode("cp1252")
    black, white, text = re.split(r"^f\n", drawing, flags=re.MULTILINE)[:3]
    assert black.count(" c\n") == 4 * len(page.discs)
    assert white.startswith("1 g\n")
    assert white.count(" c\n") == 4 * len(page.white_discs)
    assert text.startswith("0 g\n")
    right, down = PuzzleBoard((50, 100)).read_dots((6, 8))
    assert len(page.white_discs) == right.sum() + down.sum()
    assert len(page.discs) + len(page.white_discs) == right.size + down.size
