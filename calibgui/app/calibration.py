"""From located corners to a result, the same for the command line and the window."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePath

import numpy as np
from threadpoolctl import threadpool_limits

from calibgui import engine
from calibgui.app.marking import removed
from calibgui.engine.errors import CalibrationError
from calibgui.engine.screening import screen
from calibgui.engine.types import (
    Ambiguity,
    Calibration,
    Cost,
    IntArray,
    Observation,
    Plate,
    PlateModel,
    Prior,
    Report,
    View,
)
from calibgui.engine.validation import choose_plate
from calibgui.formats.corners_json import CornerSet
from calibgui.formats.result import Result
from calibgui.report.numbers import counted


def calibrate_views(
    corner_set: CornerSet,
    *,
    cost: Cost | str = Cost.IMAGE,
    fix: Mapping[str, float | None] | Iterable[str] = (),
    free: Iterable[str] = (),
    plate: PlateModel | Plate | None = PlateModel.NOMINAL,
    prior: Prior | None = None,
    robust: bool = False,
    report: Report | None = None,
) -> Result:
    """Calibrate from the usable views of a set; the arguments are ``engine.calibrate``'s.

    Without a `plate` (None) the model that predicts unseen views best is chosen, and the
    result's warnings say why. `robust` leaves outliers out first (``engine.screening``): the
    result's views are without them, and its warnings name them.

    Raises:
        CalibrationError: as ``engine.calibrate``, naming images, or if no view is usable.
        Cancelled: from `report`.
    """
    views = corner_set.views
    if not any(view.usable for view in views):
        raise CalibrationError(
            "None of the images can be used.",
            "Photograph the whole board, sharp and evenly lit, at least 3 times from different "
            "directions.",
        )
    # The matrices are small: threads would cost more than they bring.
    with threadpool_limits(1):
        said: tuple[str, ...] = ()
        if robust:
            views, said = _screened(corner_set, fix, free)
        used = [view for view in views if view.usable]
        observations = [view.observation(corner_set.target) for view in used]
        if plate is None:
            choice = choose_plate(observations, corner_set.size, fix=fix, free=free)
            plate, said = choice.model, (choice.words, *said)
        calibration = engine.calibrate(
            observations,
            corner_set.size,
            cost=cost,
            fix=fix,
            free=free,
            plate=plate,
            prior=prior,
            report=report,
            names=short_names(used),
        )
    said = (*calibration.warnings, *said, *_unplaced(used, calibration))
    calibration = replace(calibration, warnings=said)
    return Result(calibration, views, corner_set.target)


def _unplaced(used: Sequence[View], calibration: Calibration) -> Iterator[str]:
    """Sentences on views of which it is open which corner is which."""
    parts = [view for view in used if view.corners is not None and view.corners.relative]
    if parts:
        yield (
            f"What part of the board is seen is open in {', '.join(short_names(parts))}: the "
            "pose there may be off by whole squares. The camera does not depend on it."
        )
    turned = {view.corners.ambiguity for view in used if view.corners is not None}
    if calibration.plate is not None and (parts or turned - {Ambiguity.NONE}):
        yield (
            "Not all views are known to count the board's corners alike: its estimated shape may "
            "be a mixture of what these took for the same corner."
        )


def _screened(
    corner_set: CornerSet,
    fix: Mapping[str, float | None] | Iterable[str],
    free: Iterable[str],
) -> tuple[tuple[View, ...], tuple[str, ...]]:
    """The views without outliers, and a sentence for each that lost any."""
    places = [k for k, view in enumerate(corner_set.views) if view.usable]
    used = [corner_set.views[k] for k in places]
    names = short_names(used)
    observations = [view.observation(corner_set.target) for view in used]
    screening = screen(observations, corner_set.size, names=names, fix=fix, free=free)
    views, sentences = list(corner_set.views), []
    for rejected in screening.rejected:
        view, name = used[rejected.view], names[rejected.view]
        lost = np.array(rejected.corners, dtype=np.int64)
        if rejected.whole:
            view = replace(view, enabled=False, reason=f"Left out: {rejected.reason}.")
            sentences.append(f"{name} is left out: {rejected.reason}.")
        else:
            view = _without(view, lost)
            sentences.append(f"{name} loses {counted(len(lost), 'corner')}, {rejected.reason}.")
        views[places[rejected.view]] = view
    return tuple(views), tuple(sentences)


def _without(view: View, lost: IntArray) -> View:
    """The view without some of its corners."""
    if view.corners is not None:
        view = replace(view, corners=removed(view.corners, lost))
    if view.points is not None:
        uv, xy, cov = view.points
        kept = np.setdiff1d(np.arange(len(uv)), lost)
        points = Observation(uv[kept], xy[kept], None if cov is None else cov[kept])
        view = replace(view, points=points)
    return view


def short_names(views: Sequence[View]) -> list[str]:
    """The views' images without their folders, where that leaves them different."""
    names = [PurePath(view.image).name for view in views]
    return names if len(set(names)) == len(names) else [view.image for view in views]
