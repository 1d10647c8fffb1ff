"""The residuals split into the parts of lens, board, single views and noise, in pixels.

The squared residuals are shared out in turn, each cause taking what it explains beyond noise of
what the causes before it leave (score tests, ``calibration/score_tests.py``):

lens    a smooth displacement of the image that all views share and the lens model does not follow;
board   corners of the board that are not where they should be;
views   smooth displacements of each view's own: a board that bends anew, another focal length,
        motion while the rows are read;
noise   all that is left.

Lens and board explain much of each other where the board keeps to one part of the image. What both
could explain goes to the lens if it outdoes the board (``calibration/lens_error.py``), and to the
board otherwise. The lens counts as at fault if the calibration says so, or if it outdoes the board
and contributes more than single views. A cause that explains no more than noise would, at one in a
thousand, contributes 0.

The shares say where the residuals come from, not how far the camera is off: what camera and poses
have absorbed leaves no residuals. Errors of the views' own do not average out completely over few
views; what remains counts as the lens's or the board's. Whether another lens model really predicts
unseen views better is found by calibrating with it (``lens_choice.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.assessment.residuals.residual_statistics import summarise_residuals
from calibgui.engine.assessment.residuals.systematic_errors import make_smooth_columns, prepare_fit
from calibgui.engine.boards.shape import BoardShapeModel
from calibgui.engine.calibration.lens_error import (
    MAX_FALSE_ALARM_RATE,
    count_fine_cells,
    outdoes_board,
)
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.calibration.score_tests import (
    LENS,
    LENS_CELLS,
    SharedCauses,
    judge_explanation,
)
from calibgui.engine.threads import with_one_blas_thread


@dataclass(frozen=True, slots=True)
class ErrorSources:
    """Contributions to the residuals, px rms (2-D); their squares add up to that of `rms`."""

    rms: float
    lens: float
    board: float
    views: float
    noise: float
    is_lens_at_fault: bool
    """True if the lens model does not follow the lens, as far as the residuals tell."""


@with_one_blas_thread
def separate_error_sources(calibration: Calibration, views: Sequence[Observation]) -> ErrorSources:
    """Separate what lens, board, single views and noise contribute to a calibration's residuals.

    Args:
        calibration: calibration with any cost; its residuals in the image are separated.
        views: the views that it was made from.
    """
    fit, free = prepare_fit(calibration, views), BoardShapeModel.FREE
    shared, cells = SharedCauses(fit, [LENS, free]), LENS_CELLS
    is_lens_first = calibration.lens_error > 0 or outdoes_board(shared)
    first, second = (LENS, free) if is_lens_first else (free, LENS)
    if is_lens_first:
        cells = count_fine_cells(fit)
        shared = SharedCauses(fit, [LENS, free], cells=cells)
    known: list[str] = []
    contributed = {LENS: 0.0, free: 0.0, "views": 0.0}
    for cause in (first, second):
        found = shared.explain(cause, *known)
        if found.probability < MAX_FALSE_ALARM_RATE:
            contributed[cause] = found.share * (1 - shared.reduce_cost(*known)[0] / shared.cost)
            known.append(cause)
    T, rank = shared.reduce_cost(*known)
    own = make_smooth_columns(fit)
    beside = SharedCauses(fit, known, own, cells)
    T_beside, rank_beside = beside.reduce_cost(*known)
    left = beside.cost_beside_views - T_beside
    rank_own = int(np.count_nonzero(own.any(axis=1))) - 6 * len(own) + rank_beside - rank
    explained = shared.cost_beside_views - T - left
    by_views = judge_explanation(explained, rank_own, shared.cost - T, shared.freedom - rank)
    noise = 1 - sum(contributed.values())
    if by_views.probability < MAX_FALSE_ALARM_RATE:
        variance = left / (shared.freedom - rank - rank_own)
        noise = min(noise, variance * shared.freedom / shared.cost)
        contributed["views"] = 1 - sum(contributed.values()) - noise
    rms = summarise_residuals(calibration.residuals).rms
    px = {cause: float(np.sqrt(max(share, 0.0))) * rms for cause, share in contributed.items()}
    exceeds_views = is_lens_first and px[LENS] > px["views"]
    at_fault = calibration.lens_error > 0 or exceeds_views
    own_part, noise_part = px["views"], float(np.sqrt(noise)) * rms
    return ErrorSources(rms, px[LENS], px[free], own_part, noise_part, at_fault)
