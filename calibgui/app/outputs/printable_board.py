"""A board to print, as PDF, SVG or PNG in true size, with a scale bar to check the print.

A checkerboard has one square more each way than inner corners. Its first square is dark. A board
has at least half a square of white around it, which the corner finder needs. Printers often scale
pages: the user measures the scale bar with a ruler.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from PIL.PngImagePlugin import PngInfo

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, GridSize
from calibgui.engine.boards import (
    AprilGrid,
    Board,
    Charuco,
    Circles,
    ListedCircles,
    Pattern,
    PrintedDiscs,
    PrintedRectangles,
    PrintedSquaresAndDots,
    TaggedCheckerboard,
)
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.formats.origin import FIGURE, make_mark
from calibgui.report.boards import describe_board

PAPER_SIZES_MM = {
    "A4": (210.0, 297.0),
    "A3": (297.0, 420.0),
    "A2": (420.0, 594.0),
    "A1": (594.0, 841.0),
    "A0": (841.0, 1189.0),
    "Letter": (215.9, 279.4),
    "Tabloid": (279.4, 431.8),
}
"""Width and height of upright paper, mm."""

_MARGIN_MM = 8.0
"""Width of the margin that printers leave blank, mm."""
_FOOT_HEIGHT_MM = 14.0
"""Height of the scale bar with its text, mm."""
_BAR_LENGTHS_MM = (1000.0, 500.0, 200.0, 100.0, 50.0, 20.0)
"""Possible lengths of the scale bar, mm."""
_TEXT_HEIGHT_MM = 3.2
"""Height of the text, mm."""
_TEXT_ADVANCE_RATIO = 0.5
"""Mean width of a letter of the text, as a fraction of the height."""
_MM_PER_INCH = 25.4
_POINTS_PER_MM = 72 / _MM_PER_INCH
"""Number of PDF's units in a millimetre."""
_DOTS_PER_INCH = 600
"""Resolution of a PNG: that of common printers."""

Rectangle = tuple[float, float, float, float]
"""Left, top, width, height on the page, mm."""
Disc = tuple[float, float, float]
"""Centre and radius on the page, mm."""


