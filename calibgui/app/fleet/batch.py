"""The calibration of a fleet: what is not done yet, one task a camera, with a ledger of all.

A camera is done if the ledger has a row of its photographs, board, settings and versions. Rows are
written as cameras end, so that a run that is killed loses the cameras in flight and no others; the
next run does them, and the same again: changes between the calibrations of a serial number, and
limits. These follow from rows and results alone, so that the order of completion changes nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from calibgui.app.fleet.camera_task import (
    FleetFolder,
    Pair,
    Work,
    calibrate_camera,
    is_done,
    measure_change,
    refuse_camera,
)
from calibgui.app.fleet.manifest import CameraTask
from calibgui.app.fleet.photographs import list_photographs
from calibgui.app.fleet.schedulers import Scheduler
from calibgui.app.photographs.paths import is_remote
from calibgui.app.system.workers import Crashed
from calibgui.dataset.acceptance import list_failures, measure_length
from calibgui.dataset.fleet import FleetCamera
from calibgui.dataset.limits import NO_LIMITS, Limits
from calibgui.engine.arrays import Size
from calibgui.engine.assessment import LengthUncertainty
from calibgui.engine.errors import CalibrationError, Progress
from calibgui.formats.fleet_ledger import Ledger
from calibgui.formats.result_json import read_result


@dataclass(frozen=True, slots=True)
class BatchSummary:
    """The outcome of a run."""

    cameras: int
    """Number of cameras in the manifest."""
    worked_on: int
    """Number of cameras that were calibrated in this run, or refused: not those that were done."""
    failed: tuple[FleetCamera, ...]
    """The cameras that fail, in the order of the manifest."""


def run_batch(
    tasks: Sequence[CameraTask],
    ledger: Ledger,
    scheduler: Scheduler,
    limits: Limits = NO_LIMITS,
    progress: Progress | None = None,
) -> BatchSummary:
    """Calibrate the cameras of a manifest that are not done, and judge all by the limits.

    Args:
        tasks: the cameras.
        ledger: an open ledger; results are written to folders beside it.
        scheduler: what does the work on cameras.
        limits: what is demanded of each camera.
        progress: a function that is told how many of the cameras that are not done are done since.

    Raises:
        CalibrationError: if the ledger or its folders cannot be written, or the scheduler fails.
    """
    folder = FleetFolder(ledger.path)
    folder.make()
    waiting, worked_on = [], 0
    for work, camera in _look_at_cameras(tasks, ledger, folder):
        if camera is None:
            waiting.append(work)
            continue
        worked_on += not _is_of_earlier_run(camera, work.known)
        if camera != work.known:
            ledger.write([camera])
    for done, (work, camera) in enumerate(_calibrate_all(waiting, scheduler), start=1):
        worked_on += not _is_of_earlier_run(camera, work.known)
        ledger.write([camera])
        if progress is not None:
            progress(done, len(waiting))
    ledger.write(_measure_changes(tasks, ledger, scheduler))
    ledger.write(_judge(tasks, ledger, limits))
    rows = (ledger.find(task.entry.id) for task in tasks)
    failed = tuple(row for row in rows if row is not None and not row.passed)
    return BatchSummary(len(tasks), worked_on, failed)


def _look_at_cameras(
    tasks: Iterable[CameraTask], ledger: Ledger, folder: FleetFolder
) -> Iterator[tuple[Work, FleetCamera | None]]:
    """Yield the cameras with their rows, None for those that a worker has to look at.

    Files are looked at here, which takes little; addresses are left to the workers.
    """
    for task in tasks:
        work = Work(task, ledger.find(task.entry.id), folder)
        yield work, None if any(map(is_remote, task.paths)) else _find_row(work)


def _is_of_earlier_run(camera: FleetCamera, known: FleetCamera | None) -> bool:
    """Return whether a row says no more than an earlier run has `known`.

    A camera that is calibrated again takes another time.
    """
    return known is not None and (camera.status, camera.cpu_seconds) == (
        known.status,
        known.cpu_seconds,
    )


def _find_row(work: Work) -> FleetCamera | None:
    """Return the row of a camera that needs no work: it is done, or has no photographs."""
    try:
        photographs = list_photographs(work.task.paths)
    except CalibrationError as error:
        return refuse_camera(work.task, error.message, error.hint)
    if work.known is None or not is_done(work, photographs):
        return None
    return work.known.take_entry(work.task.entry)


def _calibrate_all(
    waiting: Sequence[Work], scheduler: Scheduler
) -> Iterator[tuple[Work, FleetCamera]]:
    """Yield cameras with their rows as they end; those whose process died are tried once more."""
    crashed = []
    for k, camera in scheduler.run(calibrate_camera, waiting):
        if isinstance(camera, Crashed):
            crashed.append(waiting[k])
        else:
            yield waiting[k], camera
    for k, camera in scheduler.run(calibrate_camera, crashed):
        if isinstance(camera, Crashed):
            camera = refuse_camera(
                crashed[k].task,
                "The process that worked on it died twice.",
                "Give workers more memory, or calibrate it by itself to see why.",
            )
        yield crashed[k], camera


def _measure_changes(
    tasks: Iterable[CameraTask], ledger: Ledger, scheduler: Scheduler
) -> Iterator[FleetCamera]:
    """Yield the rows that change by a comparison with the last calibration of a serial number."""
    serials = dict.fromkeys(task.entry.serial for task in tasks if task.entry.serial)
    pairs: list[Pair] = []
    for serial in serials:
        last: dict[Size, FleetCamera] = {}
        for camera in ledger.read_serial(serial):
            earlier = None
            if (size := _find_comparable_size(camera)) is not None:
                earlier = last.get(size)
                last[size] = camera
            known = (
                None
                if camera.change is None
                else (camera.change.against, camera.change.against_digest)
            )
            if known == (None if earlier is None else (earlier.id, earlier.digest)):
                continue
            if earlier is None:
                yield replace(camera, change=None)
            else:
                pairs.append(Pair(earlier, camera, ledger.path))
    for k, change in scheduler.run(measure_change, pairs):
        yield replace(pairs[k].later, change=None if isinstance(change, Crashed) else change)


def _find_comparable_size(camera: FleetCamera) -> Size | None:
    """Return the size of the images of a camera that can be compared with another one.

    None if it has no date, or its calibration does not determine it.
    """
    found = camera.figures
    is_known = found is not None and math.isfinite(found.error.median)
    return found.size if found is not None and is_known and camera.entry.date else None


def _judge(tasks: Iterable[CameraTask], ledger: Ledger, limits: Limits) -> Iterator[FleetCamera]:
    """Yield the rows of a manifest whose reasons to fail are others than before."""
    for task in tasks:
        row = ledger.find(task.entry.id)
        if row is None:
            continue
        length = _measure_length(row, ledger, limits)
        if (failures := list_failures(row, limits, length)) != row.failures:
            yield replace(row, failures=failures)


def _measure_length(
    camera: FleetCamera, ledger: Ledger, limits: Limits
) -> LengthUncertainty | None:
    """Measure how certain the length is that the limits name, with the result of a camera."""
    if limits.length is None or not camera.result:
        return None
    try:
        return measure_length(read_result(ledger.path.parent / camera.result), limits)
    except CalibrationError:  # the result is gone
        return None
