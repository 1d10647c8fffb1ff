"""Draw the README's chart of what calibgui is better at, from the manual's tables of figures.

    python packaging/draw_comparison.py [FILE]

Every number is read from resources/manual/12-figures.md, which names the command that printed it.
"""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import escape

RESOURCES = Path(__file__).resolve().parents[1] / "resources"
FIGURES = RESOURCES / "manual" / "12-figures.md"
PICTURE = RESOURCES / "images" / "comparison.svg"

WIDTH, MARGIN, GAP = 880, 16, 24
"""Width of the picture, and spaces around and between the panels, px."""
ROW, HEAD = 24, 50
"""Heights of a bar with its name and of a panel's heading, px."""
NAMES, NUMBERS = 160, 62
"""Widths of the bars' names and of the numbers behind them, px."""

STYLE = """
text { font: 13px "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif; fill: #20262e }
.title { font-weight: 600 } .unit { fill: #5b6673; font-size: 12px }
.ground { fill: #ffffff } .other { fill: #a9b4c0 } .ours { fill: #1f6fbf } .own { font-weight: 600 }
@media (prefers-color-scheme: dark) { text { fill: #e6e9ed } .unit { fill: #a3adb8 }
  .ground { fill: #171c21 } .other { fill: #5c6875 } .ours { fill: #5aa7f0 } }
"""


@dataclass(frozen=True, slots=True)
class Panel:
    """Bars of one quantity."""

    title: str
    unit: str
    bars: tuple[tuple[str, str, int], ...]
    """What each bar is called, the beginning of the table's row that it is of, and its column; the
    first is calibgui's."""


PANELS = (
    Panel(
        "Error of a corner",
        "over the bound that the noise allows, median",
        (
            ("calibgui", "calibgui, the board's size unknown", 1),
            ("libcbdetect", "libcbdetect 1.0", 1),
            ("OpenCV", "OpenCV 5.0 `findChessboardCorners`, `cornerSubPix`", 1),
            ("OpenCV, SB", "OpenCV 5.0 `findChessboardCornersSB`", 1),
        ),
    ),
    Panel(
        "Unseen views of a lens of 186 degrees",
        "rms, px",
        (
            ("calibgui, splined", "splined, 16 x 11 control points", 3),
            ("calibgui, fisheye", "Kannala-Brandt", 3),
            ("OpenCV's usual model", "Brown-Conrady, 5 coefficients", 3),
            ("OpenCV, fisheye", "OpenCV 5.0, `cv2.fisheye.calibrate`", 2),
        ),
    ),
    Panel(
        "Solve of 100 views",
        "ms of one processor; only calibgui's computes every ±",
        (
            ("calibgui", "100", 2),
            ("mrcal", "100", 4),
            ("OpenCV", "100", 3),
        ),
    ),
    Panel(
        "Faults that nobody is told of",
        "share of sets wrong by more than 3 of their ±, nothing said",
        (
            ("calibgui", "**all**", 4),
            ("mrcal", "**all**", 6),
            ("OpenCV", "**all**", 5),
        ),
    ),
)


def read_cell(text: str, row: str, column: int) -> str:
    """Return the cell of the row that begins with `row`, bold or not."""
    (line,) = re.findall(rf"^\| {re.escape(row)} \|.*$", text, re.MULTILINE)
    return [cell.strip(" *") for cell in line.split("|")[1:-1]][column].partition(" ")[0]


def draw(text: str) -> str:
    """Return the chart as SVG.

    Args:
        text: the manual's chapter of figures.
    """
    half = (WIDTH - 2 * MARGIN - GAP) / 2
    heights = [HEAD + ROW * max(len(p.bars) for p in PANELS[k : k + 2]) for k in (0, 2)]
    height = 2 * MARGIN + GAP + sum(heights)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}">',
        f"<style>{STYLE}</style>",
        f'<rect class="ground" width="{WIDTH}" height="{height}" rx="8"/>',
    ]
    for k, panel in enumerate(PANELS):
        x, y = MARGIN + k % 2 * (half + GAP), MARGIN + k // 2 * (heights[0] + GAP)
        parts += [
            f'<text class="title" x="{x:g}" y="{y + 14:g}">{escape(panel.title)}</text>',
            f'<text class="unit" x="{x:g}" y="{y + 32:g}">{escape(panel.unit)}</text>',
            *draw_bars(panel, text, x, y + HEAD, half),
        ]
    return "\n".join([*parts, "</svg>", ""])


def draw_bars(panel: Panel, text: str, x: float, y: float, width: float) -> list[str]:
    """Return the bars of a panel whose upper left corner is at (x, y)."""
    cells = [read_cell(text, row, column) for _, row, column in panel.bars]
    numbers = [float(cell.rstrip("%")) if cell[0].isdigit() else None for cell in cells]
    largest = max(number for number in numbers if number is not None)
    room = width - NAMES - NUMBERS
    parts = []
    for (name, _, _), cell, number in zip(panel.bars, cells, numbers, strict=True):
        ours = name.startswith("calibgui")
        long = max(room * number / largest, 2) if number is not None else 0
        own = ' class="own"' if ours else ""
        parts += [
            f'<text{own} x="{x:g}" y="{y + 13:g}">{escape(name)}</text>',
            f'<rect class="{"ours" if ours else "other"}" x="{x + NAMES:g}" y="{y:g}" '
            f'width="{long:.0f}" height="{ROW - 7}" rx="2"/>',
            f'<text{own} x="{x + NAMES + long + 6:.0f}" y="{y + 13:g}">{escape(cell)}</text>',
        ]
        y += ROW
    return parts


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path, nargs="?", default=PICTURE)
    parser.parse_args().file.write_text(draw(FIGURES.read_text(encoding="utf-8")), encoding="utf-8")
