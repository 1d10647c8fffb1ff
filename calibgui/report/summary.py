"""Summary of a calibration in plain sentences: its basis, its quality, and advice.

How well a parameter is determined is judged by what its standard deviation does to the image:
a focal length or centre is good to 0.1 % of itself or of the image's width; a lens coefficient
counts if it can be told from zero. The advice on what to photograph is in ``advice``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations

import numpy as np

from calibgui.dataset import Result
from calibgui.dataset.judging import judge_result
from calibgui.engine.assessment import (
    MIN_HARM_PX,
    MIN_VIEWS_TO_BE_GOOD,
    REMEDY_OF_LENS,
    ActionKind,
    Cause,
    ErrorSources,
    Finding,
    Grade,
    separate_error_sources,
    summarise_residuals,
)
from calibgui.engine.boards import BoardShape
from calibgui.engine.calibration import Calibration, Status, compute_correlations, is_in_one_spot
from calibgui.report import advice, partial
from calibgui.report.boards import name_point
from calibgui.report.lens_models import get_short_lens_title
from calibgui.report.names import shorten_name
from calibgui.report.numbers import format_count, format_with_sigma
from calibgui.report.verdict import describe_reason, format_headline

_MAX_GOOD_RELATIVE_SIGMA = 1e-3
"""Relative standard deviation of a length below which it counts as well determined."""
_MIN_POOR_RELATIVE_SIGMA = 5e-3
"""Relative standard deviation of a length above which it counts as badly determined."""
_MIN_SIGMAS_FROM_ZERO = 2.0
"""Ratio of a lens coefficient to its sigma, below which it is not told from zero."""
_MIN_OFF_SQUARE, _MIN_SIGMAS_OFF_SQUARE = 5e-3, 4.0
"""Differences of fy/fx from 1 above which pixels are not square: by itself, beyond what rounding a
size to whole pixels does, and over its sigma. In real sets that nobody scaled it was at most 0.004
and 1.4 sigmas, or 0.002 and 4.8."""
_MIN_STRONG_CORRELATION = 0.98
"""Correlation above which two lens coefficients are named as exchangeable."""
_MAX_RMS_OVER_MEDIAN = 2.5
"""Ratio of a view's RMS to the median of all, above which it is named."""
_MAX_CHANCE_RATIO = 1.3
"""Ratio of a board's deviation to its sigma, below which it may be none."""
_MISLEADING = {Cause.WRONG_FRAME, Cause.HELD_VALUE, Cause.MISPLACED_CORNERS}
"""Causes whose residuals look like those of a lens that is not followed."""
_UNTRUSTWORTHY = {*_MISLEADING, Cause.LENS, Cause.FEW_VIEWS}
"""Causes beside which no value is called well determined."""
_LIKE_UNEQUAL_PIXELS = {*_UNTRUSTWORTHY, Cause.BOARD_SHAPE, Cause.MIXED_VIEWS}
"""Causes that may make fx and fy unequal, or of which nothing is known beside them."""


class Tone(StrEnum):
    """Purpose of a sentence."""

    FACT = "fact"
    GOOD = "good"
    CAUTION = "caution"
    ADVICE = "advice"


@dataclass(frozen=True, slots=True)
class Sentence:
    """One statement about a calibration."""

    tone: Tone
    """Its purpose."""
    text: str
    """The sentence, or a few."""
    cause: Cause | None = None
    """The cause of the finding that it is about, if it is about one."""


def describe_calibration(
    result: Result, check: Callable[[], None] | None = None
) -> tuple[Sentence, ...]:
    """Describe the calibration in words: first the verdict, then the most important.

    Args:
        result: the calibration with its views.
        check: a function that is called now and then, and raises to abandon the work.
    """
    verdict = judge_result(result, check)
    tone = Tone.GOOD if verdict.grade is Grade.GOOD else Tone.CAUTION
    headline = f"{format_headline(verdict)}."
    if not verdict.findings:  # they say why themselves
        headline += f" {describe_reason(verdict, result)}"
    first = Sentence(tone, headline)
    return first, *_describe_in_detail(result, verdict.findings)


