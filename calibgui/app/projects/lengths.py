"""The length of the squares of a project's board is stated here, and confirmed.

No pixel depends on it, so that the results of the same board are scaled and not made anew, with
their verdicts and with what was said of them.
"""

from __future__ import annotations

import re
from dataclasses import replace
from types import MappingProxyType

from calibgui.app.projects.project import Project
from calibgui.dataset import Result
from calibgui.dataset.judging import keep_verdict, recall_verdict
from calibgui.engine.assessment import Verdict
from calibgui.engine.boards import KINDS, Board, Charuco, Circles, Pattern
from calibgui.engine.calibration import has_own_lengths, scale_lengths
from calibgui.engine.errors import CalibrationError

_LENGTH = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?(?= mm\b)")


def set_square(project: Project, square: float) -> Project:
    """Return the project with squares (or distances of circles) of `square` mm, in its results too.

    Markers and circles keep their size, or become unknown if they do not fit. The user has stated
    the length: it needs no confirmation. Results from other squares, or for which other lengths
    were stated, stay as they are. The length stays as uncertain as it was, unless it is shorter.
    """
    pattern = scale_pattern(project.pattern, project.square / square)
    sigma = project.square_sigma if project.square_sigma < square else 0.0
    after = replace(
        project, square=square, square_sigma=sigma, pattern=pattern, lengths_confirmed=True
    )
    return _scale_results(after, project.square)


def set_square_sigma(project: Project, sigma: float) -> Project:
    """Return the project with squares whose side has a standard deviation of `sigma` mm, in its
    results too. Raises CalibrationError if the side is no longer than that."""
    if project.board is not None:
        replace(project.board, square_sigma=sigma)  # refuses what cannot be
    return _scale_results(replace(project, square_sigma=sigma), project.square)


def _scale_results(project: Project, square: float) -> Project:
    """Return the project with its board's squares in its results that had those of `square` mm."""
    results = {
        name: scale_result(result, project.square, project.square_sigma)
        if result.board is not None and result.board.square == square
        else result
        for name, result in project.results.items()
    }
    return replace(project, results=MappingProxyType(results))


def scale_result(result: Result, square: float, square_sigma: float = 0.0) -> Result:
    """Return a result with squares of `square` mm, with their standard deviation; the same one if
    it has them, or if it would be another with them, as other lengths were stated."""
    board = result.board
    if board is not None and board.square == square and board.square_sigma != square_sigma:
        return replace(result, board=replace(board, square_sigma=square_sigma))
    if (
        board is None
        or board.square == square
        or has_own_lengths(result.calibration)
        or any(view.points is not None for view in result.used)
    ):
        return result
    ratio = square / board.square
    calibration = scale_lengths(result.calibration, ratio)
    scaled = replace(
        result,
        calibration=replace(
            calibration, warnings=tuple(_scale_text(text, ratio) for text in calibration.warnings)
        ),
        board=Board(
            board.rows,
            board.cols,
            square,
            scale_pattern(board.pattern, 1 / ratio),
            square_sigma,
        ),
        lengths_confirmed=True,
        improvements=tuple(_scale_text(text, ratio) for text in result.improvements),
    )
    if (verdict := recall_verdict(result)) is not None:
        keep_verdict(scaled, _scale_verdict(verdict, ratio))
    return scaled


def _scale_verdict(verdict: Verdict, ratio: float) -> Verdict:
    """Return a verdict with all lengths `ratio` times as long."""
    return replace(
        verdict,
        reason=_scale_text(verdict.reason, ratio),
        mm_per_pixel=ratio * verdict.mm_per_pixel,
        distance=ratio * verdict.distance,
        findings=tuple(
            replace(
                finding,
                message=_scale_text(finding.message, ratio),
                evidence=_scale_text(finding.evidence, ratio),
                remedy=_scale_text(finding.remedy, ratio),
            )
            for finding in verdict.findings
        ),
    )


def _scale_text(text: str, ratio: float) -> str:
    """Return a sentence with the lengths in it, mm, `ratio` times as long."""
    return _LENGTH.sub(lambda length: f"{float(length[0]) * ratio:.3g}", text)


def confirm_lengths(project: Project) -> Project:
    """Return the project with its squares as long as they are said to be, in the results too."""
    results = {
        name: replace(result, lengths_confirmed=True)
        if result.board is not None and result.board.square == project.square
        else result
        for name, result in project.results.items()
    }
    return replace(project, lengths_confirmed=True, results=MappingProxyType(results))


def scale_pattern(pattern: Pattern, ratio: float) -> Pattern:
    """Return the pattern with its own lengths, in squares, times `ratio`; unknown if these do not
    fit the squares."""
    try:
        if isinstance(pattern, Charuco) and pattern.marker is not None:
            return replace(pattern, marker=pattern.marker * ratio)
        if isinstance(pattern, Circles) and pattern.diameter is not None:
            return replace(pattern, diameter=pattern.diameter * ratio)
    except CalibrationError:
        return KINDS[pattern.kind]
    return pattern
