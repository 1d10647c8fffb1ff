"""The choice of a method of calibration, and what it leaves of the other settings."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Qt

from calibgui.app.calibrating.settings import DEFAULT_MODEL, Settings
from calibgui.engine.boards import BoardShapeModel
from calibgui.engine.calibration import METHODS, Cost
from calibgui.engine.camera import find_model
from calibgui.gui.widgets.narrow_combo import NarrowCombo


class MethodChoice(NarrowCombo):
    """The methods by their titles, with what each of them assumes and who described it."""

    def __init__(self) -> None:
        super().__init__()
        for name, method in METHODS.items():
            tip = f"{method.title} ({name}). {method.limits}\n{method.source}"
            self.add_explained(method.title, name, tip)
        self.setAccessibleName(self.tr("Method"))
        self.currentIndexChanged.connect(self._describe_current)
        self._describe_current()

    def _describe_current(self) -> None:
        self.setToolTip(self.currentData(Qt.ItemDataRole.ToolTipRole))


def change_method(settings: Settings, name: str, cost: Cost = Cost.IMAGE) -> Settings:
    """Return settings with another method, which begins as its authors have it.

    The lens model is the method's own, and no parameter is held or freed but by the method. What
    the method does not take of the other settings is taken back.
    """
    model = DEFAULT_MODEL if cost is Cost.PAPER else METHODS[name].lens_models[0]
    changed = replace(settings, method=name, cost=cost, model=model, fixed={}, freed=())
    if takes_weights(changed):
        return changed
    return replace(changed, board_shape=BoardShapeModel.NOMINAL, prior=None, weigh_views=False)


def takes_weights(settings: Settings) -> bool:
    """Return whether method and cost take weights of corners, and boards not as they are drawn."""
    return settings.cost is Cost.IMAGE and METHODS[settings.method].is_weighted


def list_held(settings: Settings) -> tuple[str, ...]:
    """List the parameters that method and lens model hold unless they are freed."""
    held = METHODS[settings.method].held
    if held is not None:
        return held
    return () if settings.model is None else find_model(settings.model).held


def list_unestimated(settings: Settings) -> tuple[str, ...]:
    """List the parameters that the method cannot estimate: a closed form has no others."""
    method = METHODS[settings.method]
    return () if method.is_minimum or method.held is None else method.held
