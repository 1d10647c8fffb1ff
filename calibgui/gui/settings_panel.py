"""How to calibrate: what is minimised, what is estimated, and what is known of the board."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from PySide6.QtWidgets import (
    QCheckBox,
    QFormLayout,
    QGridLayout,
    QLabel,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from calibgui.app.settings import NAMES, Settings, held_in
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import Cost
from calibgui.engine.camera import MODELS
from calibgui.engine.errors import CalibrationError
from calibgui.gui import theme
from calibgui.gui.board_shape_choice import BoardShapeChoice
from calibgui.gui.narrow_combo import NarrowCombo
from calibgui.gui.session import Session

_HELD = MODELS["lucchese"].held
"""Held unless the user frees them."""
_PER_ROW = 5


class SettingsPanel(QWidget):
    """The cost, the board's shape, what to do about poor views, and a box for every intrinsic."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.cost = self._make_cost()
        self.board_shape = BoardShapeChoice()
        self.robust = QCheckBox(self.tr("&Leave outliers out"))
        self.robust.setToolTip(
            self.tr(
                "Remove corners and views that do not fit from the images, as by hand: undo "
                "brings them back. The result names them."
            )
        )
        self.weigh = QCheckBox(self.tr("&Weigh views by their noise"))
        self.weigh.setToolTip(
            self.tr(
                "Poor views then spoil less. Best with an estimated shape of the board, which "
                "would else pass for noise."
            )
        )
        self.again = QCheckBox(self.tr("Search a&gain with the camera"))
        self.again.setToolTip(
            self.tr(
                "Once the camera is known, search the images without a board and the boards found "
                "in part again, and calibrate from what that gains."
            )
        )
        self.boxes = {name: QCheckBox(name) for name in NAMES}
        self.values = self._make_values()
        self._lay_out()
        choices = (self.robust, self.weigh, self.again, *self.boxes.values())
        clicks = (box.clicked for box in choices)
        for edited in (self.cost.activated, self.board_shape.changed, *clicks):
            edited.connect(lambda: self._edit())
        self.board_shape.slid.connect(lambda: self._edit(sliding=True))
        self.board_shape.failed.connect(session.failed)
        session.changed.connect(self._refresh)
        self._refresh()

    def _make_cost(self) -> NarrowCombo:
        choice = NarrowCombo()
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
            choice.addItem(text, cost)
            choice.setItemData(choice.count() - 1, tip, 3)
        choice.setAccessibleName(self.tr("Minimise"))
        return choice

    def _make_values(self) -> QLineEdit:
        values = QLineEdit()
        values.setPlaceholderText("fx=650, p1=0")
        values.setAccessibleName(self.tr("Values of held parameters"))
        values.setToolTip(
            self.tr(
                "Parameters that are held at values of their own, as fx=650, p1=0. Of the others "
                "that are held coefficients are 0, the centre is the image's and focal lengths "
                "are those of the closed form."
            )
        )
        values.editingFinished.connect(self._hold)
        return values

    def _lay_out(self) -> None:
        label = QLabel(self.tr("&Minimise"))
        label.setBuddy(self.cost)
        label.setMinimumWidth(
            self.board_shape.known.sizeHint().width()
        )  # in line with what follows
        first = QFormLayout()
        first.addRow(label, self.cost)
        grid = QGridLayout()
        grid.setHorizontalSpacing(theme.SPACING)
        for k, (name, box) in enumerate(self.boxes.items()):
            box.setToolTip(
                self.tr("Estimate {0}; otherwise it is held, coefficients at 0.").format(name)
            )
            grid.addWidget(box, k // _PER_ROW, k % _PER_ROW)
        last = QFormLayout()
        last.addRow(self.tr("Held at"), self.values)
        layout = QVBoxLayout(self)
        layout.addLayout(first)
        layout.addWidget(self.board_shape)
        for choice in (self.robust, self.weigh, self.again):
            layout.addWidget(choice)
        layout.addWidget(QLabel(self.tr("Estimate")))
        layout.addLayout(grid)
        layout.addLayout(last)
        layout.addStretch(1)

    def _refresh(self) -> None:
        settings = self._session.project.settings
        self.cost.setCurrentIndex(self.cost.findData(settings.cost))
        self.board_shape.show_choice(settings.board_shape, settings.prior)
        self.board_shape.setEnabled(settings.cost is Cost.IMAGE)
        self.board_shape.setToolTip(
            ""
            if self.board_shape.isEnabled()
            else self.tr("The error in the image takes any board.")
        )
        self.robust.setChecked(settings.robust)
        self.weigh.setChecked(settings.weigh_views)
        self.weigh.setEnabled(settings.cost is Cost.IMAGE)
        self.again.setChecked(not settings.once)
        for name, box in self.boxes.items():
            box.setChecked(
                name not in settings.fixed and (name not in _HELD or name in settings.freed)
            )
        stated = {name: value for name, value in settings.fixed.items() if value is not None}
        self.values.setText(", ".join(f"{name}={value:.12g}" for name, value in stated.items()))

    def _hold(self) -> None:
        """Hold parameters at the values that were typed."""
        if not self.values.isModified():
            return
        text = self.values.text()
        try:
            typed = held_in(text) if text.strip() else {}
        except CalibrationError as error:
            self._session.failed.emit(error)
            self._refresh()
            return
        for name in typed:
            self.boxes[name].setChecked(False)
        self._edit(typed)

    def _edit(
        self, values: Mapping[str, float | None] | None = None, *, sliding: bool = False
    ) -> None:
        """Make what the widgets show the settings; what is held is at `values`, or as before."""
        values = self._session.project.settings.fixed if values is None else values
        held = [name for name, box in self.boxes.items() if not box.isChecked()]
        stated = {name: values.get(name) for name in held}
        cost = Cost(self.cost.currentData())
        # Only the error in the image takes another board than the one that was drawn.
        in_image = cost is Cost.IMAGE
        settings = Settings(
            cost=cost,
            fixed={n: v for n, v in stated.items() if n not in _HELD or v is not None},
            freed=tuple(name for name in _HELD if name not in held),
            board_shape=self.board_shape.board_shape if in_image else BoardShapeModel.NOMINAL,
            prior=self.board_shape.prior if in_image else None,
            robust=self.robust.isChecked(),
            weigh_views=self.weigh.isChecked() and in_image,
            once=not self.again.isChecked(),
        )
        if settings != self._session.project.settings:
            self._session.edit(
                self.tr("Calibration settings"),
                lambda p: replace(p, settings=settings),
                sliding=sliding,
            )
