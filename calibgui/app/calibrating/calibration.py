"""Calibration from located corners, the same for the command line and the window."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from calibgui import engine
from calibgui.app.calibrating.known_camera import locate_with_known
from calibgui.app.calibrating.settings import (
    DEFAULT_MODEL,
    DEFAULT_SETTINGS,
    Settings,
    check_settings,
)
from calibgui.app.photographs.copies import disable_copies
from calibgui.app.photographs.marking import remove_corners
from calibgui.dataset import CornerSet, Result, View
from calibgui.engine.arrays import IntArray, Size
from calibgui.engine.assessment import (
    calibrate_weighted,
    choose_board_shape,
    choose_lens,
    choose_lens_stepwise,
    screen_outliers,
)
from calibgui.engine.boards import BoardShapeModel, Symmetry
from calibgui.engine.calibration import (
    Calibration,
    DegenerateError,
    Iteration,
    Observation,
    Report,
    is_held,
)
from calibgui.engine.camera import find_common_circle, find_model
from calibgui.engine.errors import CalibrationError, Cancelled, Progress
from calibgui.engine.features import find_usable_covariances
from calibgui.engine.redetection import find_upside_down_views
from calibgui.engine.threads import limit_blas_threads
from calibgui.report.lens_choice import describe_lens_choice
from calibgui.report.numbers import format_count

_BOARD_SHAPE_UNTRIED = (
    "The nominal board shape is kept: without some of the views the others do not determine the "
    "camera, so that no model of the shape can be tested on unseen ones."
)
_BOARD_SHAPE_STOPPED = (
    "The nominal board shape is taken: the comparison of models on unseen views was stopped."
)


class ChosenLens(NamedTuple):
    """A lens model that was chosen automatically."""

    model: str
    """Its name."""
    reason: str
    """The reason in words."""
    fixed: Mapping[str, float] = MappingProxyType({})
    """Coefficients that are held at 0 with it."""

    def apply_to(self, settings: Settings) -> Settings:
        """Return the settings with this lens model in place of the automatic choice."""
        return replace(settings, model=self.model, fixed={**settings.fixed, **self.fixed})


def calibrate_views(
    corner_set: CornerSet,
    settings: Settings = DEFAULT_SETTINGS,
    report: Report | None = None,
    progress: Progress | None = None,
    lens: ChosenLens | None = None,
) -> Result:
    """Calibrate from the usable views of a set.

    If the lens model or the model of the board's shape is to be chosen, the result's warnings give
    the reason of the choice. Outliers are left out first
    (``engine.assessment.screen_outliers``): the result's views do not contain them, and its
    warnings name them. If views are weighed, the result's views have the covariances of the last
    solution. Copies of a view are left out. If the views do not determine the camera, the result is
    partial (``Calibration.diagnosis``), from all corners and unweighed. Views whose corners have no
    usable covariance are left out. A camera that is known is held, and only boards are located.

    Args:
        corner_set, settings: the views, and how to calibrate from them.
        report: a function that is called with every iteration.
        progress: a function that is told how many steps of the choice of a lens model are done; all
            of them once it is made.
        lens: the lens model that was chosen from these views before, for settings that name none.

    Raises:
        CalibrationError: as ``engine.calibrate``, with the names of images; for settings that do
            not go together, or that hold the whole camera; or if no view is usable.
        DegenerateError: if the views determine nothing at all.
        Cancelled: from `report` or `progress`.
    """
    if not any(view.usable for view in corner_set.views):
        raise CalibrationError(
            "None of the images can be used.",
            "Photograph the whole board, sharp and evenly lit, at least 3 times from different "
            "directions, and choose the pattern that it has.",
        )
    if settings.known is not None:
        return locate_with_known(corner_set, settings.known)
    check_settings(settings)
    corner_set = disable_copies(disable_unweighable_views(corner_set))
    # The matrices are small: threads would cost more than they bring.
    with limit_blas_threads():
        try:
            if settings.model is not None:
                return _calibrate_whole(corner_set, settings, report)
            lens = lens or _choose_lens(corner_set, settings, report, progress)
            if progress is not None:
                progress(1, 1)
            return _calibrate_whole(corner_set, lens.apply_to(settings), report, lens)
        except DegenerateError:
            partial = _calibrate_partially(corner_set, settings, report)
            if partial is None:
                raise
            return partial


def recall_lens_choice(result: Result) -> ChosenLens | None:
    """Return the lens model of a result if it was chosen automatically, else None."""
    calibration = result.calibration
    reason = calibration.settings.model_reason
    if reason is None:
        return None
    lens = find_model(calibration.camera.model)
    fixed = {
        name: value
        for name, value in calibration.settings.fixed.items()
        if name in lens.names and name not in lens.held
    }
    return ChosenLens(calibration.camera.model, reason, fixed)


def _choose_lens(
    corner_set: CornerSet, settings: Settings, report: Report | None, progress: Progress | None
) -> ChosenLens:
    """Choose the lens model that the views demand, without their outliers if these are left out.

    The default model is returned if the comparison is impossible or `report` stops it.
    """
    lens = _compare_lenses(corner_set, settings, report, progress)
    if not settings.robust:
        return lens
    views, _ = _leave_out_outliers(corner_set, lens.apply_to(settings))
    if all(a is b for a, b in zip(views, corner_set.views, strict=True)):
        return lens
    return _compare_lenses(replace(corner_set, views=views), settings, report, progress)


def _compare_lenses(
    corner_set: CornerSet, settings: Settings, report: Report | None, progress: Progress | None
) -> ChosenLens:
    """Choose the lens model that the usable views demand. Returns as `_choose_lens`.

    The board's shape is that of the settings: what a flat board hides of the lens counts as well.
    One that is to be chosen is chosen with the lens that views of the board as drawn demand.
    """
    used = [view for view in corner_set.views if view.usable]
    observations = [view.observation(corner_set.board) for view in used]
    board_shape = settings.board_shape
    if board_shape is None:
        drawn = replace(settings, board_shape=BoardShapeModel.NOMINAL)
        lens = _compare_lenses(corner_set, drawn, report, progress)
        camera = _list_camera_arguments(lens.apply_to(settings))
        board_shape, _ = _choose_board_shape(observations, corner_set.size, camera, report)
        if board_shape is BoardShapeModel.NOMINAL:
            return lens
    watch = _Watch(report)
    first, choose = DEFAULT_MODEL, choose_lens_stepwise
    if among := settings.candidates:
        first, choose = among[0], partial(choose_lens, candidates=among)
    title = find_model(first).title
    try:
        choice = choose(
            observations,
            corner_set.size,
            progress=progress,
            cost=settings.cost,
            method=settings.method,
            fix=settings.fixed,
            board_shape=board_shape,
            prior=settings.prior,
            report=watch,
        )
    except CalibrationError as error:
        return ChosenLens(first, f"{title} is taken without a comparison. {error.message}")
    except Cancelled:
        if not watch.stopped:
            raise
        return ChosenLens(first, f"{title} is taken: the comparison of lens models was stopped.")
    return ChosenLens(choice.model, describe_lens_choice(choice), choice.chosen.fixed)


class _Watch:
    """A report of a comparison, which cannot end with the best so far: a stop cancels it."""

    def __init__(self, report: Report | None) -> None:
        """Take the report that may ask to stop."""
        self._report = report
        self.stopped = False
        """True if the report asked to stop."""

    def __call__(self, iteration: Iteration) -> bool:
        """Hand an iteration on; raise `Cancelled` if the comparison is to be stopped."""
        if self._report is not None and not self._report(iteration):
            self.stopped = True
            raise Cancelled
        return True


def _calibrate_whole(
    corner_set: CornerSet,
    settings: Settings,
    report: Report | None,
    lens: ChosenLens | None = None,
) -> Result:
    """Calibrate from views that determine the camera; raise DegenerateError for others.

    `lens` is the lens model of the settings if it was chosen automatically.
    """
    views, size = corner_set.views, corner_set.size
    sentences: tuple[str, ...] = ()
    if settings.robust:
        views, sentences = _leave_out_outliers(corner_set, settings)
    used = [view for view in views if view.usable]
    observations = [view.observation(corner_set.board) for view in used]
    camera = _list_camera_arguments(settings)
    board_shape = settings.board_shape
    if board_shape is None:
        board_shape, words = _choose_board_shape(observations, size, camera, report)
        sentences = (words, *sentences)
    everything = camera | {
        "cost": settings.cost,
        "board_shape": board_shape,
        "prior": settings.prior,
        "report": report,
        "names": shorten_names(used),
    }
    if settings.weigh_views:
        calibration, observations = calibrate_weighted(observations, size, **everything)
        views = _replace_covariances(views, observations)
        sentences = (*sentences, _describe_weights(observations, everything["names"]))
    else:
        calibration = engine.calibrate(observations, size, **everything)
    if lens is not None:
        sentences = (lens.reason, *sentences)
        stated = replace(calibration.settings, model_reason=lens.reason)
        calibration = replace(calibration, settings=stated)
    calibration = _add_warnings(calibration, used, settings, sentences)
    if settings.robust:
        left = sum(len(view.image) for view in calibration.residuals)
        outliers = _count_corners(corner_set) - left
        stated = replace(calibration.settings, outliers=outliers)
        calibration = replace(calibration, settings=stated)
    return _make_result(calibration, replace(corner_set, views=views))


def _list_camera_arguments(settings: Settings) -> dict[str, Any]:
    """List what `engine.calibrate` is told of the camera."""
    return {
        "model": settings.model,
        "method": settings.method,
        "fix": settings.fixed,
        "free": settings.freed,
    }


def _choose_board_shape(
    observations: Sequence[Observation],
    size: Size,
    camera: Mapping[str, Any],
    report: Report | None,
) -> tuple[BoardShapeModel, str]:
    """Return the board-shape model that predicts unseen views best, and the reason in words.

    The nominal model is returned if the comparison is impossible or `report` stops it.
    """
    watch = _Watch(report)
    try:
        choice = choose_board_shape(observations, size, report=watch, **camera)
    except DegenerateError:
        return BoardShapeModel.NOMINAL, _BOARD_SHAPE_UNTRIED
    except Cancelled:
        if not watch.stopped:
            raise
        return BoardShapeModel.NOMINAL, _BOARD_SHAPE_STOPPED
    return choice.model, choice.recommendation


def _add_warnings(
    calibration: Calibration,
    used: Sequence[View],
    settings: Settings,
    sentences: Sequence[str] = (),
) -> Calibration:
    """Return the calibration with further warnings, and with the settings on poor views."""
    stated = replace(calibration.settings, robust=settings.robust, weigh_views=settings.weigh_views)
    return replace(
        calibration,
        warnings=(*calibration.warnings, *sentences, *_describe_open_places(used, calibration)),
        settings=stated,
    )


def _calibrate_partially(
    corner_set: CornerSet, settings: Settings, report: Report | None
) -> Result | None:
    """Return the partial result of views that do not determine the camera, if there is one."""
    plain = replace(
        settings,
        model=settings.model or DEFAULT_MODEL,
        robust=False,
        weigh_views=False,
        board_shape=settings.board_shape or BoardShapeModel.NOMINAL,
    )
    try:
        _calibrate_whole(corner_set, plain, report)
    except DegenerateError as error:
        if error.partial is not None:
            used = [view for view in corner_set.views if view.usable]
            calibration = _add_warnings(error.partial, used, plain)
            return _make_result(calibration, corner_set)
    return None


def _make_result(calibration: Calibration, corner_set: CornerSet) -> Result:
    """Return a calibration with the views and the board that it was made from.

    Raises:
        CalibrationError: if all parameters of the camera were held, so that there is no verdict.
    """
    if is_held(calibration):
        raise CalibrationError(
            f"All parameters of the camera are held ({', '.join(calibration.fixed)}), which leaves "
            "nothing to calibrate.",
            "Let one or more of them be estimated, or locate the board with the camera as it is: "
            "`calibgui pose` takes its file.",
        )
    circle = find_common_circle(view.circle for view in corner_set.views if view.usable)
    return Result(
        replace(calibration, camera=replace(calibration.camera, circle=circle)),
        corner_set.views,
        corner_set.board,
        lengths_confirmed=corner_set.lengths_confirmed,
    )


def disable_unweighable_views(corner_set: CornerSet) -> CornerSet:
    """Return the set with views disabled of which a corner has no usable covariance.

    Raises:
        CalibrationError: if no view is left.
    """
    views = list(corner_set.views)
    for k, view in enumerate(views):
        cov = view.observation(corner_set.board).cov if view.usable else None
        if cov is None or (usable := find_usable_covariances(cov)).all():
            continue
        reason = (
            f"Left out: {np.count_nonzero(~usable)} of {format_count(len(cov), 'corner')} would "
            "count with a covariance that is zero, negative, not finite or singular."
        )
        views[k] = replace(view, enabled=False, reason=reason)
    if not any(view.usable for view in views):
        raise CalibrationError(
            "No view is left whose corners all have a usable covariance: one that is positive, "
            "finite and not singular.",
            "Locate the corners again, or leave the covariances out of the file.",
        )
    return replace(corner_set, views=tuple(views))


def _replace_covariances(
    views: Sequence[View], observations: Sequence[Observation]
) -> tuple[View, ...]:
    """Return the views, of which the usable ones have the covariances of `observations`."""
    left = iter(observations)
    return tuple(_replace_covariance(view, next(left)) if view.usable else view for view in views)


def _replace_covariance(view: View, weighed: Observation) -> View:
    if view.points is not None:
        return replace(view, points=weighed)
    assert view.corners is not None  # usable views have corners
    return replace(view, corners=replace(view.corners, cov=weighed.cov))


def _describe_weights(weighed: Sequence[Observation], names: Sequence[str]) -> str:
    """Return a sentence on the range of the views' noise, with the noisiest view."""
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