@dataclass(frozen=True, slots=True)
class Page:
    """The content of a page: black rectangles and discs, and lines of text."""

    size: tuple[float, float]
    """Width and height of the page, mm."""
    rectangles: tuple[Rectangle, ...]
    discs: tuple[Disc, ...]
    white_discs: tuple[Disc, ...]
    """Discs of paper over the rectangles."""
    bar: float
    """Length of the scale bar, mm."""
    lines: tuple[str, ...]
    """Lines of text."""
    text_at: tuple[float, float]
    """Left end of the base line of the first, mm."""

    def svg(self) -> str:
        """Return the page as SVG."""
        width, height = self.size
        shapes = "".join(
            f'<rect x="{x:.4f}" y="{y:.4f}" width="{w:.4f}" height="{h:.4f}"/>\n'
            for x, y, w, h in self.rectangles
        )
        shapes += "".join(
            f'<circle cx="{x:.4f}" cy="{y:.4f}" r="{r:.4f}"/>\n' for x, y, r in self.discs
        )
        blanks = "".join(
            f'<circle cx="{x:.4f}" cy="{y:.4f}" r="{r:.4f}"/>\n' for x, y, r in self.white_discs
        )
        text = "".join(
            f'<text x="{x:.4f}" y="{y:.4f}" font-family="Helvetica, Arial, sans-serif" '
            f'font-size="{_TEXT_HEIGHT_MM}">{escape(line)}</text>\n'
            for x, y, line in self._place_lines()
        )
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}">\n'
            f"<!-- {make_mark(FIGURE)} -->\n"
            f'<rect width="{width}" height="{height}" fill="white"/>\n'
            f'<g fill="black" shape-rendering="crispEdges">\n{shapes}</g>\n'
            f'<g fill="white">\n{blanks}</g>\n{text}</svg>\n'
        )

    def pdf(self) -> bytes:
        """Return the page as PDF 1.4 in true size."""
        width, height = self.size
        squares = "".join(
            f"{x:.4f} {height - y - h:.4f} {w:.4f} {h:.4f} re\n" for x, y, w, h in self.rectangles
        )
        squares += "".join(_draw_disc(x, height - y, r) for x, y, r in self.discs)
        blanks = "".join(_draw_disc(x, height - y, r) for x, y, r in self.white_discs)
        over = f"1 g\n{blanks}f\n0 g\n" if blanks else ""
        text = "".join(
            f"BT /F1 {_TEXT_HEIGHT_MM} Tf {x:.4f} {height - y:.4f} Td ({_escape_pdf(line)}) Tj ET\n"
            for x, y, line in self._place_lines()
        )
        drawing = (
            f"{_POINTS_PER_MM:.8f} 0 0 {_POINTS_PER_MM:.8f} 0 0 cm\n{squares}f\n{over}{text}"
        ).encode("cp1252")
        box = f"[0 0 {width * _POINTS_PER_MM:.4f} {height * _POINTS_PER_MM:.4f}]"
        objects = [
            b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
            b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
            f"<< /Type /Page /Parent 2 0 R /MediaBox {box} /Contents 4 0 R "
            "/Resources << /Font << /F1 5 0 R >> >> >>".encode(),
            b"<< /Length %d >>\nstream\n%s\nendstream" % (len(drawing), drawing),
            b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
        ]
        return _assemble_pdf(objects)

    def png(self) -> bytes:
        """Return the page as PNG that states its true size, edges between dots as grey."""
        scale = _DOTS_PER_INCH / _MM_PER_INCH
        width, height = (round(scale * side) for side in self.size)
        ink = np.zeros((height, width), np.float32)
        for x, y, w, h in self.rectangles:
            rows, down = _cover_dots(scale * y, scale * (y + h), height)
            columns, across = _cover_dots(scale * x, scale * (x + w), width)
            ink[rows, columns] += down[:, None] * across
        for discs, is_dark in ((self.discs, True), (self.white_discs, False)):
            for x, y, r in discs:
                rows, _ = _cover_dots(scale * (y - r) - 1, scale * (y + r) + 1, height)
                columns, _ = _cover_dots(scale * (x - r) - 1, scale * (x + r) + 1, width)
                v, u = np.mgrid[rows, columns] + 0.5
                disc = np.clip(scale * r + 0.5 - np.hypot(u - scale * x, v - scale * y), 0, 1)
                part = ink[rows, columns]
                ink[rows, columns] = np.maximum(part, disc) if is_dark else part * (1 - disc)
        image = Image.fromarray(np.rint(255 * (1 - np.clip(ink, 0, 1))).astype(np.uint8))
        font = ImageFont.load_default(scale * _TEXT_HEIGHT_MM)
        for x, y, line in self._place_lines():
            text = line.replace("×", "x")  # which the font lacks
            ImageDraw.Draw(image).text((scale * x, scale * y), text, 0, font, anchor="ls")
        file = io.BytesIO()
        mark = PngInfo()
        mark.add_text("Software", make_mark(FIGURE))
        image.save(file, "PNG", dpi=(_DOTS_PER_INCH, _DOTS_PER_INCH), pnginfo=mark)
        return file.getvalue()

    def _place_lines(self) -> Iterator[tuple[float, float, str]]:
        """Yield the left end of the base line, mm, of each line of text, and the line."""
        x, y = self.text_at
        for k, line in enumerate(self.lines):
            yield x, y + 1.25 * k * _TEXT_HEIGHT_MM, line


def _escape_pdf(text: str) -> str:
    """Escape what has a meaning in a text of PDF."""
    return text.replace("\\", "\\\\").replace("(", "\\(").replace(")", "\\)")


def _cover_dots(start: float, end: float, count: int) -> tuple[slice, Array]:
    """Return the dots of a row of `count` that an interval touches, and how far it covers each."""
    dots = slice(max(int(start), 0), min(int(np.ceil(end)), count))
    first = np.arange(dots.start, dots.stop)
    return dots, np.clip(np.minimum(first + 1, end) - np.maximum(first, start), 0.0, 1.0)


