"""A target to print, as PDF or SVG in true size, with a bar to check the print by.

The board has one square more each way than inner corners, its first square is dark, and at
least half a square of white around it, which the corner finder needs. Printers scale: the bar
below it is measured with a ruler before anything is believed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from html import escape
from pathlib import Path

from calibgui.engine import opencv
from calibgui.engine.arrays import GridSize
from calibgui.engine.boards import Board, Charuco, Circles, Discs, Pattern, Raster
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.report.boards import described

PAPERS = {
    "A4": (210.0, 297.0),
    "A3": (297.0, 420.0),
    "A2": (420.0, 594.0),
    "A1": (594.0, 841.0),
    "A0": (841.0, 1189.0),
    "Letter": (215.9, 279.4),
    "Tabloid": (279.4, 431.8),
}
"""Width and height of a sheet held upright, mm."""

_EDGE = 8.0
"""Of the sheet that printers leave blank, mm."""
_FOOT = 14.0
"""Height of the bar with its text, mm."""
_BARS = (1000.0, 500.0, 200.0, 100.0, 50.0, 20.0)
"""Lengths that the bar may have, mm."""
_TEXT = 3.2
"""Height of the text, mm."""
_ADVANCE = 0.5
"""Mean advance of the text's letters over their height."""
_POINT = 72 / 25.4
"""PDF's units in a mm."""

Rectangle = tuple[float, float, float, float]
"""Left, top, width, height on the sheet, mm."""
Disc = tuple[float, float, float]
"""Centre and radius on the sheet, mm."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """What is printed where: black rectangles and discs, and a line of text."""

    size: tuple[float, float]
    """Width and height of the sheet, mm."""
    rectangles: tuple[Rectangle, ...]
    discs: tuple[Disc, ...]
    bar: float
    """Length of the bar, mm."""
    text: str
    text_at: tuple[float, float]
    """Left end of the text's base line, mm."""

    def svg(self) -> str:
        """The sheet as SVG."""
        width, height = self.size
        shapes = "".join(
            f'<rect x="{x:.4f}" y="{y:.4f}" width="{w:.4f}" height="{h:.4f}"/>\n'
            for x, y, w, h in self.rectangles
        )
        shapes += "".join(
            f'<circle cx="{x:.4f}" cy="{y:.4f}" r="{r:.4f}"/>\n' for x, y, r in self.discs
        )
        x, y = self.text_at
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
            f'viewBox="0 0 {width} {height}">\n'
            f'<rect width="{width}" height="{height}" fill="white"/>\n'
            f'<g fill="black" shape-rendering="crispEdges">\n{shapes}</g>\n'
            f'<text x="{x:.4f}" y="{y:.4f}" font-family="Helvetica, Arial, sans-serif" '
            f'font-size="{_TEXT}">{escape(self.text)}</text>\n</svg>\n'
        )

    def pdf(self) -> bytes:
        """The sheet as PDF 1.4, one page of true size."""
        width, height = self.size
        squares = "".join(
            f"{x:.4f} {height - y - h:.4f} {w:.4f} {h:.4f} re\n" for x, y, w, h in self.rectangles
        )
        squares += "".join(_circle(x, height - y, r) for x, y, r in self.discs)
        x, y = self.text_at
        text = self.text.replace("\\", "\\\\").replace("(", "\\(").replace(")", "\\)")
        drawing = (
            f"{_POINT:.8f} 0 0 {_POINT:.8f} 0 0 cm\n{squares}f\n"
            f"BT /F1 {_TEXT} Tf {x:.4f} {height - y:.4f} Td ({text}) Tj ET\n"
        ).encode("cp1252")
        box = f"[0 0 {width * _POINT:.4f} {height * _POINT:.4f}]"
        objects = [
            b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
            b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
            f"<< /Type /Page /Parent 2 0 R /MediaBox {box} /Contents 4 0 R "
            "/Resources << /Font << /F1 5 0 R >> >> >>".encode(),
            b"<< /Length %d >>\nstream\n%s\nendstream" % (len(drawing), drawing),
            b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
        ]
        return _pdf_file(objects)


