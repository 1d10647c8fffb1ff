"""The compiled levels between pixels against the readable ones."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from calibgui.engine import kernels
from calibgui.engine.images.sampling import sample_image


@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
@pytest.mark.parametrize("shape", [(40,), (5, 8), (2, 4, 5), (0,)])
def test_the_same_levels(kind: npt.DTypeLike, shape: tuple[int, ...]) -> None:
    """Inside of the image, on its border and outside."""
    rng = np.random.default_rng(0)
    image = rng.integers(0, 200, (20, 30)).astype(kind)
    uv = rng.uniform(-5, 35, (*shape, 2))
    uv[..., :1, :] = (29.0, 19.0)
    for seen in (image, image[:, ::2], image.T):
        levels = sample_image.kernel(seen, uv)
        assert levels.shape == shape
        np.testing.assert_allclose(levels, sample_image.reference(seen, uv), rtol=1e-12)


def test_points_need_not_lie_in_one_block() -> None:
    image = np.arange(12, dtype=np.uint8).reshape(3, 4)
    uv = np.broadcast_to(np.array([1.5, 1.0]), (3, 2))
    assert sample_image.kernel(image, uv).tolist() == [5.5, 5.5, 5.5]


def test_images_that_are_computed_are_sampled_without_a_kernel(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(sample_image, "_kernel", fail)
    image, uv = np.arange(12, dtype=np.int16).reshape(3, 4), np.array([[1.5, 1.0]])
    assert sample_image(image, uv).tolist() == [5.5]
    if kernels.COMPILED:
        with pytest.raises(AssertionError):
            sample_image(image.astype(np.uint8), uv)