def complete_pattern(pattern: Pattern, grid_size: GridSize) -> Pattern:
    """Return the pattern with its unknown properties as usually printed on a board of that size."""
    if isinstance(pattern, Charuco):
        needed = pattern.number_markers(grid_size).stop
        sizes = opencv.list_dictionaries()
        usual = [name for name in sizes if name.startswith("DICT_4X4_") and sizes[name] >= needed]
        dictionary = min(usual or ["DICT_4X4_1000"], key=lambda name: sizes[name])
        return Charuco(
            pattern.dictionary or dictionary,
            pattern.marker or 0.75,
            bool(pattern.legacy),
            pattern.first_marker,
        )
    if isinstance(pattern, Circles | ListedCircles):
        return replace(pattern, diameter=pattern.diameter or pattern.half_distance)
    if isinstance(pattern, AprilGrid):
        return AprilGrid(
            pattern.family or "t36h11",
            pattern.spacing or 0.3,
            pattern.border or 2,
            bool(pattern.from_top),
            pattern.corner_squares is not False,
            pattern.first_tag,
            pattern.tag_turn,
        )
    if isinstance(pattern, TaggedCheckerboard):
        return TaggedCheckerboard(
            pattern.family or "t36h11",
            pattern.border or 2,
            pattern.step or 4,
            bool(pattern.from_top),
        )
    return pattern


def count_printed(pattern: Pattern, grid_size: GridSize) -> GridSize:
    """Return the rows and columns of what is printed of a board with rows x columns points: its
    squares, tags or circles."""
    rows, cols = grid_size
    if isinstance(pattern, AprilGrid):
        return rows // 2, cols // 2
    return (rows + 1, cols + 1) if pattern.has_squares else grid_size


def count_points(pattern: Pattern, printed: GridSize) -> GridSize:
    """Return the rows and columns of points of a board of which rows x columns squares, tags or
    circles are printed."""
    rows, cols = printed
    if isinstance(pattern, ListedCircles) and pattern.places is not None:
        return pattern.grid_size
    if isinstance(pattern, AprilGrid):
        return 2 * rows, 2 * cols
    return (rows - 1, cols - 1) if pattern.has_squares else printed


def choose_paper(board: Board) -> str:
    """Return the first of `PAPER_SIZES_MM` that holds the board in true size, else the largest."""
    for paper in PAPER_SIZES_MM:
        try:
            lay_out_page(
                replace(board, pattern=complete_pattern(board.pattern, board.grid_size)), paper
            )
        except CalibrationError:
            continue
        return paper
    return max(PAPER_SIZES_MM, key=lambda paper: PAPER_SIZES_MM[paper])


def choose_square(pattern: Pattern, grid_size: GridSize, paper: str) -> float:
    """Return the largest side of a square that fits on paper, in whole mm where it has any."""
    largest = measure_largest_square(pattern, grid_size, paper)
    return float(np.floor(largest)) if largest >= 1 else largest


def measure_largest_square(pattern: Pattern, grid_size: GridSize, paper: str) -> float:
    """Measure the largest side of a square, mm, of which a board fits on paper.

    Raises:
        CalibrationError: if a property of the pattern is not known.
    """
    left, top, right, bottom = pattern.draw(grid_size).extent
    width, height = _turn_paper(paper, is_wide=right - left > bottom - top)
    # With half a square of white around the board.
    return min(
        (width - 2 * _MARGIN_MM) / (right - left + 1),
        (height - 2 * _MARGIN_MM - _FOOT_HEIGHT_MM) / (bottom - top + 1),
    )


def _turn_paper(paper: str, *, is_wide: bool) -> tuple[float, float]:
    """Return the width and height of paper that lies as a board does, mm."""
    short, long = PAPER_SIZES_MM[paper]
    return (long, short) if is_wide else (short, long)


