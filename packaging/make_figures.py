"""Draw the README's figures of what a calibration can be trusted with, from the bundled sample.

Usage: python packaging/make_figures.py, from anywhere; writes resources/images/.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from calibgui.app.calibration import calibrate_views
from calibgui.app.detection import find_views
from calibgui.app.outputs import save_figure
from calibgui.app.paths import find_images
from calibgui.engine.calibrate import calibrate
from calibgui.engine.estimation.projection import pixels
from calibgui.engine.frames import rotation
from calibgui.engine.quality.difference import difference
from calibgui.engine.quality.next_view import next_views
from calibgui.engine.quality.projection_uncertainty import projection_uncertainty
from calibgui.engine.quality.view_count import study
from calibgui.engine.types import Camera, Observation, Target
from calibgui.report import figures, quality_figures

RESOURCES = Path(__file__).resolve().parents[1] / "resources"
SQUARE = 25.0
"""Of the sample's board, mm."""


def bent_board() -> Figure:
    """A board that is bowed by 0.2 mm and printed 0.1 mm unevenly, as 20 noisy views show it."""
    rng = np.random.default_rng(1)
    target = Target(rows=7, cols=10, square=SQUARE)
    xy = target.points()
    far = (xy - xy.mean(axis=0)) / xy.max()
    bend = np.column_stack([0.1 * np.sin(5 * far[:, ::-1]), 0.6 * (far**2).sum(axis=1)])
    camera = Camera((640, 480), [660, 661, 309, 246, 0.27, 0.11, -0.06, -4e-4, 6e-4, 0])
    views = []
    for _ in range(20):
        R = rotation(rng.uniform(-0.6, 0.6, 3))
        point = (np.column_stack([xy - xy.mean(axis=0), np.zeros(len(xy))]) + bend) @ R.T
        point = point + rng.uniform([-20, -20, 300], [20, 20, 400])
        uv = pixels(point[:, :2] / point[:, 2:], camera)
        views.append(Observation(uv + rng.normal(0, 0.03, uv.shape), xy))
    plate = calibrate(views, camera.size, plate="free").plate
    assert plate is not None
    return figures.plate_deviations(plate)


def main() -> None:
    images = find_images([str(RESOURCES / "sample")])
    result = calibrate_views(find_views(images).corner_set(SQUARE))
    calibration, views = result.calibration, result.observations()
    size = calibration.camera.size
    halves = [calibrate(views[start::2], size).camera for start in (0, 1)]
    pictures = {
        "uncertainty": quality_figures.uncertainty(
            projection_uncertainty(calibration, views), views, 0.01
        ),
        "difference": quality_figures.difference(difference(*halves)),
        "views": quality_figures.view_count(study(calibration, views, solved=20), 0.03),
        "next-views": quality_figures.next_views(next_views(calibration, views), views, size),
    }
    pictures["plate"] = bent_board()
    for name, figure in pictures.items():
        save_figure(figure, RESOURCES / "images" / f"{name}.png")


if __name__ == "__main__":
    main()
