"""Do reported standard deviations hold? `python -m tests.benchmarks.standard_deviations`.

For every lens model 10 views of a lens are calibrated again and again with fresh noise of 0.2 px;
the scatter of each parameter is divided by its reported standard deviation. 300 draws know a ratio
to 4 %. Coefficients that these views leave next to open (`VALLEYS`) are held at the truth: the
scatter along a bent valley is no standard deviation.

Then a camera is calibrated with boards that are not as drawn, whose shape is estimated with it, or
is held and came from other views or from the same (``tests/engine/bent_boards.py``): reported
standard deviations over the root mean square of the errors.
"""

from __future__ import annotations

import argparse

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera.models import MODELS, find_model
from calibgui.engine.camera.models.splined_stereographic import PREFIX
from tests.engine.bent_boards import NAMES, Bend, Use, draw_calibrations
from tests.engine.scenes import VALLEYS, example, scene

BOARDS = {
    "as drawn": Bend(),
    "off by noise": Bend(0.03, 0.01, 0.005),
    "bent by 0.2 mm": Bend(0.2, 0.05, 0.02),
}
"""Boards by how far they deviate."""
NOISE = 0.2
"""Standard deviation of a corner's coordinate, px."""


def measure_deviation_ratios(model: str, draws: int) -> Array:
    """Measure scatter over reported standard deviation of every free parameter."""
    made = scene(example(model), 10, seed=6)
    camera = made.camera
    truth = dict(zip(camera.names, camera.params.tolist(), strict=True))
    held = {name: truth[name] for name in (*find_model(model).held, *VALLEYS.get(model, ()))}
    found = [
        calibrate(made.noisy(NOISE, np.random.default_rng(seed)), made.size, model=model, fix=held)
        for seed in range(draws)
    ]
    free = np.array([name not in held for name in camera.names])
    scatter = np.std([result.camera.params[free] for result in found], axis=0, ddof=1)
    return np.asarray(scatter / np.mean([result.sigma_by_noise[free] for result in found], axis=0))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--draws", type=int, default=300)
    parser.add_argument("--boards", action="store_true", help="leave out the lens models")
    arguments = parser.parse_args()
    for model in () if arguments.boards else MODELS:
        if model not in ("lucchese-pixels", PREFIX):
            ratio = measure_deviation_ratios(model, arguments.draws)
            print(f"{model:28s} {ratio.min():.2f} to {ratio.max():.2f}", flush=True)
    for title, bend in BOARDS.items():
        for use in Use:
            ratios = draw_calibrations(bend, use, arguments.draws).ratios
            listed = " ".join(f"{n} {r:.2f}" for n, r in zip(NAMES, ratios, strict=True))
            print(f"{title:28s} shape {use.value:28s} {listed}", flush=True)


if __name__ == "__main__":
    main()
