"""A choice that fits a narrow side and still shows its entries whole."""

from __future__ import annotations

from PySide6.QtWidgets import QComboBox

from calibgui.gui.widgets import theme


class NarrowCombo(QComboBox):
    """As narrow as there is room; its list is as wide as its entries."""

    def __init__(self) -> None:
        super().__init__()
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)

    def showPopup(self) -> None:  # noqa: N802 - Qt's name
        view = self.view()
        view.setMinimumWidth(view.sizeHintForColumn(0) + 4 * theme.SPACING)
        super().showPopup()
