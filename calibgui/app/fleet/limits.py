"""The limits that the cameras of a fleet have to keep, and the sentences on those that do not."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path

from calibgui.dataset.fleet import FleetCamera, FleetFigures
from calibgui.engine.assessment import Grade
from calibgui.engine.errors import CalibrationError
from calibgui.formats.toml_document import read_toml
from calibgui.report.numbers import format_count

_MAX_SIZE = 1 << 20
"""Size of the largest file of limits that is read, bytes."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What is demanded of every camera; None of what is not."""

    largest_edge_error_px: float | None = None
    """Largest error of pixels along the image's edge, px, one standard deviation
    (``assessment/verdict.py``)."""
    fewest_views: float | None = None
    """Least number of photographs that are used."""
    least_coverage: float | None = None
    """Least share of the sensor that has corners, 0 to 1 (``report/coverage.py``)."""
    largest_change_px: float | None = None
    """Largest displacement of a pixel, px, since the last calibration of the same serial number, if
    it is more than the uncertainties explain."""


NO_LIMITS = Limits()


def read_limits(file: Path) -> Limits:
    """Read limits from a TOML file, which has the names of `Limits` for its keys.

    Raises:
        CalibrationError: if the file cannot be read, or a key or a value is none that is known.
    """
    known = [field.name for field in fields(Limits)]
    found = {}
    for name, value in read_toml(file, _MAX_SIZE).members().items():
        if name not in known:
            raise CalibrationError(
                f"{file}: there is no limit {name!r}.", f"Choose from {', '.join(known)}."
            )
        if (limit := value.number()) < 0:
            value.fail("a number from 0 on")
        found[name] = limit
    return Limits(**found)


def list_failures(camera: FleetCamera, limits: Limits = NO_LIMITS) -> tuple[str, ...]:
    """List the reasons why a camera fails.

    A camera that was refused, or whose calibration is not usable, fails without any limit.
    """
    if camera.figures is None:
        return (camera.problem,)
    sentences = [*_list_broken(camera.figures, limits)]
    change, limit = camera.change, limits.largest_change_px
    if change is not None and limit is not None and change.is_significant and change.worst > limit:
        sentences.append(
            f"Pixels have moved by up to {change.worst:.3g} px since {change.against}, beyond the "
            f"limit of {limit:g} px."
        )
    return tuple(sentences)


def _list_broken(found: FleetFigures, limits: Limits) -> Iterator[str]:
    """Yield a sentence on each limit that the figures break."""
    if found.grade is Grade.NOT_USABLE:
        yield f"The calibration is not usable. {found.reason}"
    edge, limit = found.error.edge, limits.largest_edge_error_px
    if limit is not None and not edge <= limit:
        found_px = f"{edge:.3g} px, beyond" if math.isfinite(edge) else "not determined, against"
        yield f"The error of a pixel at the image's edge is {found_px} the limit of {limit:g} px."
    if limits.fewest_views is not None and found.views < limits.fewest_views:
        used = f"{format_count(found.views, 'view')} {'is' if found.views == 1 else 'are'} used"
        yield f"{used}, fewer than the limit of {limits.fewest_views:g}."
    if limits.least_coverage is not None and found.coverage < limits.least_coverage:
        yield (
            f"Corners cover {100 * found.coverage:.0f} % of the sensor, less than the limit of "
            f"{100 * limits.least_coverage:g} %."
        )
