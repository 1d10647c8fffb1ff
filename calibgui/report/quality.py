"""Text about the quality of a calibration that fits a terminal of 80 columns."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.assessment import (
    FAR_OFF,
    BoardShapeChoice,
    Bootstrap,
    CameraDifference,
    CrossValidation,
    Finding,
    LengthUncertainty,
    NoiseReport,
    Repeatability,
)
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Calibration
from calibgui.engine.numbers import format_two_digits
from calibgui.engine.uncertainty import QUANTITIES, NextView, ProjectionUncertainty, ViewCountStudy
from calibgui.report.boards import name_point
from calibgui.report.numbers import format_count, format_with_sigma
from calibgui.report.tables import align_columns, fill_lines, format_bullet

_TABULATED_COUNTS = (
    2,
    3,
    4,
    5,
    6,
    8,
    10,
    12,
    15,
    20,
    25,
    30,
    40,
    50,
    70,
    100,
    150,
    200,
    300,
    500,
    1000,
)
"""Numbers of views that have a row in the table."""
_MAX_BOOTSTRAP_RATIO = 1.5
"""Median ratio of bootstrap to reported sigma, above which the latter is taken as too small; a
single value has twice as much, as its ratio scatters."""
_MIN_VIEWS_TO_RESAMPLE = 10
"""Number of views below which a draw holds 6 different ones or fewer in the mean."""


def describe_length_uncertainty(found: LengthUncertainty) -> str:
    """Describe how wrong a length is, with k = 2, where it is known worst and in the median."""
    k = found.worst
    sigma, (u, v) = found.sigma[k], found.uv[k]
    calibration, noise, scale = found.shares
    where = f"at pixel {u:.0f}, {v:.0f}"
    if len(found.uv) > 1:
        median = format_two_digits(2 * float(np.nanmedian(found.sigma)))
        where = f"{where}, where it is known worst; ± {median} mm in the median over the image"
    text = (
        f"{found.length:g} mm at {found.depth:g} mm: ± {format_two_digits(2 * float(sigma))} mm "
        f"(k = 2) {where}. Of the variance {100 * calibration:.0f} % are the calibration's, "
        f"{100 * noise:.0f} % the noise of two corners and {100 * scale:.0f} % the board's scale"
        f"{'' if found.by_scale else ', which counts as exact'}. The distance counts as known."
    )
    return fill_lines(text, "", "  ")


def describe_repeatability(found: Repeatability, residuals: float | None = None) -> str:
    """Describe how far corners scatter where nothing moves, beside what else is known of it.

    Args:
        found: the scatter.
        residuals: standard deviation of a calibration's residuals along an axis, px, if one is
            named.
    """
    sentences = [
        f"Corners repeat to {format_with_sigma(found.rms, found.rms_sigma)} px along each axis: "
        f"{format_count(found.frames, 'frame')} of {format_count(len(found.uv), 'corner')}, "
        f"{found.sigma.min():.2g} px at the best and {found.sigma.max():.2g} px at the worst."
    ]
    if math.isfinite(found.stated):
        sentences.append(f"Where they were located they are stated to {found.stated:.2g} px.")
    sentences.append(
        f"The frames move by {found.motion:.2g} px rms, which is left out: fasten board and camera."
        if found.motion
        else "Nothing has moved meanwhile."
    )
    if residuals is not None:
        share = min(found.rms**2 / residuals**2, 1.0)
        sentences.append(
            f"The calibration's residuals are {residuals:.2g} px along each axis. Of their "
            f"variance {100 * share:.0f} % is this noise. The rest is the same in every frame: "
            "errors of the lens model, the board's shape, blur and light."
        )
    return "\n".join(map(format_bullet, sentences))


def describe_distance(distance: float) -> str:
    """Describe where points are that lie `distance` mm from the camera."""
    return f"{distance:g} mm away" if math.isfinite(distance) else "far away"


def tabulate_projection_uncertainty(
    found: ProjectionUncertainty, limit: float, condition: str = ""
) -> str:
    """Tabulate projection uncertainty, with the share of the image known to `limit` px.

    Args:
        found: the uncertainty.
        limit: of the share, px.
        condition: what lengths rest on, such as "if squares are 30 mm"; empty if they are known.
    """
    rows = [
        ["at the image's centre", f"{found.centre:.3f}"],
        ["median over the image", f"{found.median:.3f}"],
        ["worst in the image", f"{found.worst:.3f}"],
    ]
    head = ["", "px"]
    points = f"points {describe_distance(found.distance)}"
    if condition and math.isfinite(found.distance):
        points += f" {condition}"
    title = f"Projection uncertainty of {points} (one sigma, worst direction)"
    inside = f"{100 * found.fraction(limit):.0f} % of the image is known to {limit:g} px or better."
    other = (
        "The verdict's error of a pixel is another: it leaves out what a rotation of the camera "
        "makes up for. Here the camera has the direction that the boards give it."
    )
    table = align_columns([head, *rows], left=(0,))
    return "\n".join([title, table, format_bullet(inside), format_bullet(other)])


def tabulate_noise_report(
    report: NoiseReport, explanation: Finding | None, board: Board | None = None
) -> str:
    """Tabulate the tests of the residuals for noise, with the `explanation` where one fails.

    Args:
        report: the tests.
        explanation: what is wrong; None if it is not known.
        board: in the photographs; a checkerboard if None.
    """
    rows = [
        [check.name, "as noise" if check.passed else "NOT noise", check.finding]
        for check in report.checks
    ]
    head = ["looked for", "residuals", "found"]
    text = "Do the residuals look like noise?\n" + align_columns([head, *rows], left=(0, 1, 2))
    if report.passed:
        remark = "Nothing speaks against the standard deviations."
        if report.far_corners:
            points = format_count(report.far_corners, name_point(board))
            remark += (
                f" Beyond {FAR_OFF:g} sigma: {points} in "
                f"{format_count(report.far_views, 'view')}, each within its own uncertainty."
            )
    elif explanation is None:
        remark = "The residuals are not just noise, but no cause of it stands out that matters."
    else:
        remark = f"{explanation.message} {explanation.remedy}"
    return f"{text}\n{format_bullet(remark)}"


def tabulate_cross_validation(found: CrossValidation) -> str:
    """Tabulate errors on views that were held out, fold by fold."""
    rows = [
        [str(n), str(len(fold.views)), f"{fold.training:.4f}", f"{fold.held_out:.4f}"]
        for n, fold in enumerate(found.folds, start=1)
    ]
    rows.append(["all", "", f"{found.training:.4f}", f"{found.held_out:.4f}"])
    head = ["fold", "held out", "rms of the others, px", "rms of these, px"]
    return "Cross-validation over the views\n" + align_columns([head, *rows])


def tabulate_board_shape_choice(choice: BoardShapeChoice) -> str:
    """Tabulate models of the board's shape by their error on unseen views, and recommend one."""
    rows = [[model, f"{found.held_out:.4f}"] for model, found in choice.validations.items()]
    head = ["shape", "rms of unseen views, px"]
    table = "Board shapes on unseen views\n" + align_columns([head, *rows], left=(0,))
    refused = [f"{model}: {reason}" for model, reason in choice.refused.items()]
    return "\n".join([table, *map(format_bullet, [*refused, choice.recommendation])])


