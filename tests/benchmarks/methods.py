"""How much do methods lose against maximum likelihood? `python -m tests.benchmarks.methods`.

The same 10 views of a board of 12 x 9 corners, with 0.1 px of noise, are calibrated by every method
again and again with fresh noise. The camera has fx = fy = 650 px, its centre in the middle of the
image, and a lens that each method's own lens model follows: k1 = -0.25 where the model takes the
ideal point, 0.25 where it takes the measured one, all else 0. Methods without distortion have their
own table, of the same camera without any.

- fx, fy, cx, cy (px), skew (1e-4) and lens: the scatter, which is the standard deviation of the
  estimates; a dash where the method does not estimate it. For methods that know straight lines only
  cx, cy are the centre of distortion. "lens" is the radial shift by the lens, px, at the distance
  of the outermost corner from the centre.
- bias: the largest distance of a mean from the truth, in standard deviations of an estimate; 200
  draws know each to 0.07.
- ratio: least and largest ratio of these scatters to those of maximum likelihood from the same
  corners, with the same lens model and the same parameters held.
- exact: the largest error from corners without noise, relative where the truth is not 0.

The maximum of the likelihood is found by the method "lucchese" with the lens model of the other;
for a tied fy = fx by its covariance, and with known places of the board by SciPy. Methods that take
turns have 100 of them for corners with noise, as by default, and up to 2000 without. "weng" has 50
draws only, and 100 turns do not bring it to its minimum: hence its bias. "opencv" takes corners in
single precision.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from threadpoolctl import threadpool_limits

from calibgui.engine.arrays import Array
from calibgui.engine.assessment.choices.method_comparison import measure_radial_shift
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.calibration.methods import METHODS
from calibgui.engine.calibration.methods.dlt import make_dlt
from calibgui.engine.calibration.methods.method import Method
from calibgui.engine.calibration.methods.plumb_line import LINE_METHODS, PlumbLine
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.calibration.result import DEFAULT_METHOD, Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.models import find_model, list_parameter_names
from calibgui.engine.geometry.frames import centre_of_array
from calibgui.engine.geometry.rotations import rotation_from_vector
from tests.engine.scenes import VGA, Scene, scene, seen

NOISE = 0.1
"""Standard deviation of a corner's coordinate, px."""
FOCAL, K1 = 650.0, 0.25
"""Focal length of the truth, px, and size of its coefficient."""
QUANTITIES = {"fx": "px", "fy": "px", "cx": "px", "cy": "px", "skew": "1e-4", "lens": "px"}
"""What is tabulated, with its unit: parameters, and the radial shift by the lens."""
SIZES = np.array([1, 1, 1, 1, 1e-4, 1])
"""Sizes of these units."""
MAX_TURNS = 2000
"""Number of turns without noise, at most."""
DRAWS = {"weng": 50}
"""Number of draws for methods that take too long, at most."""

Views = Sequence[Observation]
Estimate = Callable[[Views], Array]
"""A function that returns `QUANTITIES` (6,), NaN for what is not estimated."""


@dataclass(frozen=True)
class Row:
    """A method of a table."""

    name: str
    truth: Scene
    estimate: Estimate
    likeliest: Estimate
    """Maximum likelihood of the same freedom."""
    exact: Callable[[Views], float]
    """Return the largest error from corners without noise."""


def make_camera(model: str, k1: float = K1) -> Camera:
    """Make the true camera in a lens model, with a barrel's k1."""
    names = list_parameter_names(model)
    params = np.zeros(len(names))
    params[:4] = FOCAL, FOCAL, *centre_of_array(VGA)
    params[names.index("k1")] = k1 if model == "lucchese" else -k1
    return Camera(VGA, params, model)


POSES = scene(make_camera("brown-conrady-4"), 10, seed=3).poses


def measure_outermost(views: Views) -> float:
    """Measure the distance of the outermost corner from the image's middle, px."""
    uv = np.concatenate([view.uv for view in views])
    return float(np.linalg.norm(uv - centre_of_array(VGA), axis=1).max())


RADIUS = measure_outermost(seen(make_camera("brown-conrady-4"), POSES).views)


