"""Readings of a robot's poses: all that their numbers may mean.

Every maker of robots writes poses in a way of its own, and programs that pass them on turn them
about. Here all ways are listed; which one fits is told by the photographs (``choice.py``).

Six numbers are x, y, z and either a rotation vector or three angles a, b, c, of which each of the
twelve sequences of axes makes a rotation in two orders, Rz(a) Ry(b) Rx(c) or Rz(c) Ry(b) Rx(a).
Turning about the axes of the moving frame and about fixed ones differ by that order alone. Seven
are x, y, z and a quaternion, whose real part is first or last. Twelve and sixteen are a matrix, row
by row or column by column. The rotation of a matrix or quaternion may be that from base to hand
although the place is the hand's ("transposed").
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import scipy

from calibgui.engine.arrays import Array
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.hand_eye.motions import Motions, project_on_rotations

MM_OF_UNITS = {"millimetres": 1.0, "metres": 1000.0}
_SEQUENCES = ("ZYX", "XYZ", "ZYZ", "ZXZ", "XZY", "YXZ", "YZX", "ZXY", "XYX", "XZX", "YXY", "YZY")
_MAX_SKEW = 0.02
"""Deviation from a rotation of what still is one, rounded to two digits: a plausibility limit."""


class Reading(NamedTuple):
    """A way to read the numbers of poses."""

    words: str
    """The meaning of the numbers, as "angles a, b, c of Rz(a) Ry(b) Rx(c) in degrees, metres"."""
    poses: Motions
    """(K,) base_from_hand, or hand_from_base."""


def list_readings(numbers: Array) -> list[Reading]:
    """List the ways to read numbers (K, n) of poses, likely ones first; equal ones once.

    Raises:
        CalibrationError: if no way makes poses of them.
    """
    n = numbers.shape[1]
    listed = {6: _read_vectors, 7: _read_quaternions, 12: _read_matrices, 16: _read_matrices}
    if n not in listed:
        raise CalibrationError(
            f"A pose of the robot cannot have {n} numbers.",
            "Give 6 (x, y, z and angles or a rotation vector), 7 (x, y, z and a quaternion), or 12 "
            "or 16 of a matrix.",
        )
    ways = list(listed[n](numbers))
    if not ways:
        raise CalibrationError(
            "The robot's poses hold no rotations: "
            + ("no quaternion has the length 1." if n == 7 else "no matrix is a rotation."),
            "Give each pose as 6, 7, 12 or 16 numbers and no others, such as times.",
        )
    R, t = (np.array(parts) for parts in zip(*(poses for _, poses in ways), strict=True))
    distinct: list[int] = []
    for k in range(len(ways)):
        same = np.isclose(R[k], R[distinct], atol=1e-9).all(axis=(1, 2, 3))
        if not (same & (t[k] == t[distinct]).all(axis=(1, 2))).any():
            distinct.append(k)
    return [
        Reading(f"{ways[k][0]}, {unit}", Motions(R[k], t[k] * mm))
        for k in distinct
        for unit, mm in MM_OF_UNITS.items()
    ]


def _read_vectors(numbers: Array) -> Iterator[tuple[str, Motions]]:
    place, angles = numbers[:, :3], numbers[:, 3:]
    for unit, values in (("degrees", np.radians(angles)), ("radians", angles)):
        for sequence in _SEQUENCES:
            for letters in ("abc", "cba"):
                order = ["abc".index(letter) for letter in letters]
                R = scipy.spatial.transform.Rotation.from_euler(sequence, values[:, order])
                product = " ".join(
                    f"R{axis.lower()}({letter})"
                    for axis, letter in zip(sequence, letters, strict=True)
                )
                yield f"angles a, b, c of {product} in {unit}", Motions(R.as_matrix(), place)
        yield f"rotation vectors in {unit}", Motions(rotation_from_vector(values), place)


def _read_quaternions(numbers: Array) -> Iterator[tuple[str, Motions]]:
    for at, where in ((slice(3, 7), slice(0, 3)), (slice(0, 4), slice(4, 7))):
        quaternions, place = numbers[:, at], numbers[:, where]
        if (np.abs(np.linalg.norm(quaternions, axis=1) - 1) > _MAX_SKEW).any():
            continue
        before = "" if at.start else "before the place "
        for name, order in (("x, y, z, w", [0, 1, 2, 3]), ("w, x, y, z", [1, 2, 3, 0])):
            R = scipy.spatial.transform.Rotation.from_quat(quaternions[:, order]).as_matrix()
            yield from _read_both_ways(f"quaternions {before}{name}", R, place)


def _read_matrices(numbers: Array) -> Iterator[tuple[str, Motions]]:
    K, n = numbers.shape
    tables = {
        "matrices row by row": numbers.reshape(K, n // 4, 4),
        "matrices column by column": np.swapaxes(numbers.reshape(K, 4, n // 4), 1, 2),
    }
    for words, table in tables.items():
        R, last = table[:, :3, :3], table[:, 3:]
        gram = R @ np.swapaxes(R, 1, 2)
        if (np.abs(gram - np.eye(3)) > _MAX_SKEW).any() or (np.linalg.det(R) < 0).any():
            continue
        if (np.abs(last - [0, 0, 0, 1]) > _MAX_SKEW).any():
            continue
        yield from _read_both_ways(words, project_on_rotations(R), table[:, :3, 3])


def _read_both_ways(words: str, R: Array, place: Array) -> Iterator[tuple[str, Motions]]:
    yield words, Motions(R, place)
    yield f"{words}, rotations transposed", Motions(np.swapaxes(R, 1, 2), place)
