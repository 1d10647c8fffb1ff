"""The settings panel asks for method, lens model, cost, estimated parameters and board shape."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from PySide6.QtWidgets import (
    QCheckBox,
    QFormLayout,
    QGridLayout,
    QLabel,
    QLineEdit,
    QWidget,
)

from calibgui.app.calibrating.settings import (
    BEST_SETTINGS,
    DEFAULT_MODEL,
    MODEL_CHOICES,
    Settings,
    list_parameters,
    parse_fixed,
)
from calibgui.app.projects.project import hold_known
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import DEFAULT_METHOD, METHODS, Cost
from calibgui.engine.camera import PINHOLE
from calibgui.engine.errors import CalibrationError
from calibgui.gui.session.session import Session
from calibgui.gui.settings.board_shape_choice import BoardShapeChoice
from calibgui.gui.settings.cost_choice import CostChoice
from calibgui.gui.settings.known_camera_choice import KnownCameraChoice
from calibgui.gui.settings.method_choice import (
    MethodChoice,
    change_method,
    list_held,
    list_unestimated,
    takes_weights,
)
from calibgui.gui.widgets import theme
from calibgui.gui.widgets.layouts import INDENTED, make_column
from calibgui.gui.widgets.narrow_combo import NarrowCombo
from calibgui.report.lens_models import describe_lens_model, get_lens_title

_BOXES_PER_ROW = 5
"""Number of parameters side by side."""
_MAX_BOXES = 20
"""Number of parameters above which only those that every lens model has get a box."""


class SettingsPanel(QWidget):
    """Edits the calibration settings of the project: one widget for each of them.

    The panel has the method, the cost, the lens model, the board's shape, what to do about poor
    views, and a box for every parameter of the lens model: a parameter without its tick is held.
    The hundreds of coefficients of a splined model have none, nor have those of a model that is
    yet to be chosen.

    Attributes:
        lens, experts: two parts of it, which are laid out where they are shown.
        labels: what stands before its fields.
    """

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.method = MethodChoice()
        self.cost = CostChoice()
        self.known = KnownCameraChoice()
        self.model = self._make_model()
        self.board_shape = BoardShapeChoice()
        self.robust = QCheckBox(self.tr("&Leave outliers out"))
        self.robust.setToolTip(
            self.tr(
                "Remove corners and views that do not fit from the images, as by hand: undo "
                "brings them back. The result names them."
            )
        )
        self.weigh = QCheckBox(self.tr("&Weigh views by their noise"))
        self.improve = QCheckBox(self.tr("Make the camera bette&r"))
        self.improve.setToolTip(
            self.tr(
                "Carry out what needs no new photograph and makes errors smaller by a fifth or "
                "more: another lens model or board shape where these are automatic, and leaving "
                "out corners and views that do not fit. Undo goes back through it."
            )
        )
        self.again = QCheckBox(self.tr("Search a&gain with the camera"))
        self.again.setToolTip(
            self.tr(
                "Once the camera is known, search the images without a board and the boards found "
                "in part again, and calibrate from what that gains."
            )
        )
        names = (name for model in MODEL_CHOICES for name in _list_boxes(model))
        self.boxes = {name: QCheckBox(name, self) for name in dict.fromkeys(names)}
        self._arranged: tuple[str, ...] = ()
        """Names of the parameters whose boxes are shown, in their order."""
        self.values = self._make_values()
        self._lay_out()
        choices = (self.robust, self.weigh, self.improve, self.again, *self.boxes.values())
        clicks = (box.clicked for box in choices)
        for edited in (
            self.cost.activated,
            self.model.activated,
            self.board_shape.changed,
            *clicks,
        ):
            edited.connect(lambda: self._edit())
        self.method.activated.connect(self._choose_listed_method)
        self.known.given_up.connect(
            lambda: self._session.edit(self.tr("Calibrate again"), lambda p: hold_known(p, None))
        )
        self.board_shape.slid.connect(lambda: self._edit(sliding=True))
        self.board_shape.failed.connect(session.failed)
        session.changed.connect(self._refresh)
        self._refresh()

    def _make_model(self) -> NarrowCombo:
        choice = NarrowCombo()
        choice.add_explained(
            self.tr("automatic"),
            None,
            self.tr(
                "The paper's model, unless views that the models have not seen demand another. "
                "The result says why. Slower."
            ),
        )
        for model in MODEL_CHOICES:
            _add_model(choice, model)
        choice.setAccessibleName(self.tr("Lens model"))
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
        label, held = QLabel(self.tr("&Minimise")), QLabel(self.tr("Held at"))
        label.setBuddy(self.cost)
        held.setBuddy(self.values)
        lens, known = QLabel(self.tr("Lens model")), QLabel(self.tr("Camera"))
        self.labels = label, held, lens, known, self.board_shape.known
        self.lens, self.experts = QWidget(self), QWidget(self)
        model = QFormLayout()
        model.addRow(known, self.known)
        model.addRow(lens, self.model)
        make_column(
            model,
            self.board_shape,
            self.improve,
            of=self.lens,
            margins=INDENTED,
        )
        how = QFormLayout()
        how.addRow(self.tr("Method"), self.method)
        how.addRow(label, self.cost)
        self._grid = QGridLayout()
        self._grid.setHorizontalSpacing(theme.SPACING)
        self._grid.addWidget(QLabel(self.tr("Estimate")), 0, 0)
        last = QFormLayout()
        last.addRow(held, self.values)
        make_column(
            how,
            self.robust,
            self.weigh,
            self.again,
            self._grid,
            last,
            of=self.experts,
            margins=INDENTED,
        )

    def _arrange_boxes(self, names: Sequence[str]) -> None:
        """Show the boxes of these parameters, in this order, and no others."""
        for box in self.boxes.values():
            self._grid.removeWidget(box)
        for k, name in enumerate(names):
            self._grid.addWidget(self.boxes[name], k // _BOXES_PER_ROW, 1 + k % _BOXES_PER_ROW)
        for name, box in self.boxes.items():
            box.setVisible(name in names)

    def _refresh(self) -> None:
        settings = self._session.project.settings
        self.known.show_known(settings.known)
        self._refresh_method(settings)
        self._refresh_model(settings)
        self.board_shape.show_choice(settings.board_shape, settings.prior)
        self.robust.setChecked(settings.robust)
        self.weigh.setChecked(settings.weigh_views)
        self.improve.setChecked(settings.improve)
        self.again.setChecked(not settings.once)
        self.experts.setEnabled(settings.known is None)
        for widget in (self.model, self.board_shape, self.improve):
            widget.setEnabled(widget.isEnabled() and settings.known is None)
        stated = {name: value for name, value in settings.fixed.items() if value is not None}
        self.values.setText(", ".join(f"{name}={value:.12g}" for name, value in stated.items()))

    def _refresh_method(self, settings: Settings) -> None:
        """Show method and cost, and offer what the two take."""
        self.method.setCurrentIndex(self.method.findData(settings.method))
        self.cost.setCurrentIndex(self.cost.findData(settings.cost))
        has_costs = len(METHODS[settings.method].costs) > 1
        self.cost.setEnabled(has_costs)
        self.cost.setToolTip(
            "" if has_costs else self.tr("The chosen method has nothing else to minimise.")
        )
        in_image, weighted = settings.cost is Cost.IMAGE, takes_weights(settings)
        for widget in (self.board_shape, self.weigh):
            widget.setEnabled(weighted)
        self.board_shape.setToolTip(
            self.tr("The error in the image takes any board.")
            if not in_image
            else ""
            if weighted
            else self.tr("The chosen method takes every board as it is drawn.")
        )
        self.weigh.setToolTip(
            self.tr("Only the error in the image takes weights.")
            if not in_image
            else self.tr(
                "Poor views then spoil less. Best with an estimated shape of the board, which "
                "would else pass for noise."
            )
            if weighted
            else self.tr("The chosen method takes all corners as equally good.")
        )

    def _refresh_model(self, settings: Settings) -> None:
        if self.model.findData(settings.model) < 0 and settings.model is not None:
            _add_model(self.model, settings.model)  # splined, with numbers of its own
        self.model.setCurrentIndex(self.model.findData(settings.model))
        is_paper, has_own = settings.cost is Cost.PAPER, settings.method != DEFAULT_METHOD
        self.model.setEnabled(not (is_paper or has_own))
        self.model.setToolTip(
            self.tr("The chosen method has its own lens model: what its authors corrected.")
            if has_own
            else self.tr(
                "The formulation of the paper has its own lens model, with a radius in pixels."
            )
            if is_paper
            else self.tr("How the lens bends what a pinhole would image; the result is of it.")
        )
        self._refresh_boxes(settings)

    def _refresh_boxes(self, settings: Settings) -> None:
        names, held = _list_boxes(settings.model), list_held(settings)
        if names != self._arranged:
            self._arranged = names
            self._arrange_boxes(names)
        unestimated = list_unestimated(settings)
        for name in names:
            box = self.boxes[name]
            is_free = name not in settings.fixed and (name not in held or name in settings.freed)
            box.setChecked(is_free)
            box.setEnabled(name not in unestimated)
            box.setToolTip(
                self.tr("Estimate {0}; otherwise it is held, coefficients at 0.").format(name)
                if box.isEnabled()
                else self.tr("The chosen method cannot estimate {0}.").format(name)
            )

    def choose_method(self, name: str, cost: Cost) -> None:
        """Calibrate with another method and its own lens model.

        Args:
            name: key of the method in ``calibration.METHODS``.
            cost: what it is to minimise.
        """
        self._edit_method(change_method(self._session.project.settings, name, cost))

    def _choose_listed_method(self) -> None:
        before, name = self._session.project.settings, self.method.currentData()
        if name == before.method:
            return
        settings = change_method(before, name)
        if name == DEFAULT_METHOD:
            settings = replace(settings, model=BEST_SETTINGS.model)
        self._edit_method(settings)

    def _edit_method(self, settings: Settings) -> None:
        if settings != self._session.project.settings:
            self._session.edit(self.tr("Method"), lambda p: replace(p, settings=settings))

    def choose_model(self, model: str, held: Iterable[str]) -> None:
        """Estimate another lens model, by the default method and cost if those have their own.

        Args:
            model: name of the lens model.
            held: its coefficients to hold at 0; no others are held that the user may hold.
        """
        before = self._session.project.settings
        has_own = model not in METHODS[before.method].lens_models
        fixed = {name: value for name, value in before.fixed.items() if name in PINHOLE}
        settings = replace(
            before,
            cost=Cost.IMAGE if before.cost is Cost.PAPER else before.cost,
            method=DEFAULT_METHOD if has_own else before.method,
            model=model,
            fixed={**fixed, **dict.fromkeys(held)},
            freed=(),
        )
        if settings != before:
            self._session.edit(self.tr("Lens model"), lambda p: replace(p, settings=settings))

    def _hold(self) -> None:
        """Hold parameters at the values that were typed."""
        if not self.values.isModified():
            return
        text = self.values.text()
        try:
            typed = parse_fixed(text, self._session.project.settings.model) if text.strip() else {}
        except CalibrationError as error:
            self._session.failed.emit(error)
            self._refresh()
            return
        for name in typed.keys() & self.boxes.keys():
            self.boxes[name].setChecked(False)
        self._edit(typed)

    def _edit(
        self, values: Mapping[str, float | None] | None = None, *, sliding: bool = False
    ) -> None:
        """Change the settings to what the widgets show.

        Args:
            values: at which parameters are held; by default as before.
            sliding: whether the edit goes on, as of a value that is being turned.
        """
        before = self._session.project.settings
        cost = Cost(self.cost.currentData())
        model = DEFAULT_MODEL if cost is Cost.PAPER else self.model.currentData()
        if model == before.model:
            fixed, freed = self._read_boxes(before.fixed if values is None else values)
        else:
            fixed, freed = _carry_over(before, model)
        weighted = takes_weights(replace(before, cost=cost))
        settings = replace(
            before,
            cost=cost,
            model=model,
            fixed=fixed,
            freed=freed,
            board_shape=self.board_shape.board_shape if weighted else BoardShapeModel.NOMINAL,
            prior=self.board_shape.prior if weighted else None,
            robust=self.robust.isChecked(),
            weigh_views=self.weigh.isChecked() and weighted,
            once=not self.again.isChecked(),
            improve=self.improve.isChecked(),
        )
        if settings != before:
            self._session.edit(
                self.tr("Calibration settings"),
                lambda p: replace(p, settings=settings),
                sliding=sliding,
            )

    def _read_boxes(
        self, values: Mapping[str, float | None]
    ) -> tuple[dict[str, float | None], tuple[str, ...]]:
        """Return what is held, at which of `values`, and what is freed, as the boxes show it."""
        settings = self._session.project.settings
        names, held_by_default = _list_boxes(settings.model), list_held(settings)
        held = [name for name in names if not self.boxes[name].isChecked()]
        stated = {name: values.get(name) for name in held}
        fixed = {n: v for n, v in stated.items() if n not in held_by_default or v is not None}
        fixed |= {name: value for name, value in values.items() if name not in names}
        return fixed, tuple(name for name in held_by_default if name not in held)


def _add_model(choice: NarrowCombo, model: str) -> None:
    """Add a lens model to a choice, with its title and what it is for."""
    choice.add_explained(get_lens_title(model), model, f"{model}. {describe_lens_model(model)}")


def _list_boxes(model: str | None) -> tuple[str, ...]:
    """List the parameters of a lens model that have a box; None is a model yet to be chosen."""
    names = list_parameters(model)
    return names if len(names) <= _MAX_BOXES else PINHOLE


def _carry_over(
    settings: Settings, model: str | None
) -> tuple[dict[str, float | None], tuple[str, ...]]:
    """Return what stays held and freed with another lens model.

    A coefficient that both models have stays held, but not at its value, which means another lens.
    """
    names, held = list_parameters(model), list_held(replace(settings, model=model))
    fixed = {
        name: value if name in PINHOLE else None
        for name, value in settings.fixed.items()
        if name in names and (name in PINHOLE or name not in held)
    }
    return fixed, tuple(name for name in settings.freed if name in held)