def list_quantities(camera: Camera, held: Sequence[str]) -> Array:
    """List `QUANTITIES` of a camera, NaN where held."""
    params = dict(zip(camera.names, camera.params.tolist(), strict=True))
    values = {name: value for name, value in params.items() if name not in held}
    if "k1" in values:
        values["lens"] = measure_radial_shift(camera, RADIUS)
    return np.array([values.get(name, np.nan) for name in QUANTITIES])


def list_line_quantities(lines: PlumbLine) -> Array:
    """List `QUANTITIES` of a correction by straight lines."""
    turns = np.linspace(0, 2 * np.pi, 72, endpoint=False)
    around = lines.centre + RADIUS * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    corrected = np.linalg.norm(lines.correct_points(around) - lines.centre, axis=1)
    return np.array([np.nan, np.nan, *lines.centre, np.nan, RADIUS - corrected.mean()])


def make_fast(method: Method) -> Method:
    """Make the same method without the simulation of its covariance."""
    return replace(method, is_minimum=True)


def measure_error(found: Calibration, truth: Camera) -> float:
    """Measure the largest error of the parameters estimated, relative where the truth is not 0."""
    free = np.array([name not in found.fixed for name in truth.names])
    size = np.where(truth.params == 0, 1.0, np.abs(truth.params))
    return float((np.abs(found.camera.params - truth.params) / size)[free].max())


def maximise_likelihood(model: str, held: Sequence[str], tied: bool = False) -> Estimate:
    """Make the estimate of most likelihood, with fy tied to fx if wanted."""
    free = [name for name in find_model(model).held if name not in held]

    def estimate(views: Views) -> Array:
        found = calibrate(views, VGA, model=model, fix=held, free=free)
        if not tied:
            return list_quantities(found.camera, found.fixed)
        # The minimum under a linear condition a.p = 0, from that without and its covariance C.
        C, a = found.covariance, np.zeros(len(found.sigma))
        a[:2] = 1.0, -1.0
        p = found.camera.params
        params = p - C @ a * (a @ p) / (a @ C @ a)
        return list_quantities(Camera(VGA, params, model), [*found.fixed, "fy"])

    return estimate


def make_row(method: Method) -> Row:
    """Make the row of a method with distortion."""
    model, fast = method.lens_models[0], make_fast(method)
    held = find_model(model).held if method.held is None else method.held
    is_tied = "fy" in held
    camera = make_camera(model)

    def estimate(views: Views) -> Array:
        found = calibrate(views, VGA, method=fast)
        return list_quantities(found.camera, found.fixed)

    def measure_exact(views: Views) -> float:
        found = calibrate(views, VGA, method=fast, max_iterations=MAX_TURNS)
        return measure_error(found, camera)

    likeliest = maximise_likelihood(model, [name for name in held if name != "fy"], is_tied)
    if method.name == DEFAULT_METHOD:
        likeliest = estimate
    return Row(method.name, seen(camera, POSES), estimate, likeliest, measure_exact)


def make_line_row(name: str) -> Row:
    """Make the row of a method that knows straight lines only."""
    method, camera = LINE_METHODS[name], make_camera("lucchese")
    held = ("k3", "p1", "p2", "p3") if name == "stein" else ("k2", "k3", "p1", "p2", "p3")
    likeliest = maximise_likelihood("lucchese", held)

    def measure_exact(views: Views) -> float:
        found = method.estimate(views, VGA)
        k = found.k * FOCAL ** np.array([2, 4])[: len(found.k)]
        error = [*(found.centre / camera.centre - 1), k[0] / K1 - 1, *k[1:], found.aspect - 1]
        return float(np.abs(error).max())

    return Row(
        name,
        seen(camera, POSES),
        lambda views: list_line_quantities(method.estimate(views, VGA)),
        lambda views: np.where([0, 0, 1, 1, 0, 1], likeliest(views), np.nan),
        measure_exact,
    )