def settled(pattern: Pattern, grid_size: GridSize) -> Pattern:
    """The pattern with what it leaves open as it is usually printed, for a board of that size."""
    if isinstance(pattern, Charuco):
        needed = (grid_size[0] + 1) * (grid_size[1] + 1) // 2
        sizes = opencv.dictionaries()
        usual = [name for name in sizes if name.startswith("DICT_4X4_") and sizes[name] >= needed]
        dictionary = min(usual or ["DICT_4X4_1000"], key=lambda name: sizes[name])
        return Charuco(
            pattern.dictionary or dictionary, pattern.marker or 0.75, bool(pattern.legacy)
        )
    if isinstance(pattern, Circles):
        return replace(pattern, diameter=pattern.diameter or pattern.reach)
    return pattern


def paper_for(board: Board) -> str:
    """The first of `PAPERS` that holds the target in true size; the largest if none does."""
    for paper in PAPERS:
        try:
            sheet(replace(board, pattern=settled(board.pattern, board.grid_size)), paper)
        except CalibrationError:
            continue
        return paper
    return max(PAPERS, key=lambda paper: PAPERS[paper])


def sheet(board: Board, paper: str) -> Sheet:
    """A target in true size on a sheet of paper.

    Raises:
        CalibrationError: it does not fit, with what would, or something of it is open.
    """
    ink = board.pattern.ink(board.grid_size)
    left, top, right, bottom = ink.extent
    across, down, side = right - left, bottom - top, board.square
    short, long = PAPERS[paper]
    width, height = (long, short) if across > down else (short, long)
    largest = min((width - 2 * _EDGE) / (across + 1), (height - 2 * _EDGE - _FOOT) / (down + 1))
    if side > largest:
        raise CalibrationError(
            f"{described(board)} does not fit on {paper} with {side:g} mm.",
            f"Use at most {largest:.1f} mm, or larger paper.",
        )
    x0 = (width - across * side) / 2 - left * side
    y0 = (height - _FOOT - down * side) / 2 - top * side
    rectangles: list[Rectangle] = []
    discs: list[Disc] = []
    if isinstance(ink, Raster):
        for u, v, w, z in (side * ink.rectangles()).tolist():
            rectangles.append((x0 + u, y0 + v, w - u, z - v))
    if isinstance(ink, Discs):
        discs = [(x0 + u, y0 + v, side * ink.radius) for u, v in (side * ink.centres).tolist()]
    bar = next(length for length in _BARS if length <= width - 2 * _EDGE)
    x, y = (width - bar) / 2, height - _EDGE - _FOOT / 2
    step = bar / 10
    ruler = [(x + 2 * k * step, y, step, 2.0) for k in range(5)] + [(x, y + 2.0, bar, 0.3)]
    unit = "squares" if board.pattern.squared else "distance"
    text = (
        f"{bar:g} mm. Print without scaling and measure the bar. {described(board)}, {unit} of "
        f"{side:g} mm."
    )
    text_at = (min(x, width - _EDGE - _ADVANCE * _TEXT * len(text)), y + 2.3 + 1.4 * _TEXT)
    return Sheet((width, height), (*rectangles, *ruler), tuple(discs), bar, text, text_at)


def _circle(x: float, y: float, r: float) -> str:
    """A disc in PDF: four Bezier curves, true to 3e-4 of its radius."""
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


def write_sheet(content: Sheet, path: Path) -> None:
    """Write a sheet as PDF or SVG, by the suffix of `path`.

    Raises:
        CalibrationError: another suffix, or it cannot be written.
    """
    match path.suffix.lower():
        case ".pdf":
            write_atomically(path, content.pdf())
        case ".svg":
            write_atomically(path, content.svg().encode())
        case _:
            raise CalibrationError(
                f"{path} is neither a PDF nor an SVG file.", "End its name in .pdf or .svg."
            )


def _pdf_file(objects: list[bytes]) -> bytes:
    """A PDF file of numbered objects, the first its catalogue."""
    content = b"%PDF-1.4\n"
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