def tabulate_bootstrap(found: Bootstrap, calibration: Calibration) -> str:
    """Tabulate bootstrap standard deviations beside the reported ones."""
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
    verdict = _describe_bootstrap(found.ratio, names, len(calibration.poses))
    return f"{title}\n{align_columns([head, *rows], left=(0,))}\n{format_bullet(verdict)}"


def _describe_bootstrap(ratio: Array, names: Sequence[str], count: int) -> str:
    """Describe the ratios of bootstrap to reported standard deviations, from `count` views."""
    typical = float(np.nanmedian(ratio))
    if typical > _MAX_BOOTSTRAP_RATIO:
        return (
            f"The views scatter {typical:.1f} times as much as reported: their errors are not "
            "independent from corner to corner. Believe the larger of the two."
        )
    beyond = [n for n, times in zip(names, ratio, strict=True) if times > 2 * _MAX_BOOTSTRAP_RATIO]
    if not beyond:
        return "The views scatter no more than is reported."
    listed = ", ".join(beyond)
    if count < _MIN_VIEWS_TO_RESAMPLE:
        return (
            f"Most values scatter no more than is reported. {listed} scatter more, but draws from "
            f"{count} views often hold too few different ones to tell."
        )
    return (
        f"Most values scatter no more than is reported. {listed} scatter more: believe the larger "
        "of the two."
    )


