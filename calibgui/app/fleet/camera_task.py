"""The work on one camera of a fleet: photographs in, a row of the ledger and result.json out.

It does what ``calibgui calibrate`` does, in one process, and writes the same bytes each time: times
are left out of result.json, and what was found in photographs before is taken as it was found.
"""

from __future__ import annotations

import json
import math
import time
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, fields, replace
from pathlib import Path
from threading import Lock
from typing import NamedTuple
from urllib.parse import quote

import numpy as np

from calibgui.app.calibrating.redetection import calibrate_twice
from calibgui.app.fleet.manifest import BoardSought, CameraTask
from calibgui.app.fleet.photographs import (
    Photograph,
    combine_digests,
    compute_digest,
    fetch_photographs,
    list_photographs,
    read_exif_date,
)
from calibgui.app.outputs.output_files import make_folder
from calibgui.app.photographs.board_recognition import explain_missing_board, find_any_board
from calibgui.app.photographs.detection import (
    Detection,
    find_views,
    search_view,
)
from calibgui.app.system.workers import do_tasks_here
from calibgui.dataset import Result, View, ViewStatus, list_installed_versions
from calibgui.dataset.fleet import (
    Change,
    FleetCamera,
    FleetStatus,
    summarise_result,
)
from calibgui.engine import opencv
from calibgui.engine.arrays import GridSize
from calibgui.engine.assessment import (
    UncertainCamera,
    choose_covariance,
    measure_drift,
)
from calibgui.engine.boards import BoardShape, Pattern
from calibgui.engine.errors import CalibrationError
from calibgui.engine.threads import limit_blas_threads
from calibgui.formats.board_shape_json import encode_board_shape
from calibgui.formats.detections_json import drop_details, read_detections, write_detections
from calibgui.formats.json_document import dumps
from calibgui.formats.pattern_json import encode_pattern
from calibgui.formats.result_json import read_result, write_result

_MAX_NAME_LENGTH = 200
"""Length of an escaped id above which its files are named by a digest; names may have 255 bytes."""
_one_camera = Lock()
"""Held while a camera is worked on: threads would only take turns, and share OpenCV's settings."""


@dataclass(frozen=True, slots=True)
class FleetFolder:
    """The folders beside a ledger: results, and what was found in photographs."""

    ledger: Path

    def locate_result(self, camera: str) -> Path:
        """Return where result.json of the camera of an id is."""
        return self._locate("results", camera)

    def locate_detections(self, camera: str) -> Path:
        """Return where the views that were found for a camera are kept."""
        return self._locate("corners", camera)

    def make(self) -> None:
        """Make both folders. Raises CalibrationError if that is not possible."""
        for locate in (self.locate_result, self.locate_detections):
            make_folder(locate("any").parent)

    def _locate(self, kind: str, camera: str) -> Path:
        name = quote(camera, safe=" ()+,=@")
        if len(name) > _MAX_NAME_LENGTH:
            name = combine_digests([camera])
        return self.ledger.parent / f"{self.ledger.stem}.{kind}" / f"{name}.json"


class Work(NamedTuple):
    """The work that a worker is sent."""

    task: CameraTask
    known: FleetCamera | None
    """The camera's row of the ledger."""
    folder: FleetFolder


class Pair(NamedTuple):
    """Two calibrations of one serial number, to be compared."""

    earlier: FleetCamera
    later: FleetCamera
    ledger: Path


def is_done(work: Work, photographs: Sequence[Photograph]) -> bool:
    """Return whether the ledger's row is of these photographs, as far as their times tell."""
    known, state = work.known, compute_state(work.task, photographs)
    return known is not None and state != "" and known.state == state and _is_kept(known, work)


