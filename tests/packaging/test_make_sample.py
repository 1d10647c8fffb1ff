"""The sample set in resources/ is what its generator makes, and what it should be."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from calibgui.engine.camera.distortion import project_points
from calibgui.engine.geometry.rotations import rotation_from_vector
from calibgui.engine.images.reading import read_image

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "resources" / "sample"


def load() -> ModuleType:
    spec = importlib.util.spec_from_file_location(
        "make_sample", ROOT / "packaging" / "make_sample.py"
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


make_sample = load()


@pytest.fixture(scope="module")
def truth() -> dict[str, Any]:
    content: dict[str, Any] = json.loads((FOLDER / "truth.json").read_text())
    return content


def test_truth_is_what_the_generator_says(truth: dict[str, Any]) -> None:
    made = json.loads(json.dumps(make_sample.describe_truth()))
    for theirs, ours in zip(truth["views"], made["views"], strict=True):
        np.testing.assert_allclose(theirs["corners"], ours["corners"], atol=2e-9)
        ours["corners"] = theirs["corners"]
    assert made == truth


def test_images_are_what_the_generator_renders() -> None:
    made = make_sample.draw_photograph(6).astype(int)
    stored = read_image(FOLDER / "view06.png").pixels
    # The last bit of a sine may differ between processors and turn a rounding here and there.
    assert np.abs(made - stored).max() <= 1
    assert np.count_nonzero(made - stored) <= 10


def test_the_set_is_complete_and_small(truth: dict[str, Any]) -> None:
    names = {view["image"] for view in truth["views"]}
    assert len(names) == 14
    assert {path.name for path in FOLDER.iterdir()} == names | {"truth.json", "pixels.csv"}
    assert all(read_image(FOLDER / name).size == (640, 480) for name in names)
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < 4e6


def test_boards_are_whole_and_reach_the_edges(truth: dict[str, Any]) -> None:
    corners = np.array([view["corners"] for view in truth["views"]])
    assert corners.shape == (14, 70, 2)
    for view in make_sample.VIEWS:
        sheet = project_points(
            make_sample.draw_outline(), make_sample.CAMERA, make_sample.place_board(view)
        )
        assert sheet.min() >= make_sample.CLEARANCE - 0.1
        assert np.all(sheet <= np.array([639, 479]) - make_sample.CLEARANCE + 0.1)
    # Corners come close to all four sides, and boards into all four corners of the image.
    assert np.all(corners.min(axis=(0, 1)) < [30, 60])
    assert np.all(corners.max(axis=(0, 1)) > [610, 425])
    for corner in ([0, 0], [640, 0], [0, 480], [640, 480]):
        assert np.linalg.norm(corners - corner, axis=-1).min() < 100


def test_boards_are_tilted_both_ways(truth: dict[str, Any]) -> None:
    R = rotation_from_vector(np.array([view["rvec"] for view in truth["views"]]))
    normals = np.rad2deg(np.arctan2(R[:, :2, 2], R[:, 2:, 2]))
    assert np.all(normals.min(axis=0) < -35)
    assert np.all(normals.max(axis=0) > 35)
    assert np.rad2deg(np.arccos(R[:, 2, 2])).max() < 42
