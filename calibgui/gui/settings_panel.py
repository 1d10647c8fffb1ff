"""How to calibrate: what is minimised, what is estimated, and what is known of the board."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtWidgets import (
    QCheckBox,
    QFormLayout,
    QGridLayout,
    QLabel,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.settings import Settings
from calibgui.engine.calibrate import HELD, parameter_names
from calibgui.engine.types import Cost, PlateModel
from calibgui.gui import theme
from calibgui.gui.narrow_combo import NarrowCombo
from calibgui.gui.plate_choice import PlateChoice
from calibgui.gui.session import Session

_MODEL = "lucchese"
_PER_ROW = 5


class SettingsPanel(QWidget):
    """The cost, the board's shape, and a box for every intrinsic."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.cost = NarrowCombo()
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
            box.clicked.connect(lambda: self._edit())
            grid.addWidget(box, k // _PER_ROW, k % _PER_ROW)
        self.plate = PlateChoice()
        self.robust = QCheckBox(self.tr("&Leave outliers out"))
        self.robust.setToolTip(
            self.tr(
                "Remove corners and views that do not fit from the images, as by hand: undo "
                "brings them back. The result names them."
            )
        )
        label = QLabel(self.tr("&Minimise"))
        label.setBuddy(self.cost)
        label.setMinimumWidth(self.plate.known.sizeHint().width())  # in line with what follows
        first = QFormLayout()
        first.addRow(label, self.cost)
        layout = QVBoxLayout(self)
        layout.addLayout(first)
        layout.addWidget(self.plate)
        layout.addWidget(self.robust)
        layout.addWidget(QLabel(self.tr("Estimate")))
        layout.addLayout(grid)
        layout.addStretch(1)
        for edited in (self.cost.activated, self.plate.changed, self.robust.clicked):
            edited.connect(lambda: self._edit())
        self.plate.slid.connect(lambda: self._edit(sliding=True))
        self.plate.failed.connect(session.failed)
        session.changed.connect(self._refresh)
        self._refresh()

    def _refresh(self) -> None:
        settings = self._session.project.settings
        self.cost.setCurrentIndex(self.cost.findData(settings.cost))
        self.plate.show_choice(settings.plate, settings.prior)
        self.plate.setEnabled(settings.cost is Cost.IMAGE)
        self.plate.setToolTip(
            "" if self.plate.isEnabled() else self.tr("The error in the image takes any board.")
        )
        self.robust.setChecked(settings.robust)
        for name, box in self.boxes.items():
            held = name in settings.fixed or (name in HELD[_MODEL] and name not in settings.freed)
            box.setChecked(not held)

    def _edit(self, *, sliding: bool = False) -> None:
        default, cost = HELD[_MODEL], Cost(self.cost.currentData())
        # Only the error in the image takes another board than the one that was drawn.
        any_plate = cost is Cost.IMAGE
        settings = Settings(
            cost=cost,
            fixed=tuple(
                n for n, box in self.boxes.items() if not box.isChecked() and n not in default
            ),
            freed=tuple(n for n in default if self.boxes[n].isChecked()),
            plate=self.plate.plate if any_plate else PlateModel.NOMINAL,
            prior=self.plate.prior if any_plate else None,
            robust=self.robust.isChecked(),
        )
        if settings != self._session.project.settings:
            self._session.edit(
                self.tr("Calibration settings"),
                lambda p: replace(p, settings=settings),
                sliding=sliding,
            )
