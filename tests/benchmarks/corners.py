"""How near to the physical limit are the corners? Ours and others', from the same photographs.

    python -m tests.benchmarks.corners [--quick] [--output FOLDER]

draws boards under many conditions (`tests.scenes`), locates their corners with every method at
hand (`corner_methods`), and prints per condition the root mean square error per axis over the
Cramer-Rao bound, the boards found in full, and the time. The engine is told nothing but the image;
the others are told the board's size, which they need. Then ours alone are measured in images of 12
megapixels, on boards of few corners under a lens that bends their edges and on boards of large
squares that the image cuts, and counted where only a part of the board is seen (`corner_partial`),
under conditions drawn at random (`corner_unseen`), and in images without a board. `--output` also
gets all of it but the large images, the few corners and the cut boards as JSON and a plot.
"""

from __future__ import annotations

import argparse
import contextlib
from collections import Counter
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.benchmarks import corner_partial, corner_unseen
from tests.benchmarks.corner_methods import METHODS, Method, ours, timed
from tests.benchmarks.corner_partial import Count
from tests.benchmarks.corner_report import Report, Score, summed_up, write
from tests.scenes.checkerboards import Scene, draw
from tests.scenes.conditions import Conditions
from tests.scenes.without_board import KINDS, draw_without_board

_TOLD = 0.0005
"""Standard error of our mean error along u or v, px: a quarter of the bias that is tolerated."""

CONDITIONS: dict[str, dict[str, Any]] = {
    "base": {},
    "noise 0": {"noise": 0.0},
    "noise 10": {"noise": 10.0},
    "noise 20": {"noise": 20.0},
    "blur 0": {"blur": 0.01},
    "blur 2": {"blur": 2.0},
    "blur 5": {"blur": 5.0, "square": 36.0},
    "squares 8": {"square": 8.0, "shift": 60.0},
    "squares 40": {"square": 40.0, "shift": 10.0},
    "squares 100": {"square": 100.0, "size": (1280, 960)},
    "tilt 60": {"tilt": 60.0, "square": 36.0},
    "tilt 70": {"tilt": 70.0, "square": 45.0},
    "barrel": {"distortion": 0.5, "square": 38.0},
    "pincushion": {"distortion": -0.25},
    "fisheye": {"fisheye": True, "focal": 0.4, "square": 36.0},
    "hard light": {"light": 1.0, "noise": 1.0},
    "gamma 2.2": {"gamma": 2.2},
    "motion 5": {"motion": 5.0},
    "focus 0.7-4": {"blur": 0.7, "blur_end": 4.0},
    "ink 1.5 %": {"ink": 0.015},
    "ink -2 %": {"ink": -0.02},
    "ink 8 %": {"ink": 0.08},
    "ink -8 %": {"ink": -0.08},
    "16 bits": {"deep": True},
    "clutter": {"clutter": True, "quiet": 0.3},
    "all": {
        "clutter": True,
        "quiet": 0.5,
        "tilt": 45.0,
        "noise": 6.0,
        "blur": 1.5,
        "gamma": 2.2,
        "light": 1.0,
    },
}
LARGE: dict[str, dict[str, Any]] = {
    "54 corners": {"square": 240.0},
    "609 corners": {
        "square": 100.0,
        "grid_size": (21, 29),
        "tilt": 15.0,
        "turn": 5.0,
        "shift": 10.0,
    },
    "barrel": {"square": 260.0, "distortion": 0.5},
    "hard light": {"square": 240.0, "light": 1.0},
}
"""Conditions in images of 12 megapixels, which the others take seconds for."""
SMALL: dict[str, dict[str, Any]] = {
    f"{rows} x {cols}, {square} px": {
        "grid_size": (rows, cols),
        "square": float(square),
        "size": (max(640, 8 * square), max(480, 6 * square)),
        "distortion": 0.43,
        "parts": 4 if square < 100 else 2,
    }
    for rows, cols in ((3, 3), (3, 4), (4, 5))
    for square in (8, 90, 300)
}
"""Boards of few corners that fill the image, but for the smallest, at 30 % barrel."""
SMALL |= {
    f"{rows} x {cols}, aside": SMALL[f"{rows} x {cols}, 300 px"] | {"centre": (420.0, 210.0)}
    for rows, cols in ((3, 3), (3, 4))
}


CUT: dict[str, dict[str, Any]] = {
    f"250 px, {barrel} % barrel": {"square": 250.0, "size": (1600, 1200), "distortion": distortion}
    for barrel, distortion in ((0, 0.0), (12, 0.136), (30, 0.43))
}
"""Boards of large squares that the image cuts."""


def score(method: Method, scenes: list[Scene], draws: int, in_part: bool = False) -> Score:
    """Run one method on `draws` noisy photographs of each scene, whose boards are seen whole or
    `in_part`, numbered anyhow."""
    errors, bounds, honest, seconds, complete = [], [], [], [], 0
    for k, scene in enumerate(scenes):
        for i in range(draws):
            image = scene.photograph(1000 * k + i)
            located, spent = method(image, scene.conditions.grid_size)
            seconds.append(spent)
            if located is None:
                continue
            grid, uv, cov = located
            # Others number the board from any of its ends: the nearest corner is the one meant.
            truth = scene.uv.reshape(-1, 2)
            nearest = np.argmin(np.linalg.norm(uv[:, None] - truth, axis=2), axis=1)
            error = uv - truth[nearest]
            right = len(set(nearest)) == (len(uv) if in_part else len(truth))
            if grid is not None and not in_part:
                right &= bool(np.all(nearest == grid @ np.array([scene.uv.shape[1], 1])))
            if not right or np.abs(error).max() > 3:
                continue
            complete += 1
            errors.append(error)
            bounds.append(scene.bound.reshape(-1, 2, 2)[nearest])
            if cov is not None:
                honest.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(cov), error) / 2)
    found = complete / (len(scenes) * draws)
    ms = 1e3 * float(np.nanmedian(seconds)) if np.isfinite(seconds).any() else np.nan
    if not errors:
        return Score(np.nan, np.nan, np.nan, np.nan, found, ms)
    e, b = np.concatenate(errors), np.concatenate(bounds)
    rmse = float(np.sqrt(np.mean(e**2)))
    bound = float(np.sqrt(np.mean(np.trace(b, axis1=1, axis2=2) / 2)))
    chi2 = float(np.mean(np.concatenate(honest))) if honest else np.nan
    bias = float(np.abs(e.mean(axis=0)).max())
    return Score(rmse / bound, 1e3 * rmse, 1e3 * bias, chi2, found, ms)


