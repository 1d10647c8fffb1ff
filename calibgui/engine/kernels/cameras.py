"""Cameras as the kernels of the normal equations take them: eleven numbers and a kind of lens."""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from calibgui.engine.arrays import Array, IntArray
from calibgui.engine.kernels import COMPILED_LENSES, POLYNOMIAL_LENSES
from calibgui.engine.kernels.common import compiled_part

FORWARD, BACKWARD, KANNALA_BRANDT, UNIFIED = range(4)
"""Kinds of lenses: eq. 10 distorts, eq. 10 corrects (the paper), and those of
``kernels.ray_lenses``."""
CameraTuple = tuple[float, float, float, float, float, float, float, float, float, float, float]
"""fx, fy, cx, cy and coefficients: k1, k2, k3, p1, p2, p3, skew of eq. 10 (the skew of a lens that
corrects is 0); k1, k2, k3, k4, p1, p2; or xi, alpha, beta."""


class PackedCamera(NamedTuple):
    """A camera for the kernels."""

    camera: CameraTuple
    """Its parameters."""
    kind: int
    """The kind of its lens, which says what they mean."""


def pack_camera(model: str, params: Array) -> PackedCamera:
    """Return the camera of a lens model, a key of ``kernels.COMPILED_LENSES``."""
    camera = np.zeros(11)
    kind = FORWARD
    if model == "lucchese":
        kind = BACKWARD
    elif model.startswith("kannala-brandt"):
        kind = KANNALA_BRANDT
    elif model not in POLYNOMIAL_LENSES:
        kind = UNIFIED
        camera[6] = 1.0  # beta of the models without one
    camera[list(COMPILED_LENSES[model])] = params
    return PackedCamera(cast(CameraTuple, tuple(camera.tolist())), kind)


@compiled_part
def is_of_rays(kind: int) -> bool:
    """Return whether lenses of a kind are those of ``kernels.ray_lenses``."""
    return kind >= KANNALA_BRANDT


def find_rows(model: str, free: IntArray) -> IntArray:
    """Return (P,) places of the free parameters of a lens model in ``PackedCamera.camera``."""
    return np.array(COMPILED_LENSES[model])[free]
