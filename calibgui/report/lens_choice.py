"""Words and table about the choice of a lens model.

A row a candidate: how well it follows the corners that it was fitted to, how well it predicts views
that it has not seen, and what it says of the image. The criterion is stated relative to the least
one: differences of 10 and more count as strong, but see ``engine.assessment.choices.lens_choice``
for why it does not decide.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine.assessment import (
    SIMPLEST_MODEL,
    LensChoice,
    LensTrial,
    summarise_residuals,
)
from calibgui.engine.boards import Board
from calibgui.engine.calibration import Status
from calibgui.report.boards import name_point
from calibgui.report.lens_models import get_short_lens_title
from calibgui.report.numbers import format_count
from calibgui.report.tables import align_columns, format_bullet

_MAX_SHOWN_PX = 999
"""Length above which a model is so wrong that its figure tells nothing, px."""
_LEGEND = (
    "free: number of estimated parameters. RMS and sigma: residuals of a calibration from all "
    "views. Unseen: RMS, median and 95 % of the residuals of views that were left out of the "
    "calibration in turn, with only their poses fitted.",
    "BIC: Bayesian information criterion less the least one. H, V, D: horizontal, vertical and "
    "diagonal field of view. Off axis: largest angle at which the board was seen. Differs: largest "
    "distance from the recommended model's map where corners were seen. Valid: part of the "
    "image on which the map is one-to-one.",
)
"""What the columns of the tables mean."""


@dataclass(frozen=True, slots=True)
class LensRow:
    """A candidate as a table shows it. Lengths are in px and angles in degrees; NaN if unknown."""

    model: str
    parameters: int
    """Number of estimated parameters of the camera."""
    corners: int
    """Number of corners in all views."""
    rms: float
    """RMS length of the residuals of a calibration from all views."""
    sigma_x: float
    """Standard deviation of these residuals across the image."""
    sigma_y: float
    """Standard deviation of these residuals down the image."""
    unseen_rms: float
    """RMS length of the residuals of views that the calibration has not seen."""
    unseen_median: float
    """Median length of the residuals of unseen views."""
    unseen_p95: float
    """Length that 95 % of the residuals of unseen views do not exceed."""
    bic: float
    """Bayesian information criterion, less that of the candidate where it is least."""
    field_of_view: tuple[float, float, float]
    """Horizontal, vertical and diagonal angle that the image spans."""
    largest_angle: float
    """Largest angle off the axis at which a corner was seen."""
    difference: float
    """Largest distance between a point's images by this model and by the recommended one, where
    corners were seen, after the rotation that brings the two closest."""
    valid_share: float
    """Share of the image where the map is one-to-one."""
    held: tuple[str, ...]
    """Coefficients that were held at 0."""
    is_eligible: bool
    """True if it could be recommended: it is sound, and was tried on unseen views."""
    remarks: tuple[str, ...]
    """What else there is to know, each without a capital letter and a full stop."""


def list_lens_rows(choice: LensChoice) -> list[LensRow]:
    """List the candidates, the best on unseen views first and those that were not asked last."""
    trials = sorted(choice.trials.values(), key=lambda trial: (trial.held_out, trial.rms))
    least_bic = min(trial.bic for trial in trials)
    least_rms = min(trial.rms for trial in trials)
    return [_make_row(choice, trial, least_bic, least_rms) for trial in trials]


def _make_row(choice: LensChoice, trial: LensTrial, least_bic: float, least_rms: float) -> LensRow:
    """Make the row of a candidate, beside the least criterion and residuals of all."""
    fit = summarise_residuals(trial.calibration.residuals)
    lengths = np.array([np.nan]) if trial.validation is None else trial.validation.lengths
    horizontal, vertical, diagonal = np.rad2deg(trial.field_of_view).tolist()
    return LensRow(
        model=trial.model,
        parameters=trial.parameters,
        corners=fit.count,
        rms=fit.rms,
        sigma_x=fit.sigma_x,
        sigma_y=fit.sigma_y,
        unseen_rms=math.nan if trial.validation is None else trial.held_out,
        unseen_median=float(np.median(lengths)),
        unseen_p95=float(np.percentile(lengths, 95)),
        bic=trial.bic - least_bic,
        field_of_view=(horizontal, vertical, diagonal),
        largest_angle=float(np.rad2deg(trial.largest_angle)),
        difference=choice.differences[trial.model],
        valid_share=trial.valid_share,
        held=tuple(trial.fixed),
        is_eligible=trial.is_sound and trial.validation is not None,
        remarks=(*_list_held(trial), *_list_remarks(trial, least_rms)),
    )


def _list_held(trial: LensTrial) -> list[str]:
    """Name the coefficients, if any, that were held at 0, with the reason."""
    remarks = []
    if left_open := [name for name in trial.fixed if name not in trial.spared]:
        remarks.append(f"{', '.join(left_open)} held at 0: left open by these views")
    if trial.fuller is not None:
        remarks.append(
            f"{', '.join(trial.spared)} held at 0: they may be 0, and unseen views are predicted "
            f"better without ({trial.held_out:.3f} instead of {trial.fuller.held_out:.3f} px RMS)"
        )
    return remarks


def _list_remarks(trial: LensTrial, least_rms: float) -> list[str]:
    """List what speaks against a candidate, whatever it predicts."""
    remarks = []
    if undetermined := [u.name for u in trial.calibration.undetermined]:
        remarks.append(f"parameters not determined: {', '.join(undetermined)}")
    remarks += [f"{a} and {b} are determined only together" for a, b in trial.exchangeable]
    if not trial.is_valid_at_corners:
        remarks.append("folds within the corners: there it is not one-to-one")
    if trial.validation is None and trial.is_sound:
        ratio = trial.rms / least_rms
        remarks.append(f"not tried on unseen views: residuals {ratio:.1f} times the least")
    if trial.calibration.status is not Status.CONVERGED:
        remarks.append("did not converge")
    return remarks


def describe_lens_choice(choice: LensChoice) -> str:
    """Describe the recommended lens model and the reason in one to three sentences."""
    chosen = choice.chosen
    error = f"it predicts unseen views with {chosen.held_out:.3f} px RMS"
    if chosen.fuller is not None:
        names = ", ".join(chosen.spared)
        error += f" ({chosen.fuller.held_out:.3f} px with {names} estimated)"
    name = get_short_lens_title(chosen.model)
    if chosen.fixed:
        name += f", with {', '.join(chosen.fixed)} held at 0"
    if chosen.model == SIMPLEST_MODEL:
        text = (
            f"The paper's model ({name}) is kept: {error}, and no other model that these "
            "views determine does noticeably better."
        )
    else:
        clauses = "; ".join([error, *_describe_refusal(choice)])
        text = f"{name}: {clauses}. {_describe_rivals(choice)}"
    if not chosen.is_sound:
        faults = _list_remarks(chosen, min(trial.rms for trial in choice.trials.values()))
        text += f" No model is without reservations; of this one: {'; '.join(faults)}."
    return text


def format_lens_options(choice: LensChoice) -> str:
    """Format the options of `calibgui calibrate` that name the recommended lens model."""
    fixed = ",".join(f"{name}={value:g}" for name, value in choice.chosen.fixed.items())
    return f"--model {choice.model}" + (f" --fix {fixed}" if fixed else "")


def _describe_refusal(choice: LensChoice) -> list[str]:
    """Say in a clause why the paper's model is not kept; no clause if it was not tried."""
    if SIMPLEST_MODEL in choice.refused:
        return [f"{get_short_lens_title(SIMPLEST_MODEL)} cannot be calibrated from them"]
    if SIMPLEST_MODEL not in choice.trials:
        return []
    trial = choice.trials[SIMPLEST_MODEL]
    simplest = get_short_lens_title(SIMPLEST_MODEL)
    if not trial.is_sound:
        faults = "; ".join(_list_remarks(trial, trial.rms))
        return [f"{simplest} does not suit them ({faults})"]
    if trial.validation is None:
        return [f"{simplest} leaves {trial.rms:.3g} px on the views themselves"]
    if SIMPLEST_MODEL in choice.errors:
        error = choice.errors[SIMPLEST_MODEL]
        return [f"{simplest} predicts them as well, but is known to {format_px(error)} px only"]
    clause = f"{simplest} predicts them with {trial.held_out:.3f} px"
    if trial.valid_share < choice.chosen.valid_share:
        clause += f" and is one-to-one on {_format_share(trial.valid_share)} of the image only"
    return [clause]


