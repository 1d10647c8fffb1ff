"""From located corners to a result, the same for the command line and the window."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePath
from typing import Any

import numpy as np

from calibgui import engine
from calibgui.app.marking import removed
from calibgui.app.settings import USUAL, Settings
from calibgui.dataset.corner_set import CornerSet
from calibgui.dataset.result import Result
from calibgui.dataset.view import View
from calibgui.engine.arrays import IntArray, Size
from calibgui.engine.assessment import calibrate_weighted, choose_board_shape, screen
from calibgui.engine.boards import Ambiguity, BoardShapeModel
from calibgui.engine.calibration import (
    Calibration,
    Cost,
    DegenerateError,
    Iteration,
    Observation,
    Report,
    copies,
)
from calibgui.engine.errors import CalibrationError, Cancelled
from calibgui.engine.redetection import upside_down
from calibgui.engine.threads import one_blas_thread
from calibgui.report.numbers import counted

_UNTRIED = (
    "The nominal plate is kept: without some of the views the others do not determine the camera, "
    "so that no plate model can be tried on unseen ones."
)
_ABANDONED = (
    "The nominal plate is taken: the comparison of plate models on unseen views was stopped."
)


def calibrate_views(
    corner_set: CornerSet, settings: Settings = USUAL, report: Report | None = None
) -> Result:
    """Calibrate from the usable views of a set.

    Where the plate is left open the result's warnings say why which model was chosen. Outliers
    are left out first (``engine.quality.screening``): the result's views are without them, and its
    warnings name them. Where views are weighed, the result's views have the covariances with
    which they were. Copies of a view are left out. Of views that do not determine the camera the
    result is partial (``Calibration.diagnosis``), without looking for outliers or weighing.

    Raises:
        CalibrationError: as ``engine.calibrate``, naming images, or if no view is usable;
            DegenerateError if the views determine nothing at all.
        Cancelled: from `report`.
    """
    if not any(view.usable for view in corner_set.views):
        raise CalibrationError(
            "None of the images can be used.",
            "Photograph the whole board, sharp and evenly lit, at least 3 times from different "
            "directions, and choose the pattern that it has.",
        )
    if settings.weigh_views and settings.cost is not Cost.IMAGE:
        raise CalibrationError(
            f"The cost {settings.cost.value!r} weighs all corners alike.",
            "Weigh views by their noise with the cost 'image'.",
        )
    corner_set = replace(corner_set, views=_each_once(corner_set))
    # The matrices are small: threads would cost more than they bring.
    with one_blas_thread():
        try:
            return _calibrated(corner_set, settings, report)
        except DegenerateError:
            partial = _partly(corner_set, settings, report)
            if partial is None:
                raise
            return partial


def _calibrated(corner_set: CornerSet, settings: Settings, report: Report | None) -> Result:
    """As `calibrate_views`, if the views determine the camera."""
    views, size = corner_set.views, corner_set.size
    said: tuple[str, ...] = ()
    if settings.robust:
        views, said = _screened(corner_set, settings)
    used = [view for view in views if view.usable]
    observations = [view.observation(corner_set.board) for view in used]
    camera: dict[str, Any] = {"fix": settings.fixed, "free": settings.freed}
    board_shape = settings.board_shape
    if board_shape is None:
        board_shape, words = _predicting(observations, size, camera, report)
        said = (words, *said)
    everything = camera | {
        "cost": settings.cost,
        "board_shape": board_shape,
        "prior": settings.prior,
        "report": report,
        "names": short_names(used),
    }
    if settings.weigh_views:
        calibration, observations = calibrate_weighted(observations, size, **everything)
        views = _with_covariances(views, observations)
        said = (*said, _about_weights(observations, everything["names"]))
    else:
        calibration = engine.calibrate(observations, size, **everything)
    return Result(_told(calibration, used, settings, said), views, corner_set.board)


def _predicting(
    observations: Sequence[Observation],
    size: Size,
    camera: Mapping[str, Any],
    report: Report | None,
) -> tuple[BoardShapeModel, str]:
    """The plate model that predicts unseen views best, as far as it can be told, and why."""
    stopped = False

    def watch(iteration: Iteration) -> bool:
        nonlocal stopped
        if report is not None and not report(iteration):
            stopped = True
            raise Cancelled
        return True

    try:
        choice = choose_board_shape(observations, size, report=watch, **camera)
    except DegenerateError:
        return BoardShapeModel.NOMINAL, _UNTRIED
    except Cancelled:
        if not stopped:
            raise
        return BoardShapeModel.NOMINAL, _ABANDONED
    return choice.model, choice.words


def _told(
    calibration: Calibration, used: Sequence[View], settings: Settings, said: Sequence[str] = ()
) -> Calibration:
    """The calibration with what was done about poor views, and what there is to say of it all."""
    asked = {"robust": settings.robust, "weigh_views": settings.weigh_views}
    return replace(
        calibration,
        warnings=(*calibration.warnings, *said, *_unplaced(used, calibration)),
        settings={**calibration.settings, **asked},
    )


def _partly(corner_set: CornerSet, settings: Settings, report: Report | None) -> Result | None:
    """What views that do not determine the camera say of it, as they are; None if nothing."""
    plain = replace(
        settings,
        robust=False,
        weigh_views=False,
        board_shape=settings.board_shape or BoardShapeModel.NOMINAL,
    )
    try:
        _calibrated(corner_set, plain, report)
    except DegenerateError as error:
        if error.partial is not None:
            used = [view for view in corner_set.views if view.usable]
            calibration = _told(error.partial, used, plain)
            return Result(calibration, corner_set.views, corner_set.board)
    return None


def _each_once(corner_set: CornerSet) -> tuple[View, ...]:
    """The views, of which those are left out that repeat another's very corners, unless all do."""
    views = list(corner_set.views)
    usable = [k for k, view in enumerate(views) if view.usable]
    like = copies(views[k].observation(corner_set.board)[:2] for k in usable)
    for k, first in zip(usable, like.tolist(), strict=True):
        original = usable[first]
        if original != k and like.any():
            reason = f"A copy of {views[original].image}, which counts once."
            views[k] = replace(views[k], enabled=False, reason=reason)
    return tuple(views)


