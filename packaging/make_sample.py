"""Render the sample set in resources/sample: photographs of a board, and the truth about them.

    python packaging/make_sample.py [FOLDER]

The views are what a careful user would take: tilted both ways up to 40 degrees, turned a
little, and moved in turn to the middle, the sides and the corners of the image, always whole.
Running the script again reproduces the files.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array
from calibgui.engine.boards import Board
from calibgui.engine.camera import MODELS, Camera, project_points
from calibgui.engine.files import write_atomically
from calibgui.engine.geometry import Pose, rotation_from_vector, vector_from_rotation
from calibgui.engine.images import Appearance, render_view, write_image

FOLDER = Path(__file__).resolve().parents[1] / "resources" / "sample"

BOARD = Board(rows=7, cols=10, square=25.0)
CAMERA = Camera(
    (640, 480),
    np.array([660.4, 661.7, 309.2, 246.3, 0.27, 0.11, -0.06, -4.0e-4, 6.0e-4, 0.0]),
    "lucchese",
)
LOOK = Appearance(quiet_zone=0.4, shading=(0.25, -0.15))
BLUR, NOISE = 0.7, 2.0
"""Standard deviations of the Gaussian blur, px, and of the noise, grey levels."""
CLEARANCE = 3.0
"""Distance of the paper from the side of the image that it touches, px."""

VIEWS = (
    # Tilt about the image's x axis, about y, and turn in its plane, degrees; side of the image
    # that the paper touches along u and v (-1, 1; 0: it is centred); distance, mm.
    (0, 0, 2, 0, 0, 315),
    (30, 0, -4, 0, 0, 350),
    (-32, 3, 3, 0, 0, 360),
    (2, 33, 5, 0, 0, 400),
    (-4, -34, -3, 0, 0, 390),
    (24, -22, 4, -1, -1, 540),
    (26, 24, -7, 1, -1, 500),
    (-22, -26, -3, -1, 1, 480),
    (-24, 22, 8, 1, 1, 440),
    (40, 4, 15, 0, -1, 420),
    (-40, -3, -14, 0, 1, 430),
    (5, 40, -20, -1, 0, 480),
    (-6, -39, 18, 1, 0, 420),
    (18, -16, 90, 0, 0, 440),
)


def place_board(view: tuple[int, ...]) -> Pose:
    """Return the pose of the board in one of `VIEWS`."""
    *angles, u_side, v_side, distance = view
    about_x, about_y, turn = (
        rotation_from_vector(np.deg2rad(a) * e) for a, e in zip(angles, np.eye(3), strict=True)
    )
    rvec = vector_from_rotation(about_x @ about_y @ turn).round(6)
    to_centre = rotation_from_vector(rvec)[:, :2] @ BOARD.points().mean(axis=0)
    half = (np.array(CAMERA.size) - 1) / 2
    side = np.array([u_side, v_side])
    ray = np.zeros(2)
    for _ in range(30):  # moving the board hardly changes its outline: this converges fast
        placed = Pose(rvec, (distance * np.append(ray, 1.0) - to_centre).round(2))
        uv = project_points(draw_outline(), CAMERA, placed)
        low, high = uv.min(axis=0), uv.max(axis=0)
        touching = np.where(side < 0, low, np.where(side > 0, high, (low + high) / 2))
        ray += (half + side * (half - CLEARANCE) - touching) / CAMERA.focal
    return placed


def draw_outline() -> Array:
    """Return (n, 2) points along the edge of the white paper, mm."""
    margin = 1 + LOOK.quiet_zone
    X = np.linspace(-margin, BOARD.cols - 1 + margin, 45)
    Y = np.linspace(-margin, BOARD.rows - 1 + margin, 45)
    sides = [(X, Y[:1]), (X, Y[-1:]), (X[:1], Y), (X[-1:], Y)]
    return BOARD.square * np.concatenate([np.stack(np.broadcast_arrays(*s), 1) for s in sides])


def describe_truth() -> dict[str, object]:
    """Return what the sample set was made from, as truth.json holds it."""
    poses = [place_board(view) for view in VIEWS]
    names = ("fx", "fy", "cx", "cy", *MODELS[CAMERA.model].names)
    return {
        "camera": {
            "model": CAMERA.model,
            "size": CAMERA.size,
            "params": dict(zip(names, CAMERA.params.tolist(), strict=True)),
        },
        "target": {"rows": BOARD.rows, "cols": BOARD.cols, "square_mm": BOARD.square},
        "rendering": {"blur_px": BLUR, "noise_levels": NOISE, **asdict(LOOK)},
        "views": [
            {
                "image": f"view{number:02d}.png",
                "rvec": pose.rvec.tolist(),
                "tvec_mm": pose.tvec.tolist(),
                "corners": project_points(BOARD.points(), CAMERA, pose).round(9).tolist(),
            }
            for number, pose in enumerate(poses, start=1)
        ],
    }


def draw_photograph(number: int, look: Appearance = LOOK) -> npt.NDArray[np.uint8]:
    """Render the image of view `number`, from 1."""
    pose = place_board(VIEWS[number - 1])
    return render_view(CAMERA, pose, BOARD, blur=BLUR, noise=NOISE, seed=number, appearance=look)


def main() -> None:
    """Write the images and truth.json."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path, default=FOLDER)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    write_atomically(
        folder / "truth.json", (json.dumps(describe_truth(), indent=1) + "\n").encode()
    )
    for number in range(1, len(VIEWS) + 1):
        write_image(folder / f"view{number:02d}.png", draw_photograph(number))


if __name__ == "__main__":
    main()
