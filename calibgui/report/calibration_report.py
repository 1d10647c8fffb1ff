"""The report on a calibration, and its certificate after ISO/IEC 17025, as a `Document`.

Both have the same numbers, each written once: in a `Layout` other sections come first. A value has
its standard uncertainty u and the expanded one U = k u with k = 2, which covers some 95 %.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from enum import StrEnum

import numpy as np

from calibgui.dataset import Result, View
from calibgui.dataset.acceptance import list_broken_limits, measure_length
from calibgui.dataset.details import Details
from calibgui.dataset.fleet import summarise_result
from calibgui.dataset.judging import judge_result
from calibgui.dataset.limits import LengthLimit, Limits
from calibgui.engine.assessment import Grade, summarise_residuals
from calibgui.engine.camera import PINHOLE
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty import ProjectionUncertainty
from calibgui.report.boards import describe_board, name_point
from calibgui.report.coverage import measure_attitudes
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
from calibgui.report.lens_models import get_lens_title
from calibgui.report.names import make_printable
from calibgui.report.numbers import format_count, format_with_sigma
from calibgui.report.summary import describe_calibration
from calibgui.report.verdict import describe_reason, format_headline

COVERAGE_FACTOR = 2.0
"""k of the expanded uncertainty: some 95 % of errors lie within."""
_MAX_CORRELATED = 14
"""Number of parameters up to which their correlations are a table on one page."""
_GRADE_MOODS = {
    Grade.GOOD: Mood.GOOD,
    Grade.USABLE: Mood.CAUTION,
    Grade.CAN_BE_BETTER: Mood.CAUTION,
    Grade.NOT_USABLE: Mood.BAD,
}


class Layout(StrEnum):
    """What a document is for."""

    REPORT = "report"
    """All that is known, for those who work with the camera."""
    CERTIFICATE = "certificate"
    """After ISO/IEC 17025:2017, 7.8.2 and 7.8.4, for those who ordered the calibration."""


@dataclass(frozen=True, slots=True)
class PhotographFile:
    """What is known of the file of a photograph."""

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
    """What a report says beside the calibration itself."""

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
    yield Section("Parameters", _tabulate_parameters(result))
    yield Section("Figures", [Pictures(inputs.figures)])
    yield Section("Uncertainty", [*_tabulate_budget(result), *_tabulate_lengths(result)])
    yield Section("Board", [_tabulate_board(result, inputs.details)])
    yield Section("Method", _describe_method(result))
    yield Section("Residuals", _tabulate_residuals(result, inputs))
    yield Section("Correlations", _tabulate_correlations(result))
    yield Section("Poses of the board", [_tabulate_poses(result)])
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
    yield Section("Method", _describe_method(result))
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
    yield Section("Traceability", [_tabulate_board(result, details)])
    yield Section("Results", [*_tabulate_parameters(result), *_tabulate_lengths(result)])
    yield Section(
        "Statement of uncertainty",
        [Paragraph(_state_uncertainty(result)), *_tabulate_budget(result)],
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
    yield f"{100 * figures.coverage:.0f} %", "of the sensor covered"


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


def _tabulate_parameters(result: Result) -> list[Block]:
    """Tabulate the camera's parameters with u and U."""
    calibration = result.calibration
    camera = calibration.camera
    open_names = {each.name for each in calibration.undetermined}
    rows = []
    for name, value, sigma in zip(
        camera.names, camera.params.tolist(), calibration.sigma.tolist(), strict=True
    ):
        unit = "px" if name in PINHOLE else ""
        if name in open_names or not sigma > 0:
            told = "undetermined" if name in open_names else "held"
            rows.append([name, f"{value:z.6g}", told, "", unit])
            continue
        number, u = _split(format_with_sigma(value, sigma))
        rows.append([name, number, u, _scale_text(u, COVERAGE_FACTOR), unit])
    freedom = _count_freedom(result)
    note = (
        f"u is one standard deviation and U = k u with k = {COVERAGE_FACTOR:g}, which covers some "
        f"95 %, at {freedom:,} degrees of freedom. Pixels are counted from 0 at the centre of the "
        "upper left one, u to the right and v down."
    )
    title = f"{get_lens_title(camera.model)} ({camera.model})"
    return [
        Paragraph(f"Lens model: {title}."),
        Table(
            ["Parameter", "Value", "u", f"U (k = {COVERAGE_FACTOR:g})", "Unit"], rows, (0, 4), note
        ),
    ]