def calibrate_camera(work: Work) -> FleetCamera:
    """Calibrate a camera, write its result.json and return its row of the ledger.

    What cannot be done is a row as well: one camera must not end the work on thousands.
    """
    with _one_camera:
        start = time.process_time()
        with opencv.single_thread(), limit_blas_threads(), do_tasks_here():
            try:
                camera = _calibrate(work)
            except CalibrationError as error:
                camera = refuse_camera(work.task, error.message, error.hint)
            except Exception as error:
                problem = "".join(traceback.format_exception_only(error)).strip()
                camera = refuse_camera(
                    work.task,
                    f"A bug ended the work: {problem}.",
                    "Please report it with the photographs: calibgui calibrate shows all of it.",
                )
        if not math.isnan(camera.cpu_seconds):  # the row as it was
            return camera
        return replace(camera, cpu_seconds=time.process_time() - start)


def refuse_camera(task: CameraTask, problem: str, remedy: str) -> FleetCamera:
    """Return the row of a camera on which the work failed; the next run tries it again."""
    return FleetCamera(
        task.entry,
        FleetStatus.REFUSED,
        problem,
        remedy,
        failures=(problem,),
        versions=list_installed_versions(),
    )


def measure_change(pair: Pair) -> Change | None:
    """Measure the difference of two calibrations of one serial number.

    None if they cannot be compared: one does not determine the camera, the images differ in size,
    or a result is gone.
    """
    try:
        with _one_camera, limit_blas_threads():
            results = [
                read_result(pair.ledger.parent / camera.result)
                for camera in (pair.earlier, pair.later)
            ]
            if any(result.calibration.diagnosis is not None for result in results):
                return None
            boards = [result.board for result in results]
            alike = boards[0] is not None and boards[0] == boards[1]
            drift = measure_drift(
                *(
                    UncertainCamera(r.calibration.camera, choose_covariance(r.calibration, alike))
                    for r in results
                )
            )
    except CalibrationError:
        return None
    found = drift.difference
    return Change(
        pair.earlier.id,
        pair.earlier.digest,
        found.rms,
        found.worst,
        drift.expected,
        drift.probability,
    )


def _calibrate(work: Work) -> FleetCamera:
    """Do the work on a camera.

    Raises:
        CalibrationError: if it cannot be done, and is to be tried again by the next run.
    """
    task, known = work.task, work.known
    photographs = list_photographs(task.paths)
    if known is not None and is_done(work, photographs):
        return known.take_entry(task.entry)
    state = compute_state(task, photographs)
    with fetch_photographs(photographs) as files:
        contents = [compute_digest(file) for file in files]
        names = [photograph.name for photograph in photographs]
        digest = combine_digests([_describe_task(task), *names, *contents])
        if known is not None and known.digest == digest and _is_kept(known, work):
            return replace(known, state=state).take_entry(task.entry)
        camera = FleetCamera(
            task.entry,
            FleetStatus.DONE,
            photographs=len(files),
            exif_date=read_exif_date(files),
            digest=digest,
            state=state,
            versions=list_installed_versions(),
        ).take_entry(task.entry)
        names_of_copies = {str(f): n for f, n in zip(files, names, strict=True) if str(f) != n}
        search = _Search(work.folder.locate_detections(task.entry.id), files, contents)
        try:
            result = _name_photographs(_make_result(task, files, search), names_of_copies)
        except CalibrationError as error:
            problem, remedy = (_rename(t, names_of_copies) for t in (error.message, error.hint))
            return replace(
                camera,
                status=FleetStatus.REFUSED,
                problem=problem,
                remedy=remedy,
                failures=(problem,),
            )
        finally:
            search.save()
    file = work.folder.locate_result(task.entry.id)
    write_result(result, file)
    relative = file.relative_to(work.folder.ledger.parent).as_posix()
    return replace(camera, result=relative, figures=summarise_result(result))


def _is_kept(known: FleetCamera, work: Work) -> bool:
    """Return whether a row is final, and its result.json still there."""
    return known.digest != "" and (
        not known.result or (work.folder.ledger.parent / known.result).is_file()
    )


