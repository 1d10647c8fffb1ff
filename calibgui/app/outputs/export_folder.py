"""A folder with a result in every format that holds it, and a page that tells them apart."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from calibgui.app.outputs.output_files import check_outputs, make_folder
from calibgui.dataset import Result
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.formats import EXPORTERS, Exporter, ExportReport, export
from calibgui.formats.origin import EXPORT_PAGE, make_mark

PAGE = "README.md"


@dataclass(frozen=True, slots=True)
class ExportOutcome:
    """The outcome of writing a result in one format."""

    exporter: Exporter
    file: str
    """The file's path in the folder."""
    report: ExportReport | None
    """The report of the file; None if it is not written."""
    reason: str = ""
    """Why it is not written."""


def export_all(
    result: Result,
    folder: Path,
    overwrite: bool = False,
    report: Callable[[int, int], object] = lambda *_: None,
) -> list[ExportOutcome]:
    """Write a result in all formats, each as a file of its name, and the page that lists them.

    A format that cannot hold it is listed with the reason. A format whose files have names of their
    own has a folder in the folder.

    Args:
        result: the result.
        folder: where to; it is made if it is not there.
        overwrite: whether files that this program did not write may be replaced.
        report: is told how many of all files are done.

    Raises:
        CalibrationError: if a file cannot be written, or would replace one that must be kept.
    """
    places = {name: folder / _name_file(exporter) for name, exporter in EXPORTERS.items()}
    for place in {folder, *(path.parent for path in places.values())}:
        make_folder(place)
    outputs = [(path, name) for name, path in places.items()]
    check_outputs([*outputs, (folder / PAGE, EXPORT_PAGE)], [], overwrite)
    outcomes = []
    for done, (name, path) in enumerate(places.items()):
        report(done, len(places))
        file = path.relative_to(folder).as_posix()
        try:
            outcomes.append(ExportOutcome(EXPORTERS[name], file, export(result, name, path)))
        except CalibrationError as error:
            reason = error.message.replace(f"{path} is not written: ", "")
            outcomes.append(ExportOutcome(EXPORTERS[name], file, None, reason))
    report(len(places), len(places))
    write_atomically(folder / PAGE, format_page(result, outcomes).encode())
    return outcomes


def _name_file(exporter: Exporter) -> Path:
    """Return the path of a format's file in the folder."""
    if exporter.stem:
        return Path(exporter.name) / exporter.file_name
    return Path(f"{exporter.name}{exporter.suffixes[0]}")


def format_page(result: Result, outcomes: list[ExportOutcome]) -> str:
    """Return the page in Markdown."""
    camera = result.calibration.camera
    width, height = camera.size
    values = ", ".join(
        f"{name} {value:.7g}" for name, value in zip(camera.names, camera.params, strict=True)
    )
    lines = [
        "# One camera in many formats",
        "",
        make_mark(EXPORT_PAGE),
        "",
        f"Images of {width} x {height} px, lens model {camera.model}: {values}.",
        *([f"Lengths hold {result.condition}."] if result.condition else []),
        "",
        "*Error* is the largest distance in px between the camera in the file and the calibrated "
        "one over the whole image: 0 where the format has its lens model, else that of a refit.",
        "",
        "| file | read by | keeps | loses | error |",
        "| --- | --- | --- | --- | --- |",
    ]
    for one in outcomes:
        exporter = one.exporter
        if one.report is not None:
            facts = [exporter.readers, exporter.keeps, exporter.loses]
            lines.append(f"| {' | '.join([one.file, *facts, format_error(one.report)])} |")
    if refused := [one for one in outcomes if one.report is None]:
        lines += ["", "Not written:", "", *(f"- {one.file}: {one.reason}" for one in refused)]
    return "\n".join(lines) + "\n"


def format_error(report: ExportReport) -> str:
    """Format the largest error of a file, px, to two digits; "none" if nothing was refitted."""
    error = report.largest_error_px
    if error is None:
        return "none"
    return "unlimited at the edge" if math.isnan(error) else f"{error:.2g}"
