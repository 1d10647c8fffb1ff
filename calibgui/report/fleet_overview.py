"""A fleet's cameras beside each other: who is unlike the others, and how serial numbers drift."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.dataset.fleet import FleetCamera, FleetFigures
from calibgui.engine.arrays import Array, Size
from calibgui.engine.assessment import OUTLIER_Z, FleetSpread, measure_fleet_spread
from calibgui.engine.camera import Camera
from calibgui.engine.errors import CalibrationError

_MIN_OVER_OWN_ERROR = 3.0
"""Ratio of a camera's difference from the others to its own error of a pixel, above which it is
unlike them: below, the camera may be like them and only poorly known."""

Kind = tuple[Size, str]
"""Image size and lens model: cameras of one kind are compared with each other."""


@dataclass(frozen=True, slots=True)
class PlacedCamera:
    """A camera of a fleet and its place among those of its kind."""

    camera: FleetCamera
    difference: float = math.nan
    """Root mean square difference from the median camera of its kind, px; NaN if the camera is not
    determined."""
    worst: float = math.nan
    """Largest difference, px."""
    z: float = math.nan
    """Robust z of the difference; NaN if there are too few cameras of its kind."""

    @property
    def is_outlier(self) -> bool:
        """True if the camera is unlike the others of its kind, beyond its own uncertainty."""
        figures = self.camera.figures
        own = math.nan if figures is None else figures.error.median
        return self.z > OUTLIER_Z and self.difference > _MIN_OVER_OWN_ERROR * own


@dataclass(frozen=True, slots=True)
class FleetOverview:
    """All that a page or a window shows of a fleet."""

    placed: tuple[PlacedCamera, ...]
    """The cameras, in the order of the ledger."""
    kinds: Mapping[Kind, tuple[PlacedCamera, ...]]
    """The cameras that are determined, by kind, the most frequent kind first."""
    histories: Mapping[str, tuple[PlacedCamera, ...]]
    """By serial number the cameras of several dates, by date."""

    @property
    def outliers(self) -> tuple[PlacedCamera, ...]:
        """The cameras that are unlike the others, the farthest first."""
        found = [one for one in self.placed if one.is_outlier]
        return tuple(sorted(found, key=lambda one: -one.z))

    @property
    def undetermined(self) -> tuple[PlacedCamera, ...]:
        """The cameras that have a calibration, but one that cannot be compared with others."""
        return tuple(
            one
            for one in self.placed
            if one.camera.figures is not None and math.isnan(one.difference)
        )

    @property
    def failed(self) -> tuple[PlacedCamera, ...]:
        """The cameras that fail, in the order of the ledger."""
        return tuple(one for one in self.placed if not one.camera.passed)

    @property
    def changed(self) -> tuple[PlacedCamera, ...]:
        """The cameras that differ from their last calibration by more than the uncertainties
        explain, the largest difference first."""
        found = [
            (one.camera.change.worst, one)
            for one in self.placed
            if one.camera.change is not None and one.camera.change.is_significant
        ]
        return tuple(one for _, one in sorted(found, key=lambda pair: -pair[0]))


def make_overview(cameras: Sequence[FleetCamera]) -> FleetOverview:
    """Compare the cameras of a fleet with those of their kind, and with their earlier selves."""
    members: dict[Kind, list[int]] = defaultdict(list)
    known: dict[int, Camera] = {}
    for k, camera in enumerate(cameras):
        if camera.figures is not None and (rebuilt := rebuild_camera(camera.figures)) is not None:
            known[k] = rebuilt
            members[rebuilt.size, rebuilt.model].append(k)
    placed = [PlacedCamera(camera) for camera in cameras]
    for ids in members.values():
        spread = measure_fleet_spread([known[k] for k in ids])
        for k, *figures in _list_figures(ids, spread):
            placed[k] = PlacedCamera(cameras[k], *figures)
    ordered = sorted(members.items(), key=lambda item: (-len(item[1]), item[0]))
    return FleetOverview(
        tuple(placed),
        {kind: tuple(placed[k] for k in ids) for kind, ids in ordered},
        _find_histories(placed),
    )


def rebuild_camera(figures: FleetFigures) -> Camera | None:
    """Return the camera of a calibration; None if its views do not determine it."""
    if not math.isfinite(figures.error.median):
        return None
    values = np.array([one.value for one in figures.parameters.values()])
    sigmas = np.array([one.sigma for one in figures.parameters.values()])
    if not np.isfinite([values, sigmas]).all():
        return None
    try:
        return Camera(figures.size, values, figures.lens_model)
    except CalibrationError:
        return None


def _list_figures(ids: Sequence[int], spread: FleetSpread) -> list[tuple[int, float, float, float]]:
    columns: list[Array] = [spread.rms, spread.worst, spread.z]
    return list(zip(ids, *(column.tolist() for column in columns), strict=True))


def _find_histories(placed: Sequence[PlacedCamera]) -> dict[str, tuple[PlacedCamera, ...]]:
    """Return the cameras of each serial number with several dates, by date."""
    found: dict[str, list[PlacedCamera]] = defaultdict(list)
    for one in placed:
        if one.camera.entry.serial and one.camera.entry.date:
            found[one.camera.entry.serial].append(one)
    return {
        serial: tuple(sorted(several, key=lambda one: one.camera.entry.date))
        for serial, several in sorted(found.items())
        if len(several) > 1
    }
