"""A calibration in plain sentences: what it rests on, how good it is, what would improve it.

How well a parameter is determined is judged by what its standard deviation does to the image:
a focal length or centre is good to 0.1 % of itself or of the image's width; a lens coefficient
counts if it can be told from zero. What to photograph: ``advice``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations

import numpy as np

from calibgui.dataset.result import Result
from calibgui.engine.assessment import summarise
from calibgui.engine.boards import BoardShape
from calibgui.engine.calibration import Calibration, Status, correlations, in_one_spot
from calibgui.report import advice, partial
from calibgui.report.numbers import counted, with_sigma
from calibgui.report.words import short_name

_GOOD = 1e-3
_POOR = 5e-3
"""Relative standard deviation below which a length counts as well, above which as badly known."""
_TOLD_FROM_ZERO = 2.0
"""Standard deviations that a lens coefficient must be away from zero."""
_TRADED = 0.98
"""Correlation above which two lens coefficients are said to stand in for each other."""
_OUTLYING = 2.5
"""A view's RMS over the median of all, above which it is named."""
_STRIKING = 1.5
"""Times that the views disagree more than noise explains, above which it asks for attention."""
_BY_CHANCE = 1.3
"""A plate's deviation over its standard deviation below which it may be none."""


class Tone(StrEnum):
    """What a sentence is for."""

    FACT = "fact"
    GOOD = "good"
    CAUTION = "caution"
    ADVICE = "advice"


@dataclass(frozen=True, slots=True)
class Sentence:
    """One statement about a calibration."""

    tone: Tone
    text: str


def summary(result: Result) -> tuple[Sentence, ...]:
    """The calibration in words, the most important first."""
    return tuple(
        sentence
        for part in (
            _basis,
            _diagnosed,
            _ending,
            _board_shape,
            _fit,
            _determined,
            _correlated,
            _outlying,
            _advice,
        )
        for sentence in part(result)
    )


def _basis(result: Result) -> Iterator[Sentence]:
    used = len(result.used)
    corners = sum(len(view.image) for view in result.calibration.residuals)
    text = f"Calibrated from {counted(used, 'view')} with {counted(corners, 'corner')}"
    left_out = len(result.views) - used
    text += f"; {counted(left_out, 'image')} left out." if left_out else ", every image used."
    yield Sentence(Tone.FACT, text)


def _diagnosed(result: Result) -> Iterator[Sentence]:
    """Why the views do not determine the camera, or only a part of the image."""
    calibration = result.calibration
    uv = np.concatenate([view.uv for view in result.observations()])
    if (diagnosis := calibration.diagnosis) is not None:
        yield Sentence(Tone.CAUTION, f"A partial calibration. {diagnosis.message}")
        yield Sentence(Tone.ADVICE, diagnosis.hint)
        yield Sentence(Tone.CAUTION, partial.about_assumed(diagnosis))
        if partial.scale_assumed(diagnosis):
            yield Sentence(Tone.GOOD, partial.about_determined(calibration))
    elif in_one_spot(uv, calibration.camera.size):
        yield Sentence(
            Tone.CAUTION,
            "All corners lie in one spot of the image: what is said of the lens elsewhere is "
            "extrapolated from there.",
        )


def _ending(result: Result) -> Iterator[Sentence]:
    calibration = result.calibration
    if calibration.status is Status.STOPPED:
        yield Sentence(
            Tone.CAUTION,
            "The solve was stopped before it converged: these are the best values so far. "
            "Calibrate again for final ones.",
        )
    elif calibration.status is Status.MAX_ITERATIONS:
        yield Sentence(
            Tone.CAUTION,
            "The solve used up its iterations without converging. Allow more of them, or hold "
            "the parameters that the views do not determine.",
        )
    for warning in calibration.warnings:
        yield Sentence(Tone.CAUTION, warning)


def about_board_shape(board_shape: BoardShape) -> str:
    """How far the board is from its drawing."""
    across, along, out = np.sqrt(np.mean(board_shape.deviation**2, axis=0))
    text = (
        f"The board deviates from its drawing by {board_shape.rms:.2g} mm (rms): {across:.2g} mm "
        f"along its rows, {along:.2g} mm along its columns and {out:.2g} mm out of its plane."
    )
    chance = float(np.sqrt(np.mean(np.sum(board_shape.sigma**2, axis=1))))
    if board_shape.rms < _BY_CHANCE * chance:
        text += f" Noise alone makes as much ({chance:.2g} mm): it may well be as drawn."
    return text


def about_board_shape_error(doubt: float) -> str:
    """That the residuals of a nominal plate suspect it of deviations of `doubt` mm rms."""
    return (
        f"The residuals are not noise: over the views the board's corners are off by "
        f"{doubt:.2g} mm (rms), as if it were not flat or not printed true. Every ± includes "
        "what this does to the camera. Estimate the plate to remove it."
    )


def about_view_scatter(scatter: float) -> str:
    """That the views disagree `scatter` times as much as the corners' noise explains."""
    return (
        f"The views disagree about the camera {scatter:.1f} times as much as the scatter of their "
        "corners explains: the errors within a view hang together. Every ± is therefore what the "
        "views' disagreement shows, where that is more."
    )


