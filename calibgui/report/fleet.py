"""Text about a fleet of cameras that fits a terminal of 80 columns."""

from __future__ import annotations

from collections.abc import Sequence

from calibgui.dataset.fleet import FleetCamera
from calibgui.report.numbers import format_count
from calibgui.report.tables import format_bullet

_MAX_LISTED = 20
"""Number of cameras that are listed; the ledger has all."""


def summarise_batch(cameras: int, worked_on: int, failed: int) -> str:
    """Summarise in a sentence how many cameras there are, were worked on, and fail."""
    return (
        f"{format_count(cameras, 'camera')}: {cameras - worked_on} done before, "
        f"{cameras - failed} pass, {failed} fail."
    )


def tabulate_failures(failed: Sequence[FleetCamera]) -> str:
    """List cameras that fail with the reasons, and the remedy of those that were refused."""
    lines = [
        format_bullet(f"{camera.id}: {' '.join(filter(None, [*camera.failures, camera.remedy]))}")
        for camera in failed[:_MAX_LISTED]
    ]
    if more := len(failed) - len(lines):
        lines.append(format_bullet(f"and {more} more, which the ledger lists"))
    return "\n".join(lines)
