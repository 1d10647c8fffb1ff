"""Figures of a calibrated camera, as matplotlib makes them: a notebook shows what these return."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from calibgui.engine.errors import CalibrationError
from calibgui.engine.uncertainty import estimate_projection_uncertainty
from calibgui.report import figures, quality_figures
from calibgui.scripting.calibrated_camera import CalibratedCamera

if TYPE_CHECKING:
    from matplotlib.figure import Figure  # slow to import


def plot_residuals(camera: CalibratedCamera) -> Figure:
    """Plot the residuals of all corners in the image, px, coloured by view."""
    return figures.draw_residual_scatter(camera.calibration, on_reference=False)


def plot_distortion(camera: CalibratedCamera) -> Figure:
    """Plot what the lens displaces, px: in all, radially, and by decentering."""
    return figures.draw_distortion(camera.camera)


def plot_uncertainty(
    camera: CalibratedCamera, distance: float = np.inf, limit: float = 0.1
) -> Figure:
    """Plot how far the images of points are uncertain, one standard deviation, px.

    Args:
        camera: the camera.
        distance: distance of the points, mm; infinite for directions.
        limit: uncertainty, px, that is drawn as a line.
    """
    views = camera.result.observations()
    found = estimate_projection_uncertainty(camera.calibration, views, distance)
    return quality_figures.draw_projection_uncertainty(found, views, limit)


def plot_convergence(camera: CalibratedCamera) -> Figure:
    """Plot the cost of Stage II, px^2, against its iterations."""
    return figures.draw_convergence(camera.calibration.history, "px")


def plot_board_shape(camera: CalibratedCamera) -> Figure:
    """Plot how the board deviates from its drawing, mm.

    Raises:
        CalibrationError: if its shape was not estimated.
    """
    shape = camera.calibration.board_shape
    if shape is None:
        raise CalibrationError(
            "The board counts as drawn: its shape was not estimated.",
            'Calibrate with board_shape="free".',
        )
    return figures.draw_board_shape(shape)
