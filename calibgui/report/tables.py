"""Text tables about a calibration that fit a terminal of 80 columns.

Every table names its units and counts views from 1, as the images are listed. The paper's
quantities are in its frame: origin at the centre of the pixel array, y up.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest

import numpy as np

from calibgui.dataset import Result, View, ViewStatus
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import Cause, Finding, Verdict, summarise_residuals
from calibgui.engine.boards import Board, Symmetry
from calibgui.engine.calibration import Calibration, Cost, make_paper_table
from calibgui.engine.camera import Lucchese, find_model
from calibgui.engine.geometry import PAPER_NAMES
from calibgui.report.boards import name_point
from calibgui.report.coverage import measure_attitudes
from calibgui.report.names import make_printable, shorten_name
from calibgui.report.numbers import format_count, format_with_sigma
from calibgui.report.summary import (
    Tone,
    describe_calibration,
    describe_outliers,
    describe_unequal_pixels,
    is_board_shape_held,
)
from calibgui.report.verdict import (
    describe_acceptance,
    describe_error,
    describe_error_in_scene,
    describe_fit,
    describe_options,
    describe_reason,
    format_headline,
    format_times,
)

WIDTH_CHARACTERS = 80
"""Number of characters in a line."""

_UNITS = {"fx": "px", "fy": "px", "cx": "px", "cy": "px"}
_PAPER_UNITS = ("px", "px", "px^-2", "px^-4", "px^-6", "px^-1", "px^-1", "px^-2", "px", "px")
_URGENT = (Tone.CAUTION, Tone.ADVICE)
"""Purposes of the sentences that are said before the camera."""
_MAX_COEFFICIENTS = 14
"""Number of parameters of a lens model up to which they stand beside the focal lengths."""
_MAX_NAMES = 6
"""Number of images that are named, of those that are left out for the same reason."""
_MIN_TOLD_GAIN = 1.1
"""Ratio of errors from which it is said by how much an action makes the camera better."""
_USUAL = "--model lucchese"
"""The options of the lens model that is taken where nothing demands another."""
_MAX_LINES = 20
"""Number of lines of a short report, to which the command line adds the files that it wrote."""
_COSTS = {
    Cost.IMAGE: "reprojection error in the image",
    Cost.REFERENCE: "registration error on the reference plane",
    Cost.PAPER: "registration error of eq. 41 to the letter",
}


def format_report(result: Result, *, verbose: bool = False) -> str:
    """Format the verdict, what is wrong, the camera and its RMS; all that is known if `verbose`."""
    _, *sentences = describe_calibration(result)
    verdict = judge_result(result)
    named = {finding.cause for finding in verdict.findings}
    urgent = [s for s in sentences if s.tone in _URGENT and s.cause not in named]
    remarks = [format_bullet(s.text) for s in urgent]
    if not verbose:
        return _format_briefly(result, verdict, remarks)
    notes = [
        *(s.text for s in sentences if s not in urgent),
        *describe_symmetry(result.used),
        *(f"{view.name}: {view.note}" for view in result.used if view.note),
    ]
    return _join_sections(
        "\n".join([*_format_verdict(result, verdict), *remarks]),
        list_unused_views(result.views),
        tabulate_intrinsics(result.calibration),
        describe_residuals(result),
        "\n".join(map(format_bullet, notes)),
        tabulate_views(result),
        tabulate_stage_one(result),
    )


def _format_briefly(result: Result, verdict: Verdict, remarks: Sequence[str]) -> str:
    """Format the verdict, the camera and its RMS, with as many remarks as leave it short.

    What made the camera better is never left out, nor is a remark on the camera's pixels, which
    stands below the camera.
    """
    improved = [format_bullet(text) for text in result.improvements]
    unequal = describe_unequal_pixels(result.calibration, verdict.findings)
    camera = [tabulate_camera(result.calibration), *([format_bullet(unequal)] if unequal else [])]
    remarks = [remark for remark in remarks if remark not in camera]
    for count in range(len(remarks), -1, -1):
        text = _join_sections(
            "\n".join([*_format_verdict(result, verdict), *improved, *remarks[:count]]),
            list_unused_views(result.views),
            "\n".join(camera),
            fill_lines(describe_rms(result), "", "  "),
        )
        if text.count("\n") < _MAX_LINES:
            break
    return text


def _join_sections(*sections: str) -> str:
    """Join the sections that are not empty, a blank line between two."""
    return "\n\n".join(filter(None, sections))


def _format_verdict(result: Result, verdict: Verdict) -> Iterator[str]:
    """Format the headline, the error of a pixel, and a few lines for each finding."""
    headline = format_headline(verdict)
    # The first finding says the reason itself.
    yield (
        f"{headline}."
        if verdict.findings
        else fill_lines(f"{headline}. {describe_reason(verdict, result)}", "", "  ")
    )
    in_scene = describe_error_in_scene(verdict, result.condition)
    yield fill_lines("; ".join(filter(None, [describe_error(verdict), in_scene])) + ".", "", "  ")
    if result.limits is not None:
        yield fill_lines(describe_acceptance(result, result.limits), "", "  ")
    for finding in verdict.findings:
        yield format_bullet(f"{finding.message} {finding.evidence}")
        advice = _describe_advice(finding, result) + _describe_gain(finding)
        yield fill_lines(advice[:1].upper() + advice[1:], "  > ", "    ")


def _describe_advice(finding: Finding, result: Result) -> str:
    """Describe what to do about a finding: the options to add, or else its remedy."""
    options = describe_options(finding.action, result) if finding.action is not None else ""
    if options and finding.cause is Cause.MIXED_VIEWS:  # those left out have a camera, too
        return f"{finding.remedy} Or {options}"
    return options or finding.remedy


def _describe_gain(finding: Finding) -> str:
    """Describe in brackets by how much an action makes the camera better."""
    times = finding.times_better
    return f" ({format_times(times)} times better)" if times > _MIN_TOLD_GAIN else ""


def summarise_in_a_line(result: Result) -> str:
    """Summarise the calibration in a line: the verdict, the error of a pixel, and its remedy."""
    verdict = judge_result(result)
    words = [
        f"{format_headline(verdict)}. {describe_reason(verdict, result)}",
        f"{describe_error(verdict)}; {describe_fit(result)}, {_count_used(result)}.",
    ]
    if result.limits is not None:
        words.append(describe_acceptance(result, result.limits))
    if verdict.findings:
        words.append(f"Do: {_describe_advice(verdict.findings[0], result).removesuffix('.')}.")
    return " ".join(words)


def tabulate_stage_one(result: Result) -> str:
    """Tabulate Stage I (table 1): every view by itself, in the paper's frame and units."""
    rows = [
        [
            str(number),
            _format_decimals(row.xp, 4),
            _format_decimals(row.yp, 4),
            _format_decimals(row.k1 * 1e7, 4),
            _format_decimals(row.aspect, 4),
            _format_decimals(row.fx, 2),
            _format_decimals(row.fy, 2),
            str(row.iterations),
            _format_decimals(row.rms, 4),
        ]
        for number, row in zip(
            _list_view_numbers(result), result.calibration.stage_one, strict=True
        )
    ]
    table = np.array([[row.xp, row.yp, row.k1 * 1e7] for row in result.calibration.stage_one])
    rows.append(["mean", *(_format_decimals(mean, 4) for mean in table.mean(axis=0)), *[""] * 5])
    head = ["view", "xp", "yp", "k1 x 1e7", "fy/fx", "fx", "fy", "steps", "rms e'"]
    units = ["", "px", "px", "px^-2", "", "px", "px", "", "ref px"]
    return "Stage I, each view by itself (paper's Table 1; - : not determined)\n" + align_columns(
        [head, units, *rows]
    )


