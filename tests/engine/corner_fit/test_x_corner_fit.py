"""Positions and covariances of the edge fit, against drawn boards and their physical limit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy

from calibgui.engine.corner_fit import x_corner_fit
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.features.corners import find_usable_covariances
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions

FEW = {"size": (720, 600), "turn": 15.0, "blur": 0.8, "parts": 2}
"""Of a board with few corners."""


@pytest.mark.parametrize(
    "condition",
    [
        {},
        {"motion": 5.0},  # a blur that is not Gaussian
        {"ink": 0.08},  # squares that overlap
        {"ink": -0.08},  # and that part
        {"blur": 5.0, "square": 36.0},  # neighbours' edges are near
        {"light": 1.0, "noise": 0.5, "square": 100.0, "size": (1280, 960), "parts": 2},  # long arms
        {"grid_size": (12, 16), "square": 72.0, "size": (1400, 1050), "turn": 4.0, "parts": 2},
        {"fisheye": True, "focal": 0.32, "square": 80.0, "size": (720, 720)},  # near its front lens
        {"distortion": 0.9, "focal": 0.5, "square": 60.0, "size": (800, 600)},
        {"distortion": -0.3, "focal": 0.8, "square": 60.0, "size": (800, 600)},
        # Few corners of large squares: only the edges' directions tell how they bend.
        {**FEW, "grid_size": (3, 4), "square": 100.0, "distortion": 0.032},
        {**FEW, "grid_size": (4, 5), "square": 90.0, "distortion": 0.065},
        {**FEW, "grid_size": (3, 4), "square": 90.0, "distortion": 0.43},
    ],
    ids=str,
)
def test_errors_are_the_bound_and_what_the_covariance_says(condition: dict[str, Any]) -> None:
    scene = draw(Conditions(**condition), 2, with_bound=True)
    squares, limits, honest = [], [], []
    for seed in range(4):
        corners = find_corners(scene.photograph(seed))
        assert corners.shape == scene.conditions.grid_size
        at = corners.grid[:, 0], corners.grid[:, 1]
        error = corners.uv - scene.uv[at]
        assert corners.cov is not None
        squares.append(error**2)
        limits.append(np.trace(scene.bound[at], axis1=1, axis2=2) / 2)
        honest.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2)
    assert np.sqrt(np.mean(np.concatenate(squares)) / np.mean(np.concatenate(limits))) < 1.15
    assert 0.75 < np.mean(np.concatenate(honest)) < 1.25


@pytest.mark.parametrize("arm", [4.0, 25.0, 150.0, 2000.0])
def test_ever_more_of_long_arms_is_read(arm: float) -> None:
    first, *others = x_corner_fit._choose_reaches(arm)
    reaches = np.array([first, *others, max(arm, others[-1])])
    assert first == 9.0
    assert others[-1] == pytest.approx(max(arm / 3, 9.0))
    assert (reaches[1:] / reaches[:-1]).max() <= 6.0
    assert len(others) == (3 if arm == 2000.0 else 1)


@pytest.mark.parametrize("distortion", [0.136, 0.43])
def test_corners_whose_edges_the_image_cuts_are_at_the_bound_too(distortion: float) -> None:
    settings: dict[str, Any] = {"turn": 15.0, "parts": 2, "distortion": distortion}
    conditions = Conditions(square=200.0, size=(1280, 960), centre=(150.0, 100.0), **settings)
    scene = draw(conditions, 1, with_bound=True)
    squares, limits, honest = [], [], []
    for seed in range(3):
        corners = find_corners(scene.photograph(seed))
        assert corners.cov is not None
        near = np.argmin(np.linalg.norm(corners.uv[:, None] - scene.uv.reshape(-1, 2), axis=2), 1)
        error = corners.uv - scene.uv.reshape(-1, 2)[near]
        squares.append(error**2)
        limits.append(np.trace(scene.bound.reshape(-1, 2, 2)[near], axis1=1, axis2=2) / 2)
        honest.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2)
    assert np.sqrt(np.mean(np.concatenate(squares)) / np.mean(np.concatenate(limits))) < 1.15
    assert 0.75 < np.mean(np.concatenate(honest)) < 1.25


def test_what_lies_on_squares_draws_no_corner_aside() -> None:
    conditions = Conditions(light=1.0, noise=1.0, square=60.0, size=(800, 600), turn=0.0, parts=2)
    scene = draw(conditions, 2)
    v, u = np.indices(scene.clean.shape)
    clean = scene.clean.copy()
    for corner in scene.uv[1:-1:2, ::2].reshape(-1, 2):
        middle = corner + 0.3 * (scene.uv[1, 1] - scene.uv[0, 0])
        clean[np.hypot(u - middle[0], v - middle[1]) < 9] = 30.0
    corners = find_corners(replace(scene, clean=clean).photograph(0))
    assert corners.cov is not None
    error = corners.uv - scene.uv[corners.grid[:, 0], corners.grid[:, 1]]
    chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
    assert len(error) > 40
    assert np.mean(chi2) < 1.3


@pytest.mark.parametrize("gamma", [1.0, 2.2])
def test_light_that_varies_draws_no_corner_into_the_dark(gamma: float) -> None:
    """A blur of 1.5 px would draw the whole board by 4e-3 px."""
    scene = draw(Conditions(light=1.0, blur=1.5, noise=0.3, gamma=gamma), 1)
    corners = find_corners(scene.photograph(0))
    error = corners.uv - scene.uv[corners.grid[:, 0], corners.grid[:, 1]]
    assert np.abs(error.mean(axis=0)).max() < 1.5e-3


@pytest.mark.parametrize("dimmed", [0.4, 0.8])
def test_the_edge_of_a_shadow_draws_no_corner_aside(dimmed: float) -> None:
    """Corners that it runs through say how far off they may be, and the others are none the
    worse."""
    scene = draw(Conditions(turn=0.0, shift=0.0), 3)
    v, u = np.indices(scene.clean.shape)
    off = scene.uv @ [0.6, 0.8] - 400
    shadowed = replace(scene, clean=scene.clean * np.where(0.6 * u + 0.8 * v > 400, dimmed, 1.0))
    corners = find_corners(shadowed.photograph(0))
    assert corners.cov is not None
    at = corners.grid[:, 0], corners.grid[:, 1]
    error = corners.uv - scene.uv[at]
    far = abs(off[at]) > 25
    chi2 = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2
    assert np.count_nonzero(far) > 35
    assert np.mean(chi2[far]) < 1.3
    assert np.mean(chi2[~far]) < 2.0
    distance = np.linalg.norm(error, axis=1)
    assert distance.max() < 0.4
    assert distance[corners.cov[:, 0, 0] < 0.03**2].max() < 0.1


@pytest.mark.parametrize("levels", [(0, 255), (40, 200)], ids=["saturated", "drawn"])
@pytest.mark.parametrize("square", [12, 25])
def test_a_drawing_without_noise_has_that_of_its_rounded_levels(
    levels: tuple[int, int], square: int
) -> None:
    """Opposite pixels are equal there: the residual has no odd part at all."""
    dark = np.kron(np.indices((7, 8)).sum(axis=0) % 2, np.ones((square, square))) > 0
    drawing = np.pad(np.where(dark, *levels), 2 * square, constant_values=levels[1])
    image = np.rint(scipy.ndimage.gaussian_filter(drawing.astype(np.float64), 0.6))
    corners = find_corners(image.astype(np.uint8), (6, 7))
    assert corners.complete
    assert corners.cov is not None
    sigma = np.sqrt(np.linalg.eigvalsh(corners.cov))
    assert (sigma > 1e-4).all()
    assert (sigma < 1e-2).all()
    fractions = find_corners(image / 255, (6, 7))
    assert fractions.cov is not None
    assert find_usable_covariances(fractions.cov).all()
