"""What neighbouring pixels have in common makes corners' covariances grow, chance does not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest

from calibgui.engine.corner_fit import corner_noise, x_corner_fit
from calibgui.engine.corner_fit.corner_noise import compute_growth, estimate_growth, pool_noise
from calibgui.engine.detection.find_corners import find_corners
from tests.scenes.checkerboards import Scene, draw
from tests.scenes.conditions import Conditions
from tests.scenes.perspective import photograph_board
from tests.scenes.troubles import TROUBLES

Photograph = Callable[[Scene, int], tuple[np.ndarray[Any, Any], float]]
"""A function from a scene and a seed to an image and its scale."""


def _draw_scores(corners: int, lines: int, in_common: int, seed: int) -> np.ndarray[Any, Any]:
    """Scores of corners whose noise, of variance 4, is the mean of neighbours' at several lines."""
    rng = np.random.default_rng(seed)
    slopes = np.linspace(2.0, 1.0, lines) * np.ones((corners, 2, lines))
    white = rng.standard_normal((corners, 2, lines + in_common - 1))
    noise = sum(white[..., k : k + lines] for k in range(in_common)) / np.sqrt(in_common)
    # The fit leaves no sum of the scores.
    noise -= (
        np.mean(slopes * noise, axis=2, keepdims=True)
        / np.mean(slopes**2, axis=2, keepdims=True)
        * slopes
    )
    return np.stack([2.0 * slopes * noise, slopes**2], axis=2)


@pytest.mark.parametrize(
    ("lines", "in_common", "reach"), [(40, 2, 8.0), (40, 3, 8.0), (120, 9, 40.0)]
)
def test_errors_in_common_grow_the_covariance(lines: int, in_common: int, reach: float) -> None:
    """The mean of k independent errors at every line grows the variance by k."""
    scores, noise = _draw_scores(200, lines, in_common, 0), np.full(200, 4.0)
    assert compute_growth(scores, noise, reach) == pytest.approx(in_common, rel=0.2)
    scores[:5, :, 0] = 50.0 * np.sqrt(scores[:5, :, 1])  # a stain, which all lines see
    assert compute_growth(scores, noise, reach) == pytest.approx(in_common, rel=0.2)


@pytest.mark.parametrize(("square", "reach"), [(20.0, 8.0), (60.0, 10.0)])
def test_errors_are_in_common_as_far_as_edges_tell(
    square: float, reach: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = []
    monkeypatch.setattr(corner_noise, "compute_growth", lambda *args: seen.append(args[2]) or 1.0)
    conditions = Conditions(square=square, grid_size=(4, 5), tilt=5.0, parts=2)
    find_corners(draw(conditions, 0).photograph(0))
    assert seen == [pytest.approx(reach, rel=0.05)]


@pytest.mark.parametrize(("square", "corners"), [(36.0, 44), (240.0, 17)])
def test_fewer_corners_are_read_where_edges_are_long(
    square: float, corners: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are read a second time for it, which took a fifth of the time in 48 megapixels."""
    seen = []
    monkeypatch.setattr(corner_noise, "compute_growth", lambda *args: seen.append(args[1]) or 1.0)
    width, height = round(18 * square), round(13 * square)
    find_corners(photograph_board((width, height), (6, 9), square, square / 45))
    assert [len(noise) for noise in seen] == [pytest.approx(corners, abs=2)]


def test_chance_does_not() -> None:
    for seed in range(30):
        assert compute_growth(_draw_scores(54, 15, 1, seed), np.full(54, 4.0), 8.0) == 1.0


def _photograph(scene: Scene, seed: int) -> tuple[np.ndarray[Any, Any], float]:
    return scene.photograph(seed), 1.0


def _enlarge(scene: Scene, seed: int) -> tuple[np.ndarray[Any, Any], float]:
    image = scene.photograph(seed)
    return cv2.resize(image, None, fx=2.0, fy=2.0, interpolation=cv2.INTER_LINEAR), 2.0


def _compress(scene: Scene, seed: int) -> tuple[np.ndarray[Any, Any], float]:
    coded = cv2.imencode(".jpg", scene.photograph(seed), [cv2.IMWRITE_JPEG_QUALITY, 30])[1]
    return np.asarray(cv2.imdecode(coded, cv2.IMREAD_GRAYSCALE)), 1.0


def _smooth(scene: Scene, seed: int) -> tuple[np.ndarray[Any, Any], float]:
    return np.asarray(cv2.GaussianBlur(scene.photograph(seed), (0, 0), 0.8)), 1.0


@pytest.mark.parametrize("take", [_photograph, _enlarge, _compress, _smooth])
def test_covariances_say_how_far_corners_are_off(take: Photograph) -> None:
    honest = []
    for pose in range(3):
        scene = draw(Conditions(noise=3.0, parts=2), pose)
        for seed in range(2):
            image, scale = take(scene, seed)
            corners = find_corners(image)
            at = corners.grid[:, 0], corners.grid[:, 1]
            error = corners.uv - ((scene.uv[at] + 0.5) * scale - 0.5)
            assert corners.cov is not None
            honest.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error) / 2)
    assert 0.75 < np.mean(honest) < 1.35


def test_independent_noise_leaves_covariances_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    growths = []

    def record(*args: Any) -> float:
        growths.append(estimate_growth(*args))
        return growths[-1]

    monkeypatch.setattr(x_corner_fit, "estimate_growth", record)
    for seed in range(3):
        find_corners(draw(Conditions(noise=float(4**seed), parts=2), seed).photograph(seed))
    assert growths == [1.0, 1.0, 1.0]


def test_no_corner_has_far_less_noise_than_the_others() -> None:
    noise, many = np.array([4.0, 5.0, 3.0, 4.0, 0.0]), np.full(5, 100.0)
    np.testing.assert_allclose(pool_noise(noise, many), [4.0, 5.0, 3.0, 4.0, 1.0])


@pytest.mark.parametrize("trouble", ["two levels", "repeated pixels"])
def test_corners_whose_opposite_pixels_are_equal_are_no_surer_for_it(trouble: str) -> None:
    photograph = TROUBLES[trouble](704)
    corners = find_corners(photograph.image)
    truth = photograph.boards[0].reshape(-1, 2)
    error = np.linalg.norm(corners.uv[:, None] - truth, axis=2).min(axis=1)
    assert corners.cov is not None
    sigma = np.sqrt(np.trace(corners.cov, axis1=1, axis2=2))
    assert (error / sigma).max() < 8.0