def tabulate_views(result: Result) -> str:
    """Tabulate the used views: corners, residual, distance and tilt."""
    calibration = result.calibration
    attitude = measure_attitudes(calibration, result.observations())
    rows = [
        [
            str(number),
            shorten_name(view.image),
            str(len(fit.image)),
            f"{fit.rms:.3f}",
            f"{distance:.0f}",
            f"{math.degrees(tilt):.1f}",
        ]
        for number, view, fit, distance, tilt in zip(
            _list_view_numbers(result),
            result.used,
            calibration.residuals,
            attitude.distance,
            attitude.tilt,
            strict=True,
        )
    ]
    head = ["view", "image", f"{name_point(result.board)}s", "rms", "distance", "tilt"]
    units = ["", "", "", "px", "mm", "deg"]
    condition = f", distances {result.condition}" if result.condition else ""
    return f"Views{condition}\n" + align_columns([head, units, *rows], left=(1,))


def list_unused_views(all_views: Iterable[View]) -> str:
    """List the images that were left out by the reason; empty if there are none."""
    names: dict[str, list[str]] = {}
    for view in all_views:
        if not view.usable:
            reason = (view.why_unused or "By choice.").removeprefix("Left out: ")
            # Reading errors name the file already.
            named = reason.startswith(view.image)
            names.setdefault(reason, []).extend([] if named else [view.name])
    lines = [
        fill_lines(_join_names(images) + make_printable(reason), "  ", "    ")
        for reason, images in names.items()
    ]
    return "\n".join(["Left out", *lines]) if lines else ""


