"""The a-contrario test: could a lattice have come about by chance?

Where squares are dark or bright at random, as in codes, tilings and textures, some of them
alternate like a board's. Given a corner, around which four do, the (a + 1)(b + 1) squares of a
full rectangle of a x b corners that contains it all alternate with the probability
2^(4 - (a + 1)(b + 1)), and it is contained in a b of them. Around J corners that makes an expected

    J a b 2^(4 - (a + 1)(b + 1))

rectangles by chance alone. A lattice means something if for its most surprising rectangle that
number is far below one (a-contrario detection: Desolneux, Moisan and Morel 2000). Its size alone
is no evidence: ragged parts of almost any size hang together by chance.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from calibgui.engine.arrays import BoolArray
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.lattice import list_full_rectangles

BY_CHANCE = "squares at random could have formed it"
"""The reason for which a lattice that chance explains is refused, as the end of a sentence."""
_MOST = math.log2(THRESHOLDS.verification.max_false_boards)


def is_meaningful(found: BoolArray, others: int) -> bool:
    """Return whether chance does not explain a lattice.

    Args:
        found: (rows, cols) mask of its corners.
        others: number J of corners seen in the image that are not its own; 0 counts as 1.
    """
    log_others = math.log2(max(others, 1))
    # A board tells by its first few lines.
    return any(log_others < bound for bound in _list_bounds(found))


def bound_log_others(found: BoolArray) -> float:
    """Return the binary logarithm of the number J of other corners in the image below which chance
    does not explain a lattice of the corners `found` (rows, cols)."""
    return max(_list_bounds(found), default=-math.inf)


def _list_bounds(found: BoolArray) -> Iterator[float]:
    """List the bounds, as `bound_log_others`, of each of the rectangles in a lattice."""
    for _, _, height, width in list_full_rectangles(found):
        yield _MOST + (height + 1) * (width + 1) - 4 - math.log2(height * width)
