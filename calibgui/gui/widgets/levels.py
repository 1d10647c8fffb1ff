"""Round numbers for contour lines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

_MOST = 8
"""Lines that can be told apart on a map that fills a panel."""


def choose_levels(top: float, most: int = _MOST) -> Iterator[float]:
    """Yield at most `most` round numbers between 0 and `top`."""
    if top <= 0:
        return
    power = 10.0 ** np.floor(np.log10(top / most))
    step = next(m * power for m in (1, 2, 5, 10) if top / (m * power) <= most)
    n = 1
    while n * step < top:
        yield float(n * step)
        n += 1
