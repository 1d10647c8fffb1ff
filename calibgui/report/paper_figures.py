"""Figures 4 to 16 of the paper, for one calibration and its synthetic check."""

from __future__ import annotations

from matplotlib.figure import Figure

from calibgui.dataset import Result
from calibgui.engine.arrays import Array
from calibgui.engine.images import (
    compute_board_extent,
    read_image,
    rectify_image,
    render_view,
    undistort_image,
)
from calibgui.report import figures
from calibgui.report.printed_values import EXTRINSIC_ERROR, SHOWN_VIEW

_UNIT = "reference px"
_PRINTED_BOUNDS = {
    f"paper: {100 * bound:g} %\n{word}": bound
    for word, bound in zip(("at most", "mostly"), EXTRINSIC_ERROR, strict=True)
}
"""What the paper says of the errors in figure 14, fractions."""


def draw_paper_figures(real: Result, synthetic: Result, errors: Array) -> dict[str, Figure]:
    """Draw the figures, by their captions and in the paper's order.

    Args:
        real: result from photographs of a checkerboard.
        synthetic: result from their synthetic versions (5.2).
        errors: (K, 6) relative errors of the extrinsics (eq. 51).

    Raises:
        CalibrationError: if the photograph of the shown view cannot be read any more.
    """
    a, b = real.calibration, synthetic.calibration
    number = min(SHOWN_VIEW, len(a.poses))
    shown = number - 1
    view, pose, row = real.used[shown], a.poses[shown], a.stage_one[shown]
    if view.corners is None or real.board is None:
        raise ValueError("the paper's figures need corners found on a checkerboard")
    photograph = read_image(view.image).pixels
    rendered = render_view(a.camera, pose, real.board)
    extent = compute_board_extent(real.board)
    undistorted = undistort_image(photograph, a.camera).image
    rectified = rectify_image(photograph, a.camera, pose, extent, a.reference_scale).image
    return {
        f"Figure 4: the cosines' equation of view {number}": figures.draw_cosines_equation(
            row, number
        ),
        "Figure 5: pixel aspect ratio from each view": figures.draw_aspect_ratios(a.stage_one),
        f"Figure 6: corners of view {number}": figures.draw_corners(photograph, view.corners),
        "Figure 7a: cost of Stage II, real images": figures.draw_convergence(a.history, _UNIT),
        "Figure 7b: cost of Stage II, synthetic images": figures.draw_convergence(b.history, _UNIT),
        "Figure 8: corrective displacement with its gradient": figures.draw_distortion(a.camera),
        "Figure 9: (a) undistorted, (b) rectified": figures.draw_image_pair(
            undistorted, rectified, ("(a) undistorted", "(b) rectified")
        ),
        "Figure 10: rectification residuals, real images": figures.draw_residual_scatter(a),
        "Figure 11: their histograms": figures.draw_residual_histograms(a),
        "Figure 12: reprojection errors in the image": figures.draw_residual_histograms(
            a, on_reference=False
        ),
        f"Figure 13: (a) synthetic view {number}, (b) over the real one": figures.draw_image_pair(
            rendered,
            figures.superpose_images(photograph, rendered),
            ("(a) synthetic", "(b) real (green) over synthetic (magenta)"),
        ),
        "Figure 14: relative errors of the extrinsics": figures.draw_extrinsic_errors(
            errors,
            [place + 1 for place in synthetic.places],
            _PRINTED_BOUNDS,
        ),
        "Figure 15: rectification residuals, synthetic images": figures.draw_residual_scatter(b),
        "Figure 16: their histograms": figures.draw_residual_histograms(b),
    }
