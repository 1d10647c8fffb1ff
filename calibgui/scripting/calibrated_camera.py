"""A calibrated camera as Python programs and notebooks hold it."""

from __future__ import annotations

import os
from dataclasses import dataclass, fields
from functools import cached_property
from html import escape
from pathlib import Path as FilePath
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from calibgui.app.outputs.report_files import ReportStyle, write_report
from calibgui.dataset import Result
from calibgui.dataset.details import Details
from calibgui.dataset.judging import judge_result
from calibgui.engine.arrays import Array
from calibgui.engine.assessment import LengthUncertainty, Verdict, estimate_length_uncertainty
from calibgui.engine.calibration import Calibration
from calibgui.engine.camera import Camera, pixels_from_rays, rays_from_pixels
from calibgui.engine.errors import CalibrationError, parse_choice
from calibgui.engine.images import undistort_image
from calibgui.formats import EXPORTERS, export
from calibgui.formats.camera_refit import express_in_format
from calibgui.formats.opencv_lens import FISHEYE, list_coefficients
from calibgui.formats.result_json import read_result, write_result
from calibgui.report.calibration_report import Layout
from calibgui.report.tables import format_report, summarise_in_a_line
from calibgui.report.verdict import describe_error, describe_fit, format_headline

Path = str | os.PathLike[str]


class OpenCVCamera(NamedTuple):
    """A camera as OpenCV's functions take it."""

    K: Array
    """(3, 3) the camera matrix."""
    D: Array
    """(n,) the coefficients of the distortion, in OpenCV's order."""


@dataclass(frozen=True, eq=False)
class CalibratedCamera:
    """A camera with all that its calibration found out: print it to read the report."""

    result: Result
    """The calibration and the views that it was made from."""

    @classmethod
    def load(cls, path: Path) -> CalibratedCamera:
        """Load a camera from a result.json, as ``calibgui.load``.

        Raises:
            CalibrationError: if the file cannot be read, or is not a result.json.
        """
        return cls(read_result(path))

    @property
    def calibration(self) -> Calibration:
        """The calibration as the engine made it."""
        return self.result.calibration

    @property
    def camera(self) -> Camera:
        """The lens model and the values of its parameters."""
        return self.calibration.camera

    @property
    def values(self) -> dict[str, float]:
        """The camera's parameters by their names."""
        return dict(zip(self.camera.names, self.camera.params.tolist(), strict=True))

    @property
    def sigmas(self) -> dict[str, float]:
        """One standard deviation of each parameter, by its name."""
        return dict(zip(self.camera.names, self.calibration.sigma.tolist(), strict=True))

    @cached_property
    def verdict(self) -> Verdict:
        """The grade, the error of pixels, and what is wrong."""
        return judge_result(self.result)

    def save(self, path: Path) -> None:
        """Write everything as result.json, which ``calibgui.load``, the window and the command line
        read. Raises CalibrationError if the file cannot be written."""
        write_result(self.result, path)

    def export(self, name: str, path: Path) -> str:
        """Write the camera for another program; return what the file loses, if anything.

        Args:
            name: the format, one of ``calibgui.formats.EXPORTERS``.
            path: the file.

        Raises:
            CalibrationError: as ``calibgui.formats.export``.
        """
        return export(self.result, name, path).note

    def to_opencv(self, *, fisheye: bool = False) -> OpenCVCamera:
        """Return K and D for OpenCV's functions.

        The paper's lens model and others that OpenCV does not have are refitted to the same
        corners: calibrate with a `model` of OpenCV's to have them as calibrated.

        Args:
            fisheye: True for the functions of cv2.fisheye.

        Raises:
            CalibrationError: if no model of these functions can follow the lens.
        """
        camera = express_in_format(self.result, EXPORTERS["opencv"]).calibration.camera
        if (camera.model == FISHEYE) is not fisheye:
            functions = "cv2.fisheye's functions" if fisheye else "the functions without fisheye"
            raise CalibrationError(
                f"This lens is followed by OpenCV's model {camera.model}, which is not of "
                f"{functions}.",
                f"Say fisheye={not fisheye}, and use OpenCV's functions of that kind.",
            )
        return OpenCVCamera(camera.matrix, list_coefficients(camera))

    def undistort(self, image: npt.ArrayLike, view: str = "all") -> npt.NDArray[Any]:
        """Return an image (h, w) or (h, w, 3) of this camera without distortion.

        For its geometry, and other projections, see ``engine.undistort_image``.
        """
        return undistort_image(np.asarray(image), self.camera, view).image

    def estimate_length_error(
        self, length: float, at: float, uv: npt.ArrayLike | None = None
    ) -> LengthUncertainty:
        """Return how wrong a length, mm, is that is measured by its two ends in a plane across the
        axis `at` a distance, mm; at pixels (n, 2) or all over the image."""
        views = self.result.observations()
        scale_sigma = self.result.scale_sigma
        return estimate_length_uncertainty(self.calibration, views, length, at, uv, scale_sigma)

    def report(self, path: Path, *, layout: str = "report", **details: str) -> None:
        """Write the report on the calibration, or its certificate, as .html or .pdf.

        Args:
            path: the file.
            layout: "report" or "certificate".
            details: what is printed of what the program cannot know, as operator="N. N."; the names
                are those of ``calibgui report``.

        Raises:
            CalibrationError: if the suffix or a name is another one, or the file cannot be written.
        """
        known = [field.name for field in fields(Details)]
        if unknown := sorted(set(details) - set(known)):
            raise CalibrationError(
                f"A report has no {unknown[0]!r}.", f"Choose from {', '.join(known)}."
            )
        style = ReportStyle(parse_choice(Layout, layout, "layout"))
        write_report(self.result, FilePath(path), Details(**details), style)

    def find_rays(self, uv: npt.ArrayLike) -> Array:
        """Return the rays (..., 3) of length 1 of pixels (..., 2); NaN where the lens has none."""
        return rays_from_pixels(np.asarray(uv, np.float64), self.camera)

    def find_pixels(self, points: npt.ArrayLike) -> Array:
        """Return the pixels (..., 2) of points (..., 3) in the camera's frame; NaN where the lens
        has no image."""
        return pixels_from_rays(np.asarray(points, np.float64), self.camera)

    def __repr__(self) -> str:
        """Return the verdict in a line."""
        return f"<CalibratedCamera: {summarise_in_a_line(self.result)}>"

    def __str__(self) -> str:
        """Return the report that the command line prints."""
        return format_report(self.result)

    def _repr_html_(self) -> str:
        """Return the verdict and the camera for notebooks."""
        rows = "".join(
            _format_row(name, value, self.sigmas[name]) for name, value in self.values.items()
        )
        return (
            f"<b>{escape(format_headline(self.verdict))}</b><br>"
            f"{escape(describe_error(self.verdict))}<br>{escape(describe_fit(self.result))}"
            f"<table><tr><th></th><th>value</th><th>± (1 σ)</th></tr>{rows}</table>"
        )


def _format_row(name: str, value: float, sigma: float) -> str:
    """Format a row of a table in HTML."""
    told = f"{sigma:.2g}" if sigma > 0 else "held" if sigma == 0 else "open"
    return f"<tr><td>{escape(name)}</td><td>{value:.6g}</td><td>{told}</td></tr>"
