"""Text tables about a calibration that fit a terminal of 80 columns.

Every table names its units and counts views from 1, as the images are listed. The paper's
quantities are in its frame: origin at the centre of the pixel array, y up.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from pathlib import PurePath

import numpy as np

from calibgui.dataset import Result, View, ViewStatus
from calibgui.engine.assessment import summarise_residuals
from calibgui.engine.boards import Symmetry
from calibgui.engine.calibration import Calibration, Cost, make_paper_table
from calibgui.engine.camera import Lucchese, find_model
from calibgui.engine.geometry import PAPER_NAMES
from calibgui.report.coverage import measure_attitudes
from calibgui.report.names import make_printable, shorten_name
from calibgui.report.numbers import format_count, format_with_sigma
from calibgui.report.summary import describe_calibration

WIDTH_CHARACTERS = 80
"""Number of characters in a line."""

_UNITS = {"fx": "px", "fy": "px", "cx": "px", "cy": "px"}
_PAPER_UNITS = ("px", "px", "px^-2", "px^-4", "px^-6", "px^-1", "px^-1", "px^-2", "px", "px")
_COSTS = {
    Cost.IMAGE: "reprojection error in the image",
    Cost.REFERENCE: "registration error on the reference plane",
    Cost.PAPER: "registration error of eq. 41 to the letter",
}


def format_report(result: Result) -> str:
    """Format all tables, the most important at the end, where a terminal shows it."""
    calibration = result.calibration
    sections = [
        tabulate_stage_one(result),
        tabulate_views(result),
        list_unused_views(result.views),
        tabulate_intrinsics(calibration),
        describe_residuals(calibration),
        describe_notes(result),
    ]
    return "\n\n".join(section for section in sections if section)


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
    head = ["view", "image", "corners", "rms", "distance", "tilt"]
    units = ["", "", "", "px", "mm", "deg"]
    return "Views\n" + align_columns([head, units, *rows], left=(1,))


def list_unused_views(all_views: Iterable[View]) -> str:
    """List the images that were left out, each with the reason; empty if there are none."""
    lines = [
        _fill_lines(_describe_unused(view), "  ", "    ") for view in all_views if not view.usable
    ]
    return "\n".join(["Left out", *lines]) if lines else ""


def tabulate_intrinsics(calibration: Calibration) -> str:
    """Tabulate the camera in the array frame and, for the paper's model, in the paper's units."""
    camera = calibration.camera
    names = camera.names
    left = [
        [name, _format_parameter(calibration, name, value, sigma), _UNITS.get(name, "")]
        for name, value, sigma in zip(names, camera.params, calibration.sigma, strict=True)
    ]
    size = f"{camera.size[0]} x {camera.size[1]} px"
    title = f"Camera, {size}, each value ± one standard deviation"
    if not isinstance(find_model(camera.model), Lucchese):
        return f"{title}\n" + align_columns([["", "array frame", ""], *left], left=(0, 1, 2))
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
    head = ["", "array frame", "", " ", "", "paper's frame, units", ""]
    if calibration.cost is Cost.PAPER:
        head.append("its own SD")
        for row, i in zip(right, order, strict=True):
            row.append(f"{printed[i]:.2g}".replace("e-0", "e-"))
    rows = [[*a, " ", *b] for a, b in zip(left, right, strict=True)]
    return f"{title}\n" + align_columns([head, *rows], left=range(8))


def describe_residuals(calibration: Calibration) -> str:
    """Describe the residuals of the calibration, and how the solve ended."""
    fit = summarise_residuals(calibration.residuals)
    corners, views = format_count(fit.count, "corner"), format_count(len(calibration.poses), "view")
    lines = [
        f"Residuals of {corners} in {views}",
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


def describe_notes(result: Result) -> str:
    """Describe what is determined and what is not, with warnings and advice."""
    texts = [
        *(sentence.text for sentence in describe_calibration(result)),
        *describe_symmetry(result.used),
    ]
    texts += [f"{PurePath(view.image).name}: {view.note}" for view in result.used if view.note]
    return "\n".join(map(format_bullet, texts))


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
                f"{truth[name]:.6g}",
                _format_parameter(calibration, name, value, sigma),
                f"{error:+.2g}",
                f"{error / sigma:+.1f}" if sigma > 0 else "",
            ]
        )
    head = ["", "true", "found", "error", "in sigmas"]
    return "Camera against the truth\n" + align_columns([head, *rows], left=(0, 2))


def tabulate_detection(all_views: Sequence[View]) -> str:
    """Tabulate the outcome of the search in each image."""
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
    head = ["view", "image", "status", "corners", "board"]
    parts = ["Images\n" + align_columns([head, *rows], left=(1, 2)), list_unused_views(all_views)]
    found = sum(view.status is ViewStatus.FOUND for view in all_views)
    remarks = [f"The board was found in {found} of {format_count(len(all_views), 'image')}."]
    remarks += [*map(_describe_other_boards, all_views), *describe_symmetry(all_views)]
    parts.append("\n".join(map(format_bullet, filter(None, remarks))))
    return "\n\n".join(part for part in parts if part)


def _describe_other_boards(view: View) -> str:
    """Describe the further boards in an image, by size and place; empty where there are none."""
    if view.corners is None or not view.corners.others:
        return ""
    boards = [
        f"{rows} x {cols} inner corners around ({u:.0f}, {v:.0f})"
        for (rows, cols), (u, v) in (
            (other.shape, other.outline.mean(axis=0)) for other in view.corners.others
        )
    ]
    return f"{shorten_name(view.image)} shows further boards: {', '.join(boards)}."


def _list_view_numbers(result: Result) -> list[int]:
    """List the number of each used view in the list of all, counted from 1."""
    return [number for number, view in enumerate(result.views, start=1) if view.usable]


def _describe_unused(view: View) -> str:
    """Describe why a view does not take part."""
    reason = view.reason or "Left out by choice."
    # Reading errors name the file already.
    named = reason.startswith(view.image)
    return make_printable(reason if named else f"{PurePath(view.image).name}: {reason}")


def _format_parameter(calibration: Calibration, name: str, value: float, sigma: float) -> str:
    """Format a camera parameter: its value ± sigma, or why it has none."""
    if name in calibration.fixed:
        return f"{value:.6g} (held)"
    if name in {u.name for u in calibration.undetermined}:
        return "not determined"
    diagnosis = calibration.diagnosis
    assumed = diagnosis is not None and name in {a.name for a in diagnosis.assumptions}
    return format_with_sigma(value, sigma) + " (assumed)" * assumed


def _format_decimals(value: float, decimals: int) -> str:
    """Format a number with fixed decimals, or "-" if it is not finite."""
    return f"{value:.{decimals}f}" if math.isfinite(value) else "-"


def format_bullet(text: str) -> str:
    """Format a remark in lines of at most `WIDTH_CHARACTERS`."""
    return _fill_lines(text, "- ", "  ")


def _fill_lines(text: str, first: str, others: str) -> str:
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
