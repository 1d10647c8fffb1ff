"""The compiled outlines of tags against the readable ones."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from calibgui.engine import kernels
from calibgui.engine.detection.apriltags import tag_outlines
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
@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.float32])
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
