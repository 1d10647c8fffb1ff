"""The compiled outlines of tags against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from calibgui.engine import kernels
from calibgui.engine.detection.apriltags import tag_outlines
from calibgui.engine.detection.apriltags.outline_model import (
    OutlineModel,
    accumulate_normal_equations,
)
from calibgui.engine.detection.apriltags.tag_outlines import TagOutlines, fit_tag_outlines

SQUARES = np.argwhere(np.ones((3, 4)))
SIDE, GAP, BORDER = 40.0, 0.3, 0.2
"""Of the tags, px and sides."""
LEFT_OUT = 30.0
"""What the left border of the image leaves out of the board, px; its lower one cuts
the paper beside a tag."""


def draw(blur: float, swing: float = -140.0) -> tuple[np.ndarray, np.ndarray]:
    """Tags of a turned board that leaves the image, their borders of even ink, and their corners
    half a pixel off."""
    turn = np.array([[0.97, -0.24], [0.24, 0.97]]) * SIDE
    v, u = np.indices((216, 230)).astype(np.float64)
    at = (np.stack([u + LEFT_OUT - 70, v - 20], axis=-1)) @ np.linalg.inv(turn).T
    soft = blur / SIDE
    image = np.full(u.shape, 180.0)
    for row, col in SQUARES:
        inside = np.minimum(
            *(
                np.minimum(each, 1 - each)
                for each in np.moveaxis(at - (1 + GAP) * np.array([col, row]), -1, 0)
            )
        )
        image += swing * scipy.special.expit(1.7 * inside / soft)
    around = (1 + GAP) * SQUARES[:, None, ::-1] + tag_outlines.AROUND
    corners = around @ turn.T + [70 - LEFT_OUT, 20]
    return image, corners + np.random.default_rng(0).uniform(-0.5, 0.5, corners.shape)


@pytest.mark.parametrize(
    ("blur", "swing"), [(0.4, -140.0), (1.2, -140.0), (0.8, 60.0)], ids=["sharp", "soft", "bright"]
)
@pytest.mark.parametrize("kind", [np.uint8, np.uint16])
def test_the_same_outlines(
    blur: float, swing: float, kind: type, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn, corners = draw(blur, swing)
    image = np.rint(drawn).astype(kind)

    def fit() -> TagOutlines:
        return fit_tag_outlines(image, corners, SQUARES, BORDER, GAP)

    compiled = fit()
    monkeypatch.setattr(kernels, "COMPILED", False)
    readable = fit()
    moved = np.linalg.norm(readable.corners - corners, axis=2)
    assert 0.2 < np.median(moved) < 0.8, "there is something to fit"
    # The readable sums are of single precision: what lies on the border of a band may not count.
    np.testing.assert_allclose(compiled.corners, readable.corners, atol=5e-3)
    np.testing.assert_allclose(compiled.blur, readable.blur, rtol=2e-3)
    np.testing.assert_allclose(compiled.contrast, readable.contrast, rtol=1e-3)
    off = np.abs(compiled.covariance - readable.covariance).max(axis=(2, 3))
    assert (off < 0.02 * readable.covariance.max(axis=(2, 3))).all()


def test_the_same_pixels_of_bent_and_small_outlines() -> None:
    """Edges are bent by far, tags so narrow that their bands overlap, or leave the image."""
    rng = np.random.default_rng(2)
    image = rng.integers(0, 255, (200, 240)).astype(np.uint8)
    side = np.array([60.0, 60.0, 9.0, 14.0, 40.0, 40.0])
    place = np.array([(30, 30), (120, 90), (40, 150), (90, 150), (-10, 100), (205, 170)])
    corners = place[:, None] + side[:, None, None] * tag_outlines.AROUND
    corners += rng.uniform(-0.15, 0.15, corners.shape) * side[:, None, None]
    n = len(side)
    model = OutlineModel(
        corners,
        rng.uniform(0.8, 2.5, (n, 2)),
        np.tile([[180.0, 3.0, -4.0], [40.0, 2.0, 5.0]], (n, 1, 1)),
        rng.normal(0, 0.06, (n, 4)) * side[:, None],
        rng.uniform(-0.6, 0.6, n),
        np.full(n, 4.0),
        np.full(n, 6.0),
        side / 2,
    )
    found, expected = (
        run(image, model, False)
        for run in (accumulate_normal_equations.kernel, accumulate_normal_equations.reference)
    )
    count = expected[:, 10, 10] + expected[:, 13, 13] + 2 * expected[:, 10, 13]
    assert (count > 100).all()
    scale = np.sqrt(np.einsum("nii->ni", expected)) + 1e-9
    off = abs(found - expected) / scale[:, :, None] / scale[:, None]
    assert (np.median(off, axis=(1, 2)) < 1e-6).all()
    assert off.max() < 0.02  # of a tag outside of the image, whose corners hardly show