def _join_names(names: Sequence[str]) -> str:
    """Join the names of images that have something in common, before what that is."""
    if not names:
        return ""
    more = [f"and {len(names) - _MAX_NAMES} more"] if len(names) > _MAX_NAMES else []
    return f"{', '.join([*map(make_printable, names[:_MAX_NAMES]), *more])}: "


def tabulate_camera(calibration: Calibration) -> str:
    """Tabulate the camera in the array frame, in few lines."""
    camera = calibration.camera
    rows = [
        [name, _format_parameter(calibration, name, value, sigma), _UNITS.get(name, "")]
        for name, value, sigma in zip(camera.names, camera.params, calibration.sigma, strict=True)
    ]
    lens = rows[4:]
    if len(lens) > _MAX_COEFFICIENTS:
        lens = [["", f"and {len(lens)} parameters of the lens model {camera.model}", ""]]
    columns = zip_longest(rows[:4], lens, fillvalue=["", "", ""])
    chosen = calibration.settings.model_reason
    options = _format_model_options(calibration)
    return "\n".join(
        [
            _make_camera_title(calibration),
            align_columns([[*a, " ", *b] for a, b in columns], left=range(7)),
            *(
                [format_bullet(f"{chosen} That is {options}.")]
                if chosen and options != _USUAL
                else []
            ),
        ]
    )


def _format_model_options(calibration: Calibration) -> str:
    """Format the options of `calibgui calibrate` that take a lens model without comparing."""
    camera = calibration.camera
    usual = find_model(camera.model).held
    values = dict(zip(camera.names, camera.params, strict=True))
    fixed = [f"{name}={values[name]:g}" for name in calibration.fixed if name not in usual]
    return f"--model {camera.model}" + (f" --fix {','.join(fixed)}" if fixed else "")