def _with_covariances(
    views: Sequence[View], observations: Sequence[Observation]
) -> tuple[View, ...]:
    """The views, the usable ones with the covariances of these observations."""
    left = iter(observations)
    return tuple(_with_covariance(view, next(left)) if view.usable else view for view in views)


def _with_covariance(view: View, weighed: Observation) -> View:
    if view.points is not None:
        return replace(view, points=weighed)
    assert view.corners is not None  # usable views have corners
    return replace(view, corners=replace(view.corners, cov=weighed.cov))


def _about_weights(weighed: Sequence[Observation], names: Sequence[str]) -> str:
    """Between what the views' noise lies, and the noisiest."""
    sigma = [
        float(np.sqrt(np.median(np.trace(view.cov, axis1=1, axis2=2)) / 2))
        for view in weighed
        if view.cov is not None
    ]
    noisiest = int(np.argmax(sigma))
    return (
        f"The views are weighed by their noise, {min(sigma):.2g} to {max(sigma):.2g} px at a "
        f"typical corner, {np.median(sigma):.2g} px in the median view, most in "
        f"{names[noisiest]}."
    )


def _unplaced(used: Sequence[View], calibration: Calibration) -> Iterator[str]:
    """Sentences on views of which it is open which corner is which."""
    parts = [view for view in used if view.corners is not None and view.corners.relative]
    if parts:
        yield (
            f"What part of the board is seen is open in {', '.join(short_names(parts))}: the "
            "pose there may be off by whole squares. The camera does not depend on it."
        )
    turned = {view.corners.ambiguity for view in used if view.corners is not None}
    if calibration.board_shape is not None and (parts or turned - {Ambiguity.NONE}):
        yield (
            "Not all views are known to count the board's corners alike: its estimated shape may "
            "be a mixture of what these took for the same corner."
        )


def _screened(
    corner_set: CornerSet, settings: Settings
) -> tuple[tuple[View, ...], tuple[str, ...]]:
    """The views without outliers, and a sentence for each that lost any."""
    places = [k for k, view in enumerate(corner_set.views) if view.usable]
    used = [corner_set.views[k] for k in places]
    names = short_names(used)
    observations = [view.observation(corner_set.board) for view in used]
    screening = screen(
        observations, corner_set.size, names=names, fix=settings.fixed, free=settings.freed
    )
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
    kept = [(used[k], names[k]) for k, good in enumerate(screening.kept) if good.any()]
    against = [kept[k] for k in upside_down(screening.calibration.poses).tolist()]
    if unsure := [name for view, name in against if _turn_is_open(view)]:
        sentences.append(
            f"The board is upside down in {', '.join(unsure)}, as its corners are counted. If the "
            "photograph does not show it so, they are counted from the wrong end; only an "
            "estimated plate would notice."
        )
    return tuple(views), tuple(sentences)


def _turn_is_open(view: View) -> bool:
    """Whether the board might be turned: nothing is known of its colours, or they do not tell."""
    return view.corners is None or view.corners.ambiguity is not Ambiguity.NONE


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
