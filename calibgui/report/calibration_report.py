"""The report on a calibration, and its certificate after ISO/IEC 17025, as a `Document`.

Both have the same tables (``report_tables.py``): in a `Layout` other sections come first.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from enum import StrEnum

from calibgui.dataset import Result, View
from calibgui.dataset.acceptance import list_broken_limits
from calibgui.dataset.details import Details
from calibgui.dataset.fleet import summarise_result
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import Grade
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty import ProjectionUncertainty
from calibgui.report.boards import name_point
from calibgui.report.document import (
    Block,
    Bullets,
    Document,
    Facts,
    Mood,
    Paragraph,
    Photograph,
    Photographs,
    Picture,
    Pictures,
    Section,
    Signatures,
    Table,
)
from calibgui.report.names import make_printable
from calibgui.report.numbers import format_count
from calibgui.report.report_tables import (
    describe_method,
    state_uncertainty,
    tabulate_board,
    tabulate_budget,
    tabulate_correlations,
    tabulate_lengths,
    tabulate_parameters,
    tabulate_poses,
    tabulate_residuals,
)
from calibgui.report.summary import describe_calibration
from calibgui.report.verdict import describe_reason, format_headline

_GRADE_MOODS = {
    Grade.GOOD: Mood.GOOD,
    Grade.USABLE: Mood.CAUTION,
    Grade.CAN_BE_BETTER: Mood.CAUTION,
    Grade.NOT_USABLE: Mood.BAD,
}


class Layout(StrEnum):
    """The purpose of a document."""

    REPORT = "report"
    """All that is known, for those who work with the camera."""
    CERTIFICATE = "certificate"
    """After ISO/IEC 17025:2017, 7.8.2 and 7.8.4, for those who ordered the calibration."""


@dataclass(frozen=True, slots=True)
class PhotographFile:
    """A photograph's file, as far as it is known."""

    digest: str = ""
    """SHA-256; empty if the file is not there."""
    jpeg: str = ""
    """A small picture, as JPEG in base64; empty if there is none."""
    camera: str = ""
    """Make and model by EXIF."""
    lens: str = ""
    setting: str = ""
    date: str = ""
    """Date and time by EXIF."""


@dataclass(frozen=True, slots=True)
class ReportInputs:
    """The facts of a report beside the calibration itself."""

    details: Details
    files: Mapping[str, PhotographFile]
    """By the images' names, as the views have them."""
    digest: str
    """SHA-256 of result.json."""
    issued: str
    """Date of issue, as YYYY-MM-DD."""
    command: str
    """The command that makes the calibration again."""
    uncertainty: ProjectionUncertainty
    figures: Sequence[Picture] = ()
    views_figure: Picture | None = None


def make_report(result: Result, inputs: ReportInputs, layout: Layout = Layout.REPORT) -> Document:
    """Make the report, or the certificate, on a calibration."""
    verdict, details = judge_result(result), inputs.details
    is_certificate = layout is Layout.CERTIFICATE
    camera = details.camera or _find_common(inputs, "camera")
    reasons = () if result.limits is None else list_broken_limits(result, result.limits)
    number = details.id or f"{inputs.issued.replace('-', '')}-{inputs.digest[:8]}"
    sections = _list_certificate_sections if is_certificate else _list_report_sections
    return Document(
        title="Calibration certificate" if is_certificate else "Camera calibration",
        subtitle=", ".join(filter(None, [camera, details.camera_serial, details.lens])),
        id=number,
        issued=inputs.issued,
        mood=_GRADE_MOODS[verdict.grade],
        headline="" if is_certificate else format_headline(verdict),
        reason="" if is_certificate else describe_reason(verdict, result),
        stamp=""
        if is_certificate or result.limits is None
        else f"{'FAIL' if reasons else 'PASS'}: {result.limits.name}",
        stamp_mood=Mood.BAD if reasons else Mood.GOOD,
        tiles=() if is_certificate else tuple(_list_tiles(result)),
        sections=tuple(sections(result, inputs, camera, reasons)),
        footer="The results relate only to the item calibrated. This certificate shall not be "
        "reproduced except in full without approval of the laboratory."
        if is_certificate
        else f"SHA-256 of result.json: {inputs.digest}",
    )


