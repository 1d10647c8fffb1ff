"""The report on a calibration as a file, with what the photographs' files tell."""

from __future__ import annotations

import base64
import hashlib
import io
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import date
from pathlib import Path, PurePath

from PIL import Image

from calibgui.app.outputs.output_files import check_suffix
from calibgui.app.photographs.image_store import read_thumbnail
from calibgui.app.photographs.paths import is_remote
from calibgui.dataset import Result
from calibgui.dataset.details import NO_DETAILS, Details
from calibgui.engine.boards import CHECKERBOARD, BoardShapeModel
from calibgui.engine.calibration import DEFAULT_METHOD, Cost
from calibgui.engine.camera import find_model
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import write_atomically
from calibgui.engine.images import Header
from calibgui.engine.threads import limit_blas_threads
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from calibgui.formats.json_document import dumps
from calibgui.formats.origin import REPORT, make_mark
from calibgui.formats.result_json import encode_result_with_findings
from calibgui.report.calibration_report import (
    Layout,
    PhotographFile,
    ReportInputs,
    make_report,
)
from calibgui.report.rendering import render_html, render_pdf

SUFFIXES = (".html", ".pdf")
"""Suffixes of the files that `write_report` writes."""
_LONG_SIDE_PX, _JPEG_QUALITY = 220, 70
"""Size of the small pictures, 200 dpi in print, and their quality: each takes some 6 kB."""


@dataclass(frozen=True, slots=True)
class ReportStyle:
    """The layout of a report."""

    layout: Layout = Layout.REPORT
    paper: str = "a4"
    """A key of ``report.rendering.PAPERS``."""
    template: Path | None = None
    """A template of the user's own."""


def check_report_name(path: Path) -> None:
    """Refuse a name that does not tell the format of a report.

    Raises:
        CalibrationError: naming the suffixes.
    """
    check_suffix(path, SUFFIXES, "a report")


def write_report(
    result: Result,
    path: Path,
    details: Details = NO_DETAILS,
    style: ReportStyle | None = None,
    folder: Path | None = None,
    issued: date | None = None,
    check: Callable[[], None] | None = None,
) -> None:
    """Write the report on a calibration, completely or not at all.

    Args:
        result: the calibration.
        path: the file, .html or .pdf.
        details: what a person states of it.
        style: how it is laid out.
        folder: the folder that the photographs' paths count from; the current one if None.
        issued: the date of issue; today if None.
        check: a function that is called now and then, and raises to abandon the work.

    Raises:
        CalibrationError: if the suffix is another one, typst is missing for PDF, a template is
            wrong or the file cannot be written.
    """
    from calibgui.report.report_figures import draw_report_figures, draw_views  # matplotlib

    check_report_name(path)
    style = style or ReportStyle()
    content = dumps(encode_result_with_findings(result)).encode()
    files = {}
    for view in result.views:
        if check is not None:
            check()
        files[view.image] = _describe_file(view.image, folder or Path())
    with limit_blas_threads():
        uncertainty = estimate_projection_uncertainty(
            result.calibration, result.observations(), float("inf")
        )
    inputs = ReportInputs(
        details=details,
        files=files,
        digest=hashlib.sha256(content).hexdigest(),
        issued=(issued or date.today()).isoformat(),
        command=format_command(result),
        uncertainty=uncertainty,
        figures=draw_report_figures(result, uncertainty),
        views_figure=draw_views(result),
    )
    document = make_report(result, inputs, style.layout)
    if path.suffix.lower() == ".pdf":
        data = render_pdf(document, content, make_mark(REPORT), style.paper, style.template)
    else:
        data = render_html(document, make_mark(REPORT), style.paper, style.template).encode()
    write_atomically(path, data)


def _describe_file(image: str, folder: Path) -> PhotographFile:
    """Return what the file of a photograph tells; nothing if it cannot be read."""
    if is_remote(image):
        return PhotographFile()
    path = folder / image
    try:
        thumbnail = read_thumbnail(str(path))
    except CalibrationError:
        return PhotographFile()
    jpeg = io.BytesIO()
    picture = Image.fromarray(thumbnail.grey)
    picture.thumbnail((_LONG_SIDE_PX, _LONG_SIDE_PX))
    picture.save(jpeg, "JPEG", quality=_JPEG_QUALITY)
    return PhotographFile(
        digest=thumbnail.digest,
        jpeg=base64.b64encode(jpeg.getvalue()).decode(),
        **_read_camera(thumbnail.header),
    )


def _read_camera(header: Header) -> Mapping[str, str]:
    """Return what EXIF says of the camera and the moment."""
    exif = header.exif
    make, model = exif.make or "", exif.model or ""
    named = model if model.startswith(make) else f"{make} {model}"
    length = exif.focal_length_mm
    return {
        "camera": named.strip(),
        "lens": exif.lens or "",
        "setting": "" if length is None else f"{length:g} mm",
        "date": "" if exif.date is None else exif.date.isoformat(sep=" ", timespec="seconds"),
    }


def format_command(result: Result) -> str:
    """Format the command that makes a calibration again from its photographs.

    What no option states is a word in capitals: a file of corners, or of a board's shape.
    """
    calibration, board = result.calibration, result.board
    settings, camera = calibration.settings, calibration.camera
    folders = {str(PurePath(view.image).parent) for view in result.views}
    paths = sorted(folders) if len(folders) == 1 else [view.image for view in result.views]
    words = ["calibgui", "calibrate", *(paths if board else ["CORNERS"])]
    if board:
        words += ["--board", f"{board.rows}x{board.cols}"]
        sigma = f"+-{board.square_sigma:.6g}" if board.square_sigma else ""
        words += ["--square", f"{board.square:g}{sigma}"]
        if board.pattern != CHECKERBOARD:
            words += ["--target", board.pattern.kind]
    words.append("--as-asked")
    if settings.method != DEFAULT_METHOD:
        words += ["--method", settings.method]
    if calibration.cost is Cost.PAPER:
        words += ["--cost", Cost.PAPER.value]  # which has its own lens model
    else:
        words += ["--cost", calibration.cost.value, "--model", camera.model]
    held = find_model(camera.model).held
    values = dict(zip(camera.names, camera.params.tolist(), strict=True))
    if fixed := [f"{name}={values[name]:g}" for name in calibration.fixed if name not in held]:
        words += ["--fix", ",".join(fixed)]
    if freed := [name for name in held if name not in calibration.fixed]:
        words += ["--free", ",".join(freed)]
    shape = str(settings.board_shape or BoardShapeModel.NOMINAL)
    words += ["--board-shape", "SHAPE" if settings.is_board_shape_held else shape]
    if settings.prior is not None:
        words += ["--prior", f"{settings.prior.in_plane:g},{settings.prior.out_of_plane:g}"]
    words += ["--robust"] * bool(settings.robust) + ["--weigh-views"] * bool(settings.weigh_views)
    if left_out := [view.name for view in result.views if not view.enabled]:
        words += ["--exclude", *left_out]
    return shlex.join(words)