def _split(text: str) -> tuple[str, str]:
    """Return a value and its standard deviation as texts, each with the power of ten if any."""
    value, sigma = text.removeprefix("(").split(" ± ")
    if ")" not in sigma:
        return value, sigma
    sigma, power = sigma.split(")")
    return value + power, sigma + power


def _scale_text(text: str, factor: float) -> str:
    """Return a number that is `factor` times as large, with the same decimals."""
    digits, _, power = text.partition("e")
    decimals = len(digits.partition(".")[2])
    return f"{factor * float(digits):.{decimals}f}{'e' + power if power else ''}"


def _count_freedom(result: Result) -> int:
    """Count the degrees of freedom: coordinates of corners less the parameters and the poses."""
    calibration = result.calibration
    coordinates = 2 * sum(len(view.image) for view in calibration.residuals)
    free = len(calibration.camera.params) - len(calibration.fixed)
    return coordinates - free - 6 * len(calibration.poses)


def _state_uncertainty(result: Result) -> str:
    """State what U is, as a certificate has to."""
    return (
        "The reported expanded uncertainty U is the standard uncertainty u multiplied by the "
        f"coverage factor k = {COVERAGE_FACTOR:g}, which for a normal distribution corresponds to "
        "a coverage probability of approximately 95 %. The standard uncertainty was evaluated by "
        "statistical analysis (type A) of the corners' scatter and of the views' disagreement, "
        f"with {_count_freedom(result):,} degrees of freedom, and by other means (type B) for the "
        "board's shape and scale."
    )


def _tabulate_budget(result: Result) -> list[Block]:
    """Tabulate what the standard uncertainty of each parameter consists of."""
    calibration = result.calibration
    rows = []
    for name, sigma, noise in zip(
        calibration.camera.names,
        calibration.sigma.tolist(),
        calibration.sigma_by_noise.tolist(),
        strict=True,
    ):
        if sigma > 0:
            others = math.sqrt(max(sigma**2 - noise**2, 0.0))
            share = min(noise**2 / sigma**2, 1.0)
            parts = [f"{part:.2g}".replace("e-0", "e-") for part in (noise, others, sigma)]
            rows.append([name, *parts, f"{share:.0%}"])
    scale = result.scale_sigma
    board = result.board
    note = (
        "Board, lens and views: the board's shape as far as it is not known, the lens model's "
        "error, and what views disagree by beyond noise. "
    ) + (
        "The board's scale enters no parameter here, and every length: "
        + (
            f"{board.square:g} mm with u = {board.square_sigma:.2g} mm, {100 * scale:.2g} %."
            if board is not None and scale
            else "it counts as exact."
        )
    )
    head = ["Parameter", "Corners' noise", "Board, lens and views", "u", "Share of noise in u²"]
    return [Table(head, rows, (0,), note)] if rows else []


def _tabulate_lengths(result: Result) -> list[Block]:
    """Tabulate how certain a length is: that of the limits, or 100 mm at the boards' distance."""
    limits = result.limits
    if limits is None or limits.length is None:
        distance = float(
            np.median(measure_attitudes(result.calibration, result.observations()).distance)
        )
        limits = Limits(length=LengthLimit(math.inf, 100.0, float(f"{distance:.2g}")))
    found = measure_length(result, limits)
    if found is None:
        return []
    k = found.worst
    parts = [found.by_calibration[k], found.by_noise[k], found.by_scale, found.sigma[k]]
    condition = f", {result.condition}" if result.condition else ""
    note = (
        f"A length of {found.length:g} mm, measured by its two ends {found.depth:g} mm away in a "
        f"plane across the axis, where it is known worst{condition}. The distance counts as known."
    )
    head = ["Length", "Calibration", "Two corners", "Board's scale", "u", "U (k = 2)"]
    cells = [f"{part:.2g} mm" for part in parts]
    cells.append(f"{COVERAGE_FACTOR * parts[-1]:.2g} mm")
    return [Table(head, [[f"{found.length:g} mm at {found.depth:g} mm", *cells]], (0,), note)]