def _list_report_sections(
    result: Result, inputs: ReportInputs, camera: str, reasons: Sequence[str]
) -> Iterator[Section]:
    """Yield the sections of the report."""
    _, *sentences = describe_calibration(result)
    yield Section(
        "What was found",
        [*_judge_limits(result, reasons), Bullets([sentence.text for sentence in sentences])],
    )
    yield Section("Camera and conditions", [_tabulate_conditions(inputs, camera)])
    yield Section("Parameters", tabulate_parameters(result))
    yield Section("Figures", [Pictures(inputs.figures)])
    yield Section("Uncertainty", [*tabulate_budget(result), *tabulate_lengths(result)])
    yield Section("Board", [tabulate_board(result, inputs.details)])
    yield Section("Method", describe_method(result))
    yield Section("Residuals", tabulate_residuals(result, inputs.views_figure))
    yield Section("Correlations", tabulate_correlations(result))
    yield Section("Poses of the board", [tabulate_poses(result)])
    yield Section("Photographs", _show_photographs(result, inputs))
    yield Section("How to repeat it", _list_origins(result, inputs))


def _list_certificate_sections(
    result: Result, inputs: ReportInputs, camera: str, reasons: Sequence[str]
) -> Iterator[Section]:
    """Yield the sections of the certificate, in the order of ISO/IEC 17025:2017, 7.8.2 and 7.8.4.

    An interval of recalibration and a mark of accreditation are not for a program to give.
    """
    details = inputs.details
    stated = [
        ("Laboratory", details.laboratory),
        ("Place of calibration", details.place),
        ("Customer", details.customer),
        ("Date of receipt", details.received),
        ("Date of calibration", details.calibrated or _find_dates(inputs)),
        ("Date of issue", inputs.issued),
    ]
    yield Section("Identification", [Facts([(a, b or "not stated") for a, b in stated])])
    width, height = result.calibration.camera.size
    item = [
        ("Camera", camera),
        ("Serial number", details.camera_serial),
        ("Lens", details.lens or _find_common(inputs, "lens")),
        ("Serial number of the lens", details.lens_serial),
        ("Aperture, focus, zoom", details.setting or _find_common(inputs, "setting")),
        ("Images", f"{width} × {height} px"),
        ("Condition", details.condition),
    ]
    yield Section("Item", [Facts([(a, b or "not stated") for a, b in item])])
    yield Section("Method", describe_method(result))
    yield Section(
        "Conditions",
        [
            Facts(
                [
                    ("Temperature", details.temperature or "not stated"),
                    ("Operator", details.operator or "not stated"),
                ]
            )
        ],
    )
    yield Section("Traceability", [tabulate_board(result, details)])
    yield Section("Results", [*tabulate_parameters(result), *tabulate_lengths(result)])
    yield Section(
        "Statement of uncertainty",
        [Paragraph(state_uncertainty(result)), *tabulate_budget(result)],
    )
    if result.limits is not None:
        yield Section("Statement of conformity", _judge_limits(result, reasons))
    yield Section("Maps", [Pictures(inputs.figures)])
    if remarks := [details.remarks] if details.remarks else []:
        yield Section("Remarks", [Bullets(remarks)])
    yield Section(
        "Authorisation",
        [
            Paragraph(
                "Nothing was adjusted: the results are those of the item as received. No interval "
                "of recalibration is recommended."
            ),
            Signatures([("Calibrated by", details.operator), ("Authorised by", details.signatory)]),
        ],
    )
    yield Section("Data", _list_origins(result, inputs))


