"""A calibration is compared with its limits, and sentences tell those that it does not keep."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from calibgui.dataset.fleet import FleetCamera, FleetFigures, summarise_result
from calibgui.dataset.limits import NO_LIMITS, LengthLimit, Limits
from calibgui.dataset.result import Result
from calibgui.engine.assessment import Grade, LengthUncertainty, estimate_length_uncertainty
from calibgui.engine.errors import CalibrationError


def list_broken_limits(result: Result, limits: Limits) -> tuple[str, ...]:
    """List a sentence on each limit that a calibration breaks; none if it passes."""
    return tuple(_list_broken(summarise_result(result), limits, measure_length(result, limits)))


def measure_length(result: Result, limits: Limits) -> LengthUncertainty | None:
    """Measure how certain the length is that the limits name; None if they name none, or the length
    does not lie in the image."""
    if (stated := limits.length) is None:
        return None
    try:
        return estimate_length_uncertainty(
            result.calibration,
            result.observations(),
            stated.length_mm,
            stated.distance_mm,
            scale_sigma=result.scale_sigma,
        )
    except CalibrationError:
        return None


def list_failures(
    camera: FleetCamera, limits: Limits = NO_LIMITS, length: LengthUncertainty | None = None
) -> tuple[str, ...]:
    """List the reasons why a camera of a fleet fails.

    A camera that was refused, or whose calibration is not usable, fails without any limit.

    Args:
        camera: the camera.
        limits: what is demanded of it.
        length: how certain the length is that they name; None if it is not known.
    """
    if camera.figures is None:
        return (camera.problem,)
    sentences = [*_list_broken(camera.figures, limits, length)]
    change, limit = camera.change, limits.largest_change_px
    if change is not None and limit is not None and change.is_significant and change.worst > limit:
        sentences.append(
            f"Pixels have moved by up to {change.worst:.3g} px since {change.against}, beyond the "
            f"limit of {limit:g} px."
        )
    return tuple(sentences)


def _list_broken(
    found: FleetFigures, limits: Limits, length: LengthUncertainty | None
) -> Iterator[str]:
    """Yield a sentence on each limit that the figures break."""
    if found.grade is Grade.NOT_USABLE:
        yield f"The calibration is not usable. {found.reason}"
    edge, limit = found.error.edge, limits.largest_edge_error_px
    if limit is not None and not edge <= limit:
        found_px = f"{edge:.3g} px, beyond" if math.isfinite(edge) else "not determined, against"
        yield f"The error of a pixel at the image's edge is {found_px} the limit of {limit:g} px."
    if limits.fewest_views is not None and found.views < limits.fewest_views:
        used = "1 view is used" if found.views == 1 else f"{found.views} views are used"
        yield f"{used}, fewer than the limit of {limits.fewest_views:g}."
    if limits.least_coverage is not None and found.coverage < limits.least_coverage:
        yield (
            f"Corners cover {100 * found.coverage:.0f} % of the sensor, less than the limit of "
            f"{100 * limits.least_coverage:g} %."
        )
    if limits.length is not None:
        yield from _judge_length(limits.length, length)


def _judge_length(limit: LengthLimit, length: LengthUncertainty | None) -> Iterator[str]:
    """Yield a sentence on a length that is less certain than demanded."""
    sigma = math.nan if length is None else float(np.nanmax(length.sigma))
    if not sigma <= limit.sigma_mm:
        found = f"{sigma:.3g} mm, beyond" if sigma > 0 else "not determined, against"
        yield (
            f"The standard deviation of a length of {limit.length_mm:g} mm at "
            f"{limit.distance_mm:g} mm is {found} the limit of {limit.sigma_mm:g} mm."
        )