def _describe_open_places(used: Sequence[View], calibration: Calibration) -> Iterator[str]:
    """Yield sentences on views in which the places of the corners on the board are ambiguous."""
    parts = [view for view in used if view.corners is not None and view.corners.relative]
    if parts:
        yield (
            f"It is not known which part of the board {', '.join(shorten_names(parts))} shows: the "
            "pose there may be off by whole squares. The camera does not depend on it."
        )
    turned = {view.corners.ambiguity for view in used if view.corners is not None}
    if calibration.board_shape is not None and (parts or turned - {Symmetry.NONE}):
        yield (
            "The views may number the corners of the board differently: the estimated shape may "
            "then be a mixture of several corners."
        )


def _leave_out_outliers(
    corner_set: CornerSet, settings: Settings
) -> tuple[tuple[View, ...], tuple[str, ...]]:
    """Return the views without outliers, and a sentence on each view that lost corners."""
    places = [k for k, view in enumerate(corner_set.views) if view.usable]
    used = [corner_set.views[k] for k in places]
    names = shorten_names(used)
    observations = [view.observation(corner_set.board) for view in used]
    screening = screen_outliers(
        observations,
        corner_set.size,
        names=names,
        model=settings.model,
        method=settings.method,
        fix=settings.fixed,
        free=settings.freed,
    )
    views, sentences = list(corner_set.views), []
    for rejected in screening.rejected:
        view, name = used[rejected.view], names[rejected.view]
        lost = np.array(rejected.corners, dtype=np.int64)
        if rejected.is_whole_view:
            view = replace(view, enabled=False, reason=f"Left out: {rejected.reason}.")
            sentences.append(f"{name} is left out: {rejected.reason}.")
        else:
            view = _remove_corners(view, lost)
            sentences.append(
                f"{name} loses {format_count(len(lost), 'corner')}, {rejected.reason}."
            )
        views[places[rejected.view]] = view
    kept = [(used[k], names[k]) for k, good in enumerate(screening.kept) if good.any()]
    against = [kept[k] for k in find_upside_down_views(screening.calibration.poses).tolist()]
    if unsure := [name for view, name in against if _is_turn_open(view)]:
        sentences.append(
            f"The board is upside down in {', '.join(unsure)}, as its corners are numbered. If the "
            "photograph does not show this, they are numbered from the wrong end, which affects "
            "an estimated board shape only."
        )
    return tuple(views), tuple(sentences)


def _count_corners(corner_set: CornerSet) -> int:
    """Count the corners of the views that are usable."""
    board = corner_set.board
    return sum(len(view.observation(board).uv) for view in corner_set.views if view.usable)


def _is_turn_open(view: View) -> bool:
    """Return whether the colours of the board leave open which way up it is."""
    return view.corners is None or view.corners.ambiguity is not Symmetry.NONE


def _remove_corners(view: View, lost: IntArray) -> View:
    """Return the view without some of its corners."""
    if view.corners is not None:
        view = replace(view, corners=remove_corners(view.corners, lost))
    if view.points is not None:
        uv, xy, cov = view.points
        kept = np.setdiff1d(np.arange(len(uv)), lost)
        points = Observation(uv[kept], xy[kept], None if cov is None else cov[kept])
        view = replace(view, points=points)
    return view


def shorten_names(views: Sequence[View]) -> list[str]:
    """Return the names of the views' images, without their folders if that keeps them distinct."""
    names = [view.name for view in views]
    return names if len(set(names)) == len(names) else [view.image for view in views]
