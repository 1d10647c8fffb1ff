"""Cameras as the kernels of the normal equations take them: 18 numbers and a kind of lens."""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels import COMPILED_LENSES, POLYNOMIAL_LENSES, QUOTIENT_LENSES
from calibgui.engine.kernels.common import compiled_part

FORWARD, BACKWARD, KANNALA_BRANDT, UNIFIED, QUOTIENT = range(5)
"""Kinds of lenses: eq. 10 distorts, eq. 10 corrects (the paper), and those of
``kernels.ray_lenses``."""
CameraTuple = tuple[
    float, float, float, float, float, float, float, float, float,
    float, float, float, float, float, float, float, float, float,
]  # fmt: skip
"""fx, fy, cx, cy and coefficients: k1, k2, k3, p1, p2, p3, skew of eq. 10 (the skew of a lens that
corrects is 0); k1, k2, k3, k4, p1, p2; xi, alpha, beta; or k1, k2, p1, p2, k3, k4, k5, k6, s1, s2,
s3, s4, skew of a quotient, and the square of the radius at its pole. The rest is 0."""


class PackedCamera(NamedTuple):
    """A camera for the kernels."""

    camera: CameraTuple
    """Its parameters."""
    kind: int
    """The kind of its lens, which says what they mean."""


def pack_camera(model: str, params: Array) -> PackedCamera:
    """Return the camera of a lens model, a key of ``kernels.COMPILED_LENSES``."""
    camera = np.zeros(18)
    kind = FORWARD
    if model == "lucchese":
        kind = BACKWARD
    elif model.startswith("kannala-brandt"):
        kind = KANNALA_BRANDT
    elif model in QUOTIENT_LENSES:
        kind = QUOTIENT
        camera[17] = _find_pole(params[9:12])
    elif model not in POLYNOMIAL_LENSES:
        kind = UNIFIED
        camera[6] = 1.0  # beta of the models without one
    camera[list(COMPILED_LENSES[model])] = params
    return PackedCamera(cast(CameraTuple, tuple(camera.tolist())), kind)


def _find_pole(k: Array) -> float:
    """Find the least s at which 1 + k4 s + k5 s^2 + k6 s^3 is 0; infinity if there is none."""
    inverses = np.roots([1.0, *k])  # 1 / s: a last coefficient of 0 is no difficulty
    largest = inverses[inverses.imag == 0].real.max(initial=0.0)
    return float(1 / largest) if largest > 0 else np.inf


@compiled_part
def is_of_rays(kind: int) -> bool:
    """Return whether lenses of a kind are those of ``kernels.ray_lenses``."""
    return kind >= KANNALA_BRANDT


def find_rows(model: str, free: IntArray) -> IntArray:
    """Return (P,) places of the free parameters of a lens model in ``PackedCamera.camera``."""
    return np.array(COMPILED_LENSES[model])[free]
