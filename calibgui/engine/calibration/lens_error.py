"""The part of the residuals that the lens model cannot follow, told from that of a bent board.

A lens that the model does not follow displaces the image alike in all views. Where the board keeps
to one part of the image, the same residuals look as if its corners were off; and a bent board, seen
often enough at one place, looks like a lens. So neither is judged alone. With the score tests of
``score_tests.py`` (hats over the image for the lens, every corner by itself for the board) the lens
is at fault

- if it explains something that a free board leaves, beyond noise, and at least half as much of
  the residuals as a free board explains of what the lens leaves; or
- if a free board explains nothing beyond noise of what the lens leaves, and the lens explains
  something that a board with unequal sides, shear and bow leaves. (These four unknowns are enough
  for most boards that are off, and a lens can look like any of them over few views.)

In either case the views must agree about it.

On 222 synthetic calibrations in which ``board_shape/uncertainty.py`` suspects the board (lenses of
50 to 186 degrees; 5 to 25 views; noise of 0.05 to 0.3 px; boards true, or off by 0.05 to 1 mm:
bowed, twisted, askew, wavy, printed unevenly, rough) the lens was blamed in 0 of 88 with the true
lens model, in 57 of 58 where a wrong one cost over three times the residuals that the board did,
and in 0 of 24 where the board cost over three times those of the lens. What the views have of their
own does not average out over few of them: where the boards bent by 0.1 to 0.3 mm from view to view,
too, it was blamed in 10 of 82, 55 of 55 and 0 of 17.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.refinement.residuals import compute_misses
from calibgui.engine.calibration.result import Cost
from calibgui.engine.calibration.score_tests import (
    LENS,
    LENS_CELLS,
    LinearisedFit,
    SharedCauses,
)

MAX_FALSE_ALARM_RATE = 1e-3
"""Probability under noise below which a cause explains something."""
_MIN_SHARE_OF_BOARD = 0.5
"""Ratio of what the lens alone explains to what the board alone explains, from which the lens is at
fault; fixed on the synthetic calibrations above and on photographs with known lenses."""
_MIN_PART_OF_BOARD = _MIN_SHARE_OF_BOARD / (1 + _MIN_SHARE_OF_BOARD)
"""Ratio of what the lens explains to what the board explains at least, below which the board
explains so much beyond the lens that the lens is not at fault."""
_MIN_CORNERS_PER_NODE = 10
"""Number of corners, on average, for each node of the mesh over which a faulty lens is measured."""
_MAX_CELLS = 24
"""Largest number of cells along the image's longer side of that mesh."""


def measure_lens_error(fit: LinearisedFit, by_board: float) -> float:
    """Measure the displacement, px rms, that the lens model leaves where a board is suspected.

    Args:
        fit: a calibration with the image cost, whose residuals a bent board would explain.
        by_board: the part of the squared residuals that the board explains at least. A lens that
            explains less than a third of it cannot outdo the board, and is not examined further,
            which saves time.

    Returns:
        Root mean square length of the displacement that all views share; 0 if the lens is not at
        fault. What the camera's parameters and the poses have absorbed is not in it.
    """
    alone = SharedCauses(fit, [LENS])
    if alone.explain(LENS).share * alone.cost < _MIN_PART_OF_BOARD * by_board:
        return 0.0
    simple, free = (BoardShapeModel.AFFINE, BoardShapeModel.BOW), BoardShapeModel.FREE
    causes = SharedCauses(fit, [LENS, *simple, free])
    if not outdoes_board(causes) and (
        causes.explain(free, LENS).probability < MAX_FALSE_ALARM_RATE
        or causes.explain(LENS, *simple).probability >= MAX_FALSE_ALARM_RATE
    ):
        return 0.0
    if not causes.do_views_agree(LENS):
        return 0.0
    lens = SharedCauses(fit, [LENS], cells=count_fine_cells(fit)).explain(LENS)
    missed = compute_misses(fit.state, fit.observations, fit.camera.model, Cost.IMAGE)
    square = np.sum(missed[fit.observations.mask > 0] ** 2)
    return float(np.sqrt(lens.share * square / fit.observations.count))


def count_fine_cells(fit: LinearisedFit) -> int:
    """Count the cells, along the image's longer side, over which a faulty lens is measured.

    A lens that is badly off bends the image sharply at its edges. The cells are as small as leaves
    each of their nodes enough corners on average.
    """
    nodes = fit.observations.count / _MIN_CORNERS_PER_NODE
    square_cells = min(fit.camera.size) / max(fit.camera.size)
    return int(np.clip(np.sqrt(nodes / square_cells), LENS_CELLS, _MAX_CELLS))


def outdoes_board(causes: SharedCauses) -> bool:
    """Return whether the lens explains what a free board cannot, and enough beside the board.

    Args:
        causes: `LENS` and `BoardShapeModel.FREE` side by side.
    """
    free = BoardShapeModel.FREE
    lens, board = causes.explain(LENS, free), causes.explain(free, LENS)
    by_lens = lens.share * (causes.cost - causes.reduce_cost(free)[0])
    by_board = board.share * (causes.cost - causes.reduce_cost(LENS)[0])
    return bool(
        lens.probability < MAX_FALSE_ALARM_RATE and by_lens > _MIN_SHARE_OF_BOARD * by_board
    )
