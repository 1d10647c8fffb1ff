"""A calibration as text tables that fit a terminal of 80 columns.

Every table names its units and counts views from 1, as the images are listed. The paper's
quantities are in its frame: origin at the centre of the pixel array, y up.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from pathlib import PurePath

import numpy as np

from calibgui.dataset.result import Result
from calibgui.dataset.view import View, ViewStatus
from calibgui.engine.assessment import summarise
from calibgui.engine.boards import Ambiguity
from calibgui.engine.calibration import Calibration, Cost, paper_table
from calibgui.engine.camera import MODELS, Lucchese
from calibgui.engine.geometry import PAPER_NAMES
from calibgui.report.coverage import attitudes
from calibgui.report.numbers import counted, with_sigma
from calibgui.report.summary import summary
from calibgui.report.words import printable, short_name

WIDTH = 80

_UNITS = {"fx": "px", "fy": "px", "cx": "px", "cy": "px"}
_PAPER_UNITS = ("px", "px", "px^-2", "px^-4", "px^-6", "px^-1", "px^-1", "px^-2", "px", "px")
_COSTS = {
    Cost.IMAGE: "reprojection error in the image",
    Cost.REFERENCE: "registration error on the reference plane",
    Cost.PAPER: "registration error of eq. 41 to the letter",
}


def report(result: Result) -> str:
    """All tables, what matters most at the end, where a terminal shows it."""
    calibration = result.calibration
    sections = [
        stage_one(result),
        views(result),
        unused(result.views),
        intrinsics(calibration),
        residuals(calibration),
        notes(result),
    ]
    return "\n\n".join(section for section in sections if section)


def stage_one(result: Result) -> str:
    """Table 1: what every view gives by itself, in the paper's frame and units."""
    rows = [
        [
            str(number),
            _fixed(row.xp, 4),
            _fixed(row.yp, 4),
            _fixed(row.k1 * 1e7, 4),
            _fixed(row.aspect, 4),
            _fixed(row.fx, 2),
            _fixed(row.fy, 2),
            str(row.iterations),
            _fixed(row.rms, 4),
        ]
        for number, row in zip(_numbers(result), result.calibration.stage_one, strict=True)
    ]
    table = np.array([[row.xp, row.yp, row.k1 * 1e7] for row in result.calibration.stage_one])
    rows.append(["mean", *(_fixed(mean, 4) for mean in table.mean(axis=0)), *[""] * 5])
    head = ["view", "xp", "yp", "k1 x 1e7", "fy/fx", "fx", "fy", "steps", "rms e'"]
    units = ["", "px", "px", "px^-2", "", "px", "px", "", "ref px"]
    return "Stage I, each view by itself (paper's Table 1; - : not determined)\n" + aligned(
        [head, units, *rows]
    )


def views(result: Result) -> str:
    """The used views: how well they fit and how the board was held."""
    calibration = result.calibration
    attitude = attitudes(calibration, result.observations())
    rows = [
        [
            str(number),
            short_name(view.image),
            str(len(fit.image)),
            f"{fit.rms:.3f}",
            f"{distance:.0f}",
            f"{math.degrees(tilt):.1f}",
        ]
        for number, view, fit, distance, tilt in zip(
            _numbers(result),
            result.used,
            calibration.residuals,
            attitude.distance,
            attitude.tilt,
            strict=True,
        )
    ]
    head = ["view", "image", "corners", "rms", "distance", "tilt"]
    units = ["", "", "", "px", "mm", "deg"]
    return "Views\n" + aligned([head, units, *rows], left=(1,))


def unused(all_views: Iterable[View]) -> str:
    """The images that were left out, each with the reason; empty if there are none."""
    lines = [_filled(_why_unused(view), "  ", "    ") for view in all_views if not view.usable]
    return "\n".join(["Left out", *lines]) if lines else ""


