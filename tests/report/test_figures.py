"""Figures of a calibration, where there is nothing to draw as well."""

from __future__ import annotations

from io import BytesIO

from calibgui.engine.camera.camera import Camera
from calibgui.report.figures import draw_distortion


def test_a_lens_without_distortion_is_drawn_without_arrows() -> None:
    """Matplotlib would divide by their longest, and warn."""
    figure = draw_distortion(Camera((64, 48), [60.0, 60.0, 31.5, 23.5], "pinhole"))
    drawn = BytesIO()
    figure.savefig(drawn)
    assert drawn.tell()