def _describe_in_detail(result: Result, findings: Sequence[Finding]) -> Iterator[Sentence]:
    """Describe all that is known of the calibration, the most important first."""
    yield from _describe_basis(result)
    if lost := describe_lost_images(result):
        yield Sentence(Tone.CAUTION, lost)
    yield from _describe_diagnosis(result)
    yield from _describe_ending(result, findings)
    if result.condition:
        yield Sentence(Tone.FACT, f"All lengths hold {result.condition}: nobody has confirmed it.")
    yield from _describe_findings(findings)
    yield from _describe_sources(result, findings)
    yield from _describe_board(result, findings)
    yield from _describe_fit(result)
    yield from _describe_parameters(result, findings)
    if unequal := describe_unequal_pixels(result.calibration, findings):
        yield Sentence(Tone.CAUTION, unequal)
    yield from _describe_correlations(result)
    yield from _describe_outlying_views(result, findings)
    yield from _describe_advice(result, findings)


def _describe_basis(result: Result) -> Iterator[Sentence]:
    """Describe how many views and corners were used."""
    used = len(result.used)
    corners = sum(len(view.image) for view in result.calibration.residuals)
    points = format_count(corners, name_point(result.board))
    text = f"Calibrated from {format_count(used, 'view')} with {points}"
    left_out = len(result.views) - used
    text += f"; {format_count(left_out, 'image')} left out." if left_out else ", every image used."
    if outliers := describe_outliers(result):
        text += f" {outliers[:1].upper()}{outliers[1:]}."
    yield Sentence(Tone.FACT, text)


def describe_lost_images(result: Result) -> str:
    """Say that a calibration lacks views because most images cannot be used; empty if not so."""
    count, used = len(result.views), len(result.used)
    lost = sum(view.enabled and not view.usable for view in result.views)
    if used >= MIN_VIEWS_TO_BE_GOOD or lost <= count / 2:
        return ""
    return (
        f"{lost} of {count} images cannot be used, for reasons stated with them: mend that before "
        "you take others."
    )


def _describe_diagnosis(result: Result) -> Iterator[Sentence]:
    """Describe why the views do not determine the camera, or only for a part of the image."""
    calibration = result.calibration
    uv = np.concatenate([view.uv for view in result.observations()])
    if (diagnosis := calibration.diagnosis) is not None:
        yield Sentence(Tone.CAUTION, f"A partial calibration. {diagnosis.message}")
        yield Sentence(Tone.ADVICE, diagnosis.hint)
        yield Sentence(Tone.CAUTION, partial.describe_assumptions(diagnosis))
        if partial.is_scale_assumed(diagnosis):
            yield Sentence(Tone.GOOD, partial.describe_aspect_ratio(calibration))
    elif is_in_one_spot(uv, calibration.camera.size):
        yield Sentence(
            Tone.CAUTION,
            "All corners lie in one spot of the image: what is said of the lens elsewhere is "
            "extrapolated from there.",
        )


def _describe_ending(result: Result, findings: Sequence[Finding]) -> Iterator[Sentence]:
    """Describe what made the camera better, how the solve ended, and its warnings."""
    calibration = result.calibration
    for improvement in result.improvements:
        yield Sentence(Tone.FACT, improvement)
    if calibration.status is Status.STOPPED:
        yield Sentence(
            Tone.CAUTION,
            "The solve was stopped before it converged: these are the best values so far. "
            "Calibrate again for final ones.",
        )
    elif calibration.status is Status.MAX_ITERATIONS:
        yield _state_fault(
            findings,
            "The solve used up its iterations without converging.",
            "Allow more of them, or hold the parameters that the views do not determine.",
        )
    for warning in calibration.warnings:
        is_choice = warning == calibration.settings.model_reason
        yield Sentence(Tone.FACT if is_choice else Tone.CAUTION, warning)


def _describe_findings(findings: Sequence[Finding]) -> Iterator[Sentence]:
    """Describe what is wrong and what to do, except for lens and board, which follow."""
    for finding in findings:
        if finding.cause not in (Cause.LENS, Cause.BOARD_SHAPE):
            yield Sentence(Tone.CAUTION, f"{finding.message} {finding.evidence}", finding.cause)
            yield Sentence(Tone.ADVICE, finding.remedy, finding.cause)


def describe_outliers(result: Result) -> str:
    """Say how many corners were left out as outliers; empty if all were to be kept."""
    count = result.calibration.settings.outliers
    if not count:
        return "" if count is None else "no outliers to leave out"
    return f"{format_count(count, name_point(result.board))} left out as outliers"


def is_board_shape_held(calibration: Calibration) -> bool:
    """Return whether the shape of the board was given, and not estimated."""
    return bool(calibration.settings.is_board_shape_held)


