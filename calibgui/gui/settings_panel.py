"""How to calibrate: what is minimised and which intrinsics are estimated."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtWidgets import QCheckBox, QComboBox, QGridLayout, QLabel, QVBoxLayout, QWidget

from calibgui.app.project import Settings
from calibgui.engine.calibrate import HELD, parameter_names
from calibgui.engine.types import Cost
from calibgui.gui import theme
from calibgui.gui.session import Session

_MODEL = "lucchese"
_PER_ROW = 5


class SettingsPanel(QWidget):
    """The cost, and a box for every intrinsic."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.cost = QComboBox()
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
            self.cost.addItem(text, cost)
            self.cost.setItemData(self.cost.count() - 1, tip, 3)
        self.cost.setAccessibleName(self.tr("Minimise"))
        self.boxes = {name: QCheckBox(name) for name in parameter_names(_MODEL)}
        grid = QGridLayout()
        grid.setHorizontalSpacing(theme.SPACING)
        for k, (name, box) in enumerate(self.boxes.items()):
            box.setToolTip(
                self.tr("Estimate {0}; otherwise it is held, coefficients at 0.").format(name)
            )
            box.clicked.connect(self._edit)
            grid.addWidget(box, k // _PER_ROW, k % _PER_ROW)
        layout = QVBoxLayout(self)
        label = QLabel(self.tr("&Minimise"))
        label.setBuddy(self.cost)
        layout.addWidget(label)
        layout.addWidget(self.cost)
        layout.addSpacing(theme.SPACING)
        layout.addWidget(QLabel(self.tr("Estimate")))
        layout.addLayout(grid)
        layout.addStretch(1)
        self.cost.activated.connect(self._edit)
        session.changed.connect(self._refresh)
        self._refresh()

    def _refresh(self) -> None:
        settings = self._session.project.settings
        self.cost.setCurrentIndex(self.cost.findData(settings.cost))
        for name, box in self.boxes.items():
            held = name in settings.fixed or (name in HELD[_MODEL] and name not in settings.freed)
            box.setChecked(not held)

    def _edit(self) -> None:
        default = HELD[_MODEL]
        settings = Settings(
            cost=Cost(self.cost.currentData()),
            fixed=tuple(
                n for n, box in self.boxes.items() if not box.isChecked() and n not in default
            ),
            freed=tuple(n for n in default if self.boxes[n].isChecked()),
        )
        if settings != self._session.project.settings:
            self._session.edit(
                self.tr("Calibration settings"), lambda p: replace(p, settings=settings)
            )