def resect_with_places(views: Views) -> Array:
    """Find camera and its one place of most likelihood, the board's places known, by SciPy."""
    points = [
        view.xy @ rotation_from_vector(pose.rvec)[:, :2].T + pose.tvec
        for view, pose in zip(views, POSES, strict=True)
    ]
    X, uv = np.concatenate(points), np.concatenate([view.uv for view in views])

    def compute_residuals(q: Array) -> Array:
        fx, fy, cx, cy, skew = q[:5]
        point = X @ rotation_from_vector(q[5:8]).T + q[8:]
        x, y = point[:, :2].T / point[:, 2]
        return np.concatenate([fx * (x + skew * y) + cx - uv[:, 0], fy * y + cy - uv[:, 1]])

    start = np.array([0.9 * FOCAL, 1.1 * FOCAL, *VGA, *np.full(7, 0.1)]) / [1, 1, 2, 2, *np.ones(7)]
    found = scipy.optimize.least_squares(compute_residuals, start, x_scale="jac", xtol=1e-12)
    return np.append(found.x[:5], np.nan)


def make_ideal_rows() -> list[Row]:
    """Make the rows of the methods without distortion, each with maximum likelihood below it."""
    model, rows = "brown-conrady-4", []
    camera = make_camera(model, 0.0)
    truth = seen(camera, POSES)
    held = ("k1", "k2", "p1", "p2")
    likeliest = {
        "zhang-closed-form": maximise_likelihood(model, held),
        "dlt": resect_with_places,
    }
    for method in (METHODS["zhang-closed-form"], make_dlt(POSES)):
        fast = make_fast(method)

        def estimate(views: Views, fast: Method = fast) -> Array:
            found = calibrate(views, VGA, method=fast)
            return list_quantities(found.camera, found.fixed)

        def measure_exact(views: Views, fast: Method = fast) -> float:
            return measure_error(calibrate(views, VGA, method=fast), camera)

        best = likeliest[method.name]

        def measure_likeliest(views: Views, best: Estimate = best) -> float:
            miss = best(views)[:5] - camera.params[[0, 1, 2, 3, 8]]
            return float(np.abs(miss / [*camera.params[:4], 1.0]).max())

        rows.append(Row(method.name, truth, estimate, best, measure_exact))
        rows.append(Row("maximum likelihood", truth, best, best, measure_likeliest))
    return rows


def measure_row(row: Row, draws: int) -> list[str]:
    """Measure a method, and return the cells of its row."""
    drawn, best = [], []
    for seed in range(min(draws, DRAWS.get(row.name, draws))):
        views = row.truth.noisy(NOISE, np.random.default_rng(seed))
        drawn.append(row.estimate(views))
        best.append(drawn[-1] if row.estimate is row.likeliest else row.likeliest(views))
    values, held = np.array(drawn), np.isnan(drawn[0])
    scatter = values.std(axis=0, ddof=1)
    true = list_quantities(row.truth.camera, ())
    bias = np.abs(values.mean(axis=0) - true) / scatter
    ratio = (scatter / np.std(best, axis=0, ddof=1))[~held]
    low, high = f"{ratio.min():.2f}", f"{ratio.max():.2f}"
    numbers = [f"{value:#.3g}" if np.isfinite(value) else "-" for value in scatter / SIZES]
    return [
        row.name,
        *numbers,
        f"{bias[~held].max():.2f}",
        low if low == high else f"{low} to {high}",
        f"{row.exact(row.truth.views):.0e}",
    ]


def print_table(rows: Sequence[Row], draws: int) -> None:
    """Print a table in Markdown."""
    quantities = [f"{name}, {unit}" for name, unit in QUANTITIES.items()]
    head = ["method", *quantities, "bias", "ratio", "exact"]
    print(f"| {' | '.join(head)} |\n|{' --- |' * len(head)}", flush=True)
    for row in rows:
        print(f"| {' | '.join(measure_row(row, draws))} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--methods", nargs="+", help="these only")
    arguments = parser.parse_args()
    ideal = make_ideal_rows()
    names = [name for name in METHODS if name not in {row.name for row in ideal}]
    rows = [make_row(METHODS[name]) for name in names]
    rows += [make_line_row(name) for name in LINE_METHODS]
    if arguments.methods:
        rows = [row for row in rows if row.name in arguments.methods]
    with threadpool_limits(1):
        print_table(rows, arguments.draws)
        print()
        print_table(ideal, arguments.draws)


if __name__ == "__main__":
    main()
