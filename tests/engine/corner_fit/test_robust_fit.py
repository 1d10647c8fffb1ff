"""Corners beside which something lies are kept, with what is known of them; the others are as good
as without them."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from calibgui.engine.boards.board import Board
from calibgui.engine.corner_fit import robust_fit
from calibgui.engine.corner_fit.robust_fit import fit_plain_corners, fit_robustly
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from calibgui.engine.features.lattice import Lattice
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions
from tests.scenes.perspective import photograph_pattern
from tests.scenes.troubles import TROUBLES


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """One entry for each time that corners are fitted."""
    calls: list[int] = []
    fit_once = robust_fit.fit_x_corners
    monkeypatch.setattr(
        robust_fit,
        "fit_x_corners",
        lambda *args, **options: calls.append(1) or fit_once(*args, **options),
    )
    return calls


def test_an_undisturbed_board_is_fitted_once(calls: list[int]) -> None:
    scene = draw(Conditions(), 3)
    image = scene.photograph(0)
    _, displacement = fit_robustly(
        Lattice(scene.uv, True), lambda part: fit_plain_corners(image, part, 0.5)
    )
    assert not displacement.any()
    assert len(calls) == 1


def test_a_board_far_out_of_focus_is_fitted_once(calls: list[int]) -> None:
    """It was fitted six times before it was refused, which took ten times as long as to find a
    sharp one."""
    sharp = photograph_pattern((640, 480), Board(7, 10, 20.0), 0.7, 0.8)
    image = cv2.GaussianBlur(sharp, (0, 0), 12.8)
    with pytest.raises(NoBoardError, match="too blurred"):
        find_corners(image)
    assert len(calls) == 1


@pytest.mark.parametrize(("name", "seed"), [("hand", 1001), ("object", 1001), ("glare", 1008)])
def test_what_covers_a_part_of_the_squares_costs_no_corner(name: str, seed: int) -> None:
    """Corners with a third of a square clear around them were rejected; taken into the fit of all
    they misled that of the others, up to ten times their stated errors off."""
    photograph = TROUBLES[name](seed)
    corners = find_corners(photograph.image, photograph.boards[0].shape[:2])
    truth = photograph.boards[0].reshape(-1, 2)
    distance = np.linalg.norm(corners.uv[:, None] - truth, axis=2)
    nearest = np.argmin(distance, axis=1)
    assert photograph.hidden is not None
    assert set(np.flatnonzero(~photograph.hidden)) <= set(nearest)
    assert corners.cov is not None
    off = corners.uv - truth[nearest]
    assert np.mean(np.einsum("ni,nij,nj->n", off, np.linalg.inv(corners.cov), off)) / 2 < 1.5


def test_the_edge_of_a_shadow_widens_the_covariance() -> None:
    """A corner that it draws aside is kept, and says so."""
    photograph = TROUBLES["shadow"](2005)
    corners = find_corners(photograph.image)
    assert corners.complete
    assert corners.cov is not None
    truth = photograph.boards[0].reshape(-1, 2)
    off = np.linalg.norm(corners.uv[:, None] - truth, axis=2).min(axis=1)
    sigma = np.sqrt(np.trace(corners.cov, axis1=1, axis2=2) / 2)
    farthest = np.argsort(off)[-3:]
    assert off[farthest].max() > 0.1
    assert (off[farthest] < 5 * sigma[farthest]).all()
