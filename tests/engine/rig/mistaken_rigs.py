"""Rigs with the mistakes that people make."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from calibgui.engine.calibration import calibrate
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.rig import Mistake, RigCamera
from tests.engine.rig.scenes import SIZE, RigScene, compose, make_rig, photograph_board

LENSES = (
    Camera(SIZE, [900, 905, 631, 492, -0.2, 0.08, 3e-4, -5e-4, -0.02], "brown-conrady"),
    Camera(SIZE, [905, 908, 645, 480, -0.21, 0.09, -2e-4, 3e-4, -0.02], "brown-conrady"),
)
INSTANTS, SIGMA = 25, 0.1
Views = dict[int, Observation]


def make_scene(seed: int) -> RigScene:
    return make_rig(2, instants=INSTANTS, seed=seed, lenses=LENSES)


def see_noisily(
    scene: RigScene, rng: np.random.Generator, change: Mapping[int, Pose] | None = None
) -> list[Views]:
    """What both cameras see with noise; the second at some instants from where `change` has it."""
    seen: list[Views] = [{}, {}]
    for c, views in enumerate(seen):
        for k, board in enumerate(scene.boards):
            pose = compose(scene.poses[c], board)
            if c and change and k in change:
                pose = compose(change[k], pose)
            view = photograph_board(scene.cameras[c].camera, pose)
            if view is not None:
                noise = rng.normal(0, SIGMA, view.uv.shape)
                views[k] = view._replace(uv=view.uv + noise)
    return seen


def calibrate_alone(seen: list[Views]) -> list[RigCamera]:
    cameras = []
    for name, views in zip(("left", "right"), seen, strict=True):
        found = calibrate(list(views.values()), SIZE, model="brown-conrady", model_errors=False)
        cameras.append(RigCamera(name, found.camera, views, found.fixed))
    return cameras


def _see_clean(scene: RigScene, rng: np.random.Generator) -> list[Views]:
    return see_noisily(scene, rng)


def _permute(scene: RigScene, rng: np.random.Generator) -> list[Views]:
    left, right = see_noisily(scene, rng)
    order = [k for k in (3, 8, 14, 20) if k in right]
    shuffled = dict(right)
    for to, source in zip(order, order[1:] + order[:1], strict=True):
        shuffled[to] = right[source]
    return [left, shuffled]


def _shift(scene: RigScene, rng: np.random.Generator) -> list[Views]:
    left, right = see_noisily(scene, rng)
    return [left, {k + 1: view for k, view in right.items()}]


def _exchange(scene: RigScene, rng: np.random.Generator) -> list[Views]:
    left, right = see_noisily(scene, rng)
    for k in (4, 11, 17):
        if k in left and k in right:
            left[k], right[k] = right[k], left[k]
    return [left, right]


def _move(scene: RigScene, rng: np.random.Generator) -> list[Views]:
    moved = Pose([0.004, -0.006, 0.003], [2.0, -1.5, 1.0])
    return see_noisily(scene, rng, dict.fromkeys(range(12, INSTANTS), moved))


def _refocus(scene: RigScene, rng: np.random.Generator) -> list[Views]:
    left, right = see_noisily(scene, rng)
    lens = scene.cameras[1].camera
    longer = replace(lens, params=lens.params * np.r_[1.01, 1.01, np.ones(len(lens.params) - 2)])
    other = replace(scene.cameras[1], camera=longer)
    _, after = see_noisily(replace(scene, cameras=(scene.cameras[0], other)), rng)
    return [left, {k: view if k < 12 else after[k] for k, view in right.items() if k in after}]


def _rescale(scene: RigScene, rng: np.random.Generator) -> list[Views]:
    seen = see_noisily(scene, rng)
    return [
        {
            k: view._replace(xy=view.xy * 25 / 30) if k % 4 == 1 else view
            for k, view in views.items()
        }
        for views in seen
    ]


MISTAKES: dict[str, tuple[Callable[[RigScene, np.random.Generator], list[Views]], set[Mistake]]] = {
    "clean": (_see_clean, set()),
    "permuted": (_permute, {Mistake.OTHER_INSTANT}),
    "shifted": (_shift, {Mistake.SHIFTED}),
    "exchanged": (_exchange, {Mistake.EXCHANGED}),
    "moved": (_move, {Mistake.MOVED}),
    "refocused": (_refocus, {Mistake.REFOCUSED}),
    "other squares": (_rescale, {Mistake.OTHER_SCALE}),
}
"""Functions that make the views, and what is to be named, by the names of the mistakes."""


def make_mistaken(name: str, seed: int) -> list[RigCamera]:
    """Cameras with a mistake, each calibrated alone."""
    rng = np.random.default_rng(1000 + seed)
    return calibrate_alone(MISTAKES[name][0](make_scene(seed), rng))