def lay_out_page(board: Board, paper: str) -> Page:
    """Lay out a board in true size on paper.

    Raises:
        CalibrationError: if it does not fit, with the largest square that does, or if a property of
            its pattern is not known.
    """
    ink = board.pattern.draw(board.grid_size)
    left, top, right, bottom = ink.extent
    across, down, side = right - left, bottom - top, board.square
    width, height = _turn_paper(paper, is_wide=across > down)
    largest = measure_largest_square(board.pattern, board.grid_size, paper)
    if side > largest:
        raise CalibrationError(
            f"{describe_board(board)} does not fit on {paper} with {side:g} mm.",
            f"Use at most {largest:.1f} mm, or larger paper.",
        )
    x0 = (width - across * side) / 2 - left * side
    y0 = (height - _FOOT_HEIGHT_MM - down * side) / 2 - top * side
    rectangles: list[Rectangle] = []
    discs: list[Disc] = []
    white_discs: list[Disc] = []
    if isinstance(ink, PrintedSquaresAndDots):
        dots = [(x0 + u, y0 + v, side * ink.radius) for u, v in (side * ink.centres).tolist()]
        discs = [dot for dot, dark in zip(dots, ink.dark.tolist(), strict=True) if dark]
        white_discs = [dot for dot, dark in zip(dots, ink.dark.tolist(), strict=True) if not dark]
        ink = ink.rectangles
    if isinstance(ink, PrintedRectangles):
        for u, v, w, z in (side * ink.list_rectangles()).tolist():
            rectangles.append((x0 + u, y0 + v, w - u, z - v))
    if isinstance(ink, PrintedDiscs):
        discs = [(x0 + u, y0 + v, side * ink.radius) for u, v in (side * ink.centres).tolist()]
    bar = next(length for length in _BAR_LENGTHS_MM if length <= width - 2 * _MARGIN_MM)
    x, y = (width - bar) / 2, height - _MARGIN_MM - _FOOT_HEIGHT_MM / 2
    step = bar / 10
    ruler = [(x + 2 * k * step, y, step, 2.0) for k in range(5)] + [(x, y + 2.0, bar, 0.3)]
    unit = "squares" if board.pattern.has_squares else "distance"
    if isinstance(board.pattern, AprilGrid):
        unit = "tags"
    lines = (
        f"{bar:g} mm. Print without scaling and measure the bar.",
        f"{describe_board(board).replace(' x ', ' × ')}, {unit} of {side:g} mm.",
    )
    longest = _TEXT_ADVANCE_RATIO * _TEXT_HEIGHT_MM * max(map(len, lines))
    text_at = (
        max(min(x, width - _MARGIN_MM - longest), _MARGIN_MM),
        y + 2.3 + 1.4 * _TEXT_HEIGHT_MM,
    )
    return Page(
        (width, height),
        (*rectangles, *ruler),
        tuple(discs),
        tuple(white_discs),
        bar,
        lines,
        text_at,
    )


def _draw_disc(x: float, y: float, r: float) -> str:
    """Draw a disc in PDF: four Bezier curves, true to 3e-4 of its radius."""
    k = 0.5522847 * r
    path = f"{x + r:.4f} {y:.4f} m\n"
    for c, s, e, f in ((1, 0, 0, 1), (0, 1, -1, 0), (-1, 0, 0, -1), (0, -1, 1, 0)):
        points = (
            (x + r * c + k * e, y + r * s + k * f),
            (x + r * e + k * c, y + r * f + k * s),
            (x + r * e, y + r * f),
        )
        path += " ".join(f"{u:.4f} {v:.4f}" for u, v in points) + " c\n"
    return path + "h\n"


def write_page(content: Page, path: Path) -> None:
    """Write a page as PDF, SVG or PNG, by the suffix of `path`.

    Raises:
        CalibrationError: if the suffix is another one, or the file cannot be written.
    """
    match path.suffix.lower():
        case ".pdf":
            write_atomically(path, content.pdf())
        case ".svg":
            write_atomically(path, content.svg().encode())
        case ".png":
            write_atomically(path, content.png())
        case _:
            raise CalibrationError(
                f"{path} is not named as PDF, SVG or PNG.", "End its name in .pdf, .svg or .png."
            )


def _assemble_pdf(objects: list[bytes]) -> bytes:
    """Assemble a PDF file from numbered objects, the first of which is the catalogue."""
    content = f"%PDF-1.4\n% {make_mark(FIGURE)}\n".encode()
    places = []
    for number, body in enumerate(objects, start=1):
        places.append(len(content))
        content += b"%d 0 obj\n%s\nendobj\n" % (number, body)
    table = "".join(f"{place:010} 00000 n \n" for place in places)
    return (
        content
        + (
            f"xref\n0 {len(objects) + 1}\n0000000000 65535 f \n{table}"
            f"trailer\n<< /Size {len(objects) + 1} /Root 1 0 R >>\n"
            f"startxref\n{len(content)}\n%%EOF\n"
        ).encode()
    )