def intrinsics(calibration: Calibration) -> str:
    """The camera in the array frame and, for the paper's model, in the paper's units."""
    camera = calibration.camera
    names = camera.names
    left = [
        [name, _measured(calibration, name, value, sigma), _UNITS.get(name, "")]
        for name, value, sigma in zip(names, camera.params, calibration.sigma, strict=True)
    ]
    size = f"{camera.size[0]} x {camera.size[1]} px"
    title = f"Camera, {size}, each value ± one standard deviation"
    if not isinstance(MODELS[camera.model], Lucchese):
        return f"{title}\n" + aligned([["", "array frame", ""], *left], left=(0, 1, 2))
    # The paper's values beside those of the same meaning.
    order = [PAPER_NAMES.index({"cx": "xp", "cy": "yp"}.get(name, name)) for name in names]
    values, sigma, printed = paper_table(calibration)
    right = [
        [
            PAPER_NAMES[i],
            _measured(calibration, names[row], values[i], sigma[i]),
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
    return f"{title}\n" + aligned([head, *rows], left=range(8))


def residuals(calibration: Calibration) -> str:
    """What the calibration leaves unexplained, and how the solve ended."""
    fit = summarise(calibration.residuals)
    lines = [
        f"Residuals of {counted(fit.count, 'corner')} in {counted(len(calibration.poses), 'view')}",
        f"  in the image            rms {fit.rms:.4f} px, "
        f"sigma_x {fit.sigma_x:.4f} px, sigma_y {fit.sigma_y:.4f} px",
        f"  in the median view      sigma_x {fit.typical_x:.4f} px, sigma_y {fit.typical_y:.4f} px",
        f"  on the reference plane  mean e' {fit.reference_mean:.4f}, "
        f"SD {fit.reference_sd:.4f} reference px",
        f"Stage II: {calibration.status} after "
        f"{counted(len(calibration.history) - 1, 'iteration')}, minimising",
        f"  the {_COSTS[calibration.cost]}",
    ]
    return "\n".join(lines)


def notes(result: Result) -> str:
    """In words: what is determined and what is not, warnings, and what would improve it."""
    texts = [*(sentence.text for sentence in summary(result)), *symmetry(result.used)]
    texts += [f"{PurePath(view.image).name}: {view.note}" for view in result.used if view.note]
    return "\n".join(map(bullet, texts))


def symmetry(found: Iterable[View]) -> list[str]:
    """What a board that can be turned unnoticed means for the poses; nothing for others."""
    kinds = {view.corners.ambiguity for view in found if view.corners is not None}
    if kinds <= {Ambiguity.NONE}:
        return []
    turn = "quarter" if Ambiguity.QUARTER_TURN in kinds else "half"
    return [
        f"The board looks the same after a {turn} turn, so the origins of two views may differ "
        "by one, and their poses with them; the camera does not depend on it. A board with an "
        "odd number of corners one way and an even number the other has no such turn."
    ]


def comparison(calibration: Calibration, truth: Mapping[str, float]) -> str:
    """The intrinsics beside their true values, the error in standard deviations."""
    rows = []
    names = calibration.camera.names
    for name, value, sigma in zip(names, calibration.camera.params, calibration.sigma, strict=True):
        error = value - truth[name]
        rows.append(
            [
                name,
                f"{truth[name]:.6g}",
                _measured(calibration, name, value, sigma),
                f"{error:+.2g}",
                f"{error / sigma:+.1f}" if sigma > 0 else "",
            ]
        )
    head = ["", "true", "found", "error", "in sigmas"]
    return "Camera against the truth\n" + aligned([head, *rows], left=(0, 2))


def detection(all_views: Sequence[View]) -> str:
    """What was found in each image."""
    rows = [
        [
            str(number),
            short_name(view.image),
            view.status.value,
            "" if view.corners is None else str(len(view.corners)),
            "" if view.corners is None else f"{view.corners.shape[0]} x {view.corners.shape[1]}",
        ]
        for number, view in enumerate(all_views, start=1)
    ]
    head = ["view", "image", "status", "corners", "board"]
    parts = ["Images\n" + aligned([head, *rows], left=(1, 2)), unused(all_views)]
    found = sum(view.status is ViewStatus.FOUND for view in all_views)
    remarks = [f"The board was found in {found} of {counted(len(all_views), 'image')}."]
    remarks += [*map(_others, all_views), *symmetry(all_views)]
    parts.append("\n".join(map(bullet, filter(None, remarks))))
    return "\n\n".join(part for part in parts if part)


def _others(view: View) -> str:
    """The further boards in an image, by size and place; nothing where there are none."""
    if view.corners is None or not view.corners.others:
        return ""
    boards = [
        f"{rows} x {cols} inner corners around ({u:.0f}, {v:.0f})"
        for (rows, cols), (u, v) in (
            (other.shape, other.outline.mean(axis=0)) for other in view.corners.others
        )
    ]
    return f"{short_name(view.image)} shows further boards: {', '.join(boards)}."


def _numbers(result: Result) -> list[int]:
    """Place of each used view in the list of all."""
    return [number for number, view in enumerate(result.views, start=1) if view.usable]


def _why_unused(view: View) -> str:
    reason = view.reason or "Left out by choice."
    # Reading errors name the file already.
    named = reason.startswith(view.image)
    return printable(reason if named else f"{PurePath(view.image).name}: {reason}")


def _measured(calibration: Calibration, name: str, value: float, sigma: float) -> str:
    if name in calibration.fixed:
        return f"{value:.6g} (held)"
    if name in {u.name for u in calibration.undetermined}:
        return "not determined"
    diagnosis = calibration.diagnosis
    assumed = diagnosis is not None and name in {a.name for a in diagnosis.assumed}
    return with_sigma(value, sigma) + " (assumed)" * assumed


def _fixed(value: float, decimals: int) -> str:
    return f"{value:.{decimals}f}" if math.isfinite(value) else "-"


def bullet(text: str) -> str:
    """A remark in lines of at most 80 characters."""
    return _filled(text, "- ", "  ")


def _filled(text: str, first: str, others: str) -> str:
    """In lines that fit the terminal and begin as said; a path longer than that stays whole."""
    return textwrap.fill(
        text,
        WIDTH,
        initial_indent=first,
        subsequent_indent=others,
        break_long_words=False,
        break_on_hyphens=False,
    )


def aligned(rows: Sequence[Sequence[str]], left: Iterable[int] = ()) -> str:
    """Rows of cells in columns two blanks apart, to the right but for the `left` ones."""
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
