"""A fleet in HTML: one page of all cameras, and a page for each of them in a folder beside it.

The pages need no script, no network and no other file than each other. Figures are the ledger's;
what is compared here (`fleet_overview.py`) is said to be.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from html import escape
from urllib.parse import quote

from calibgui.dataset.fleet import Estimate, FleetFigures
from calibgui.engine.assessment import MIN_FLEET, OUTLIER_Z
from calibgui.engine.camera import PINHOLE
from calibgui.formats.origin import FLEET_PAGE, make_mark
from calibgui.report.fleet_figures import Histogram, Measured, draw_history, make_histogram
from calibgui.report.fleet_overview import FleetOverview, Kind, PlacedCamera
from calibgui.report.numbers import format_with_sigma
from calibgui.report.verdict import join_names

_MAX_HISTORIES = 12
"""Largest number of serial numbers whose drift is drawn on the first page: those that changed most.
The others are drawn on the pages of their cameras."""
_STYLE = """
:root { color-scheme: light dark; --line: #8886; --bar: #3b7dd8; --good: #1a7f4b; --bad: #c0392b;
  --soft: #777 }
@media (prefers-color-scheme: dark) { :root { --bar: #6aa5f0; --good: #4cc38a; --bad: #ff7b6b;
  --soft: #aaa } }
body { font: 15px/1.5 sans-serif; max-width: 78rem; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.6rem } h2 { font-size: 1.2rem; margin-top: 2.2rem }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums }
th, td { padding: .25rem .7rem; text-align: right; border-bottom: 1px solid var(--line) }
th { position: sticky; top: 0; background: Canvas; vertical-align: bottom }
th.text, td.text { text-align: left } .bad { color: var(--bad) } .good { color: var(--good) }
.soft { color: var(--soft) } .plots { display: flex; flex-wrap: wrap; gap: 1rem }
.tiles { display: flex; flex-wrap: wrap; gap: 1rem; margin: 1rem 0 }
.tile { border: 1px solid var(--line); border-radius: 6px; padding: .5rem 1rem }
.tile b { display: block; font-size: 1.5rem } .scroll { overflow-x: auto }
.date { white-space: nowrap }
svg text { font: 10px sans-serif; fill: var(--soft) }
svg .title { font-size: 12px; fill: CanvasText }
svg .bar { fill: var(--bar) } svg .axis { fill: none; stroke: var(--line) }
svg .line { fill: none; stroke: var(--line) } svg .mark { stroke: var(--bad); stroke-width: 2 }
svg .good { stroke: var(--good); fill: var(--good) }
svg .bad { stroke: var(--bad); fill: var(--bad) }
"""


class FleetPages:
    """Makes the pages of a fleet.

    Args:
        overview: the fleet.
        name: what the fleet is called, which is the heading of its first page.
        folder: name of the folder beside the first page, for the cameras' pages.
        first: name of the first page's file.
        results: addresses of the cameras' result.json from that folder, by id.
    """

    def __init__(
        self,
        overview: FleetOverview,
        name: str,
        folder: str,
        first: str,
        results: Mapping[str, str],
    ) -> None:
        self._overview, self._name = overview, name
        self._folder, self._first, self._results = folder, first, results
        digits = len(str(len(overview.placed)))
        self._pages = {
            one.camera.id: f"{k:0{digits}d}.html" for k, one in enumerate(overview.placed, start=1)
        }
        self._histograms = {kind: _lay_out(ids) for kind, ids in overview.kinds.items()}

    def make_first(self) -> str:
        """Make the page of all cameras."""
        overview, folder = self._overview, quote(self._folder)
        links = {key: f"{folder}/{page}" for key, page in self._pages.items()}
        parts = [f"<h1>{escape(self._name)}</h1>", _make_tiles(overview)]
        parts += _describe_outliers(overview, links)
        if overview.failed:
            rows = [
                [*_name_camera(one, links), escape(" ".join(one.camera.failures))]
                for one in overview.failed
            ]
            parts.append("<h2>Cameras that fail</h2>")
            parts.append(_make_table([*_NAMES, "Why"], rows, texts=(0, 1, 2, 3)))
        parts += _describe_drift(overview, links)
        for kind, histograms in self._histograms.items():
            plots = "".join(one.draw() for one in histograms.values())
            count = len(overview.kinds[kind])
            parts.append(f"<h2>{_name_kind(kind)}: {_count(count)}</h2>")
            parts.append(f'<div class="plots">{plots}</div>')
        parts.append("<h2>All cameras</h2>")
        rows = [[*_name_camera(one, links), *_list_figures(one)] for one in overview.placed]
        parts.append(_make_table([*_NAMES, *_FIGURES], rows, texts=(0, 1, 2, 3, 4)))
        return _make_page(self._name, parts)

    def make_cameras(self) -> Iterator[tuple[str, str]]:
        """Yield the name and the content of each camera's page."""
        for one in self._overview.placed:
            yield self._pages[one.camera.id], self._make_camera(one)

    def _make_camera(self, one: PlacedCamera) -> str:
        """Make the page of one camera, in HTML."""
        camera, figures = one.camera, one.camera.figures
        verdict = "passes" if camera.passed else "fails"
        parts = [
            f'<p><a href="../{quote(self._first)}">{escape(self._name)}</a></p>',
            f"<h1>{escape(camera.id)}</h1>",
            f'<p class="{"good" if camera.passed else "bad"}">This camera {verdict}.</p>',
            _make_list([*camera.failures, camera.remedy]),
            _make_table(["", ""], _list_facts(one), texts=(0, 1)),
        ]
        if address := self._results.get(camera.id):
            parts.append(f'<p><a href="{escape(address)}">result.json</a></p>')
        if figures is not None:
            rows = [
                [escape(name), escape(_format_estimate(value)), unit]
                for name, value, unit in _list_parameters(figures)
            ]
            parts.append("<h2>Camera</h2>")
            parts.append(_make_table(["Parameter", "Value ± 1σ", "Unit"], rows, texts=(0, 2)))
            kind = (figures.size, figures.lens_model)
            if histograms := self._histograms.get(kind):
                values = _measure(one)
                plots = "".join(
                    histogram.draw(values[name]) for name, histogram in histograms.items()
                )
                parts.append(
                    f"<h2>Among {_count(len(self._overview.kinds[kind]))} of its kind</h2>"
                )
                parts.append(f'<div class="plots">{plots}</div>')
        if history := self._overview.histories.get(camera.entry.serial):
            parts.append(f"<h2>Serial number {escape(camera.entry.serial)}</h2>")
            parts.append(f'<div class="plots">{_draw_histories(history)}</div>')
            links = self._pages
            rows = [[*_name_camera(past, links), *_list_change(past, links)] for past in history]
            parts.append(_make_table([*_NAMES, *_CHANGE], rows, texts=(0, 1, 2, 3)))
        return _make_page(f"{camera.id}, {self._name}", parts)


_NAMES = ("Camera", "Serial number", "Date")
_FIGURES = (
    "Verdict",
    "Grade",
    "Views",
    "RMS [px]",
    "Error, edge [px]",
    "Coverage",
    "From the median camera [px rms]",
    "Robust z",
    "Changed by [px rms]",
)
_CHANGE = ("Against", "Changed by [px rms]", "Largest [px]", "Explained [px rms]", "Probability")


def _make_tiles(overview: FleetOverview) -> str:
    """Count the cameras by what became of them."""
    refused = sum(one.camera.figures is None for one in overview.placed)
    counts = {
        "cameras": len(overview.placed),
        "pass": len(overview.placed) - len(overview.failed),
        "fail": len(overview.failed),
        "of these without a calibration": refused,
        "unlike the others": len(overview.outliers),
        "have changed": len(overview.changed),
    }
    tiles = "".join(f'<div class="tile"><b>{n}</b>{text}</div>' for text, n in counts.items())
    return f'<div class="tiles">{tiles}</div>'


def _describe_outliers(overview: FleetOverview, links: Mapping[str, str]) -> list[str]:
    """Describe in HTML which cameras are unlike the others, with links to their pages."""
    parts = ["<h2>Cameras unlike the others</h2>"]
    parts.append(
        "<p>Each camera is compared with the median of its image size and lens model by where both "
        "image the same far points, after the rotation that brings them together. The difference "
        "contains the calibration's own error. Robust z is its distance from the median difference "
        f"in standard deviations; beyond {OUTLIER_Z:g} a camera is listed here, if its own error "
        f"does not explain it. Of fewer than {MIN_FLEET} cameras none is.</p>"
    )
    if overview.undetermined:
        names = escape(join_names([one.camera.id for one in overview.undetermined]))
        parts.append(f"<p>Not compared, as photographs do not determine them: {names}.</p>")
    if not overview.outliers:
        return [*parts, "<p>There is none.</p>"]
    rows = [
        [
            *_name_camera(one, links),
            _format(one.difference, 3),
            _format(one.worst, 3),
            _format(one.z, 1),
        ]
        for one in overview.outliers
    ]
    head = [*_NAMES, "Difference [px rms]", "Largest [px]", "Robust z"]
    return [*parts, _make_table(head, rows, texts=(0, 1, 2))]


def _describe_drift(overview: FleetOverview, links: Mapping[str, str]) -> list[str]:
    """List the cameras that have changed, and draw the serial numbers that changed most."""
    if not overview.histories:
        return []
    parts = ["<h2>Drift</h2>"]
    if not overview.changed:
        return [
            *parts,
            f"<p>Of {len(overview.histories)} serial numbers with several dates none has changed "
            "by more than the calibrations' uncertainties explain.</p>",
        ]
    rows = [[*_name_camera(one, links), *_list_change(one, links)] for one in overview.changed]
    parts.append(
        "<p>Differences from the last calibration of the same serial number that uncertainties do "
        "not explain.</p>"
    )
    parts.append(_make_table([*_NAMES, *_CHANGE], rows, texts=(0, 1, 2, 3)))
    serials = dict.fromkeys(one.camera.entry.serial for one in overview.changed)
    drawn = [serial for serial in serials if serial in overview.histories][:_MAX_HISTORIES]
    for serial in drawn:
        parts.append(f"<h3>Serial number {escape(serial)}</h3>")
        parts.append(f'<div class="plots">{_draw_histories(overview.histories[serial])}</div>')
    return parts


def _draw_histories(history: Sequence[PlacedCamera]) -> str:
    """Draw the changes, focal length and centre of a serial number over time."""
    known = [one for one in history if one.camera.figures is not None]
    changes = [
        Measured(
            one.camera.entry.date,
            change.rms,
            change.expected,
            not change.is_significant,
            one.camera.id,
        )
        for one in known
        if (change := one.camera.change) is not None
    ]
    plots = [draw_history(changes, "change ± explained [px rms]")]
    for name in ("fx", "cx", "cy"):
        points = [
            Measured(
                one.camera.entry.date,
                one.camera.figures.parameters[name].value,
                one.camera.figures.parameters[name].sigma,
                one.camera.change is None or not one.camera.change.is_significant,
                one.camera.id,
            )
            for one in known
            if one.camera.figures is not None and name in one.camera.figures.parameters
        ]
        plots.append(draw_history(points, f"{name} ± 1σ [px]"))
    return "".join(plots)


def _lay_out(members: Sequence[PlacedCamera]) -> dict[str, Histogram]:
    """Lay out the histograms of the cameras of a kind, by quantity."""
    measured = [_measure(one) for one in members]
    found = {}
    for name in measured[0]:
        if histogram := make_histogram([values[name] for values in measured], name):
            found[name] = histogram
    return found


def _measure(one: PlacedCamera) -> dict[str, float]:
    """Return the quantities of a camera whose distribution is drawn, by name and unit."""
    figures = one.camera.figures
    assert figures is not None
    measured = {
        "from the median camera [px rms]": one.difference,
        "residuals [px rms]": figures.rms,
        "error at the edge [px]": figures.error.edge,
        "coverage": figures.coverage,
    }
    for name, value, unit in _list_parameters(figures):
        if value.sigma > 0:
            measured[f"{name} [{unit}]" if unit else name] = value.value
    return measured


def _list_parameters(figures: FleetFigures) -> list[tuple[str, Estimate, str]]:
    """List the parameters of a camera with their units."""
    return [
        (name, value, "px" if name in PINHOLE else "") for name, value in figures.parameters.items()
    ]


def _list_facts(one: PlacedCamera) -> list[list[str]]:
    """List what there is to say of a camera, as rows of two cells."""
    camera, figures, entry = one.camera, one.camera.figures, one.camera.entry
    facts = {
        "Serial number": entry.serial,
        "Date": entry.date,
        "Temperature": "" if entry.temperature is None else f"{entry.temperature:g} °C",
        "Photographs": str(camera.photographs),
        "Processor time": f"{camera.cpu_seconds:.1f} s" if camera.cpu_seconds > 0 else "",
    }
    if figures is not None:
        error = figures.error
        facts |= {
            "Grade": _name_grade(figures),
            "Reason": figures.reason,
            "Image size": f"{figures.size[0]} × {figures.size[1]} px",
            "Lens model": figures.lens_model,
            "Board": figures.board,
            "Views with the board": str(figures.views),
            "Corners": str(figures.corners),
            "Residuals": f"{_format(figures.rms, 3)} px rms",
            "Noise": f"{_format(figures.noise, 3)} px",
            "Coverage": f"{figures.coverage:.0%}",
            "Error, centre": f"{_format(error.centre, 3)} px",
            "Error, covered part": f"{_format(error.covered, 3)} px",
            "Error, edge": f"{_format(error.edge, 3)} px",
            "Error, worst": f"{_format(error.worst, 3)} px",
            "Difference from the median camera": f"{_format(one.difference, 3)} px rms, "
            f"{_format(one.worst, 3)} px at most, robust z {_format(one.z, 1)}",
        }
    facts["Versions"] = ", ".join(f"{name} {text}" for name, text in camera.versions.items())
    return [[escape(name), escape(text)] for name, text in facts.items() if text]


def _name_camera(one: PlacedCamera, links: Mapping[str, str]) -> list[str]:
    """Return the cells of a camera's link, serial number and date."""
    camera = one.camera
    link = f'<a href="{escape(links[camera.id])}">{escape(camera.id)}</a>'
    date = f'<span class="date">{escape(camera.entry.date)}</span>'
    return [link, escape(camera.entry.serial), date]


def _list_figures(one: PlacedCamera) -> list[str]:
    """Return the cells of a camera's figures, under `_FIGURES`."""
    camera, figures, change = one.camera, one.camera.figures, one.camera.change
    verdict = '<span class="good">pass</span>' if camera.passed else '<span class="bad">fail</span>'
    if figures is None:
        return [verdict, "–", *["–"] * (len(_FIGURES) - 2)]
    return [
        verdict,
        _name_grade(figures),
        str(figures.views),
        _format(figures.rms, 3),
        _format(figures.error.edge, 3),
        f"{figures.coverage:.0%}",
        _format(one.difference, 3),
        _format(one.z, 1),
        "" if change is None else _format(change.rms, 3),
    ]


def _list_change(one: PlacedCamera, links: Mapping[str, str]) -> list[str]:
    """Return the cells of a camera's change, under `_CHANGE`."""
    change = one.camera.change
    if change is None:
        return ["–"] * len(_CHANGE)
    against = escape(change.against)
    if address := links.get(change.against):
        against = f'<a href="{escape(address)}">{against}</a>'
    return [
        against,
        _format(change.rms, 3),
        _format(change.worst, 3),
        _format(change.expected, 3),
        f"{change.probability:.2g}",
    ]


def _name_grade(figures: FleetFigures) -> str:
    return str(figures.grade).replace("-", " ")


def _format_estimate(value: Estimate) -> str:
    if value.sigma == 0:
        return f"held at {value.value:.6g}"
    return format_with_sigma(value.value, value.sigma)


def _format(value: float, decimals: int) -> str:
    """Format a number, which may be infinite or unknown."""
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞"
    return f"{round(value, decimals) + 0.0:.{decimals}f}"  # no minus before nothing


def _name_kind(kind: Kind) -> str:
    (width, height), model = kind
    return f"{width} × {height} px, {escape(model)}"


def _count(count: int) -> str:
    return f"{count} camera{'s' * (count != 1)}"


def _make_list(sentences: Iterable[str]) -> str:
    items = "".join(f"<li>{escape(sentence)}</li>" for sentence in sentences if sentence)
    return f"<ul>{items}</ul>" if items else ""


def _make_table(
    head: Sequence[str], rows: Iterable[Sequence[str]], texts: Collection[int] = ()
) -> str:
    """Make a table of cells in HTML; the columns `texts` are aligned on the left."""
    align = [' class="text"' if k in texts else "" for k in range(len(head))]
    top = "".join(f"<th{a}>{escape(cell)}</th>" for a, cell in zip(align, head, strict=True))
    body = "".join(
        f"<tr>{''.join(f'<td{a}>{c}</td>' for a, c in zip(align, row, strict=True))}</tr>\n"
        for row in rows
    )
    above = f"<thead><tr>{top}</tr></thead>" if any(head) else ""
    return f'<div class="scroll"><table>{above}<tbody>\n{body}</tbody></table></div>'


def _make_page(title: str, parts: Iterable[str]) -> str:
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta name="generator" content="{make_mark(FLEET_PAGE)}">'
        '<meta name="viewport" content="width=device-width">'
        f"<title>{escape(title)}</title><style>{_STYLE}</style></head>\n<body>\n"
        + "\n".join(filter(None, parts))
        + "\n</body></html>\n"
    )