def _describe_rivals(choice: LensChoice) -> str:
    """Say in a sentence why none of the other models is taken that predict as well."""
    if len(choice.errors) == 1:
        return "No other model that these views determine predicts as well."
    return (
        "Of the models that predict as well it is the simplest that no other is known better than "
        f"by more than a fifth: pixels are known to {format_px(choice.errors[choice.model])} px "
        "rms over the image."
    )


def tabulate_lens_choice(choice: LensChoice, board: Board | None = None) -> str:
    """Tabulate all candidates, and state the recommendation and the remarks in words.

    Args:
        choice: among them.
        board: in the photographs; a checkerboard if None.
    """
    rows = list_lens_rows(choice)
    views = format_count(len(choice.chosen.calibration.poses), "view")
    points = format_count(rows[0].corners, name_point(board))
    notes = [
        describe_lens_choice(choice),
        f"To calibrate with it: {format_lens_options(choice)}",
        *(f"{row.model}: {'; '.join(row.remarks)}." for row in rows if row.remarks),
        *(f"{model}: cannot be calibrated. {why}" for model, why in choice.refused.items()),
        *_LEGEND,
    ]
    return "\n".join(
        [
            f"Lens models on {points} in {views} (* recommended)",
            _tabulate_errors(rows, choice.model),
            "",
            "Lens models over the image",
            _tabulate_image(rows, choice.model),
            "",
            *map(format_bullet, notes),
        ]
    )


