"""The results of a series and the value of the scalar of each: from a table, or from EXIF."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from pathlib import Path
from typing import assert_never

import numpy as np

from calibgui.app.photographs.paths import find_photograph, make_natural_key
from calibgui.dataset import LeftOut, Result
from calibgui.engine.assessment import (
    MIN_SETTINGS,
    Drift,
    Series,
    Setting,
    UncertainCamera,
    choose_covariance,
    fit_series,
    measure_drift,
)
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import read_image_header
from calibgui.formats import Exporter, ExportReport
from calibgui.formats.camera_conversion import export_camera
from calibgui.formats.camera_import import read_result_file
from calibgui.formats.csv_table import read_csv_rows
from calibgui.formats.gate import parse_number

_SECONDS_OF_DAY = 86400.0
_FEW_DAYS = 5.0
"""Length of a series, days, up to which the times of its dates matter."""


class Scalar(StrEnum):
    """The quantities that a series can vary by."""

    ZOOM = "zoom"
    FOCUS = "focus"
    TEMPERATURE = "temperature"
    DATE = "date"

    @property
    def unit(self) -> str:
        """The unit of values, empty for a date and where the user alone knows it."""
        match self:
            case Scalar.ZOOM:
                return "mm"
            case Scalar.TEMPERATURE:
                return "°C"
            case Scalar.FOCUS | Scalar.DATE:
                return ""
            case _:
                assert_never(self)


@dataclass(frozen=True, eq=False, slots=True)
class SeriesResult:
    """One result of a series."""

    path: Path
    result: Result
    value: float
    """Value of the scalar; of a date, days since 1970. NaN if it is not known, which only a result
    may have that does not determine its camera."""

    @property
    def is_determined(self) -> bool:
        """True if the photographs determine the camera, and no part of it is assumed."""
        return self.result.calibration.diagnosis is None

    def make_setting(self, is_same_board: bool = True) -> Setting:
        """Return the camera with its uncertainty beside other results."""
        calibration = self.result.calibration
        covariance = choose_covariance(calibration, is_same_board)
        return Setting(self.value, UncertainCamera(calibration.camera, covariance))


@dataclass(frozen=True, eq=False, slots=True)
class AnalysedSeries:
    """Results with the function that describes them, and their changes."""

    scalar: Scalar
    results: tuple[SeriesResult, ...]
    """The results that the series is made of, by ascending values."""
    left_out: tuple[LeftOut, ...]
    """The results whose photographs do not determine the camera, by ascending values."""
    series: Series
    """The camera as a function of the scalar."""
    drifts: tuple[Drift, ...]
    """The differences from the first result, of all but the first; none for a zoom lens, which has
    changed, of course."""


def analyse_series(
    paths: Sequence[Path], scalar: Scalar, values: Path | None = None
) -> AnalysedSeries:
    """Read results, fit functions of the scalar, and test whether the camera has changed.

    Args:
        paths, scalar, values: as for `read_series`.

    Raises:
        CalibrationError: as `read_series` and ``engine.assessment.fit_series``, or if too few
            results determine their cameras.
    """
    found = read_series(paths, scalar, values)
    results = tuple(one for one in found if one.is_determined)
    left_out = tuple(_leave_out(one) for one in found if not one.is_determined)
    if left_out and len(results) < MIN_SETTINGS:
        named = " ".join(f"{one.file} is left out: {one.reason}" for one in left_out)
        raise CalibrationError(
            f"{len(results)} of {len(found)} results can be used, and a series needs "
            f"{MIN_SETTINGS}. {named}",
            left_out[0].remedy,
        )
    alike = are_boards_alike(results)
    series = fit_series([one.make_setting(alike) for one in results])
    if scalar is Scalar.ZOOM:
        return AnalysedSeries(scalar, results, left_out, series, ())
    first, *others = (setting.known for setting in series.settings)
    drifts = tuple(measure_drift(first, other) for other in others)
    return AnalysedSeries(scalar, results, left_out, series, drifts)


def find_results(names: Iterable[str]) -> tuple[Path, ...]:
    """Return the files that `names` mean: files, and all ``*.json`` in folders at any depth.

    Raises:
        CalibrationError: if a name means no file, or a folder has none.
    """
    found: list[Path] = []
    for name in names:
        path = Path(name)
        files = sorted(path.rglob("*.json"), key=make_natural_key) if path.is_dir() else [path]
        if not files or not files[0].exists():
            raise CalibrationError(
                f"{name} holds no results." if files == [] else f"There is no file {name}.",
                "Name files that calibgui calibrate -o wrote, or their folder.",
            )
        found.extend(files)
    return tuple(dict.fromkeys(found))


def read_series(
    paths: Sequence[Path], scalar: Scalar, values: Path | None = None
) -> tuple[SeriesResult, ...]:
    """Read results and the value of the scalar of each, in the order of the values.

    Results that do not determine their cameras are among them; without a value they stand last.

    Args:
        paths: the files.
        scalar: the quantity that varies.
        values: a CSV file with the columns ``file`` and ``value``, the former a name or a path as
            it stands beside the table; None to read focal lengths or dates from the photographs.

    Raises:
        CalibrationError: if a file is no result, or has no value and determines its camera.
    """
    results = [read_result_file(path) for path in paths]  # what is none is said before all else
    table = {} if values is None else _read_values(values, scalar)
    found = []
    for path, result in zip(paths, results, strict=True):
        try:
            if values is not None:
                value = _find_value(table, path, values)
            else:
                value = _read_from_photographs(path, result, scalar)
        except CalibrationError:
            if result.calibration.diagnosis is None:
                raise
            value = math.nan
        found.append(SeriesResult(path, result, value))
    return tuple(sorted(found, key=lambda one: (math.isnan(one.value), one.value)))


def _leave_out(one: SeriesResult) -> LeftOut:
    """Return the record of a result that does not determine its camera."""
    diagnosis = one.result.calibration.diagnosis
    assert diagnosis is not None
    return LeftOut(str(one.path), one.value, diagnosis.message, diagnosis.hint)


def are_boards_alike(results: Sequence[SeriesResult]) -> bool:
    """Return whether all results are of one board, as far as its layout tells."""
    boards = [one.result.board for one in results]
    return boards[0] is not None and all(board == boards[0] for board in boards)


def export_from_series(
    series: Series, value: float | None, exporter: Exporter, path: Path
) -> ExportReport:
    """Write the camera at a value of the scalar, or a profile of all focal lengths.

    Args:
        series: the series.
        value: the value; None for a profile of the series' settings, by focal lengths in mm, with
            the cameras of the function that describes them.
        exporter: the format, which holds a zoom lens if there is no value.
        path: the file.

    Raises:
        CalibrationError: if the format cannot hold the lens, the value lies outside of the series,
            or the file cannot be written.
    """
    if value is not None:
        return export_camera(series.predict(value).camera, exporter, path)
    assert exporter.write_zoom is not None
    focals = [setting.value for setting in series.settings]
    return exporter.write_zoom([(mm, series.predict(mm).camera) for mm in focals], path)


def format_value(value: float, scalar: Scalar) -> str:
    """Format a value of the scalar, with its unit where it has one; a dash if it is not known."""
    if math.isnan(value):
        return "–"
    if scalar is Scalar.DATE:
        return datetime.fromtimestamp(value * _SECONDS_OF_DAY).isoformat(" ", "minutes")
    return f"{value:g} {scalar.unit}".rstrip()


def choose_axis_text(analysed: AnalysedSeries) -> Callable[[float], str] | None:
    """Return what writes values of the scalar on an axis; None if they are read as numbers.

    Of a date it is the day, or day and time without the year where all lie within a few days.
    """
    if analysed.scalar is not Scalar.DATE:
        return None
    first, *_, last = (setting.value for setting in analysed.series.settings)
    part = slice(0, 10) if last - first > _FEW_DAYS else slice(5, None)
    return lambda value: format_value(value, Scalar.DATE)[part]


def parse_value(text: str, scalar: Scalar) -> float:
    """Read a value of the scalar: a number, with or without its unit, or an ISO date.

    Raises:
        ValueError: if it is neither, or not finite.
    """
    text = text.strip()
    if scalar is Scalar.DATE:
        return datetime.fromisoformat(text).timestamp() / _SECONDS_OF_DAY
    value = parse_number(text.removesuffix(scalar.unit).strip())
    if not np.isfinite(value):
        raise ValueError(f"{text!r} is not a finite number")
    return value


def _read_values(file: Path, scalar: Scalar) -> dict[Path, float]:
    """Read the values by the paths of the files."""
    found = {}
    for line, row in enumerate(read_csv_rows(file), start=2):
        try:
            if not (row["file"] and row["value"]):
                raise ValueError("a cell is empty")
            found[Path(row["file"])] = parse_value(row["value"], scalar)
        except (KeyError, TypeError, ValueError) as error:
            raise CalibrationError(
                f"{file}, line {line}: there is no file with its value ({error}).",
                "The first line names the columns file,value; each further one has both.",
            ) from error
    return found


def _find_value(table: Mapping[Path, float], path: Path, values: Path) -> float:
    """Return the value of a file that the table names by its path, or by its name alone."""
    for name, value in table.items():
        if (values.parent / name).resolve() == path.resolve():
            return value
    alike = {value for name, value in table.items() if name.name == path.name == str(name)}
    if len(alike) != 1:
        raise CalibrationError(
            f"{values} has no value for {path}.", f"Add a line for it: {path.name},VALUE."
        )
    return alike.pop()


def _read_from_photographs(path: Path, result: Result, scalar: Scalar) -> float:
    """Return the median of what EXIF says of the photographs that were used."""
    if scalar not in (Scalar.ZOOM, Scalar.DATE):
        raise CalibrationError(
            f"Photographs do not state the {scalar}.",
            "Give a table of file,value for each result: --values FILE.csv.",
        )
    found = []
    for view in result.used:
        image = find_photograph(path, view.image)
        if image is None:
            continue
        exif = read_image_header(image).exif
        if scalar is Scalar.ZOOM and exif.focal_length_mm is not None:
            found.append(exif.focal_length_mm)
        elif scalar is Scalar.DATE and exif.date is not None:
            found.append(exif.date.timestamp() / _SECONDS_OF_DAY)
    if not found:
        what = "focal length" if scalar is Scalar.ZOOM else "date"
        raise CalibrationError(
            f"No photograph of {path} was found that states its {what}.",
            "Give a table of file,value for each result: --values FILE.csv.",
        )
    return float(np.median(found))
