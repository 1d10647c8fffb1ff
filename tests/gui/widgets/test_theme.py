"""One colour is one view, and views beyond the eighth have colours of their own."""

from __future__ import annotations

from itertools import combinations

import cv2
import numpy as np

from calibgui.engine.arrays import Array
from calibgui.gui.widgets import theme


def to_lab(views: int) -> Array:
    """(n, 3) CIELAB of the colours of the first views."""
    colours = [theme.view_colour(k) for k in range(views)]
    rgb = np.array([[c.redF(), c.greenF(), c.blueF()] for c in colours], dtype=np.float32)
    return np.asarray(cv2.cvtColor(rgb[None], cv2.COLOR_RGB2LAB)[0])


def test_the_colours_of_views_are_told_apart() -> None:
    lab = to_lab(64)
    distance = {(a, b): np.linalg.norm(lab[a] - lab[b]) for a, b in combinations(range(64), 2)}
    assert min(distance.values()) > 5, "one just notices 2.3 side by side"
    next_to = [distance[k, k + 1] for k in range(63)]
    assert min(next_to) > 25


def test_a_colour_that_is_changed_changes_no_other() -> None:
    theme.view_colour(9).setAlpha(10)
    assert theme.view_colour(9).alpha() == 255


def test_every_colour_shows_on_light_and_on_dark() -> None:
    lightness = to_lab(64)[:, 0]
    assert lightness.min() > 25 and lightness.max() < 86