def describe_board_shape(board_shape: BoardShape) -> str:
    """Describe how far the board is from its drawing."""
    across, along, out = np.sqrt(np.mean(board_shape.deviation**2, axis=0))
    text = (
        f"The board deviates from its drawing by {board_shape.rms:.2g} mm (rms): {across:.2g} mm "
        f"along its rows, {along:.2g} mm along its columns and {out:.2g} mm out of its plane."
    )
    chance = float(np.sqrt(np.mean(np.sum(board_shape.sigma**2, axis=1))))
    if board_shape.rms < _MAX_CHANCE_RATIO * chance:
        text += f" Noise alone makes as much ({chance:.2g} mm): it may well be as drawn."
    return text


def describe_lens_error(calibration: Calibration, rms: float, does_harm: bool = True) -> str:
    """Describe that the lens model of a calibration leaves a displacement of `rms` px.

    Args:
        calibration: the calibration.
        rms: root mean square of the displacement, px.
        does_harm: whether that is more than the verdict passes over.
    """
    follows = "does not follow this lens" if does_harm else "follows this lens nearly"
    is_as_drawn = calibration.board_shape is not None and calibration.lens_error > 0
    text = (
        f"The lens model {get_short_lens_title(calibration.camera.model)} {follows}: "
        f"{'with the board as drawn, ' if is_as_drawn else ''}it leaves a "
        f"displacement of {rms:.2g} px (rms) that all views share and the board "
        "does not explain. No ± includes that: each is of the values that fit best."
    )
    if calibration.board_shape is not None:
        text += " The board's estimated shape stands in for the lens: do not rely on it."
    if not does_harm:
        return f"{text} Another lens model may be closer: compare them."
    return f"{text} {REMEDY_OF_LENS}"


def describe_error_sources(sources: ErrorSources) -> str:
    """Describe what lens, board, single views and noise contribute to the residuals."""
    causes = [
        (sources.lens, "the lens model leaves {} that it cannot follow"),
        (sources.board, "the board adds {}"),
        (sources.views, "single views add {} of their own"),
    ]
    parts = [text.format(f"{px:.2g} px") for px, text in causes if px > 0]
    if not parts:
        return (
            f"The RMS distance of {sources.rms:.3f} px looks like noise: neither lens, board nor "
            "single views explain a part of it."
        )
    listed = ", ".join(parts)
    return (
        f"Of the {sources.rms:.2g} px RMS, {listed} and noise adds {sources.noise:.2g} px (these "
        "add up in squares)."
    )


def describe_board_shape_error(rms: float) -> str:
    """Describe that the residuals suggest deviations of the board of `rms` mm."""
    return (
        f"The residuals are not noise: over the views the board's corners are off by "
        f"{rms:.2g} mm (rms), as if it were not flat or not printed true. Every ± includes "
        "what this does to the camera."
    )


def _advises(findings: Sequence[Finding], kind: ActionKind) -> bool:
    """Return whether an action of that kind is advised."""
    return any(finding.action is not None and finding.action.kind is kind for finding in findings)


def _state_fault(findings: Sequence[Finding], fault: str, remedy: str) -> Sentence:
    """Return a caution with its remedy, or the mere fact where another lens model is advised: one
    that is to be given up need not be mended, and with another the fault may be gone."""
    if _advises(findings, ActionKind.CHOOSE_LENS_MODEL):
        return Sentence(Tone.FACT, fault)
    return Sentence(Tone.CAUTION, f"{fault} {remedy}")


def describe_view_scatter(scatter: float) -> str:
    """Describe that the views disagree `scatter` times as much as the corners' noise explains."""
    return (
        f"The views disagree about the camera {scatter:.1f} times as much as the scatter of their "
        "corners explains: corners within a view share errors. Every ± is therefore what the "
        "views' disagreement shows, where that is more."
    )


def _describe_sources(result: Result, findings: Sequence[Finding]) -> Iterator[Sentence]:
    """Describe where the residuals come from, and a lens that the lens model does not follow.

    Misplaced corners look like anything; the lens is then judged without them, as a finding.
    """
    causes = {finding.cause for finding in findings}
    calibration = result.calibration
    if calibration.status is not Status.CONVERGED:
        return
    sources = separate_error_sources(calibration, result.observations())
    yield Sentence(Tone.FACT, describe_error_sources(sources))
    if Cause.LENS in causes or (sources.is_lens_at_fault and not causes & _MISLEADING):
        rms, does_harm = calibration.lens_error or sources.lens, Cause.LENS in causes
        tone = Tone.CAUTION if does_harm else Tone.FACT
        yield Sentence(tone, describe_lens_error(calibration, rms, does_harm), Cause.LENS)


