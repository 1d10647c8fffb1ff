"""What a calibration can be trusted with, as text that fits a terminal of 80 columns."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from calibgui.engine.assessment import (
    BoardShapeChoice,
    Bootstrap,
    CrossValidation,
    Difference,
    NoiseReport,
)
from calibgui.engine.calibration import Calibration
from calibgui.engine.uncertainty import QUANTITIES, NextView, ProjectionUncertainty, ViewCount
from calibgui.report.numbers import counted
from calibgui.report.tables import aligned, bullet

_TABLED = (2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 70, 100, 150, 200, 300, 500, 1000)

_INCREDIBLE = 1.5
"""Bootstrap over reported sigma from which the latter is too small beyond chance."""


def where(distance: float) -> str:
    """Which points are meant, in words."""
    return f"{distance:g} mm away" if math.isfinite(distance) else "far away"


def projection(found: ProjectionUncertainty, limit: float) -> str:
    """Projection uncertainty in numbers."""
    rows = [
        ["at the image's centre", f"{found.centre:.3f}"],
        ["median over the image", f"{found.median:.3f}"],
        ["worst in the image", f"{found.worst:.3f}"],
    ]
    head = ["", "px"]
    title = f"Projection uncertainty of points {where(found.distance)} (one sigma, worst direction)"
    inside = f"{100 * found.fraction(limit):.0f} % of the image is known to {limit:g} px or better."
    return f"{title}\n{aligned([head, *rows], left=(0,))}\n{bullet(inside)}"


def noise(report: NoiseReport) -> str:
    """Whether the residuals look like noise, with the cause where they do not."""
    rows = [
        [check.name, "as noise" if check.passed else "NOT noise", check.finding]
        for check in report.checks
    ]
    text = "Do the residuals look like noise?\n" + aligned(rows, left=(0, 1, 2))
    cause = report.cause
    remark = "Nothing speaks against the standard deviations." if cause is None else cause.advice
    return f"{text}\n{bullet(remark)}"


def validation(found: CrossValidation) -> str:
    """Errors on views that were held out, fold by fold."""
    rows = [
        [str(n), str(len(fold.views)), f"{fold.training:.4f}", f"{fold.held_out:.4f}"]
        for n, fold in enumerate(found.folds, start=1)
    ]
    rows.append(["all", "", f"{found.training:.4f}", f"{found.held_out:.4f}"])
    head = ["fold", "held out", "rms of the others, px", "rms of these, px"]
    return "Cross-validation over the views\n" + aligned([head, *rows])


def board_shapes(choice: BoardShapeChoice) -> str:
    """The plate models by their error on unseen views, and the recommendation."""
    rows = [
        [model, f"{found.training:.4f}", f"{found.held_out:.4f}"]
        for model, found in choice.validations.items()
    ]
    head = ["plate", "training rms, px", "held-out rms, px"]
    table = "Plate models on unseen views\n" + aligned([head, *rows], left=(0,))
    refused = [f"{model}: {reason}" for model, reason in choice.refused.items()]
    return "\n".join([table, *map(bullet, [*refused, choice.words])])


def resampled(found: Bootstrap, calibration: Calibration) -> str:
    """Bootstrap over the views beside the reported standard deviations."""
    names = calibration.camera.names
    rows = [
        [name, f"{sigma:.3g}", f"{reported:.3g}", f"{ratio:.2f}"]
        for name, sigma, reported, ratio in zip(
            names, found.sigma, calibration.sigma, found.ratio, strict=True
        )
        if np.isfinite(ratio)
    ]
    head = ["", "bootstrap", "reported", "ratio"]
    title = f"One sigma from {len(found.params)} resamplings of the views"
    typical = float(np.nanmedian(found.ratio))
    verdict = (
        f"The views scatter {typical:.1f} times as much as reported: their errors are not "
        "independent from corner to corner. Believe the larger of the two."
        if typical > _INCREDIBLE
        else "The views scatter no more than is reported."
    )
    return f"{title}\n{aligned([head, *rows], left=(0,))}\n{bullet(verdict)}"


def difference(found: Difference, expected: float) -> str:
    """The difference of two cameras in numbers.

    Args:
        found: the difference.
        expected: median of what their own uncertainties explain, px.
    """
    rows = [
        ["root mean square", f"{found.rms:.3f}"],
        ["median", f"{found.median:.3f}"],
        ["worst", f"{found.worst:.3f}"],
        ["expected from both uncertainties (median)", f"{expected:.3f}"],
    ]
    title = f"Difference in where points {where(found.distance)} are imaged, px"
    turn = np.degrees(found.turn)
    motion = f"B is turned against A by ({turn[0]:+.3f}, {turn[1]:+.3f}, {turn[2]:+.3f}) degrees"
    if math.isfinite(found.distance):
        x, y, z = found.shift
        motion += f" and shifted by ({x:+.2f}, {y:+.2f}, {z:+.2f}) mm"
    remarks = [f"{motion}, which is taken out.", _verdict(found.median, expected)]
    return "\n".join([title, aligned(rows, left=(0,)), *map(bullet, remarks)])


def _verdict(median: float, expected: float) -> str:
    if median <= 2 * expected:
        return "The two agree within their uncertainties."
    return (
        f"The two differ by {median / expected:.1f} times what their uncertainties explain: the "
        "camera or its focus has changed, or the residuals are not noise in one of them."
    )


def view_count(study: ViewCount, limit: float) -> str:
    """The uncertainty against the number of views, and what it means."""
    chosen = [i for i, n in enumerate(study.counts) if n in _TABLED or n == study.counts[-1]]
    rows = []
    for i in chosen:
        centre, focal, image = zip(study.random[i, 1], study.chosen[i], strict=True)
        solved = study.scatter[i]
        cells = [*centre, solved[0], *focal, solved[1], *image]
        rows.append([str(study.counts[i]), *(_number(float(cell)) for cell in cells)])
    head = ["views", *["random", "chosen", "solved"] * 2, "random", "chosen"]
    title = "One sigma against the number of views"
    table = aligned([head, *rows])
    over = "         " + "principal point, px".center(24) + "focal length, px".center(24)
    over += "projection, px".center(16)
    legend = (
        "random: median of random sets; chosen: well-chosen sets; solved: scatter of random sets "
        "that were calibrated."
    )
    remarks = [legend, *sentences(study, limit)]
    return "\n".join([title, over.rstrip(), table, *map(bullet, remarks)])


def sentences(study: ViewCount, limit: float) -> list[str]:
    """How many views are enough, in words."""
    said = []
    for column, name in enumerate(QUANTITIES):
        last = float(study.random[-1, 1, column])
        at_random, chosen = (study.enough(name, limit, well) for well in (False, True))
        if at_random is None:
            said.append(
                f"The {name} is not known to {limit:g} px: {last:.2g} px from all "
                f"{counted(int(study.counts[-1]), 'view')}."
            )
            continue
        well = f", or {chosen} well-chosen ones" if chosen and chosen < at_random else ""
        said.append(
            f"The {name} is known to {limit:g} px from {at_random} random views{well}; "
            f"to {last:.2g} px from all {study.counts[-1]}."
        )
    return [*said, *_scatter(study)]


def _scatter(study: ViewCount) -> list[str]:
    """How the principal point moves between sets of views that were calibrated."""
    tried = np.isfinite(study.scatter[:, 0])
    if tried.sum() < 2:
        return []
    counts, sigma = study.counts[tried], study.scatter[tried, 0]
    slope = float(np.polyfit(np.log(counts), np.log(sigma), 1)[0])
    shown = [np.abs(counts - n).argmin() for n in (6, counts[-1])]
    said = " and ".join(f"{sigma[i]:.2g} px between sets of {counts[i]}" for i in shown)
    averaging = -0.7 < slope < -0.3
    return [
        f"The principal point scatters by {said}, falling as the number of views to the power "
        f"{slope:.1f}"
        + (
            ": views average like independent measurements, and no number is special."
            if averaging
            else "."
        )
    ]


def next_views(proposed: Sequence[NextView]) -> str:
    """Where to hold the board next."""
    lines = [f"{one.words} Projection: {one.before:.3f} to {one.after:.3f} px." for one in proposed]
    return "What to photograph next\n" + "\n".join(map(bullet, lines))


def _number(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.3f}" if value < 100 else f"{value:.0f}"