def tabulate_intrinsics(calibration: Calibration) -> str:
    """Tabulate the camera in the array frame and, for the paper's model, in the paper's units."""
    camera = calibration.camera
    names = camera.names
    left = [
        [name, _format_parameter(calibration, name, value, sigma), _UNITS.get(name, "")]
        for name, value, sigma in zip(names, camera.params, calibration.sigma, strict=True)
    ]
    title = _make_camera_title(calibration)
    if not isinstance(find_model(camera.model), Lucchese):
        return f"{title}\n" + align_columns([["", "OpenCV's frame", ""], *left], left=(0, 1, 2))
    # The paper's values beside those of the same meaning.
    order = [PAPER_NAMES.index({"cx": "xp", "cy": "yp"}.get(name, name)) for name in names]
    values, sigma, printed = make_paper_table(calibration)
    right = [
        [
            PAPER_NAMES[i],
            _format_parameter(calibration, names[row], values[i], sigma[i]),
            _PAPER_UNITS[i],
        ]
        for row, i in enumerate(order)
    ]
    head = ["", "OpenCV's frame", "", " ", "", "paper's frame, units", ""]
    if calibration.cost is Cost.PAPER:
        head.append("its own SD")
        for row, i in zip(right, order, strict=True):
            row.append(f"{printed[i]:.2g}".replace("e-0", "e-"))
    rows = [[*a, " ", *b] for a, b in zip(left, right, strict=True)]
    return f"{title}\n" + align_columns([head, *rows], left=range(8))


def _make_camera_title(calibration: Calibration) -> str:
    width, height = calibration.camera.size
    return f"Camera, {width} x {height} px, each value ± one standard deviation"


def describe_rms(result: Result) -> str:
    """Describe how well the camera fits, to how much, and with which shape of the board."""
    calibration = result.calibration
    fit, shape = summarise_residuals(calibration.residuals), calibration.board_shape
    parts = [
        f"RMS {fit.rms:.3f} px, σx {fit.sigma_x:.3f}, σy {fit.sigma_y:.3f} px",
        f"{format_count(fit.count, name_point(result.board))}, {_count_used(result)}",
    ]
    if shape is not None:
        how = "held as given" if is_board_shape_held(calibration) else "estimated"
        parts.append(f"board shape {how} ({shape.model}), {shape.rms:.2g} mm rms off the drawing")
    return "; ".join(filter(None, [*parts, describe_outliers(result)]))


def _count_used(result: Result) -> str:
    """Describe how many of the images were used."""
    return f"{len(result.used)} of {format_count(len(result.views), 'image')}"


def describe_residuals(result: Result) -> str:
    """Describe the residuals of the calibration, and how the solve ended."""
    calibration = result.calibration
    fit = summarise_residuals(calibration.residuals)
    points = format_count(fit.count, name_point(result.board))
    views = format_count(len(calibration.poses), "view")
    lines = [
        f"Residuals of {points} in {views}",
        f"  in the image            rms {fit.rms:.4f} px, "
        f"sigma_x {fit.sigma_x:.4f} px, sigma_y {fit.sigma_y:.4f} px",
        f"  in the median view      sigma_x {fit.median_sigma_x:.4f} px, "
        f"sigma_y {fit.median_sigma_y:.4f} px",
        f"  on the reference plane  mean e' {fit.reference_mean:.4f}, "
        f"SD {fit.reference_sd:.4f} reference px",
        f"Stage II: {calibration.status} after "
        f"{format_count(len(calibration.history) - 1, 'iteration')}, minimising",
        f"  the {_COSTS[calibration.cost]}",
    ]
    return "\n".join(lines)


def describe_symmetry(found: Iterable[View]) -> list[str]:
    """Describe what a board that can be turned unnoticed means for the poses; empty for others."""
    kinds = {view.corners.ambiguity for view in found if view.corners is not None}
    if kinds <= {Symmetry.NONE}:
        return []
    turn = "quarter" if Symmetry.QUARTER_TURN in kinds else "half"
    return [
        f"The board looks the same after a {turn} turn, so the origins of two views may differ "
        "by one, and their poses with them; the camera does not depend on it. A board with an "
        "odd number of corners one way and an even number the other has no such turn."
    ]


