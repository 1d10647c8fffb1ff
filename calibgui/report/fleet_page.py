"""A fleet in HTML: one page of all cameras, and a page for each of them in a folder beside it.

The pages need no script, no network and no other file than each other. Figures are the ledger's;
what is compared here (`fleet_overview.py`) is said to be.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple
from urllib.parse import quote

from calibgui.dataset.fleet import Estimate, FleetFigures
from calibgui.engine.assessment import MIN_FLEET, OUTLIER_Z
from calibgui.engine.camera import PINHOLE
from calibgui.formats.origin import FLEET_PAGE, make_mark
from calibgui.report.fleet_figures import Histogram, Measured, draw_history, make_histogram
from calibgui.report.fleet_overview import FleetOverview, Kind, PlacedCamera
from calibgui.report.numbers import format_with_sigma
from calibgui.report.rendering import render_page
from calibgui.report.verdict import join_names

_MAX_HISTORIES = 12
"""Largest number of serial numbers whose drift is drawn on the first page: those that changed most.
The others are drawn on the pages of their cameras."""


class Cell(NamedTuple):
    """A cell of a table that is more than its text."""

    text: str
    address: str = ""
    """Where it leads."""
    look: str = ""
    """Class of the page's style."""


Row = list["str | Cell"]


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
        serials = dict.fromkeys(one.camera.entry.serial for one in overview.changed)
        drawn = [serial for serial in serials if serial in overview.histories][:_MAX_HISTORIES]
        return render_page(
            "fleet.html",
            make_mark(FLEET_PAGE),
            name=self._name,
            counts=_count_cameras(overview),
            outlier_z=f"{OUTLIER_Z:g}",
            min_fleet=MIN_FLEET,
            undetermined=join_names([one.camera.id for one in overview.undetermined]),
            outliers=[
                [
                    *_name_camera(one, links),
                    _format(one.difference, 3),
                    _format(one.worst, 3),
                    _format(one.z, 1),
                ]
                for one in overview.outliers
            ],
            failed=[
                [*_name_camera(one, links), " ".join(one.camera.failures)]
                for one in overview.failed
            ],
            histories=len(overview.histories),
            changed=[
                [*_name_camera(one, links), *_list_change(one, links)] for one in overview.changed
            ],
            drift={serial: _draw_histories(overview.histories[serial]) for serial in drawn},
            kinds={
                f"{_name_kind(kind)}: {_count(len(overview.kinds[kind]))}": [
                    one.draw() for one in histograms.values()
                ]
                for kind, histograms in self._histograms.items()
            },
            cameras=[[*_name_camera(one, links), *_list_figures(one)] for one in overview.placed],
            names=_NAMES,
            figures_head=_FIGURES,
            change_head=_CHANGE,
        )

    def make_cameras(self) -> Iterator[tuple[str, str]]:
        """Yield the name and the content of each camera's page."""
        for one in self._overview.placed:
            yield self._pages[one.camera.id], self._make_camera(one)

    def _make_camera(self, one: PlacedCamera) -> str:
        """Make the page of one camera, in HTML."""
        camera, figures = one.camera, one.camera.figures
        histograms: Mapping[str, Histogram] = {}
        if figures is not None:
            kind = (figures.size, figures.lens_model)
            histograms = self._histograms.get(kind) or {}
        values = _measure(one) if histograms else {}
        history = self._overview.histories.get(camera.entry.serial) or ()
        links = self._pages
        return render_page(
            "fleet_camera.html",
            make_mark(FLEET_PAGE),
            id=camera.id,
            name=self._name,
            first=f"../{quote(self._first)}",
            passed=camera.passed,
            sentences=[text for text in [*camera.failures, camera.remedy] if text],
            facts=_list_facts(one),
            result=self._results.get(camera.id),
            parameters=[
                [name, _format_estimate(value), unit]
                for name, value, unit in (() if figures is None else _list_parameters(figures))
            ],
            kind=_count(len(self._overview.kinds[kind])) if histograms else "",
            drawn=[histogram.draw(values[name]) for name, histogram in histograms.items()],
            serial=camera.entry.serial,
            drift=_draw_histories(history),
            history=[[*_name_camera(past, links), *_list_change(past, links)] for past in history],
            names=_NAMES,
            change_head=_CHANGE,
        )


_NAMES = ("Camera", "Serial number", "Date")
_FIGURES = (
    "Verdict",
    "Grade",
    "Views",
    "RMS [px]",
    "Error, edge [px]",
    "Coverage",
    "From the median camera [px rms]",
    "Standard deviations from the fleet",
    "Changed by [px rms]",
)
_CHANGE = ("Against", "Changed by [px rms]", "Largest [px]", "Explained [px rms]", "Probability")


def _count_cameras(overview: FleetOverview) -> dict[str, int]:
    """Count the cameras by what became of them."""
    refused = sum(one.camera.figures is None for one in overview.placed)
    return {
        "cameras": len(overview.placed),
        "pass": len(overview.placed) - len(overview.failed),
        "fail": len(overview.failed),
        "of these without a calibration": refused,
        "unlike the others": len(overview.outliers),
        "have changed": len(overview.changed),
    }


def _draw_histories(history: Sequence[PlacedCamera]) -> list[str]:
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
    return plots


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
            "Error, among corners": f"{_format(error.covered, 3)} px",
            "Error, edge": f"{_format(error.edge, 3)} px",
            "Error, worst": f"{_format(error.worst, 3)} px",
            "Difference from the median camera": f"{_format(one.difference, 3)} px rms, "
            f"{_format(one.worst, 3)} px at most, "
            f"{_format(one.z, 1)} standard deviations of the fleet",
        }
    facts["Versions"] = ", ".join(f"{name} {text}" for name, text in camera.versions.items())
    return [[name, text] for name, text in facts.items() if text]


def _name_camera(one: PlacedCamera, links: Mapping[str, str]) -> Row:
    """Return the cells of a camera's link, serial number and date."""
    camera = one.camera
    link = Cell(camera.id, links[camera.id])
    return [link, camera.entry.serial, Cell(camera.entry.date, look="date")]


def _list_figures(one: PlacedCamera) -> Row:
    """Return the cells of a camera's figures, under `_FIGURES`."""
    camera, figures, change = one.camera, one.camera.figures, one.camera.change
    verdict = Cell("pass", look="good") if camera.passed else Cell("fail", look="bad")
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


def _list_change(one: PlacedCamera, links: Mapping[str, str]) -> Row:
    """Return the cells of a camera's change, under `_CHANGE`."""
    change = one.camera.change
    if change is None:
        return ["–"] * len(_CHANGE)
    address = links.get(change.against)
    return [
        Cell(change.against, address) if address else change.against,
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
    return f"{width} × {height} px, {model}"


def _count(count: int) -> str:
    return f"{count} camera{'s' * (count != 1)}"
