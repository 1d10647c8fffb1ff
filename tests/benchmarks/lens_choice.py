"""How good the choice of a lens model is: `python -m tests.benchmarks.lens_choice`.

Random lenses of all families, 60 to 220 degrees, are seen in 12 views with 0.1 px of noise. The
choice is made from these alone; then every candidate is tried on 12 further views, of which only
the poses are fitted, and the error of the recommended model is divided by that of the best one.
"""

from __future__ import annotations

import argparse
from collections import Counter

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.choices.cross_validation import resect_views
from calibgui.engine.assessment.choices.lens_choice import LensChoice, choose_lens_stepwise
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from tests.engine.random_lenses import draw_view, problem

VIEWS = 12
"""Numbers of views to choose from, and of unseen ones."""
NOISE = 0.1
"""Standard deviation of a corner's coordinate, px."""


def photograph(camera: Camera, rng: np.random.Generator) -> list[Observation]:
    """Random views with noise, every third with corners beyond 90 degrees if the lens sees them."""
    views = [draw_view(rng, camera, past=k % 3 == 0)[1] for k in range(VIEWS)]
    return [Observation(v.uv + rng.normal(0, NOISE, v.uv.shape), v.xy) for v in views]


def measure_errors(choice: LensChoice, unseen: list[Observation]) -> dict[str, float]:
    """RMS distance, px, of every candidate on views that the choice has not seen."""
    errors = {}
    for model, trial in choice.trials.items():
        try:
            residuals = resect_views(trial.calibration, unseen)
        except CalibrationError:
            continue
        length = np.concatenate([np.linalg.norm(view.image, axis=1) for view in residuals])
        if np.isfinite(length).all():
            errors[model] = float(np.sqrt(np.mean(length**2)))
    return errors


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    arguments = parser.parse_args()
    ratios, taken = [], Counter[str]()
    for seed in range(arguments.first, arguments.first + arguments.scenes):
        camera = problem(seed).scene.camera
        rng = np.random.default_rng([seed, 1])
        views, unseen = (photograph(camera, rng) for _ in range(2))
        try:
            choice = choose_lens_stepwise(views, camera.size)
        except CalibrationError as error:
            print(f"{seed:3d} {camera.model:28s} {error.message}", flush=True)
            ratios.append(np.inf)
            continue
        errors = measure_errors(choice, unseen)
        best = min(errors, key=errors.__getitem__)
        ratio = errors.get(choice.model, np.inf) / errors[best]
        ratios.append(ratio)
        taken[choice.model] += 1
        print(
            f"{seed:3d} {camera.model:28s} -> {choice.model:28s} {ratio:.4f} of {best} "
            f"({errors[best]:.3f} px, {len(errors)} candidates)",
            flush=True,
        )
    report(np.array(ratios), taken)


def report(ratios: Array, taken: Counter[str]) -> None:
    """Print how many choices are good."""
    good = int(np.count_nonzero(ratios <= 1.02))
    print(f"\n{good} of {len(ratios)} within 1.02 of the best candidate; worst {ratios.max():.3f}")
    print(", ".join(f"{model} {count}" for model, count in taken.most_common()))


if __name__ == "__main__":
    main()