def _describe_board(result: Result, findings: Sequence[Finding]) -> Iterator[Sentence]:
    """Describe the board's shape, known or suspected, and whether the views agree."""
    board_shape, error = result.calibration.board_shape, result.calibration.board_shape_error
    if error > 0:
        matters = any(finding.cause is Cause.BOARD_SHAPE for finding in findings)
        tone = Tone.CAUTION if matters else Tone.FACT
        text = describe_board_shape_error(error)
        if _advises(findings, ActionKind.ESTIMATE_BOARD_SHAPE):
            text += " Estimate the board's shape to remove it."
        yield Sentence(tone, text, Cause.BOARD_SHAPE)
    if board_shape is not None:
        held = is_board_shape_held(result.calibration)
        how = "held as it was given" if held else "estimated with the camera"
        text = f"The board's shape is {how}. {describe_board_shape(board_shape)}"
        yield Sentence(Tone.FACT, text)
    if (scatter := result.calibration.overdispersion) > 0:
        yield Sentence(Tone.FACT, describe_view_scatter(scatter))


def _describe_fit(result: Result) -> Iterator[Sentence]:
    """Describe the residuals."""
    calibration = result.calibration
    fit = summarise_residuals(calibration.residuals)
    unknowns = int(np.count_nonzero(calibration.sigma)) + 6 * len(calibration.poses)
    if calibration.diagnosis is not None:
        unknowns -= len(calibration.diagnosis.assumptions)
    if calibration.board_shape is not None:
        unknowns += int(np.count_nonzero(calibration.board_shape.sigma))
    yield Sentence(
        Tone.FACT,
        f"Corners scatter about the fitted camera with σ = {fit.sigma_x:.3f} px across and "
        f"{fit.sigma_y:.3f} px down (RMS distance {fit.rms:.3f} px; "
        f"{2 * fit.count:,} measurements, {unknowns} unknowns). "
        "A small scatter shows that the model fits; how far each value can be trusted is its ±.",
    )


def _describe_parameters(result: Result, findings: Sequence[Finding]) -> Iterator[Sentence]:
    """Describe the parameters by how well they are determined."""
    calibration = result.calibration
    camera, sigma = calibration.camera, calibration.sigma
    names = camera.names
    texts = dict(zip(names, map(format_with_sigma, camera.params, sigma), strict=True))
    scale = np.concatenate([camera.params[:2], [camera.size[0]] * 2])
    relative = dict(zip(names[:4], sigma[:4] / scale, strict=True))
    free = [n for n in names if n not in calibration.fixed]
    missing = {u.name for u in calibration.undetermined}
    if calibration.diagnosis is not None:
        missing |= {a.name for a in calibration.diagnosis.assumptions}
    if partial.is_scale_assumed(calibration.diagnosis):
        missing |= {"fx", "fy", *names[4:]}

    def listed(chosen: list[str]) -> str:
        return ", ".join(f"{name} = {texts[name]}" for name in chosen)

    left_open = any(finding.cause is Cause.UNDETERMINED for finding in findings)
    for lacking in () if left_open else calibration.undetermined:
        yield _state_fault(
            findings,
            f"{lacking.name} is not determined by these views: {lacking.reason}.",
            "Hold it, or add views that differ more from each other.",
        )
    lengths = [n for n in names[:4] if n in free and n not in missing]
    if good := [n for n in lengths if relative[n] < _MAX_GOOD_RELATIVE_SIGMA]:
        if _UNTRUSTWORTHY & {finding.cause for finding in findings}:
            yield Sentence(Tone.FACT, f"As far as the above leaves them: {listed(good)} px.")
        else:
            yield Sentence(Tone.GOOD, f"Well determined: {listed(good)} px.")
    if poor := [n for n in lengths if relative[n] > _MIN_POOR_RELATIVE_SIGMA]:
        fault = f"Badly determined: {listed(poor)} px."
        if any(finding.cause is Cause.FEW_VIEWS for finding in findings):  # which says what to do
            yield Sentence(Tone.FACT, fault)
        else:
            yield _state_fault(
                findings,
                fault,
                "Estimate the board's shape."
                if _advises(findings, ActionKind.ESTIMATE_BOARD_SHAPE)
                else "Add views with the board tilted by 30 to 45 degrees in different directions.",
            )
    coefficients = [n for n in names[4:] if n in free and n not in missing]
    away = np.abs(camera.params) / np.where(sigma > 0, sigma, np.inf)
    if vague := [n for n in coefficients if away[names.index(n)] < _MIN_SIGMAS_FROM_ZERO]:
        yield Sentence(
            Tone.FACT,
            f"These may be 0: {listed(vague)}. They may be held there; to measure them, "
            + (
                "estimate the board's shape."
                if _advises(findings, ActionKind.ESTIMATE_BOARD_SHAPE)
                else "bring corners closer to the image's edges."
            ),
        )


