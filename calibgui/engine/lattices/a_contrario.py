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

import numpy as np
import scipy

from calibgui.engine.arrays import BoolArray, compute_median
from calibgui.engine.features.corner_template import MIN_RELATIVE_CONTRAST
from calibgui.engine.features.lattice import Lattice, list_full_rectangles
from calibgui.engine.lattices.x_junctions import Junctions

_MAX_FALSE_BOARDS = 1 / 16
"""Number of boards that may be expected by chance in an image full of squares at random."""
BY_CHANCE = "squares at random could have formed it"
"""The reason for which a lattice that chance explains is refused, as the end of a sentence."""
_MOST = math.log2(_MAX_FALSE_BOARDS)


def is_meaningful(found: BoolArray, others: int) -> bool:
    """Return whether chance does not explain a lattice.

    Args:
        found: (rows, cols) mask of its corners.
        others: number J of corners seen in the image that are not its own; 0 counts as 1.
    """
    log_others = math.log2(max(others, 1))
    return any(
        log_others < _MOST + (height + 1) * (width + 1) - 4 - math.log2(height * width)
        for _, _, height, width in list_full_rectangles(found)
    )


def count_others(lattice: Lattice, junctions: Junctions) -> int:
    """Count the junctions that are none of a lattice's, to half a step, and not too faint beside
    these: noise where nothing is printed has any number of such."""
    tree = scipy.spatial.cKDTree(lattice.uv[lattice.found])
    distance, nearest = tree.query(junctions.uv)
    is_own = distance < lattice.spacing()[lattice.found][nearest] / 2
    if not is_own.any():
        return len(junctions)
    least = MIN_RELATIVE_CONTRAST * compute_median(junctions.contrast[is_own])
    return int(np.count_nonzero(~is_own & (junctions.contrast > least)))
