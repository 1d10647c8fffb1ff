"""The residuals in short: an RMS never stands without sigma and their number."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from calibgui.dataset import Result
from calibgui.engine.assessment import summarise_residuals
from calibgui.report.boards import name_point

translate = QCoreApplication.translate


def describe_fit(result: Result) -> str:
    """Describe the residuals: their RMS, sigma and number."""
    fit = summarise_residuals(result.calibration.residuals)
    text = (
        translate("VerdictTexts", "RMS {0:.3f} px, σ {1:.3f} px of {2:,} circles")
        if name_point(result.board) == "circle"
        else translate("VerdictTexts", "RMS {0:.3f} px, σ {1:.3f} px of {2:,} corners")
    )
    return text.format(fit.rms, fit.sigma, fit.count)
