"""The choice where residuals are shown: in the image, or on the paper's reference plane."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox

from calibgui.engine.arrays import Array
from calibgui.engine.calibration import Calibration
from calibgui.gui.widgets.glossary import explain


class PlaneChoice(QComboBox):
    """A choice of two planes, with their names and units."""

    def __init__(self) -> None:
        super().__init__()
        self.addItem(self.tr("in the image"))
        self.addItem(self.tr("on the reference plane"))
        self.setItemData(1, explain(self.tr("reference px")), Qt.ItemDataRole.ToolTipRole)
        self.setToolTip(
            self.tr(
                "In the image a residual is the measured less the predicted corner.\n"
                "The paper's reference plane has 30 px to a square; residuals of far and tilted\n"
                "boards look larger there (figures 10 to 12)."
            )
        )
        self.setAccessibleName(self.tr("Where residuals are shown"))

    @property
    def on_reference(self) -> bool:
        """Return whether the reference plane is chosen."""
        return self.currentIndex() == 1

    @property
    def names(self) -> tuple[str, str, str]:
        """Names of the components of a residual and of its length."""
        return ("Δx′", "Δy′", "e′") if self.on_reference else ("Δu", "Δv", "e")

    @property
    def unit(self) -> str:
        """Unit of residuals on the chosen plane."""
        return self.tr("reference px") if self.on_reference else self.tr("px")

    def residuals(self, calibration: Calibration) -> list[Array]:
        """(n, 2) residuals of each view on the chosen plane."""
        return [v.reference if self.on_reference else v.image for v in calibration.residuals]
