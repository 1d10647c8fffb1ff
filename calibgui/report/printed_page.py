"""A result on paper: the sentences, tables and plots of a calibration as one HTML page.

The page is black on white whatever the window's colours, and says in words what the window says in
colours.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape

from matplotlib.figure import Figure

from calibgui.dataset import Result
from calibgui.report.boards import name_point
from calibgui.report.coverage import measure_attitudes
from calibgui.report.figures import (
    draw_distortion,
    draw_residual_histograms,
    draw_residual_scatter,
)
from calibgui.report.lens_models import get_short_lens_title
from calibgui.report.names import shorten_name
from calibgui.report.numbers import format_with_sigma
from calibgui.report.summary import Tone, describe_calibration
from calibgui.report.tables import describe_rms

_MARKS = {Tone.FACT: "", Tone.GOOD: "Good", Tone.CAUTION: "Caution", Tone.ADVICE: "Advice"}
_RESOLUTION = 150
"""Dots per inch of the plots: letters are sharp on paper, and a page stays below 1 MB."""
_TEXT_WIDTH = 640
"""Width of a plot on the page, in CSS pixels: that of the text on A4 with its margins."""


@dataclass(frozen=True, eq=False, slots=True)
class PrintedPage:
    """A page in HTML with the pictures that it names."""

    html: str
    pictures: Mapping[str, bytes]
    """PNG files by the names under which the page shows them."""


def make_printed_page(result: Result, name: str) -> PrintedPage:
    """Make the page of a result that is called `name`.

    It takes a second or two: what the window does in a worker.
    """
    calibration = result.calibration
    figures = {
        "residuals": ("Residuals of all corners, one colour a view", _draw_residuals(result)),
        "histograms": (
            "Residuals along u and v and their length, with the curves of noise",
            draw_residual_histograms(calibration, on_reference=False),
        ),
        "distortion": (
            "Displacement by the lens, px: all of it (a), radial (b), decentering (c)",
            draw_distortion(calibration.camera),
        ),
    }
    plots = "".join(
        f'<p><img src="{key}" width="{_choose_width(figure)}"><br><i>{escape(caption)}</i></p>'
        for key, (caption, figure) in figures.items()
    )
    lens = get_short_lens_title(calibration.camera.model)
    parts = [
        f"<h1>Calibration “{escape(name)}”</h1>",
        f"<p>{escape(describe_rms(result))}</p>",
        _list_sentences(result),
        f"<h2>Camera, {escape(lens)}, {_describe_size(result)}</h2>",
        _tabulate_parameters(result),
        "<h2>Views</h2>",
        _tabulate_views(result),
        "<h2>Plots</h2>",
        plots,
    ]
    pictures = {key: _encode_png(figure) for key, (_, figure) in figures.items()}
    return PrintedPage("".join(parts), pictures)


def _draw_residuals(result: Result) -> Figure:
    return draw_residual_scatter(result.calibration, on_reference=False)


def _choose_width(figure: Figure) -> int:
    """Return the width of a figure on the page: single plots take half of it."""
    width, height = figure.get_size_inches()
    return _TEXT_WIDTH if width > 2 * height else _TEXT_WIDTH // 2


def _describe_size(result: Result) -> str:
    width, height = result.calibration.camera.size
    return f"{width} × {height} px"


def _list_sentences(result: Result) -> str:
    """List what there is to say of the result, each with a word on what it is for."""
    rows = [
        [f"<b>{_MARKS[sentence.tone]}</b>", escape(sentence.text)]
        for sentence in describe_calibration(result)
    ]
    body = "".join(f"<tr><td>{mark}</td><td>{text}</td></tr>" for mark, text in rows)
    return f'<table cellpadding="3">{body}</table>'


def _tabulate_parameters(result: Result) -> str:
    """Tabulate the parameters of the camera with their standard deviations, in HTML."""
    calibration = result.calibration
    rows = [
        [
            name,
            "held at " + f"{value:g}"
            if name in calibration.fixed
            else format_with_sigma(value, sigma),
            "px" if place < 4 else "",
        ]
        for place, (name, value, sigma) in enumerate(
            zip(
                calibration.camera.names,
                calibration.camera.params,
                calibration.sigma,
                strict=True,
            )
        )
    ]
    return _make_table(["Parameter", "Value ± 1σ", "Unit"], rows)


def _tabulate_views(result: Result) -> str:
    """Tabulate the used views: corners, residuals, distance and tilt of the board, in HTML."""
    attitudes = measure_attitudes(result.calibration, result.observations())
    rows = [
        [
            shorten_name(view.image),
            str(len(fit.image)),
            f"{fit.rms:.3f}",
            f"{distance:.0f}",
            f"{math.degrees(tilt):.1f}",
        ]
        for view, fit, distance, tilt in zip(
            result.used,
            result.calibration.residuals,
            attitudes.distance,
            attitudes.tilt,
            strict=True,
        )
    ]
    unit = f"mm {result.condition}".rstrip()
    head = [
        "Image",
        f"{name_point(result.board)}s".capitalize(),
        "RMS [px]",
        f"Distance [{unit}]",
        "Tilt [°]",
    ]
    return _make_table(head, rows)


def _make_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table with rules; the first column is of names, the others are aligned right."""

    def make_row(cells: Sequence[str], tag: str) -> str:
        sides = ["left", *["right"] * (len(cells) - 1)]
        made = (
            f'<{tag} align="{side}">{escape(cell)}</{tag}>'
            for side, cell in zip(sides, cells, strict=True)
        )
        return f"<tr>{''.join(made)}</tr>"

    body = "".join(make_row(row, "td") for row in rows)
    ruled = 'border="1" cellspacing="0" cellpadding="3"'
    style = 'style="border-collapse: collapse; margin-bottom: 12px"'
    return f"<table {ruled} {style}><thead>{make_row(head, 'th')}</thead>{body}</table>"


def _encode_png(figure: Figure) -> bytes:
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=_RESOLUTION)
    return out.getvalue()