def _tabulate_board(result: Result, details: Details) -> Facts:
    """List what is known of the board, with its own certificate."""
    board = result.board
    rows = []
    if board is not None:
        scale = f"{board.square:g} mm"
        if board.square_sigma:
            scale = f"{format_with_sigma(board.square, board.square_sigma)} mm (one sigma)"
        else:
            scale += ", counted as exact"
        if not result.lengths_confirmed:
            scale += ", not confirmed"
        rows = [("Board", describe_board(board)), ("Square or distance", scale)]
    shape = result.calibration.board_shape
    if shape is None:
        error = result.calibration.board_shape_error
        rows.append(
            ("Shape", f"as drawn{f', to {error:.2g} mm rms by the residuals' if error else ''}")
        )
    else:
        rows.append(("Shape", f"{shape.model}, deviates by {shape.rms:.2g} mm rms"))
    rows.append(("Identification", details.board or "not stated"))
    rows.append(("Its own certificate", details.board_certificate or "not stated"))
    return Facts(rows)


def _describe_method(result: Result) -> list[Block]:
    """Say how the calibration was made."""
    calibration = result.calibration
    settings = calibration.settings
    facts = [
        (
            "Procedure",
            "Photographs of a flat board in several attitudes; all corners adjusted "
            "together (bundle adjustment) after Lucchese 2005",
        ),
        ("Method", str(settings.method)),
        ("Cost", str(calibration.cost)),
        ("Lens model", get_lens_title(calibration.camera.model)),
        ("Why this lens model", settings.model_reason or ""),
        ("Held", ", ".join(calibration.fixed) or "nothing"),
        ("End of the adjustment", f"{calibration.status}, {len(calibration.history)} iterations"),
        ("Program", ", ".join(f"{name} {text}" for name, text in result.versions.items())),
    ]
    return [Facts([fact for fact in facts if fact[1]])]


def _tabulate_residuals(result: Result, inputs: ReportInputs) -> list[Block]:
    """Tabulate what is left between corners and their predictions."""
    fit = summarise_residuals(result.calibration.residuals)
    facts = Facts(
        [
            ("RMS", f"{fit.rms:.4f} px"),
            ("σ along u, along v", f"{fit.sigma_x:.4f}, {fit.sigma_y:.4f} px"),
            (
                "σ of the median view",
                f"{fit.median_sigma_x:.4f}, {fit.median_sigma_y:.4f} px",
            ),
            ("Number of corners", f"{fit.count:,}"),
        ]
    )
    figure = inputs.views_figure
    return [facts] if figure is None else [facts, Pictures([figure], columns=1)]


def _tabulate_correlations(result: Result) -> list[Block]:
    """Tabulate the correlations of the parameters that were estimated."""
    calibration = result.calibration
    free = [k for k, sigma in enumerate(calibration.sigma.tolist()) if sigma > 0]
    names = [calibration.camera.names[k] for k in free]
    if not free or len(free) > _MAX_CORRELATED:
        return [Paragraph("There are too many parameters for a table: they are in result.json.")]
    covariance = calibration.covariance[np.ix_(free, free)]
    sigma = np.sqrt(np.diag(covariance))
    values = covariance / np.outer(sigma, sigma)
    rows = [
        [name, *(f"{value:z.2f}" for value in row[: k + 1]), *[""] * (len(free) - k - 1)]
        for k, (name, row) in enumerate(zip(names, values.tolist(), strict=True))
    ]
    return [Table(["", *names], rows, is_fine=True)]


def _tabulate_poses(result: Result) -> Table:
    """Tabulate where the board was, with one standard deviation."""
    rows = []
    numbers = [k + 1 for k in result.places]
    for number, pose, covariance in zip(
        numbers, result.calibration.poses, result.pose_covariances, strict=True
    ):
        sigma = np.sqrt(np.diag(covariance))
        place = map(format_with_sigma, pose.tvec.tolist(), sigma[3:].tolist())
        turn = map(
            format_with_sigma, np.degrees(pose.rvec).tolist(), np.degrees(sigma[:3]).tolist()
        )
        rows.append([str(number), *place, *turn])
    head = ["No.", "X, mm", "Y, mm", "Z, mm", "ωX, °", "ωY, °", "ωZ, °"]
    condition = f" Lengths hold {result.condition}." if result.condition else ""
    note = (
        "The board's first corner in the camera's frame (X right, Y down, Z ahead) and the "
        f"rotation vector, ± one standard deviation.{condition}"
    )
    return Table(head, rows, (), note, is_fine=True)


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