def _list_tiles(result: Result) -> Iterator[tuple[str, str]]:
    """Yield the numbers that matter most, each with what it is."""
    error, figures = judge_result(result).error, summarise_result(result)
    if math.isfinite(error.edge):
        yield f"{format_two_digits(error.centre)} px", "error at the centre"
        yield f"{format_two_digits(error.edge)} px", "error at the edge"
    yield (
        f"{figures.rms:.3f} px",
        f"RMS of {format_count(figures.corners, name_point(result.board))}",
    )
    yield f"{figures.views} of {len(result.views)}", "photographs used"
    yield f"{100 * figures.coverage:.0f} %", "of the sensor with corners"


def _judge_limits(result: Result, reasons: Sequence[str]) -> list[Block]:
    """State whether the limits are kept."""
    if result.limits is None:
        return []
    mood, word = (Mood.BAD, "FAIL") if reasons else (Mood.GOOD, "PASS")
    blocks: list[Block] = [Paragraph(f"{word} by the limits {result.limits.name}.", mood)]
    return [*blocks, Bullets(reasons)] if reasons else blocks


def _tabulate_conditions(inputs: ReportInputs, camera: str) -> Facts:
    """List what is known of the camera and of what surrounded it."""
    details = inputs.details
    known = {
        "camera": camera,
        "lens": details.lens or _find_common(inputs, "lens"),
        "setting": details.setting or _find_common(inputs, "setting"),
        "calibrated": details.calibrated or _find_dates(inputs),
    }
    rows = [
        (field.metadata["label"], known.get(field.name) or getattr(details, field.name))
        for field in fields(Details)
        if field.name not in ("id", "board", "board_certificate")
    ]
    return Facts([row for row in rows if row[1]] or [("Camera", "not stated")])


def _find_common(inputs: ReportInputs, name: str) -> str:
    """Return what the files of all photographs say alike; empty if they differ or say nothing."""
    said = {getattr(file, name) for file in inputs.files.values()} - {""}
    return said.pop() if len(said) == 1 else ""


def _find_dates(inputs: ReportInputs) -> str:
    """Return the day on which the photographs were taken, or the first and the last of them."""
    days = sorted({file.date[:10] for file in inputs.files.values() if file.date})
    return " to ".join(dict.fromkeys([days[0], days[-1]])) if days else ""


def _show_photographs(result: Result, inputs: ReportInputs) -> list[Block]:
    """Show every photograph, with what was found in it or why it was left out."""
    rms = dict(zip(result.places, result.calibration.residuals, strict=True))
    items = []
    for k, view in enumerate(result.views):
        file = inputs.files.get(view.image, PhotographFile())
        name = make_printable(view.name)
        if k in rms:
            caption = f"{len(rms[k].image)} corners, {rms[k].rms:.3f} px"
            items.append(Photograph(f"{k + 1}. {name}", file.jpeg, caption))
        else:
            items.append(Photograph(f"{k + 1}. {name}", file.jpeg, "left out", Mood.CAUTION))
    blocks: list[Block] = [Photographs(items)]
    left_out = [view for k, view in enumerate(result.views) if k not in rms]
    if left_out:
        rows = [[make_printable(view.name), _explain(view)] for view in left_out]
        blocks.append(Table(["Left out", "Why"], rows, (0, 1)))
    return blocks


def _explain(view: View) -> str:
    return make_printable(view.why_unused) or "Not wanted by the user."


def _list_origins(result: Result, inputs: ReportInputs) -> list[Block]:
    """List what the calibration was made from, and how it is made again."""
    blocks: list[Block] = [
        Facts(
            [
                ("Command", inputs.command),
                ("Digest of the corners", result.calibration.digest),
                ("Digest of result.json", inputs.digest),
            ]
        )
    ]
    rows = [
        [make_printable(view.name), file.digest]
        for view in result.views
        if (file := inputs.files.get(view.image)) is not None and file.digest
    ]
    if rows:
        blocks.append(Table(["Photograph", "SHA-256"], rows, (0, 1), is_fine=True))
    return blocks
