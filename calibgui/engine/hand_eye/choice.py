"""The choice of the reading of the robot's poses, and of their order, that fits the photographs.

Every reading is tried both as base_from_hand and inverted, and with its poses one place later or
earlier than the photographs. In the right one the board scatters by millimetres, in others by as
much as the robot has moved (``closed_form.py``).

H^-1 in place of H exchanges base and hand: a camera that stands, before a board in the hand, is a
camera in the hand of a robot whose poses are inverted. Robots state base_from_hand, which tells the
two apart unless the user says which of them it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.hand_eye.closed_form import ClosedForm, measure_scale, solve_closed_form
from calibgui.engine.hand_eye.motions import Motions
from calibgui.engine.hand_eye.readings import Reading

MIN_POSES = 3
"""Number of poses that tell the motions of two axes."""
_MAX_SCATTER = 0.05
"""Scatter over the distance of camera and board from which poses do not fit: a plausibility limit,
30 mm at 60 cm."""
_CLEARLY = 2.0
"""Ratio of scatters from which one reading is better than another: right ones have ratios beyond
10, and equal ones of 1."""
_LEAST_SCATTER_MM = 1e-6
"""Scatter below which there is nothing to explain, mm: rounding."""
_CHANCE = 1e-4
"""Chance of a board of the stated size to be refused."""
_MAX_SHIFTED = 10
"""Number of readings that are tried in a shifted order where one of them fits as it is: in smooth
motions that one fits nearly."""


class Choice(NamedTuple):
    """The reading that fits."""

    reading: Reading
    is_inverted: bool
    """True if H_k of ``closed_form.py`` is the inverse of the reading's poses."""
    shift: int
    """Number of places by which poses come before their photographs: photograph k has the pose of
    row k - shift."""
    start: ClosedForm
    next_best: float
    """Scatter, mm, of the best other one."""
    rivals: tuple[str, ...]
    """Readings, in words, that fit as well."""

    def pair(self, count: int) -> tuple[slice, slice]:
        """Return which of `count` photographs and of as many poses make the pairs."""
        return _pair(self.shift, count)


def _pair(shift: int, count: int) -> tuple[slice, slice]:
    return slice(max(shift, 0), count + min(shift, 0)), slice(max(-shift, 0), count - max(shift, 0))


def choose_reading(
    readings: Sequence[Reading], boards: Motions, points: Array, eye_in_hand: bool | None
) -> Choice:
    """Choose the reading with which the board scatters least.

    Args:
        readings: what the robot's poses may be, likely ones first.
        boards: (K,) cam_from_board.
        points: (n, 3) points of the board, mm.
        eye_in_hand: whether the camera is in the hand; None if it is not known.

    Raises:
        CalibrationError: if none fits, or if the board is of another size than stated.
    """
    tried = [each for reading in readings for each in _try(reading, 0, boards, points)]
    likely = sorted(tried, key=lambda each: each[0])[:_MAX_SHIFTED]
    distance = float(np.linalg.norm(boards.t, axis=1).mean())
    fits = likely[0][1].start.scatter <= _MAX_SCATTER * distance
    shifted = [choice.reading for _, choice in likely] if fits else readings
    for shift in (1, -1):
        if len(boards.R) > MIN_POSES:
            tried += [each for reading in shifted for each in _try(reading, shift, boards, points)]
    best = min(merit for merit, _ in tried)
    # Among equals the first: likely readings come first.
    at = next(
        k for k, (merit, _) in enumerate(tried) if merit <= best * (1 + 1e-6) + _LEAST_SCATTER_MM
    )
    merit, choice = tried.pop(at)
    if choice.start.scatter > _MAX_SCATTER * distance:
        raise CalibrationError(
            "The robot's poses do not fit the photographs, however they are read: at best the "
            f"board scatters by {choice.start.scatter:.0f} mm in the robot's frame.",
            "Check that they are the poses of these photographs in this order, and that board and "
            "camera stayed fixed, one to the hand and the other to the base.",
        )
    others = [(m, other) for m, other in tried if other.shift == choice.shift]
    rivals = [
        _describe(other, eye_in_hand)
        for m, other in others
        if m < _CLEARLY * merit + _LEAST_SCATTER_MM
    ]
    next_best = min((other.start.scatter for _, other in others), default=np.inf)
    _check_lengths(choice, boards, points)
    return choice._replace(next_best=next_best, rivals=tuple(rivals))


def _try(
    reading: Reading, shift: int, boards: Motions, points: Array
) -> list[tuple[float, Choice]]:
    """Try a reading both ways; return how badly each fits, mm, with it.

    That is the scatter, but few poses fit better by themselves, as 12 of their 6 K numbers are
    fitted, and a shifted order has to be clearly better.
    """
    photographs, rows = _pair(shift, len(boards.R))
    poses, seen = reading.poses.select(rows), boards.select(photographs)
    numbers = 6 * len(seen.R)
    handicap = np.sqrt(numbers / max(numbers - 12, 1)) * (_CLEARLY if shift else 1.0)
    tried = []
    for is_inverted in (False, True):
        start = solve_closed_form(poses.invert() if is_inverted else poses, seen, points)
        choice = Choice(reading, is_inverted, shift, start, np.inf, ())
        tried.append((float(handicap * start.scatter), choice))
    return tried


def _check_lengths(choice: Choice, boards: Motions, points: Array) -> None:
    """Refuse a board that is of another size than stated, by an F-test of the scatters.

    Raises:
        CalibrationError: if a board that is larger or smaller fits better, and not by chance.
    """
    photographs, rows = choice.pair(len(boards.R))
    poses, seen = choice.reading.poses.select(rows), boards.select(photographs)
    robot = poses.invert() if choice.is_inverted else poses
    scale, other = 1.0, choice.start
    for _ in range(2):  # the first rotation may be that of boards of a wrong size
        scale = measure_scale(other.X.R, robot, seen)
        other = solve_closed_form(robot, Motions(seen.R, scale * seen.t), scale * points)
    freedom = 3 * len(seen.R) - 7
    gain = choice.start.scatter**2 - other.scatter**2
    ratio = freedom * gain / (other.scatter**2 + _LEAST_SCATTER_MM**2)
    if scipy.special.fdtrc(1, freedom, ratio) < _CHANCE:
        raise CalibrationError(
            f"By the robot's motions the board's squares are {scale:.3g} times as long as stated.",
            "State the side of a square as it was printed.",
        )


def _describe(choice: Choice, eye_in_hand: bool | None) -> str:
    """Describe a reading with what its poses map, or with where the camera is."""
    return f"{choice.reading.words}, {describe_direction(choice.is_inverted, eye_in_hand)}"


def describe_direction(is_inverted: bool, eye_in_hand: bool | None) -> str:
    """Describe what poses map, or, if it is not known where the camera is, that."""
    if eye_in_hand is None:
        return "camera beside the robot" if is_inverted else "camera in the hand"
    return "base from hand" if is_inverted is not eye_in_hand else "hand from base"
