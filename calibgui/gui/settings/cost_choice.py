"""The choice of what a calibration minimises."""

from __future__ import annotations

from calibgui.engine.calibration import Cost
from calibgui.gui.widgets.narrow_combo import NarrowCombo


class CostChoice(NarrowCombo):
    """The costs, with what speaks for each."""

    def __init__(self) -> None:
        super().__init__()
        for cost, text, tip in (
            (
                Cost.IMAGE,
                self.tr("error in the image"),
                self.tr(
                    "Distance between measured and predicted corners, px. The noise is in the "
                    "image: this gives the smallest standard deviations."
                ),
            ),
            (
                Cost.REFERENCE,
                self.tr("error on the reference plane"),
                self.tr(
                    "Distance between the corners registered on the board and where they should "
                    "be. Far and tilted views weigh more."
                ),
            ),
            (
                Cost.PAPER,
                self.tr("as printed in the paper"),
                self.tr("The formulation of the paper to the letter, to reproduce its tables."),
            ),
        ):
            self.add_explained(text, cost, tip)
        self.setAccessibleName(self.tr("Minimise"))