def tabulate_errors(calibration: Calibration, truth: Mapping[str, float]) -> str:
    """Tabulate the intrinsics beside their true values, the errors in standard deviations."""
    rows = []
    names = calibration.camera.names
    for name, value, sigma in zip(names, calibration.camera.params, calibration.sigma, strict=True):
        error = value - truth[name]
        rows.append(
            [
                name,
                f"{truth[name]:z.6g}",
                _format_parameter(calibration, name, value, sigma),
                f"{error:+z.2g}",
                f"{error / sigma:+z.1f}" if sigma > 0 else "",
            ]
        )
    head = ["", "true", "found", "error", "in sigmas"]
    return "Camera against the truth\n" + align_columns([head, *rows], left=(0, 2))


def tabulate_detection(all_views: Sequence[View], board: Board | None = None) -> str:
    """Tabulate the outcome of the search in each image for a `board`, a checkerboard if None."""
    rows = [
        [
            str(number),
            shorten_name(view.image),
            view.status.value,
            "" if view.corners is None else str(len(view.corners)),
            "" if view.corners is None else f"{view.corners.shape[0]} x {view.corners.shape[1]}",
        ]
        for number, view in enumerate(all_views, start=1)
    ]
    head = ["view", "image", "status", f"{name_point(board)}s", "board"]
    parts = ["Images\n" + align_columns([head, *rows], left=(1, 2)), list_unused_views(all_views)]
    remarks = [count_boards(all_views)]
    remarks += [f"{view.name}: {view.note}" for view in all_views if view.note]
    remarks += [*map(_describe_other_boards, all_views), *describe_symmetry(all_views)]
    parts.append("\n".join(map(format_bullet, filter(None, remarks))))
    return "\n\n".join(part for part in parts if part)


def count_boards(all_views: Sequence[View]) -> str:
    """Describe in how many of the images the board was found."""
    found = sum(view.status is ViewStatus.FOUND for view in all_views)
    return f"The board was found in {found} of {format_count(len(all_views), 'image')}."


def _describe_other_boards(view: View) -> str:
    """Describe the further boards in an image, by size and place; empty where there are none."""
    if view.corners is None or not view.corners.others:
        return ""
    boards = [
        f"{rows} x {cols} inner corners around ({u:z.0f}, {v:z.0f})"
        for (rows, cols), (u, v) in (
            (other.shape, other.outline.mean(axis=0)) for other in view.corners.others
        )
    ]
    return f"{shorten_name(view.image)} shows further boards: {', '.join(boards)}."


def _list_view_numbers(result: Result) -> list[int]:
    """List the number of each used view in the list of all, counted from 1."""
    return [place + 1 for place in result.places]


def _format_parameter(calibration: Calibration, name: str, value: float, sigma: float) -> str:
    """Format a camera parameter: its value ± sigma, or why it has none."""
    if name in calibration.fixed:
        return f"{value:z.6g} (held)"
    if name in {u.name for u in calibration.undetermined}:
        return "not determined"
    diagnosis = calibration.diagnosis
    assumed = diagnosis is not None and name in {a.name for a in diagnosis.assumptions}
    return format_with_sigma(value, sigma) + " (assumed)" * assumed


def _format_decimals(value: float, decimals: int) -> str:
    """Format a number with fixed decimals, or "-" if it is not finite."""
    return f"{value:z.{decimals}f}" if math.isfinite(value) else "-"


def format_bullet(text: str) -> str:
    """Format a remark in lines of at most `WIDTH_CHARACTERS`."""
    return fill_lines(text, "- ", "  ")


def fill_lines(text: str, first: str, others: str) -> str:
    """Fill lines that begin with `first` and `others`; a path longer than a line stays whole."""
    return textwrap.fill(
        text,
        WIDTH_CHARACTERS,
        initial_indent=first,
        subsequent_indent=others,
        break_long_words=False,
        break_on_hyphens=False,
    )


def align_columns(rows: Sequence[Sequence[str]], left: Iterable[int] = ()) -> str:
    """Align cells in columns two blanks apart, to the right but for the columns `left`."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    flush = set(left)
    lines = (
        "  ".join(
            cell.ljust(width) if i in flush else cell.rjust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        for row in rows
    )
    return "\n".join(f"  {line}".rstrip() for line in lines)