def describe_unequal_pixels(calibration: Calibration, findings: Sequence[Finding]) -> str:
    """Describe pixels that are not square; empty if they are, or if what is wrong may look so.

    Unequal squares of the board look so, but the ± includes that: of boards stretched by 0.5 to
    2 %, in 6 or 14 views that were tilted or hardly, fy/fx was at most 1 sigma from 1, or the board
    or too few views were a finding.
    """
    ratio, sigma = partial.compute_aspect_ratio(calibration)
    off = abs(ratio - 1)
    is_held = bool({"fx", "fy"} & {*calibration.fixed}) or calibration.diagnosis is not None
    is_open = is_held or bool(_LIKE_UNEQUAL_PIXELS & {finding.cause for finding in findings})
    if is_open or off <= max(_MIN_OFF_SQUARE, _MIN_SIGMAS_OFF_SQUARE * sigma):
        return ""
    return (
        f"The pixels are not square, fy/fx = {format_with_sigma(ratio, sigma)}: so are those of "
        "anamorphic lenses and of PAL and NTSC video, and `calibgui undistort --square-pixels` "
        "makes them square. If a program has scaled the images, take them as the camera writes "
        "them."
    )


def _describe_correlations(result: Result) -> Iterator[Sentence]:
    """Describe pairs of lens coefficients of which only a combination is determined."""
    calibration = result.calibration
    names = calibration.camera.names
    matrix = compute_correlations(calibration.covariance)
    pairs = [
        f"{names[i]} and {names[j]} ({matrix[i, j]:+z.3f})"
        for i, j in combinations(range(4, len(names)), 2)
        if abs(matrix[i, j]) > _MIN_STRONG_CORRELATION
    ]
    if pairs:
        yield Sentence(
            Tone.FACT,
            f"Strongly correlated: {', '.join(pairs)}. Only their combination is known well, "
            "so do not compare them one by one.",
        )


def _describe_outlying_views(result: Result, findings: Sequence[Finding]) -> Iterator[Sentence]:
    """Name the views that fit much worse than the others, if they are not named already."""
    named = {k for finding in findings for k in finding.views}
    for k in find_outlying_views(result.calibration):
        if k in named:
            continue
        name = shorten_name(result.used[k].image)
        rms = result.calibration.residuals[k].rms
        yield _state_fault(
            findings,
            f"{name} fits much worse than the others ({rms:.3f} px).",
            "Look at its corners, or exclude it.",
        )


def find_outlying_views(calibration: Calibration) -> tuple[int, ...]:
    """Find the indices of the calibrated views whose RMS is far above the median, and matters."""
    rms = np.array([view.rms for view in calibration.residuals])
    least = max(_MAX_RMS_OVER_MEDIAN * float(np.median(rms)), MIN_HARM_PX)
    return tuple(int(k) for k in np.flatnonzero(rms > least))


def _describe_advice(result: Result, findings: Sequence[Finding]) -> Iterator[Sentence]:
    """Describe what to photograph to improve the calibration, if nothing is to be mended first."""
    if _UNTRUSTWORTHY & {finding.cause for finding in findings} - {Cause.FEW_VIEWS}:
        return
    texts = advice.advise_photographs(result)
    for text in texts:
        yield Sentence(Tone.ADVICE, f"To improve it, {text}.")
    calibration = result.calibration
    if not (texts or findings or calibration.board_shape_error > 0):
        yield Sentence(
            Tone.GOOD,
            "The views cover sensor, tilts and distances; four times as many of the same kind "
            "would halve every ±.",
        )
