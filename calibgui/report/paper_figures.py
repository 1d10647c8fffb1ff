"""Figures 4 to 16 of the paper for one calibration and its synthetic check."""

from __future__ import annotations

from matplotlib.figure import Figure

from calibgui.dataset.result import Result
from calibgui.engine.arrays import Array
from calibgui.engine.images import board_extent, read_image, rectify_image, render, undistort_image
from calibgui.report import figures
from calibgui.report.printed import SHOWN_VIEW

_UNIT = "reference px"


def paper_figures(real: Result, synthetic: Result, errors: Array) -> dict[str, Figure]:
    """The figures by their captions, in the paper's order.

    Args:
        real: from photographs of a checkerboard.
        synthetic: from their synthetic versions (5.2).
        errors: (K, 6) relative errors of the extrinsics (eq. 51).

    Raises:
        CalibrationError: if the photograph of the shown view cannot be read any more.
    """
    a, b = real.calibration, synthetic.calibration
    shown = min(SHOWN_VIEW, len(a.poses)) - 1
    view, pose, row = real.used[shown], a.poses[shown], a.stage_one[shown]
    if view.corners is None or real.board is None:
        raise ValueError("the paper's figures need corners found on a checkerboard")
    photograph = read_image(view.image).pixels
    rendered = render(a.camera, pose, real.board)
    extent = board_extent(real.board)
    undistorted = undistort_image(photograph, a.camera).image
    rectified = rectify_image(photograph, a.camera, pose, extent, a.reference_scale).image
    return {
        f"Figure 4: the cosines' equation of view {shown + 1}": figures.draw_cosines_equation(
            row, shown + 1, literal=True
        ),
        "Figure 5: pixel aspect ratio from each view": figures.aspect_ratios(a.stage_one),
        f"Figure 6: corners of view {shown + 1}": figures.corners(photograph, view.corners),
        "Figure 7a: cost of Stage II, real images": figures.convergence(a.history, _UNIT),
        "Figure 7b: cost of Stage II, synthetic images": figures.convergence(b.history, _UNIT),
        "Figure 8: corrective displacement with its gradient": figures.distortion(a.camera),
        "Figure 9: (a) undistorted, (b) rectified": figures.image_pair(
            undistorted, rectified, ("(a) undistorted", "(b) rectified")
        ),
        "Figure 10: rectification residuals, real images": figures.residual_scatter(a),
        "Figure 11: their histograms": figures.residual_histograms(a),
        "Figure 12: reprojection errors in the image": figures.residual_histograms(
            a, on_reference=False
        ),
        f"Figure 13: (a) synthetic view {shown + 1}, (b) over the real one": figures.image_pair(
            rendered,
            figures.superposed(photograph, rendered),
            ("(a) synthetic", "(b) real (green) over synthetic (magenta)"),
        ),
        "Figure 14: relative errors of the extrinsics": figures.extrinsic_errors(errors),
        "Figure 15: rectification residuals, synthetic images": figures.residual_scatter(b),
        "Figure 16: their histograms": figures.residual_histograms(b),
    }
