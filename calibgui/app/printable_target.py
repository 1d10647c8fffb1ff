"""A checkerboard to print, as PDF or SVG in true size, with a bar to check the print by.

The board has one square more each way than inner corners, its first square is dark, and at
least half a square of white around it, which the corner finder needs. Printers scale: the bar
below it is measured with a ruler before anything is believed.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.types import Board

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
_POINT = 72 / 25.4
"""PDF's units in a mm."""

Rectangle = tuple[float, float, float, float]
"""Left, top, width, height on the sheet, mm."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """What is printed where: black rectangles and a line of text."""

    size: tuple[float, float]
    """Width and height of the sheet, mm."""
    rectangles: tuple[Rectangle, ...]
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


def sheet(board: Board, square: float, paper: str) -> Sheet:
    """A board of rows x cols inner corners with squares of side `square` mm on a sheet.

    Raises:
        CalibrationError: it does not fit, with what would.
    """
    rows, cols = board[0] + 1, board[1] + 1
    short, long = PAPERS[paper]
    width, height = (long, short) if cols > rows else (short, long)
    largest = min((width - 2 * _EDGE) / (cols + 1), (height - 2 * _EDGE - _FOOT) / (rows + 1))
    if square > largest:
        raise CalibrationError(
            f"{rows} x {cols} squares of {square:g} mm do not fit on {paper}.",
            f"Use squares of at most {largest:.1f} mm, or larger paper.",
        )
    left = (width - cols * square) / 2
    top = (height - _FOOT - rows * square) / 2
    squares = [
        (left + col * square, top + row * square, square, square)
        for row in range(rows)
        for col in range(cols)
        if (row + col) % 2 == 0
    ]
    bar = next(length for length in _BARS if length <= width - 2 * _EDGE)
    x, y = (width - bar) / 2, height - _EDGE - _FOOT / 2
    step = bar / 10
    ruler = [(x + 2 * k * step, y, step, 2.0) for k in range(5)] + [(x, y + 2.0, bar, 0.3)]
    text = (
        f"{bar:g} mm. Print without scaling and measure the bar. Board: {rows} x {cols} squares "
        f"of {square:g} mm, {board[0]} x {board[1]} inner corners."
    )
    return Sheet((width, height), (*squares, *ruler), bar, text, (x, y + 2.3 + 1.4 * _TEXT))


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
