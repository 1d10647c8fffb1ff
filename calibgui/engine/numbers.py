"""Numbers in sentences."""

from __future__ import annotations


def format_two_digits(value: float) -> str:
    """Format a positive number with two digits, and large ones as they are: 0.010, 270."""
    rounded = float(f"{value:.2g}")
    return f"{rounded:,.0f}" if rounded >= 10 else f"{rounded:#.2g}"
