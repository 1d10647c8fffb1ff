"""Words and tables on a comparison of methods of calibration.

The tables have a row for each method: what it says of the camera, how well it predicts views that
it has not seen, and how far its camera is from the chosen one. What is compared means the same for
all methods: pixels of the array frame, each value with one standard deviation, as a calibration by
that method states it. What a method does not estimate is a dash, never a zero. Coefficients of
different lens models mean different things even where they share a name; they are listed with their
model, and what the tables compare is how far the distortion moves the outermost corners.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from calibgui.engine.assessment import (
    Distortion,
    LineTrial,
    MethodComparison,
    MethodTrial,
    summarise_residuals,
)
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Calibration
from calibgui.report.boards import name_point
from calibgui.report.names import join_words
from calibgui.report.numbers import format_count, format_with_sigma
from calibgui.report.tables import align_columns, format_bullet

QUANTITIES = ("fx", "fy", "cx", "cy", "skew")
"""Names of the values of a row, all in px."""
_NEAR_SHARE = 0.02
"""Share of the least error on unseen views within which others are named together with the best."""
_NEAR_SIGMAS = 2.0
"""Number of its own standard deviations within which a method agrees with the best."""
_LINE_UNITS = {"k1": " px^-2", "k2": " px^-4"}
"""Units of the coefficients of methods without lengths."""
_LEGEND = (
    "Each value has one standard deviation below it, that of calibgui calibrate by that method (of "
    "methods marked *, that of the corners' noise); - is not estimated. "
    "skew: fx times the coefficient, the shift across the image over a length of fy down it. "
    "shift: how far the distortion moves points that are measured {radius:.0f} px from the "
    "principal point, the outermost corner's distance; negative towards it. cx and cy of methods "
    "marked * are the centre of the distortion.",
    "RMS, sigma: length and one coordinate of the residuals of a calibration from all views, with "
    "the poses as the method leaves them. "
    "unseen: RMS of the residuals of views that were left out of the calibration in turn, with "
    "only their poses fitted, which may be less than the RMS of a method that fits no pose. Of "
    "methods marked *, which know no lengths, both are distances of corners from straight rows "
    "and columns: compare them with each other only.",
    "time, steps: of initialisation and refinement from all views; no steps where there are none "
    "or they are not told. differs: distance between a point's images by this method and by the "
    "chosen camera where corners were seen, after the rotation (for *, the homography) that brings "
    "the two closest.",
)
"""What the columns of the tables mean."""


@dataclass(frozen=True, eq=False, slots=True)
class MethodRow:
    """A method as a table shows it. Lengths are in px; NaN if unknown."""

    name: str
    """Name of the method in the comparison."""
    label: str
    """Name that a user reads in a table."""
    title: str
    """Name that a user reads, with what the method does."""
    source: str
    """Publication that describes the method."""
    limits: str
    """Sentence on what the method assumes or cannot estimate."""
    kind: str
    """Kind of the outcome: "camera"; "lines" if the method knows no lengths and gives a distortion
    only; "refused" if it gives nothing."""
    values: Mapping[str, tuple[float, float]]
    """Those of `QUANTITIES` that the method estimates, with one standard deviation, NaN where
    that is not known. The centre of a method of the kind "lines" is that of the
    distortion."""
    shift: tuple[float, float] | None
    """Shift of the outermost corners by the distortion along the radius, with its standard
    deviation; None if the method estimates no distortion, or none that holds so far out."""
    radius: float
    """Measured distance from the centre at which the shift is stated."""
    coefficients: str
    """Coefficients of the method's own lens model, as "k1 = 0.2512 ± 0.0003, k2 = ..."; may be
    empty."""
    rms: float
    """RMS length of the residuals of a calibration from all views; of a method of the kind "lines"
    the RMS distance of corners from straight lines."""
    sigma: float
    """Standard deviation of a coordinate of these residuals; NaN for distances, which have one."""
    unseen: float
    """RMS length of the residuals, or the RMS distance, of views that the method has not seen."""
    seconds: float
    """Time of initialisation and refinement, s."""
    iterations: int | None
    """Number of iterations; None if there are none, or their number is not known."""
    difference_rms: float
    """RMS distance between a point's images by this method and by the chosen camera, where corners
    were seen."""
    difference_worst: float
    """Largest distance between a point's images by this method and by the chosen camera, where
    corners were seen."""
    remarks: tuple[str, ...]
    """Sentences on the result; of a refused method, the reason."""
    is_usable: bool
    """True if the method gives a camera that can be taken over."""


def list_method_rows(comparison: MethodComparison) -> list[MethodRow]:
    """List all methods in their order, those included that gave nothing."""
    return [_make_row(comparison, name) for name in comparison.methods]


def _make_row(comparison: MethodComparison, name: str) -> MethodRow:
    if name in comparison.trials:
        return _make_camera_row(comparison.trials[name])
    if name in comparison.lines:
        return _make_line_row(comparison.lines[name])
    method = comparison.methods[name]
    nan = math.nan
    return MethodRow(
        name=name,
        label=method.label,
        title=method.title,
        source=method.source,
        limits=method.limits,
        kind="refused",
        values={},
        shift=None,
        radius=nan,
        coefficients="",
        rms=nan,
        sigma=nan,
        unseen=nan,
        seconds=nan,
        iterations=None,
        difference_rms=nan,
        difference_worst=nan,
        remarks=(comparison.refused[name],),
        is_usable=False,
    )


def _make_camera_row(trial: MethodTrial) -> MethodRow:
    found, difference = trial.calibration, trial.difference
    return MethodRow(
        name=trial.name,
        label=trial.method.label,
        title=trial.method.title,
        source=trial.method.source,
        limits=trial.method.limits,
        kind="camera",
        values=_list_values(found),
        shift=_get_shift(trial.distortion),
        radius=trial.distortion.radius,
        coefficients=_list_coefficients(
            (name, value, sigma)
            for name, value, sigma in zip(
                found.camera.names, found.camera.params, found.sigma, strict=True
            )
            if name not in (*QUANTITIES, *found.fixed)
        ),
        rms=trial.rms,
        sigma=summarise_residuals(found.residuals).sigma,
        unseen=trial.held_out,
        seconds=found.seconds,
        iterations=(len(found.history) - 1) or None,
        difference_rms=math.nan if difference is None else difference.rms,
        difference_worst=math.nan if difference is None else difference.worst,
        remarks=trial.remarks,
        is_usable=True,
    )


def _list_values(found: Calibration) -> dict[str, tuple[float, float]]:
    """List the estimated values of a camera in px, with one standard deviation."""
    names = found.camera.names
    estimated = {
        name: (float(value), float(sigma))
        for name, value, sigma in zip(names, found.camera.params, found.sigma, strict=True)
        if name in QUANTITIES and name not in found.fixed
    }
    if "skew" in estimated:
        fx, (skew, sigma) = found.camera.params[0], estimated["skew"]
        # fx is known far better than the skew, which is small: its error does not count.
        estimated["skew"] = float(fx * skew), float(fx * sigma)
    return estimated


def _make_line_row(trial: LineTrial) -> MethodRow:
    lines = trial.lines
    estimated = [
        (name, float(value), float(sigma))
        for name, value, sigma in zip(lines.names, trial.params, lines.sigma, strict=True)
        if name in lines.estimated
    ]
    return MethodRow(
        name=trial.name,
        label=trial.method.label,
        title=trial.method.title,
        source=trial.method.source,
        limits=trial.method.limits,
        kind="lines",
        values={name: (value, sigma) for name, value, sigma in estimated if name in QUANTITIES},
        shift=_get_shift(trial.distortion),
        radius=trial.distortion.radius,
        coefficients=_list_coefficients(
            (each for each in estimated if each[0] not in QUANTITIES), _LINE_UNITS
        ),
        rms=lines.straightness_after,
        sigma=math.nan,
        unseen=trial.held_out,
        seconds=trial.seconds,
        iterations=lines.iterations or None,
        difference_rms=trial.difference_rms,
        difference_worst=trial.worst,
        remarks=trial.remarks,
        is_usable=False,
    )


def _get_shift(distortion: Distortion) -> tuple[float, float] | None:
    if math.isnan(distortion.shift):
        return None
    return distortion.shift, distortion.sigma


def _list_coefficients(
    estimated: Iterable[tuple[str, float, float]], units: Mapping[str, str] = MappingProxyType({})
) -> str:
    return ", ".join(
        f"{name} = {format_with_sigma(value, sigma)}{units.get(name, '')}"
        for name, value, sigma in estimated
    )


def describe_method_comparison(comparison: MethodComparison, *, by_label: bool = False) -> str:
    """Describe in a few sentences, with figures, what the comparison supports.

    Args:
        comparison: the comparison.
        by_label: true for words beside a table of the window, whose labels name the methods then,
            not arguments, and which has the errors of those that predict less well.
    """
    rows = list_method_rows(comparison)
    if by_label:
        rows = [replace(row, name=row.label) for row in rows]
    cameras = [row for row in rows if row.kind == "camera" and math.isfinite(row.unseen)]
    if not cameras:
        return "None of the methods could be tried on unseen views."
    cameras.sort(key=lambda row: row.unseen)
    best = cameras[0]
    near = [row for row in cameras[1:] if row.unseen <= (1 + _NEAR_SHARE) * best.unseen]
    sentences = [
        _describe_best(best, near),
        "" if by_label else _describe_losses(best, cameras[1 + len(near) :]),
        _describe_agreement(best, cameras[1:]),
        _describe_lines([row for row in rows if row.kind == "lines"]),
    ]
    return " ".join(filter(None, sentences))


def _describe_best(best: MethodRow, near: Sequence[MethodRow]) -> str:
    """Say in a sentence which methods predict unseen views best."""
    share = f"{100 * _NEAR_SHARE:.0f} %"
    others = (
        f"within {share} of it {'is' if len(near) == 1 else 'are'} "
        f"{join_words(row.name for row in near)}"
        if near
        else f"no other method comes within {share} of it"
    )
    least = format_length(best.unseen)
    return f"{best.name} predicts unseen views best, with {least} px RMS; {others}."


def _describe_losses(best: MethodRow, others: Sequence[MethodRow]) -> str:
    """Say in a sentence by how much the other methods predict unseen views less well."""
    if not others:
        return ""
    losses = [f"{row.name}: {row.unseen - best.unseen:.2g}" for row in others]
    return f"The others are off by so many px RMS more: {'; '.join(losses)}."


def _describe_agreement(best: MethodRow, others: Sequence[MethodRow]) -> str:
    """Say in a sentence which cameras agree with the best within their own uncertainty."""
    distances = {row.name: _measure_disagreement(row, best) for row in others}
    judged = {name: distance for name, distance in distances.items() if math.isfinite(distance)}
    agreeing = [name for name, distance in judged.items() if distance <= _NEAR_SIGMAS]
    apart = [f"{name} ({judged[name]:.1f})" for name in judged if name not in agreeing]
    limit = "two of their own standard deviations"
    if not judged:
        return ""
    if not agreeing:
        return (
            f"No other method's focal lengths and centre all lie within {limit} of "
            f"{best.name}'s; the largest distances, in standard deviations: {join_words(apart)}."
        )
    text = f"All that they estimate of fx, fy, cx and cy lies within {limit} of {best.name}'s in "
    text += join_words(agreeing)
    return (
        f"{text}; not in {join_words(apart)}, the largest distance in brackets."
        if apart
        else f"{text}."
    )


def _measure_disagreement(row: MethodRow, best: MethodRow) -> float:
    """Return the largest difference of two rows' focal lengths and centres, in sigmas of `row`.

    NaN if there is nothing to compare. It does not measure how likely the difference is: both rest
    on the same corners.
    """
    common = [n for n in QUANTITIES[:4] if n in row.values and n in best.values]
    pairs = [(row.values[n], best.values[n]) for n in common]
    sigmas = [abs(a - b) / sigma for (a, sigma), (b, _) in pairs if sigma > 0]
    return max(sigmas, default=math.nan)


def _describe_lines(lines: Sequence[MethodRow]) -> str:
    """Say in a sentence how straight the methods without lengths make unseen views."""
    known = [row for row in lines if math.isfinite(row.unseen)]
    if not known:
        return ""
    errors = [f"{format_length(row.unseen)} px by {row.name}" for row in known]
    return (
        "Rows and columns of unseen views are straight, in RMS distance, to "
        f"{join_words(errors)}, without lengths."
    )


def tabulate_methods(comparison: MethodComparison, board: Board | None = None) -> str:
    """Tabulate all methods, and state what the tables support and the remarks in words.

    Args:
        comparison: of them.
        board: in the photographs; a checkerboard if None.
    """
    rows = list_method_rows(comparison)
    tried = [row for row in rows if row.kind != "refused"]
    calibration = next(iter(comparison.trials.values())).calibration
    views = format_count(len(calibration.poses), "view")
    count = sum(len(view.image) for view in calibration.residuals)
    points = format_count(count, name_point(board))
    notes = [
        describe_method_comparison(comparison),
        *(_describe_row(row, comparison) for row in rows),
        *(line.format(radius=tried[0].radius) for line in _LEGEND),
    ]
    return "\n".join(
        [
            f"Methods of calibration on {points} in {views} (* without lengths)",
            _tabulate_values(tried),
            "",
            f"Errors, time, and difference from the chosen camera{_name_chosen(comparison)}",
            _tabulate_errors(tried),
            "",
            *map(format_bullet, notes),
        ]
    )


def _name_chosen(comparison: MethodComparison) -> str:
    """Name the method whose camera the others are compared with, if it is one of them."""
    names = [
        name
        for name, trial in comparison.trials.items()
        if trial.calibration.camera is comparison.chosen
    ]
    return f", that of {names[0]}" if names else ""


def _describe_row(row: MethodRow, comparison: MethodComparison) -> str:
    """Say what a method is, the coefficients of its lens model, and what there is to remark."""
    head = f"{row.name} ({row.title})"
    if row.kind == "refused":
        return f"{head}: refused. {' '.join(row.remarks)}"
    coefficients = f"{row.coefficients}." if row.coefficients else ""
    if coefficients and row.kind == "camera":
        model = comparison.trials[row.name].calibration.camera.model
        coefficients = f"Lens model {model}, {coefficients}"
    return f"{head}. {' '.join(filter(None, [coefficients, row.limits, *row.remarks]))}"


def _tabulate_values(rows: Sequence[MethodRow]) -> str:
    """Tabulate what the methods say of the camera, each with its standard deviations below it."""
    cells = [["", "method", *QUANTITIES, "shift"], ["", "", *["px"] * (len(QUANTITIES) + 1)]]
    for row in rows:
        pairs = [*(row.values.get(name) for name in QUANTITIES), row.shift]
        shown = [("-", "") if pair is None else _split_sigma(*pair) for pair in pairs]
        cells.append([_mark(row), row.name, *(value for value, _ in shown)])
        if any(sigma for _, sigma in shown):
            cells.append(["", "", *(sigma for _, sigma in shown)])
    return align_columns(cells, left=(0, 1))


def _split_sigma(value: float, sigma: float) -> tuple[str, str]:
    """Format a value and its "± sigma", which are of equal decimals."""
    text, _, width = format_with_sigma(value, sigma).partition(" ± ")
    return text, f"± {width}" if width else ""


def _tabulate_errors(rows: Sequence[MethodRow]) -> str:
    """Tabulate what the methods leave, what they take, and how far they are from the chosen."""
    head = ["", "method", "RMS", "sigma", "unseen", "time", "steps", "differs", "worst"]
    units = ["", "", "px", "px", "RMS px", "s", "", "RMS px", "px"]
    cells = [
        [
            _mark(row),
            row.name,
            format_length(row.rms),
            format_length(row.sigma),
            format_length(row.unseen),
            "-" if math.isnan(row.seconds) else f"{row.seconds:.2g}",
            "-" if row.iterations is None else str(row.iterations),
            format_length(row.difference_rms),
            format_length(row.difference_worst),
        ]
        for row in rows
    ]
    return align_columns([head, units, *cells], left=(0, 1))


def format_length(length: float) -> str:
    """Format a length in px with four significant digits, at most four decimals; "-" if unknown."""
    if math.isnan(length):
        return "-"
    return f"{length:.{4 if length < 1 else 3 if length < 10 else 2}f}"


def _mark(row: MethodRow) -> str:
    return "*" * (row.kind == "lines")
