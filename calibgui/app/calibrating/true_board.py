"""The gain of stating that the board is flat and printed true is measured beside a calibration.

Few views cannot show how far a board deviates from its drawing. They are taken to deviate as
ordinary boards do, and every ± counts that; of a board of glass, most of some ± is then in vain.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from calibgui import engine
from calibgui.dataset import Result
from calibgui.engine.boards import BoardShapePrior
from calibgui.engine.calibration import Cost, Status, recover_arguments
from calibgui.engine.camera import PINHOLE
from calibgui.engine.threads import limit_blas_threads

GLASS = BoardShapePrior(in_plane=0.002, out_of_plane=0.01)
"""Deviations of a board of chrome on glass, which its makers state. With 0.02 mm for both, as of a
plate of aluminium, no ± of the sample or of 12 views with 0.03 to 0.1 px of noise became less than
0.87 of what it is without."""
_MAX_SHARE = 0.5
"""Share of its ± up to which a value's ± with a board of glass is worth being told."""


def measure_gain_of_glass(result: Result) -> dict[str, float]:
    """Measure what the ± of focal lengths and centre would be if the board was stated to be glass.

    Returns:
        Those that would be less than half, by name; none if the views show that the board or the
        lens deviates, if its shape is known otherwise, or if lengths are not.
    """
    calibration = result.calibration
    if (
        result.condition
        or calibration.status is not Status.CONVERGED
        or calibration.cost is not Cost.IMAGE
        or calibration.board_shape is not None
        or calibration.settings.prior is not None
        or max(calibration.board_shape_error, calibration.lens_error) > 0
    ):
        return {}
    arguments = recover_arguments(calibration) | {"prior": GLASS}
    with limit_blas_threads():
        known = engine.calibrate(result.observations(), calibration.camera.size, **arguments)
    pairs = zip(calibration.camera.names, known.sigma, calibration.sigma, strict=True)
    return {
        name: float(sigma)
        for name, sigma, before in pairs
        if name in PINHOLE and np.isfinite(sigma) and 0 < sigma < _MAX_SHARE * before
    }


def list_gains(narrower: Mapping[str, float]) -> str:
    """List what `measure_gain_of_glass` returns, as "cx ± 0.16, cy ± 0.12"."""
    return ", ".join(f"{name} ± {sigma:.2g}" for name, sigma in narrower.items())
