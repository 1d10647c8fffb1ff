"""Injecting a fault, calibrating, and judging what is said of it."""

from __future__ import annotations

import zlib
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from calibgui.engine.assessment.causes.findings import list_findings
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from tests.faults.causes import CLEAN, FAULTS, Fault
from tests.faults.sets import FaultySet

MAX_DEVIATION = 3.0
"""Distance from the truth, in standard deviations of its own, beyond which an answer is wrong."""


class Verdict(StrEnum):
    """What is said of a fault."""

    RIGHT = "right"
    """The first finding, or the error, names the fault; of a clean set, there is no finding."""
    WRONG = "wrong"
    """Another cause is named first."""
    HARMLESS = "harmless"
    """Nothing is said, and every intrinsic is within `MAX_DEVIATION` of the truth."""
    SILENT = "SILENT"
    """Nothing is said, and an intrinsic is beyond `MAX_DEVIATION` of the truth."""
    FALSE_ALARM = "false alarm"
    """Something is said of a clean set."""


@dataclass(frozen=True)
class Answer:
    """What one calibration said of the fault in its views."""

    fault: str
    seed: int
    verdict: Verdict
    story: str
    """What was injected."""
    said: tuple[str, ...]
    """The findings, the most harmful first, or the error."""
    deviation: float
    """Largest distance of an intrinsic from the truth, in standard deviations; NaN if none."""


def examine_fault(name: str, seed: int) -> Answer:
    """Inject a fault, calibrate, and judge what is said."""
    fault, made = FAULTS[name], inject_fault(name, seed)
    options: Mapping[str, Any] = made.options
    try:
        calibration = calibrate(made.views, made.size, **options)
        findings = list_findings(calibration, made.views)
    except CalibrationError as error:
        verdict = _judge_error(fault, str(error))
        return Answer(name, seed, verdict, made.story, (f"error: {error}",), float("nan"))
    deviation = measure_deviation(calibration, made)
    causes = [finding.cause.value for finding in findings]
    said = tuple(f"{f.cause.value} ({f.harm:.2g} px): {f.message}" for f in findings)
    return Answer(name, seed, judge_causes(fault, causes, deviation), made.story, said, deviation)


def inject_fault(name: str, seed: int) -> FaultySet:
    """Inject a fault. A seed always makes the same views."""
    return FAULTS[name].inject(np.random.default_rng([zlib.crc32(name.encode()), seed]))


def _judge_error(fault: Fault, text: str) -> Verdict:
    if fault is FAULTS[CLEAN]:
        return Verdict.FALSE_ALARM
    named = any(word in text.lower() for word in fault.words)
    return Verdict.RIGHT if named else Verdict.WRONG


def judge_causes(fault: Fault, causes: list[str], deviation: float) -> Verdict:
    """Judge the causes that are named, the most harmful first."""
    if fault is FAULTS[CLEAN] and causes:
        return Verdict.FALSE_ALARM
    if causes:
        return Verdict.RIGHT if causes[0] in fault.causes else Verdict.WRONG
    if not deviation <= MAX_DEVIATION:
        return Verdict.SILENT
    return Verdict.RIGHT if fault is FAULTS[CLEAN] else Verdict.HARMLESS


def measure_deviation(calibration: Calibration, made: FaultySet) -> float:
    """Measure the largest distance of an estimated intrinsic from the truth, in its own sigmas.

    Of a lens of another model only focal lengths and centre compare. Parameters that are held, or
    reported as undetermined, are left out.
    """
    truth: Camera = made.truth
    camera = calibration.camera
    count = len(camera.params) if camera.model == truth.model else 4
    sigma = calibration.sigma[:count]
    estimated = sigma > 0
    difference = np.abs(camera.params[:count] - truth.params[:count])[estimated]
    return float(np.max(difference / sigma[estimated]))


def run_campaign(draws: int, names: Iterable[str] = FAULTS) -> list[Answer]:
    """Examine `draws` draws of each fault."""
    return [examine_fault(name, seed) for name in names for seed in range(draws)]


def count_verdicts(answers: Iterable[Answer]) -> Counter[Verdict]:
    """Count how often each verdict fell."""
    return Counter(answer.verdict for answer in answers)


def make_table(
    answers: list[Answer], peers: Mapping[str, tuple[float, float]] | None = None
) -> str:
    """Make the manual's table in Markdown: a row for each fault, one for all, one for clean sets.

    A clean set has no cause: another one is named where it raises an alarm.

    Args:
        answers: the answers.
        peers: for each fault the shares of wrong answers of OpenCV and mrcal, NaN where none ends.
    """
    head = ["fault", "named", "harmless, not named", "another cause named", "wrong in silence"]
    head += [] if peers is None else ["OpenCV wrong", "mrcal wrong"]
    rows = [head, ["---", *["--:"] * (len(head) - 1)]]
    names = list(dict.fromkeys(answer.fault for answer in answers))
    faults = [name for name in names if name != CLEAN]
    for title, chosen in [
        *((name, [name]) for name in faults),
        ("**all**", faults),
        *((name, [name]) for name in names if name == CLEAN),
    ]:
        if not chosen:
            continue
        shares = _compute_shares([answer for answer in answers if answer.fault in chosen])
        if peers is not None:
            shares += [
                _compute_mean(each) for each in zip(*(peers[name] for name in chosen), strict=True)
            ]
        rows.append([title, *("-" if np.isnan(share) else f"{share:.0%}" for share in shares)])
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _compute_mean(shares: Iterable[float]) -> float:
    """Compute the mean of those that are not NaN; NaN if all are."""
    known = [share for share in shares if not np.isnan(share)]
    return float(np.mean(known)) if known else np.nan


def _compute_shares(answers: list[Answer]) -> list[float]:
    """Compute the shares of a row of answers; NaN for the name of the fault of clean sets."""
    counts, is_clean = count_verdicts(answers), answers[0].fault == CLEAN
    named, harmless = counts[Verdict.RIGHT], counts[Verdict.HARMLESS]
    wrong = counts[Verdict.WRONG] + counts[Verdict.FALSE_ALARM]
    found = [np.nan, named] if is_clean else [named, harmless]
    return [count / len(answers) for count in [*found, wrong, counts[Verdict.SILENT]]]
