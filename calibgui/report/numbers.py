"""Numbers as people read them: a value with as many digits as its uncertainty deserves."""

from __future__ import annotations

import math


def with_sigma(value: float, sigma: float) -> str:
    """`value` ± one standard deviation, which has two significant digits.

    "657.30 ± 0.12", "(5.71 ± 0.29)e-7"; the value alone if sigma is 0 or not known.
    """
    if not (math.isfinite(sigma) and sigma > 0 and math.isfinite(value)):
        return f"{value:.6g}"
    place = _place(sigma)
    power = _place(value) if value else place
    if -4 < power < 6 and place > -7:
        decimals = max(0, 1 - place)
        return f"{value:.{decimals}f} ± {sigma:.{decimals}f}"
    power = max(power, place)
    decimals = power - place + 1
    return f"({value / 10.0**power:.{decimals}f} ± {sigma / 10.0**power:.{decimals}f})e{power}"


def counted(n: int, thing: str) -> str:
    """ "1 view", "25 views", "3,900 corners"."""
    return f"{n:,} {thing}" + ("" if n == 1 else "s")


def _place(value: float) -> int:
    """The power of ten of the first of two significant digits, after rounding to them."""
    return int(f"{abs(value):.1e}".split("e")[1])