def tabulate_camera_difference(found: CameraDifference, expected: float | None) -> str:
    """Tabulate the difference of two cameras, and say if nothing tells how much is expected.

    Args:
        found: the difference.
        expected: root mean square of the difference that their own uncertainties explain, px; None
            if one of them is not known.
    """
    rows = [
        ["root mean square", f"{found.rms:.3f}"],
        ["median", f"{found.median:.3f}"],
        ["worst", f"{found.worst:.3f}"],
        [
            "expected from both uncertainties (rms)",
            "not known" if expected is None else f"{expected:.3f}",
        ],
    ]
    title = f"Difference in where points {describe_distance(found.distance)} are imaged, px"
    turn = np.degrees(found.turn)
    motion = f"B is turned against A by ({turn[0]:+z.3f}, {turn[1]:+z.3f}, {turn[2]:+z.3f}) degrees"
    if math.isfinite(found.distance):
        x, y, z = found.shift
        motion += f" and shifted by ({x:+z.2f}, {y:+z.2f}, {z:+z.2f}) mm"
    remarks = [f"{motion}, which is taken out."]
    if expected is None:
        remarks.append(
            "Whether that is more than their uncertainties explain is not known: only a "
            "result.json of this program holds the corners that tell."
        )
    return "\n".join([title, align_columns(rows, left=(0,)), *map(format_bullet, remarks)])


def tabulate_number_of_views(study: ViewCountStudy, limit: float) -> str:
    """Tabulate uncertainty against the number of views, and say which number reaches `limit` px."""
    chosen = [
        i for i, n in enumerate(study.counts) if n in _TABULATED_COUNTS or n == study.counts[-1]
    ]
    rows = []
    for i in chosen:
        centre, focal, image = zip(study.random[i, 1], study.chosen[i], strict=True)
        solved = study.scatter[i]
        cells = [*centre, solved[0], *focal, solved[1], *image]
        rows.append([str(study.counts[i]), *(_format_number(float(cell)) for cell in cells)])
    head = ["views", *["random", "chosen", "solved"] * 2, "random", "chosen"]
    title = "One sigma against the number of views"
    table = align_columns([head, *rows])
    over = "         " + "principal point, px".center(24) + "focal length, px".center(24)
    over += "projection, px".center(16)
    legend = (
        "random: median of random sets; chosen: well-chosen sets; solved: scatter of random sets "
        "that were calibrated."
    )
    remarks = [legend, *describe_number_of_views(study, limit)]
    return "\n".join([title, over.rstrip(), table, *map(format_bullet, remarks)])


def describe_number_of_views(study: ViewCountStudy, limit: float) -> list[str]:
    """Describe how many views reach `limit` px."""
    texts = []
    for column, name in enumerate(QUANTITIES):
        last = float(study.random[-1, 1, column])
        at_random, chosen = (
            study.find_sufficient_count(name, limit, well) for well in (False, True)
        )
        if at_random is None:
            texts.append(
                f"The {name} is not known to {limit:g} px: {format_two_digits(last)} px from all "
                f"{format_count(int(study.counts[-1]), 'view')}."
            )
            continue
        well = f", or {chosen} well-chosen ones" if chosen and chosen < at_random else ""
        texts.append(
            f"The {name} is known to {limit:g} px from {at_random} random views{well}; "
            f"to {last:.2g} px from all {study.counts[-1]}."
        )
    return [*texts, *_describe_scatter(study)]


def _describe_scatter(study: ViewCountStudy) -> list[str]:
    """Describe how the principal point scatters between sets of views that were calibrated."""
    tried = np.isfinite(study.scatter[:, 0])
    if tried.sum() < 2:
        return []
    counts, sigma = study.counts[tried], study.scatter[tried, 0]
    slope = float(np.polyfit(np.log(counts), np.log(sigma), 1)[0])
    last = len(counts) - 1
    six = int(np.abs(counts - 6).argmin())
    shown = [six if six < last else 0, last]
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


def describe_next_views(proposed: Sequence[NextView]) -> str:
    """Describe where to hold the board next, and what that gains."""
    lines = [
        f"{view.instruction} It lowers the uncertainty over the image from "
        f"{format_two_digits(view.before)} to {format_two_digits(view.after)} px."
        for view in proposed
    ]
    return "What to photograph next\n" + "\n".join(map(format_bullet, lines))


def _format_number(value: float) -> str:
    """Format a standard deviation in px, or "-" if it is not known."""
    return "-" if math.isnan(value) else f"{value:.3f}" if value < 100 else f"{value:.0f}"
