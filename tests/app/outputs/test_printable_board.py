"""The sheet is read back as what it must be: a board of the stated size, in mm."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import gaussian_filter

from calibgui.app.outputs.printable_board import (
    PAPER_SIZES_MM,
    Page,
    choose_paper,
    choose_square,
    complete_pattern,
    lay_out_page,
    write_page,
)
from calibgui.engine import opencv
from calibgui.engine.arrays import Array
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import CalibrationError

_PER_MM = 4


def rasterised(content: Page) -> Array:
    """The SVG's rectangles as an image of 4 pixels a mm."""
    root = ElementTree.fromstring(content.svg())
    width, height = (float(root.attrib[k].removesuffix("mm")) for k in ("width", "height"))
    image = np.full((round(_PER_MM * height), round(_PER_MM * width)), 255, np.uint8)
    for rect in root.iter("{http://www.w3.org/2000/svg}rect"):
        if "x" in rect.attrib:
            x, y, w, h = (
                round(_PER_MM * float(rect.attrib[k])) for k in ("x", "y", "width", "height")
            )
            image[y : y + h, x : x + w] = 0
    v, u = np.indices(image.shape)
    for disc in root.iter("{http://www.w3.org/2000/svg}circle"):
        x, y, r = (_PER_MM * float(disc.attrib[k]) for k in ("cx", "cy", "r"))
        image[np.hypot(u + 0.5 - x, v + 0.5 - y) < r] = 0
    return image


@pytest.mark.parametrize("grid_size", [(6, 9), (9, 6)])
def test_the_finder_sees_the_board_in_its_size(grid_size: tuple[int, int]) -> None:
    content = lay_out_page(Board(*grid_size, 20.0), "A4")
    corners = find_corners(rasterised(content), grid_size)
    assert corners.complete
    row = corners.uv[corners.grid[:, 0] == 0]
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(row, axis=0), axis=1), 20.0 * _PER_MM, atol=0.6
    )


def test_pdf_and_svg_hold_the_same_rectangles(tmp_path: Path) -> None:
    content = lay_out_page(Board(5, 8, 22.5), "A4")
    for name in ("board.pdf", "board.svg"):
        write_page(content, tmp_path / name)
    pdf = (tmp_path / "board.pdf").read_bytes().decode("cp1252")
    found = [
        tuple(map(float, m))
        for m in re.findall(r"^([\d.]+) ([\d.]+) ([\d.]+) ([\d.]+) re$", pdf, re.M)
    ]
    expected = [(x, content.size[1] - y - h, w, h) for x, y, w, h in content.rectangles]
    np.testing.assert_allclose(found, expected, atol=1e-4)
    start = int(re.search(r"startxref\n(\d+)", pdf)[1])
    assert pdf[start : start + 4] == "xref"
    for place in re.findall(r"^(\d{10}) 00000 n", pdf, re.M):
        assert re.match(r"\d+ 0 obj", pdf[int(place) :])
    with pytest.raises(CalibrationError, match="is not named as PDF, SVG or PNG"):
        write_page(content, tmp_path / "board.gif")


def test_a_png_has_its_true_size_and_edges_to_a_tenth_of_a_dot(tmp_path: Path) -> None:
    content = lay_out_page(Board(5, 8, 20.3), "A4")
    write_page(content, tmp_path / "board.png")
    with Image.open(tmp_path / "board.png") as image:
        np.testing.assert_allclose(image.info["dpi"], 600, atol=0.1)
        pixels = np.array(image)
    small = opencv.halve_image(opencv.halve_image(pixels))
    found = find_corners(gaussian_filter(small, 1.5), (5, 8))
    ends = (found.uv[found.grid[:, 1] == column] for column in (0, 7))
    length = np.linalg.norm(np.subtract(*ends), axis=1) * 4 * 25.4 / 600
    np.testing.assert_allclose(length, 7 * 20.3, rtol=2e-4)
    # The edges of the first square, by how far its dots are covered.
    x, y, w, _ = content.rectangles[0]
    row = 1 - pixels[round((y + 5) * 600 / 25.4), : round((x + w + 5) * 600 / 25.4)] / 255
    np.testing.assert_allclose(row.sum() * 25.4 / 600, w, atol=0.004)


def test_every_line_of_text_is_on_the_paper() -> None:
    pattern = complete_pattern(KINDS["aprilgrid"], (12, 12))
    page = lay_out_page(Board(12, 12, 15.0, pattern), "A4")
    assert page.text_at[0] >= 8.0 and max(map(len, page.lines)) * 1.6 < 210 - 16


def test_the_largest_square_of_whole_mm_is_chosen() -> None:
    pattern = KINDS["checkerboard"]
    assert choose_square(pattern, (6, 9), "A4") == 22.0
    lay_out_page(Board(6, 9, 22.0), "A4")
    assert 0.4 < choose_square(pattern, (199, 199), "A4") < 1


@pytest.mark.parametrize("paper", PAPER_SIZES_MM)
def test_everything_is_on_the_sheet_with_white_around(paper: str) -> None:
    with pytest.raises(CalibrationError) as error:
        lay_out_page(Board(6, 9, 5000.0), paper)
    largest = float(re.search(r"at most ([\d.]+) mm", error.value.hint)[1])
    content = lay_out_page(Board(6, 9, largest - 0.1), paper)
    squares = np.array([r for r in content.rectangles if np.isclose(r[2], r[3])])
    width, height = content.size
    left, top = squares[:, :2].min(axis=0)
    right, bottom = (squares[:, :2] + squares[:, 2:]).max(axis=0)
    margin = squares[0, 2] / 2
    assert min(left, top, width - right) > margin
    bar_top = min(r[1] for r in content.rectangles if not np.isclose(r[2], r[3]))
    assert bottom + margin < bar_top < height - 8
    assert content.bar in (20, 50, 100, 200, 500, 1000)


@pytest.mark.parametrize(
    ("kind", "grid_size", "side"),
    [
        ("charuco", (9, 4), 15.0),
        ("circles", (9, 4), 15.0),
        ("asymmetric-circles", (9, 4), 15.0),
        ("aprilgrid", (8, 6), 40.0),
        ("tagged-checkerboard", (10, 6), 20.0),
    ],
)
def test_other_patterns_are_found_on_their_sheet(
    kind: str, grid_size: tuple[int, int], side: float, tmp_path: Path
) -> None:
    board = Board(*grid_size, side, complete_pattern(KINDS[kind], grid_size))
    content = lay_out_page(board, choose_paper(board))
    seen = gaussian_filter(rasterised(content), 1.5)
    corners = find_corners(seen, grid_size, pattern=KINDS[kind])
    assert corners.complete
    assert corners.pattern.kind == kind
    size = np.linalg.norm(np.ptp(corners.uv, axis=0))
    assert size == pytest.approx(_PER_MM * np.linalg.norm(np.ptp(board.points(), axis=0)), rel=0.01)
    write_page(content, tmp_path / "board.pdf")
    pdf = (tmp_path / "board.pdf").read_bytes()
    assert pdf.count(b" c\n") == 4 * len(content.discs)


@pytest.mark.parametrize(
    ("board", "paper"),
    [
        (Board(6, 9, 20.0), "A4"),
        (Board(7, 10, 25.0), "A3"),
        (Board(8, 12, 50.0), "A1"),
        (Board(30, 40, 100.0), "A0"),
    ],
)
def test_paper_is_as_large_as_the_target_asks_for(board: Board, paper: str) -> None:
    assert choose_paper(board) == paper
