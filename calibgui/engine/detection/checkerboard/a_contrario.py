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

import numpy as np

from calibgui.engine.arrays import BoolArray
from calibgui.engine.detection.checkerboard.thresholds import THRESHOLDS
from calibgui.engine.detection.lattice import list_full_rectangles

BY_CHANCE = "squares at random could have formed it"
"""The reason for which a lattice that chance explains is refused, as the end of a sentence."""
_MOST = float(np.log2(THRESHOLDS.verification.max_false_boards))


def is_meaningful(found: BoolArray, others: int) -> bool:
    """Return whether chance does not explain a lattice.

    Args:
        found: (rows, cols) mask of its corners.
        others: number J of corners seen in the image that are not its own; 0 counts as 1.
    """
    return any(
        np.log2(max(others, 1) * height * width) - ((height + 1) * (width + 1) - 4) < _MOST
        for _, _, height, width in list_full_rectangles(found)
    )
