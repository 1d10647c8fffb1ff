"""Draw the README's figures of what a calibration can be trusted with, from the bundled sample.

Usage: python packaging/make_figures.py, from anywhere; writes resources/images/.
"""

from __future__ import annotations

from pathlib import Path

from calibgui.app.calibration import calibrate_views
from calibgui.app.detection import find_views
from calibgui.app.outputs import save_figure
from calibgui.app.paths import find_images
from calibgui.engine.calibrate import calibrate
from calibgui.engine.difference import difference
from calibgui.engine.next_view import next_views
from calibgui.engine.projection_uncertainty import projection_uncertainty
from calibgui.engine.view_count import study
from calibgui.report import quality_figures

RESOURCES = Path(__file__).resolve().parents[1] / "resources"
SQUARE = 25.0
"""Of the sample's board, mm."""


def main() -> None:
    images = find_images([str(RESOURCES / "sample")])
    result = calibrate_views(find_views(images).corner_set(SQUARE))
    calibration, views = result.calibration, result.observations()
    size = calibration.camera.size
    halves = [calibrate(views[start::2], size).camera for start in (0, 1)]
    figures = {
        "uncertainty": quality_figures.uncertainty(
            projection_uncertainty(calibration, views), views, 0.01
        ),
        "difference": quality_figures.difference(difference(*halves)),
        "views": quality_figures.view_count(study(calibration, views, solved=20), 0.03),
        "next-views": quality_figures.next_views(next_views(calibration, views), views, size),
    }
    for name, figure in figures.items():
        save_figure(figure, RESOURCES / "images" / f"{name}.png")


if __name__ == "__main__":
    main()
