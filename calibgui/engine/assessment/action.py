"""Actions: what can be done about a finding, as data that a program carries out.

An action that another calibration from the same photographs carries out is a `Change` of how they
are calibrated. Trials (``action_trials.py``), the application's settings and the options of the
command line read the change and know no kinds: what a new kind does stands in `Action.change`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import assert_never

AUTO = "auto"
"""Name of a lens model, or of a board's shape, that is still to be chosen by what views say."""


class ActionKind(StrEnum):
    """The kinds of actions that remedy a finding, or help to."""

    ESTIMATE_BOARD_SHAPE = "estimate-board-shape"
    CHOOSE_LENS_MODEL = "choose-lens-model"
    LEAVE_OUT_CORNERS = "leave-out-corners"
    """Leave out all corners and views that do not fit."""
    LEAVE_OUT_VIEWS = "leave-out-views"
    FREE_HELD_VALUE = "free-held-value"
    HOLD_AT_ZERO = "hold-at-zero"
    ESTIMATE_SKEW = "estimate-skew"
    """Calibrate with a lens model that holds a skew, and free it."""
    WEIGH_VIEWS = "weigh-views"
    LOOK_AT_VIEW = "look-at-view"
    PHOTOGRAPH_MORE = "photograph-more"


@dataclass(frozen=True, slots=True)
class Change:
    """A change of how photographs are calibrated; what is None, empty or False stays as it was."""

    lens_model: str | None = None
    """Name of the lens model that is taken, or `AUTO`. Coefficients of the one before that were
    held or freed are forgotten."""
    board_shape: str | None = None
    """Name of the board's shape model that is estimated, or `AUTO`."""
    releases: tuple[str, ...] = ()
    """Names of parameters that were held by choice and are estimated."""
    frees: tuple[str, ...] = ()
    """Names of parameters that the lens model holds and that are estimated."""
    holds_at_zero: tuple[str, ...] = ()
    """Names of parameters that are held at 0."""
    leaves_out_corners: bool = False
    """True if corners and views that do not fit are left out."""
    leaves_out_views: tuple[int, ...] = ()
    """Indices of the views that are left out."""
    weighs_views: bool = False
    """True if views are weighed by their noise."""

    @property
    def takes_image_cost(self) -> bool:
        """True if it takes the image cost and the default method, whatever was minimised before."""
        return self.lens_model is not None or self.board_shape is not None or self.weighs_views


@dataclass(frozen=True, slots=True)
class Action:
    """Something that can be done about a finding, and that a program can carry out or prepare."""

    kind: ActionKind
    """The kind of action."""
    views: tuple[int, ...] = ()
    """Indices of the views that it is about."""
    parameters: tuple[str, ...] = ()
    """Names of the camera's parameters that are freed or held."""
    model: str = ""
    """The board's shape model or the lens model that was found to be best; empty if none was
    tried."""

    @property
    def change(self) -> Change | None:
        """The change that carries it out; None if it takes the user, or other photographs."""
        match self.kind:
            case ActionKind.ESTIMATE_BOARD_SHAPE:
                return Change(board_shape=self.model or AUTO)
            case ActionKind.CHOOSE_LENS_MODEL:
                return Change(lens_model=self.model or AUTO, holds_at_zero=self.parameters)
            case ActionKind.LEAVE_OUT_CORNERS:
                return Change(leaves_out_corners=True)
            case ActionKind.LEAVE_OUT_VIEWS:
                return Change(leaves_out_views=self.views)
            case ActionKind.FREE_HELD_VALUE:
                return Change(releases=self.parameters)
            case ActionKind.HOLD_AT_ZERO:
                return Change(holds_at_zero=self.parameters)
            case ActionKind.ESTIMATE_SKEW:
                return Change(lens_model=self.model, frees=self.parameters)
            case ActionKind.WEIGH_VIEWS:
                return Change(weighs_views=True)
            case ActionKind.LOOK_AT_VIEW | ActionKind.PHOTOGRAPH_MORE:
                return None
            case _:
                assert_never(self.kind)