def _board_shape(result: Result) -> Iterator[Sentence]:
    """What is known, or suspected, of the board's shape, and whether the views agree."""
    board_shape, doubt = result.calibration.board_shape, result.calibration.board_shape_error
    if doubt > 0:
        yield Sentence(Tone.CAUTION, about_board_shape_error(doubt))
    if board_shape is not None:
        yield Sentence(Tone.FACT, about_board_shape(board_shape))
    if (scatter := result.calibration.view_scatter) > 0:
        tone = Tone.CAUTION if scatter > _STRIKING else Tone.FACT
        yield Sentence(tone, about_view_scatter(scatter))


def _fit(result: Result) -> Iterator[Sentence]:
    calibration = result.calibration
    fit = summarise(calibration.residuals)
    unknowns = int(np.count_nonzero(calibration.sigma)) + 6 * len(calibration.poses)
    if calibration.diagnosis is not None:
        unknowns -= len(calibration.diagnosis.assumed)
    if calibration.board_shape is not None:
        unknowns += int(np.count_nonzero(calibration.board_shape.sigma))
    yield Sentence(
        Tone.FACT,
        f"Corners scatter about the fitted camera with σ = {fit.sigma_x:.3f} px across and "
        f"{fit.sigma_y:.3f} px down (RMS distance {fit.rms:.3f} px; "
        f"{2 * fit.count:,} measurements, {unknowns} unknowns). "
        "A small scatter shows that the model fits; how far each value can be trusted is its ±.",
    )


def _determined(result: Result) -> Iterator[Sentence]:
    """The parameters by how well they are known."""
    calibration = result.calibration
    camera, sigma = calibration.camera, calibration.sigma
    names = camera.names
    texts = dict(zip(names, map(with_sigma, camera.params, sigma), strict=True))
    scale = np.concatenate([camera.params[:2], [camera.size[0]] * 2])
    relative = dict(zip(names[:4], sigma[:4] / scale, strict=True))
    free = [n for n in names if n not in calibration.fixed]
    missing = {u.name for u in calibration.undetermined}
    if calibration.diagnosis is not None:
        missing |= {a.name for a in calibration.diagnosis.assumed}
    if partial.scale_assumed(calibration.diagnosis):
        missing |= {"fx", "fy", *names[4:]}

    def listed(chosen: list[str]) -> str:
        return ", ".join(f"{name} = {texts[name]}" for name in chosen)

    for lacking in calibration.undetermined:
        yield Sentence(
            Tone.CAUTION,
            f"{lacking.name} is not determined by these views: {lacking.reason}. "
            "Hold it, or add views that differ more from each other.",
        )
    lengths = [n for n in names[:4] if n in free and n not in missing]
    if good := [n for n in lengths if relative[n] < _GOOD]:
        yield Sentence(Tone.GOOD, f"Well determined: {listed(good)} px.")
    if poor := [n for n in lengths if relative[n] > _POOR]:
        yield Sentence(
            Tone.CAUTION,
            f"Badly determined: {listed(poor)} px. "
            + (
                "Estimate the plate."
                if calibration.board_shape_error > 0
                else "Add views with the board tilted by 30 to 45 degrees in different directions."
            ),
        )
    coefficients = [n for n in names[4:] if n in free and n not in missing]
    away = np.abs(camera.params) / np.where(sigma > 0, sigma, np.inf)
    if vague := [n for n in coefficients if away[names.index(n)] < _TOLD_FROM_ZERO]:
        yield Sentence(
            Tone.CAUTION,
            f"Not told from zero: {listed(vague)}. They may be held at 0; to measure them, "
            + (
                "estimate the plate."
                if calibration.board_shape_error > 0
                else "bring corners closer to the image's edges."
            ),
        )


def _correlated(result: Result) -> Iterator[Sentence]:
    """Pairs of lens coefficients of which only a combination is known."""
    calibration = result.calibration
    names = calibration.camera.names
    matrix = correlations(calibration.covariance)
    pairs = [
        f"{names[i]} and {names[j]} ({matrix[i, j]:+.3f})"
        for i, j in combinations(range(4, len(names)), 2)
        if abs(matrix[i, j]) > _TRADED
    ]
    if pairs:
        yield Sentence(
            Tone.FACT,
            f"Strongly correlated: {', '.join(pairs)}. Only their combination is known well, "
            "so do not compare them one by one.",
        )


def _outlying(result: Result) -> Iterator[Sentence]:
    for k in outlying_views(result.calibration):
        name = short_name(result.used[k].image)
        yield Sentence(
            Tone.CAUTION,
            f"{name} fits much worse than the others ({result.calibration.residuals[k].rms:.3f} "
            "px): look at its corners, or exclude it.",
        )


def outlying_views(calibration: Calibration) -> tuple[int, ...]:
    """Indices of the calibrated views whose RMS is far above the median."""
    rms = np.array([view.rms for view in calibration.residuals])
    return tuple(int(k) for k in np.flatnonzero(rms > _OUTLYING * np.median(rms)))


def _advice(result: Result) -> Iterator[Sentence]:
    """What to photograph to improve the calibration."""
    wanted = advice.wanted(result)
    for text in wanted:
        yield Sentence(Tone.ADVICE, f"To improve it, {text}.")
    if not wanted and result.calibration.board_shape_error == 0:
        yield Sentence(
            Tone.GOOD,
            "The views cover sensor, tilts and distances; four times as many of the same kind "
            "would halve every ±.",
        )
