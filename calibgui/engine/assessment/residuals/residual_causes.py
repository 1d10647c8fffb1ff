"""The causes of residuals that are not noise: what each adds to the model, and what is said of it.

A cause adds unknowns: to all views alike a displacement of the board's corners or of the image
(``calibration/score_tests.py``), or to each view columns of its own (``systematic_errors.py``).
``residual_checks`` tests what each of them explains, ``causes/cause_choice.py`` which is named.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from calibgui.engine.assessment.action import ActionKind
from calibgui.engine.assessment.finding import Cause
from calibgui.engine.assessment.residuals.cause_fits import Columns
from calibgui.engine.assessment.residuals.systematic_errors import (
    make_bending_columns,
    make_centre_columns,
    make_cubic_displacements,
    make_focus_columns,
    make_line_columns,
    make_row_columns,
)
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.score_tests import CURVED, LENS


class Family(Enum):
    """The families of causes, by how many unknowns they have and which views share them."""

    BOARD = auto()
    """A board that is the same in all views."""
    LENS = auto()
    OF_VIEW = auto()
    """Few unknowns of each view's own."""
    OPEN = auto()
    """So many unknowns of each view's own that they follow nearly anything."""


@dataclass(frozen=True, slots=True)
class ResidualCause:
    """A cause of residuals that are not noise."""

    name: str
    """Name of its test."""
    cause: Cause
    """Cause that a finding names."""
    family: Family
    """Family of its unknowns."""
    adds: str | Columns
    """Displacement of board or image that it adds to all views, by its name, or columns that it
    adds to each."""
    message: str
    """Sentence that says what is wrong."""
    advice: str
    """Meaning of a failed test and, after a colon, its remedy."""
    action: ActionKind = ActionKind.PHOTOGRAPH_MORE
    """Kind of action that remedies it."""

    @property
    def remedy(self) -> str:
        """The sentence that says what to do."""
        text = self.advice.partition(": ")[2]
        return f"{text[:1].upper()}{text[1:]}"


CAUSES = (
    ResidualCause(
        "squares",
        Cause.BOARD_SHAPE,
        Family.BOARD,
        BoardShapeModel.AFFINE,
        "Your board is not printed true.",
        "The board's squares are not as wide as high, or askew: measure its sides over many "
        "squares, or estimate the board's shape (affine).",
        ActionKind.ESTIMATE_BOARD_SHAPE,
    ),
    ResidualCause(
        "bow",
        Cause.BOARD_SHAPE,
        Family.BOARD,
        CURVED,
        "Your board is not flat.",
        "The board is bowed or twisted: mount it on something stiff, or estimate its shape (free).",
        ActionKind.ESTIMATE_BOARD_SHAPE,
    ),
    ResidualCause(
        "lens",
        Cause.LENS,
        Family.LENS,
        LENS,
        "The lens model does not follow this lens.",
        "The lens model does not follow this lens: free the coefficients that are held, or use "
        "another model.",
        ActionKind.CHOOSE_LENS_MODEL,
    ),
    ResidualCause(
        "focus",
        Cause.FOCUS,
        Family.OF_VIEW,
        make_focus_columns,
        "The focal length differs between the views.",
        "The focal length differs between the views: switch autofocus and stabilisation off, and "
        "do not touch zoom and focus.",
    ),
    ResidualCause(
        "centre",
        Cause.MOVING_CENTRE,
        Family.OF_VIEW,
        make_centre_columns,
        "The principal point differs between the views, as if the images were stabilised or "
        "cropped.",
        "The principal point differs between the views: switch image stabilisation off, and do not "
        "crop or straighten the photographs.",
    ),
    ResidualCause(
        "bending",
        Cause.BENDING_BOARD,
        Family.OF_VIEW,
        make_bending_columns,
        "The board bends from view to view, or lies under glass or plastic.",
        "The board bends from view to view, as paper in the hand does, or is seen through glass: "
        "mount it on something stiff, and take off glass or plastic that covers it.",
    ),
    ResidualCause(
        "rows",
        Cause.ROLLING_SHUTTER,
        Family.OF_VIEW,
        make_row_columns,
        "Camera or board moved while the image's rows were read, or the images were warped.",
        "Camera or board moved while a rolling shutter read the rows, or a program has warped the "
        "photographs: put both on a stand, or expose all rows at once, and switch off what "
        "stabilises or straightens.",
    ),
    ResidualCause(
        "lines",
        Cause.LINE_JITTER,
        Family.OPEN,
        make_line_columns,
        "The image's rows do not start evenly.",
        "The image's rows do not start evenly, as those of an analogue camera, or of a rolling "
        "shutter that trembled: take many views, which average it, or put the camera on a stand.",
    ),
    ResidualCause(
        "smooth",
        Cause.DISAGREEMENT,
        Family.OPEN,
        make_cubic_displacements,
        "Each view is distorted in its own way, and no single cause explains it.",
        "Each view is distorted in its own way, and no single cause explains it: mount the board "
        "on something stiff, keep board and camera still, and switch off autofocus, stabilisation "
        "and what edits photographs.",
    ),
    ResidualCause(
        "board",
        Cause.BOARD_SHAPE,
        Family.BOARD,
        BoardShapeModel.FREE,
        "Your board is not flat, or not printed true.",
        "The board is not flat or not printed true: mount it on glass, or estimate its shape "
        "(free).",
        ActionKind.ESTIMATE_BOARD_SHAPE,
    ),
)
"""The causes, in the order in which they are tested."""
_BY_NAME = {cause.name: cause for cause in CAUSES}


def find_cause(name: str) -> ResidualCause:
    """Return the cause that a test of this name is of."""
    return _BY_NAME[name]


def list_tests(*families: Family) -> list[str]:
    """List the names of the tests of some families of causes."""
    return [cause.name for cause in CAUSES if cause.family in families]
