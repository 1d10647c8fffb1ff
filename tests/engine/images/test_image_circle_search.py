"""The image circle: found where a lens lights a round part of the image, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest

from calibgui.engine.arrays import GreyImage
from calibgui.engine.camera import ImageCircle, find_common_circle
from calibgui.engine.images import find_image_circle

SIZE = (640, 480)


def draw(circle: ImageCircle, seed: int = 0) -> GreyImage:
    """A scene of squares, some of them black, that a lens shows in a circle on a dark ground."""
    rng = np.random.default_rng(seed)
    squares = rng.choice([20, 90, 160, 230], size=(24, 32))
    scene = np.kron(squares, np.ones((20, 20)))
    uv = np.stack(np.meshgrid(*map(np.arange, SIZE)), axis=-1)
    image = np.where(circle.contains(uv), scene, 9) + rng.normal(0, 2, scene.shape)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(
    "circle",
    [ImageCircle(318, 242, 215), ImageCircle(330, 250, 280), ImageCircle(315, 235, 350)],
    ids=["whole", "cut above and below", "dark corners"],
)
def test_a_circle_is_found(circle: ImageCircle) -> None:
    found = [find_image_circle(draw(circle, seed)) for seed in range(5)]
    shared = find_common_circle(found)
    assert shared is not None
    np.testing.assert_allclose(shared, circle, atol=1.5)


def test_a_circle_is_found_alike_in_large_images() -> None:
    small = draw(ImageCircle(318, 242, 215))
    found = find_image_circle(np.kron(small, np.ones((4, 4), np.uint8)))
    assert found is not None
    np.testing.assert_allclose(found, [1273.5, 969.5, 862], atol=6)


def test_a_lens_that_fills_the_image_has_none() -> None:
    assert find_image_circle(draw(ImageCircle(320, 240, 500))) is None


def test_a_board_on_a_black_ground_is_none() -> None:
    image = np.full(SIZE[::-1], 5, dtype=np.uint8)
    image[90:400, 120:500] = draw(ImageCircle(320, 240, 500))[90:400, 120:500]
    assert find_image_circle(image) is None
    assert find_image_circle(np.full(SIZE[::-1], 5, dtype=np.uint8)) is None


def test_the_circle_of_most_photographs_counts() -> None:
    usual, other = ImageCircle(320, 240, 200), ImageCircle(300, 240, 150)
    assert find_common_circle([usual, usual, other]) == usual
    assert find_common_circle([usual, None, None]) is None
    assert find_common_circle([usual, other, ImageCircle(350, 240, 250)]) is None
    assert find_common_circle([]) is None
