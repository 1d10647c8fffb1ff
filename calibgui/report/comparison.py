"""Comparison of two calibrations of one camera, their differences in units of sigma.

The unit is that of a difference of two independent estimates, sqrt(sigma_a^2 + sigma_b^2). Where
both rest on the same images their errors are alike, and a difference of even one unit is large.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calibgui.engine.calibration import Calibration


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """One parameter in two calibrations."""

    name: str
    """Name of the parameter."""
    a: float
    """Value in the first calibration."""
    sigma_a: float
    """Standard deviation in the first calibration."""
    b: float
    """Value in the second calibration."""
    sigma_b: float
    """Standard deviation in the second calibration."""

    @property
    def change(self) -> float:
        """The difference b - a."""
        return self.b - self.a

    @property
    def sigmas(self) -> float:
        """The difference over its standard deviation; NaN where neither value has one."""
        unit = float(np.hypot(self.sigma_a, self.sigma_b))
        return self.change / unit if unit > 0 else float("nan")


def compare_parameters(a: Calibration, b: Calibration) -> tuple[ParameterChange, ...]:
    """Compare the parameters that both cameras have, in the order of a's.

    Coefficients of different lens models are not comparable, whatever their names; only
    focal lengths and centres are listed then.
    """
    names = a.camera.names
    if a.camera.model != b.camera.model:
        names = names[:4]
    return tuple(
        ParameterChange(
            name,
            float(a.camera.params[i]),
            float(a.sigma[i]),
            float(b.camera.params[i]),
            float(b.sigma[i]),
        )
        for i, name in enumerate(names)
    )
