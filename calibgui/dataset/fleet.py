"""The record of one camera of a fleet: what was asked, what was found, and whether it passes.

A fleet is many cameras that are calibrated from a list (``calibgui batch``). A row of its ledger
(``formats/fleet_ledger.py``) is a `FleetCamera`: figures and texts, without corners and
covariances, which stand in the camera's result.json.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from calibgui.dataset.judging import judge_result
from calibgui.dataset.result import Result
from calibgui.dataset.sensor_coverage import count_corners_per_cell
from calibgui.engine.arrays import Size
from calibgui.engine.assessment import SIGNIFICANCE, Grade, PixelError, summarise_residuals
from calibgui.engine.boards import Board


class FleetStatus(StrEnum):
    """The state of the work on a camera."""

    DONE = "done"
    """A calibration was made, whatever it is worth."""
    REFUSED = "refused"
    """No calibration could be made."""
    UNREADABLE = "unreadable"
    """The ledger's row of the camera cannot be read; it is never written."""


@dataclass(frozen=True, slots=True)
class FleetEntry:
    """An entry of a manifest about one camera."""

    id: str
    """Name of the camera's set of photographs, which no other of the fleet has."""
    serial: str = ""
    """Serial number; several entries of one serial number are one camera at several dates. Empty if
    it is not known."""
    date: str = ""
    """Date of the photographs, as YYYY-MM-DD or with a time: that of their EXIF where the manifest
    gives none; empty if it is not known."""
    temperature: float | None = None
    """Temperature of the camera, degrees Celsius; None if it is not known."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A parameter of a camera with its standard deviation."""

    value: float
    sigma: float
    """One standard deviation; 0 where the value was held, NaN where it is undetermined."""


@dataclass(frozen=True, slots=True)
class FleetFigures:
    """The figures of a calibration."""

    size: Size
    """Width and height of the images, px."""
    board: str
    """The board in words, such as "checkerboard 6x7, 30 mm"."""
    lens_model: str
    """Name of the lens model, a key of ``camera.MODELS``."""
    views: int
    """Number of photographs that were used."""
    corners: int
    """Number of corners in them."""
    rms: float
    """Root mean square length of the residual, px."""
    noise: float
    """Estimated standard deviation of one coordinate of a corner, px."""
    coverage: float
    """Share of the sensor's cells (``dataset/sensor_coverage.py``) that have corners, 0 to 1."""
    grade: Grade
    """Grade of the verdict (``assessment/verdict.py``)."""
    reason: str
    """A sentence that says why it has this grade."""
    times_better: float
    """Ratio by which the remedy of the first finding makes the error smaller; 1 if none does."""
    error: PixelError
    """The error of pixels, px; infinite where the views do not determine the camera."""
    parameters: Mapping[str, Estimate]
    """The parameters of the camera by name, in the order of its lens model."""


@dataclass(frozen=True, slots=True)
class Change:
    """The difference from the last calibration of the same serial number.

    It is that of far points after the rotation that brings both cameras closest together
    (``assessment/changes/drift.py``).
    """

    against: str
    """Id of the earlier calibration."""
    against_digest: str
    """Its digest."""
    rms: float
    """Root mean square displacement of pixels over the image, px."""
    worst: float
    """Largest displacement, px."""
    expected: float
    """Root mean square displacement that both calibrations' uncertainties explain, px."""
    probability: float
    """Probability of a difference as large as this one if the camera has not changed."""

    @property
    def is_significant(self) -> bool:
        """True if the difference is more than the uncertainties explain."""
        return self.probability < SIGNIFICANCE


@dataclass(frozen=True, slots=True)
class FleetCamera:
    """A camera of a fleet: a row of its ledger."""

    entry: FleetEntry
    """What the manifest says of it."""
    status: FleetStatus
    """How the work on it ended."""
    problem: str = ""
    """Why it was refused, or cannot be read; empty otherwise."""
    remedy: str = ""
    """What to do about that."""
    photographs: int = 0
    """Number of photographs that were searched for the board."""
    exif_date: str = ""
    """Median of the dates that the photographs state in EXIF, local time; empty if they state none.
    """
    figures: FleetFigures | None = None
    """The figures of its calibration; None unless it is done."""
    change: Change | None = None
    """Difference from the last calibration of its serial number; None if there is none before it,
    or one of both has no date, does not determine the camera or has another image size."""
    failures: tuple[str, ...] = ()
    """Sentences that say why it fails: which limit, its value and what was found."""
    digest: str = ""
    """SHA-256 of photographs, settings and versions; empty if the work is to be tried again by the
    next run whatever these are, as after the death of a worker."""
    state: str = ""
    """SHA-256 of names, sizes and times of the photographs: as long as it is the same, the
    photographs need not be read to know that `digest` is. Empty if that cannot be known."""
    versions: Mapping[str, str] = field(default_factory=dict)
    """Versions of the programs that made the calibration, by name."""
    result: str = ""
    """Path of result.json from the ledger's folder, with forward slashes; empty if it was refused.
    """
    cpu_seconds: float = field(default=math.nan, compare=False)
    """Processor time that it took, s: the one figure that is another at each run."""

    def take_entry(self, stated: FleetEntry) -> FleetCamera:
        """Return the camera with what a manifest says of it, and the date of EXIF without one."""
        return replace(self, entry=replace(stated, date=stated.date or self.exif_date))

    @property
    def id(self) -> str:
        """Name of the camera's set of photographs."""
        return self.entry.id

    @property
    def passed(self) -> bool:
        """True if there is nothing for which it fails."""
        return not self.failures


def summarise_result(result: Result) -> FleetFigures:
    """Return the figures of a result."""
    calibration, verdict = result.calibration, judge_result(result)
    camera, board = calibration.camera, result.board
    fit = summarise_residuals(calibration.residuals)
    uv = np.concatenate([view.uv for view in result.observations()])
    cells = count_corners_per_cell(uv, camera.size)
    values = zip(camera.names, camera.params.tolist(), calibration.sigma.tolist(), strict=True)
    return FleetFigures(
        size=camera.size,
        board="" if board is None else _describe_board(board),
        lens_model=camera.model,
        views=len(result.used),
        corners=fit.count,
        rms=fit.rms,
        noise=calibration.noise,
        coverage=float(np.count_nonzero(cells) / cells.size),
        grade=verdict.grade,
        reason=verdict.reason,
        times_better=verdict.times_better,
        error=verdict.error,
        parameters={name: Estimate(value, sigma) for name, value, sigma in values},
    )


def _describe_board(board: Board) -> str:
    return f"{board.pattern.kind} {board.rows}x{board.cols} {board.square:g}mm"
