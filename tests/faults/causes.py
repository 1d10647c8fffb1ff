"""The faults of the campaign: how each is injected, and the answers that name it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from tests.faults import faults_of_boards as boards
from tests.faults import faults_of_cameras as cameras
from tests.faults import faults_of_corners as corners
from tests.faults import faults_of_views as views
from tests.faults.sets import FaultySet, Rng

CLEAN = "clean"


class Fault(NamedTuple):
    """A fault, and the answers that count as right."""

    inject: Callable[[Rng], FaultySet]
    causes: tuple[str, ...]
    """Values of `Cause` that name it."""
    words: tuple[str, ...] = ()
    """Words of which an error's text has at least one if it names the fault."""


_MISPLACED = ("corner", "numbered", "rows")
_SHAPE = ("board", "square")
FAULTS = {
    "wide-lens": Fault(cameras.widen_lens, ("lens",), ("lens",)),
    "wide-lens-rough-print": Fault(cameras.widen_lens_and_roughen_print, ("lens",), ("lens",)),
    "bow": Fault(boards.bow_board, ("board-shape",), _SHAPE),
    "twist": Fault(boards.twist_board, ("board-shape",), _SHAPE),
    "affine-print": Fault(boards.print_askew, ("board-shape",), _SHAPE),
    "wrong-square": Fault(boards.mistake_square, ("board-shape",), _SHAPE),
    "rough-print": Fault(boards.print_roughly, ("board-shape",), _SHAPE),
    "bending-board": Fault(boards.bend_board, ("bending-board",), _SHAPE),
    "mixed-boards": Fault(boards.mix_boards, ("mixed-views", "views-disagree"), _SHAPE),
    "row-shifted": Fault(corners.shift_row, ("misplaced-corners",), _MISPLACED),
    "column-shifted": Fault(corners.shift_column, ("misplaced-corners",), _MISPLACED),
    "view-misnumbered": Fault(corners.misnumber_view, ("misplaced-corners",), _MISPLACED),
    "view-turned": Fault(corners.turn_view, ("misplaced-corners",), _MISPLACED),
    "views-exchanged": Fault(corners.exchange_views, ("misplaced-corners",), _MISPLACED),
    "5%-of-view-50px": Fault(corners.misplace_few, ("misplaced-corners",), _MISPLACED),
    "20%-of-view-50px": Fault(corners.misplace_many, ("misplaced-corners",), _MISPLACED),
    "1%-of-all-5px": Fault(corners.misplace_everywhere, ("misplaced-corners",), _MISPLACED),
    "rolling-shutter": Fault(cameras.roll_shutter, ("rolling-shutter",), ("shutter",)),
    "sheared-images": Fault(cameras.shear_images, ("sheared-images", "views-disagree"), ("shear",)),
    "rolled-images": Fault(cameras.roll_images, ("rolled-images",), ("roll",)),
    "scaled-images": Fault(cameras.scale_images, ("scaled-images",), ("scaled",)),
    "focus-change": Fault(cameras.refocus, ("focus",), ("focus", "zoom")),
    "stabilisation": Fault(cameras.stabilise, ("moving-centre",), ("stabilis",)),
    "zoom-change": Fault(cameras.zoom, ("mixed-views", "focus", "views-disagree"), ("zoom",)),
    "mixed-cameras": Fault(cameras.mix_cameras, ("mixed-views", "views-disagree"), ("camera",)),
    "corrected-views": Fault(
        cameras.correct_some, ("mixed-views", "views-disagree"), ("distortion", "camera")
    ),
    "blur": Fault(corners.blur_views, ("blur",), ("blur", "sharp")),
    "wrong-frame": Fault(corners.move_frame, ("wrong-frame",), ("upper left", "outside")),
    "wrong-size": Fault(corners.misstate_size, ("wrong-frame",), ("size",)),
    "held-value": Fault(cameras.hold_value, ("held-value",), ("held",)),
    "few-views": Fault(views.take_few, ("few-views",), ("views", "photograph")),
    "one-spot": Fault(
        views.stay_in_one_spot, ("few-views",), ("one spot", "small part", "part of the image")
    ),
    "one-orientation": Fault(
        views.stay_in_one_orientation, ("few-views",), ("orientation", "parallel", "tilt")
    ),
    CLEAN: Fault(views.take_none, ()),
}