def _tabulate_errors(rows: Sequence[LensRow], recommended: str) -> str:
    """Tabulate what the candidates leave on the views, and on those that they have not seen."""
    head = ["", "model", "free", "RMS", "sigma x, y", "unseen", "median", "95 %"]
    units = ["", "", "", "px", "px", "RMS px", "px", "px"]
    cells = [
        [
            "*" * (row.model == recommended),
            row.model,
            str(row.parameters),
            format_px(row.rms),
            f"{format_px(row.sigma_x)} {format_px(row.sigma_y)}",
            *map(format_px, (row.unseen_rms, row.unseen_median, row.unseen_p95)),
        ]
        for row in rows
    ]
    return align_columns([head, units, *cells], left=(0, 1))


def _tabulate_image(rows: Sequence[LensRow], recommended: str) -> str:
    """Tabulate what the candidates say of the image."""
    head = ["", "model", "BIC", "H", "V", "D", "off axis", "differs", "valid"]
    units = ["", "", "", "deg", "deg", "deg", "deg", "px", ""]
    cells = [
        [
            "*" * (row.model == recommended),
            row.model,
            f"{row.bic:.0f}",
            *(_format_whole(angle) for angle in row.field_of_view),
            "-" if math.isnan(row.largest_angle) else f"{row.largest_angle:.1f}",
            format_px(row.difference),
            _format_share(row.valid_share),
        ]
        for row in rows
    ]
    return align_columns([head, units, *cells], left=(0, 1))


def format_px(length: float) -> str:
    """Format a length in px in at most five characters, "-" if it is not known."""
    if math.isnan(length):
        return "-"
    if length >= _MAX_SHOWN_PX:
        return f">{_MAX_SHOWN_PX}"
    return f"{length:.{3 if length < 9.9995 else 2 if length < 99.995 else 1}f}"


def _format_whole(angle: float) -> str:
    return "-" if math.isnan(angle) else f"{angle:.0f}"


def _format_share(share: float) -> str:
    """Format a share in percent, 100 only if it is the whole."""
    return f"{math.floor(100 * share)} %"
