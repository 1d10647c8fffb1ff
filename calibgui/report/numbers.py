"""Numbers as people read them: a value has as many digits as its uncertainty deserves."""

from __future__ import annotations

import math


def format_with_sigma(value: float, sigma: float) -> str:
    """Format `value` ± one standard deviation, which gets two significant digits.

    The value stands alone if sigma is 0 or not known.

    Example:
        >>> format_with_sigma(657.3021, 0.1234)
        '657.30 ± 0.12'
        >>> format_with_sigma(5.71e-7, 2.9e-8)
        '(5.71 ± 0.29)e-7'
    """
    if not (math.isfinite(sigma) and sigma > 0 and math.isfinite(value)):
        return f"{value:z.6g}"
    place = _find_power_of_ten(sigma)
    power = max(_find_power_of_ten(value), place) if value else place
    if -4 < power < 6 and place > -7:
        decimals = max(0, 1 - place)
        return f"{value:z.{decimals}f} ± {sigma:.{decimals}f}"
    decimals = power - place + 1
    return f"({value / 10.0**power:z.{decimals}f} ± {sigma / 10.0**power:.{decimals}f})e{power}"


def format_count(n: int, thing: str) -> str:
    """Format a number of things, as "1 view", "25 views", "3,900 corners"."""
    return f"{n:,} {thing}" + ("" if n == 1 else "s")


def _find_power_of_ten(value: float) -> int:
    """Return the power of ten of the first of two significant digits, after rounding to them."""
    return int(f"{abs(value):.1e}".split("e")[1])