def _name_photographs(result: Result, names: Mapping[str, str]) -> Result:
    """Return a result that names photographs where they are, and not where their copies were."""
    if not names:
        return result
    views = tuple(
        replace(
            view,
            image=names.get(view.image, view.image),
            reason=_rename(view.reason, names),
            note=_rename(view.note, names),
        )
        for view in result.views
    )
    warnings = tuple(_rename(text, names) for text in result.calibration.warnings)
    return replace(result, views=views, calibration=replace(result.calibration, warnings=warnings))


def _rename(text: str, names: Mapping[str, str]) -> str:
    """Return a text with other names of files."""
    for old, new in names.items():
        text = text.replace(old, new)
    return text


class _Search:
    """The search of photographs that remembers what was found in the same content."""

    def __init__(self, file: Path, files: Sequence[Path], contents: Sequence[str]) -> None:
        self._file = file
        self._contents = dict(zip(map(str, files), contents, strict=True))
        self._known = read_detections(file)
        self._used: dict[str, View] = {}

    def __call__(
        self, view: View, grid_size: GridSize | None, method: str, pattern: Pattern
    ) -> View:
        """Search a view as `search_view`, unless that has been done before."""
        content = self._contents.get(view.image, "")
        asked = [grid_size, method, encode_pattern(pattern), view.orientation]
        key = combine_digests([content, dumps([*asked, list_installed_versions()])])
        found = self._known.get(key)
        if found is None:
            found = drop_details(search_view(view, grid_size, method, pattern))
        if content and found.status in (ViewStatus.FOUND, ViewStatus.NO_BOARD):
            self._used[key] = found
        return replace(found, image=view.image)

    def save(self) -> None:
        """Write what was used, unless all of it was known."""
        if self._used.keys() != self._known.keys():
            write_detections(self._used, self._file)


def _make_result(task: CameraTask, files: Sequence[Path], search: _Search) -> Result:
    """Search photographs and calibrate. Raises CalibrationError if that is not possible."""
    board, detection = task.board, _detect(task.board, files, search)
    error, _ = explain_missing_board(detection, board.grid_size, board.pattern is None)
    if error is not None:
        raise error
    assert task.board.square is not None  # the manifest sees to it
    corner_set = detection.corner_set(task.board.square, task.board.square_sigma)
    result = calibrate_twice(corner_set, task.settings)
    calibration = result.calibration
    history = tuple(replace(iteration, seconds=0.0) for iteration in calibration.history)
    timeless = replace(calibration, history=history, seconds=float("nan"))
    return replace(result, calibration=timeless)


def _detect(board: BoardSought, files: Sequence[Path], search: _Search) -> Detection:
    """Search photographs for a board."""

    def find(pattern: Pattern, grid_size: GridSize | None) -> Detection:
        return find_views(
            files, grid_size, method=board.method, pattern=pattern, search_image=search
        )

    if board.pattern is None:
        return find_any_board(find, board.grid_size)
    return find(board.pattern, board.grid_size)


def compute_state(task: CameraTask, photographs: Sequence[Photograph]) -> str:
    """Return a digest of a task and the times of its photographs; empty if one is not known."""
    if not all(photograph.state for photograph in photographs):
        return ""
    parts = [part for one in photographs for part in (one.name, one.state)]
    return combine_digests([_describe_task(task), *parts])


def _describe_task(task: CameraTask) -> str:
    """Return all that a result depends on besides photographs, as JSON."""
    board, settings = task.board, task.settings
    shape = settings.board_shape
    return json.dumps(
        {
            "board": {
                "square": board.square,
                **({"square_sigma": board.square_sigma} if board.square_sigma else {}),
                "grid_size": board.grid_size,
                "pattern": None if board.pattern is None else encode_pattern(board.pattern),
                "method": board.method,
            },
            "settings": {field.name: getattr(settings, field.name) for field in fields(settings)}
            | {
                "board_shape": encode_board_shape(shape)
                if isinstance(shape, BoardShape)
                else shape,
                "prior": None if settings.prior is None else astuple(settings.prior),
            },
            "versions": list_installed_versions(),
        },
        default=np.ndarray.tolist,
    )