def enough(scenes: list[Scene]) -> int:
    """Photographs of each scene whose corners tell a mean error of `_TOLD` px from chance."""
    variance = float(np.mean([np.trace(s.bound, axis1=2, axis2=3).mean() / 2 for s in scenes]))
    corners = sum(s.uv[..., 0].size for s in scenes)
    return int(np.ceil(variance / _TOLD**2 / corners))


def false_boards(count: int) -> dict[str, int]:
    """Boards reported in `count` images of clutter, texture and noise that hold none, by kind."""
    reported: Counter[str] = Counter()
    for seed in range(count):
        with contextlib.suppress(NoBoardError):
            find_corners(draw_without_board(seed))
            reported[KINDS[seed % len(KINDS)]] += 1
    return dict(reported)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a few scenes of each kind")
    parser.add_argument("--output", type=Path, help="folder for corners.json and corners.png")
    options = parser.parse_args()
    quick = options.quick
    scenes, draws = (1, 1) if quick else (3, 2)
    cv2.setNumThreads(1)
    METHODS["ours"](draw(Conditions(), 0).photograph(0), Conditions().grid_size)  # compiles
    table: dict[str, dict[str, Score]] = {}
    print(f"{'':14}" + "".join(f"{name:>22}" for name in METHODS))
    print(f"{'condition':14}" + f"{'ratio  found    ms':>22}" * len(METHODS))
    for name, settings in CONDITIONS.items():
        drawn = [draw(Conditions(**settings), seed, with_bound=True) for seed in range(scenes)]
        table[name] = {
            m: score(method, drawn, draws if quick or m != "ours" else max(draws, enough(drawn)))
            for m, method in METHODS.items()
        }
        cells = (
            f"{s.ratio:9.2f}{100 * s.found:6.0f}%{s.milliseconds:6.0f}"
            for s in table[name].values()
        )
        print(f"{name:14}" + "".join(cells), flush=True)
    print("\n" + summed_up(table))
    own = [row["ours"] for row in table.values()]
    ratios = np.array([s.ratio for s in own])
    print(f"\nours: RMSE / bound median {np.nanmedian(ratios):.3f}, worst {np.nanmax(ratios):.2f};")
    print(f"  bias at most {max(s.bias for s in own):.2f}e-3 px;", end=" ")
    print(f"chi2/dof {min(s.chi2 for s in own):.2f} to {max(s.chi2 for s in own):.2f}")

    print("\n12 megapixels")
    for name, settings in LARGE.items():
        large = Conditions(size=(4000, 3000), blur=1.2, parts=2, **settings)
        drawn = [draw(large, seed, with_bound=True) for seed in range(scenes)]
        found = score(METHODS["ours"], drawn, draws)
        print(f"{name:14}ratio {found.ratio:.2f}, chi2/dof {found.chi2:.2f}", flush=True)

    print("\nfew corners")
    for name, settings in SMALL.items():
        drawn = [draw(Conditions(**settings), seed, with_bound=True) for seed in range(scenes)]
        found = score(METHODS["ours"], drawn, draws if quick else max(6, enough(drawn)))
        print(
            f"{name:14}ratio {found.ratio:.2f}, chi2/dof {found.chi2:.2f}, {found.found:.0%} found",
            flush=True,
        )

    print("\nboards that the image cuts")
    for name, settings in CUT.items():
        cut = Conditions(parts=2, shift=300.0, **settings)
        drawn = [draw(cut, seed, with_bound=True) for seed in range(2 * scenes)]
        found = score(timed(ours("edges", in_part=True)), drawn, draws if quick else 6, True)
        print(f"{name:20}ratio {found.ratio:.2f}, chi2/dof {found.chi2:.2f}", flush=True)

    print("\nparts of boards: visible corners found, and wrong ones; size stated, size inferred")
    parts: dict[str, list[Count]] = {}
    for kind in corner_partial.KINDS:
        amount = 2 if quick else corner_partial.SCENES
        parts[kind] = [corner_partial.total(kind, known, amount) for known in (True, False)]
        cells = (f"{c.found:7d} of {c.visible:4d}, {c.wrong} wrong" for c in parts[kind])
        print(f"{kind:18}" + "".join(cells), flush=True)

    unseen = corner_unseen.total(6 if quick else corner_unseen.SCENES)
    c = unseen.corners
    print(f"\nunder random conditions: {unseen.found} of {unseen.whole} whole boards in full,")
    print(f"  {c.found} of {c.visible} visible corners, {c.wrong} wrong")
    count = 20 if quick else 200
    false = false_boards(count)
    print(f"boards reported in {count} images without one: {false or 0}")
    if options.output:
        write(options.output, Report(table, parts, unseen, false))
        print(f"written: {options.output / 'corners.json'}, {options.output / 'corners.png'}")


if __name__ == "__main__":
    main()
