"""A finding: something that is wrong with a calibration and matters to who uses it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from calibgui.engine.assessment.action import Action, ActionKind
from calibgui.engine.camera.camera import Camera
from calibgui.engine.numbers import format_two_digits

MAX_GOOD_PX = 0.5
"""Largest error of any pixel among corners, and of half of the image's, up to which a calibration
is good, px. A choice, which no benchmark fixed."""
MAX_USABLE_PX = 1.0
"""Median error over the image up to which a calibration is usable, px, and above which views are
too few. A choice, which no benchmark fixed."""
MIN_HARM_PX = 0.05
"""Harm from which a cause is a finding, px: a tenth of what makes a calibration less than good
(``verdict.py``). A choice, which no benchmark fixed; on clean sets the tests' own rate of false
alarms counts, whatever it is."""
MIN_VIEWS_TO_JUDGE = 5
"""Number of views below which their number is the finding, if pixels are poorly known. With 3
in its place one of two faults `few-views` went unnamed (``tests/faults``)."""
MIN_GAIN_TO_ACT = 1.2
"""Ratio by which a remedy makes the error of a pixel smaller, from which it is offered and carried
out. A choice, which no benchmark fixed."""
MAX_TELLING_PX = 100.0
"""Error of a pixel from which its size says no more than that it is not known, px."""

MAX_LISTED = 6
"""Number of views that a sentence names."""

REMEDY_OF_LENS = (
    "Compare the lens models and take the one that is recommended; if it is this one, add views up "
    "to the image's edges, which determine more of the lens."
)
"""Sentence on what to do about a lens that its model does not follow."""
REMEDY_OF_FEW_VIEWS = (
    "Add views with the board tilted by 20 to 45 degrees in different directions and all over the "
    "image; six good ones are enough."
)
"""Sentence on what to do about views that are too few."""
_REMEDY_OF_NARROW_VIEWS = (
    "Hold the board nearer, so that it fills half of the image or more, bring it into the image's "
    "corners, and tilt it by 20 to 45 degrees in different directions."
)
"""Sentence on what to do about views whose corners leave most of the image out."""


class Cause(StrEnum):
    """The causes that a finding can name."""

    WRONG_FRAME = "wrong-frame"
    HELD_VALUE = "held-value"
    UNDETERMINED = "undetermined"
    """Coefficients of the lens that the views leave open."""
    MISPLACED_CORNERS = "misplaced-corners"
    LENS = "lens"
    BOARD_SHAPE = "board-shape"
    FOCUS = "focus"
    MOVING_CENTRE = "moving-centre"
    """The principal point differs between the views, as that of stabilised images."""
    BENDING_BOARD = "bending-board"
    ROLLING_SHUTTER = "rolling-shutter"
    LINE_JITTER = "line-jitter"
    SHEARED_IMAGES = "sheared-images"
    """Each row is shifted sideways against the next, by the same angle in all images."""
    ROLLED_IMAGES = "rolled-images"
    """Each row is turned against the next, by the same angle in all images, or the lens is
    decentred."""
    SCALED_IMAGES = "scaled-images"
    """The corners' errors repeat with a period of few pixels, as where images were scaled."""
    MIXED_VIEWS = "mixed-views"
    """Photographs of two cameras, zooms or boards; the evidence seldom tells which."""
    DISAGREEMENT = "views-disagree"
    """The views disagree about the camera, and the evidence singles no cause out."""
    BLUR = "blur"
    FEW_VIEWS = "few-views"


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that is wrong with a calibration and matters to who uses it."""

    cause: Cause
    """The cause that the evidence singles out."""
    message: str
    """A sentence that says what is wrong."""
    evidence: str
    """A sentence with the figures that show it."""
    remedy: str
    """A sentence that says what to do."""
    harm: float
    """Error that the cause adds to that of pixels, px rms over the part of the image that corners
    cover (``case.py``): of a lens model at least what it leaves of the residuals, and the
    image's size where the corners are of another frame."""
    views: tuple[int, ...] = ()
    """Indices of the views that it is found in; none if it is in all of them."""
    action: Action | None = None
    """The action that remedies it; None if no program can help."""
    times_better: float = 1.0
    """Ratio by which the action makes the error of pixels smaller, as a trial showed
    (``verdict.py``); 1 if it was not tried or brings nothing."""
    without: Camera | None = None
    """The camera without the cause, where no action leads to it; None if it is not known."""


def describe_harm(harm: float) -> str:
    """Describe what a cause does to pixels, px, as the end of a sentence."""
    return f"it adds {format_two_digits(harm)} px to the error of pixels where there are corners"


def describe_narrow_views(
    part: float, covered: float, median: float, is_mended: bool = False
) -> Finding:
    """Describe views whose corners cover too small a part of the image to know the rest of it.

    Args:
        part: share of the image that the corners of all views cover.
        covered: error of a pixel there, px rms.
        median: median error over the image, px.
        is_mended: True if these errors are what another remedy leaves.
    """
    is_telling = median < MAX_TELLING_PX
    rest = f"only to {format_two_digits(median)} px" if is_telling else "not at all"
    return Finding(
        Cause.FEW_VIEWS,
        f"Corners cover only {100 * part:.0f} % of the image, too small a part to know the lens "
        "beyond it.",
        f"{'Once the rest is mended, a' if is_mended else 'A'} pixel is known to "
        f"{format_two_digits(covered)} px among corners, but {rest} in the median over the image.",
        _REMEDY_OF_NARROW_VIEWS,
        covered,
        action=Action(ActionKind.PHOTOGRAPH_MORE),
    )


_CAUSES_OF_NO_RESIDUALS = (Cause.UNDETERMINED, Cause.FEW_VIEWS)
"""Causes of an uncertain camera that leave no traces in the residuals."""


def find_explanation(findings: Iterable[Finding]) -> Finding | None:
    """Return the first finding that explains residuals which are not noise; None if none does."""
    return next((f for f in findings if f.cause not in _CAUSES_OF_NO_RESIDUALS), None)
