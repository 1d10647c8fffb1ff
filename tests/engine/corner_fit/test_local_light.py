"""Corners whose light is their own lie where they should, or say that they may not."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine import kernels
from calibgui.engine.corner_fit import light_gradients, x_corner_fit
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.features.corners import Corners
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions
from tests.scenes.photograph import Photograph
from tests.scenes.troubles import TROUBLES


def measure_errors(corners: Corners, photograph: Photograph) -> tuple[np.ndarray, np.ndarray]:
    """Distances from the truth (n,), in px and in standard deviations."""
    truth = photograph.boards[0].reshape(-1, 2)
    nearest = np.argmin(np.linalg.norm(corners.uv[:, None] - truth, axis=2), axis=1)
    error = corners.uv - truth[nearest]
    assert corners.cov is not None
    squares = np.einsum("ni,nij,nj->n", error, np.linalg.inv(corners.cov), error)
    return np.linalg.norm(error, axis=1), np.sqrt(squares)


@pytest.mark.parametrize(
    ("name", "seed"), [("blinds", 7), ("blinds", 9), ("flicker", 108), ("flicker", 117)]
)
def test_no_corner_is_sure_of_a_wrong_place(name: str, seed: int) -> None:
    """With the light's gradients of the whole board, up to three in four were."""
    photograph = TROUBLES[name](seed)
    distance, sigmas = measure_errors(find_corners(photograph.image), photograph)
    assert not np.any((distance > 0.3) & (sigmas > 5))


def test_flicker_hardly_moves_corners() -> None:
    """They were 1.1 px off, root mean square, one of them 2.8 px."""
    photograph = TROUBLES["flicker"](105)
    corners = find_corners(photograph.image)
    distance, _ = measure_errors(corners, photograph)
    assert corners.complete
    assert np.sqrt(np.mean(distance**2)) < 0.25
    assert distance.max() < 0.8


@pytest.mark.parametrize("light", [0.0, 1.0])
def test_light_that_a_polynomial_follows_is_the_boards(
    light: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = []
    find = light_gradients.find_uneven_light

    def count(*arguments: object) -> np.ndarray:
        uneven = find(*arguments)  # type: ignore[arg-type]
        seen.append(uneven)
        return uneven

    monkeypatch.setattr(x_corner_fit, "find_uneven_light", count)
    find_corners(draw(Conditions(light=light, square=28.0), 5).photograph(0))
    assert len(seen)
    assert np.mean(seen[0]) < 0.05


def test_compiled_and_readable_find_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    image = TROUBLES["flicker"](105).image
    compiled = find_corners(image)
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = find_corners(image)
    np.testing.assert_allclose(compiled.uv, readable.uv, atol=1e-3)  # sums in float32
    assert compiled.cov is not None
    assert readable.cov is not None
    np.testing.assert_allclose(compiled.cov, readable.cov, rtol=2e-2, atol=1e-5)
