"""Views as the kernels of the normal equations take them: one coordinate a row, padded corners with
zero weight."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from calibgui.engine.arrays import Array


class Views(NamedTuple):
    """K views as the kernels take them."""

    uv: Array
    """(K, 2, N) measured corners, px."""
    xyz: Array
    """(K, 3, N) board points, mm."""
    weight: Array
    """(K, 4, N) whitening of the corners, 0 for padding; (K, 4, 0) if all weigh 1."""


class CameraAndPoses(Protocol):
    """The fields of ``calibration.refinement.residuals.State`` that kernels read."""

    @property
    def params(self) -> Array: ...
    @property
    def R(self) -> Array: ...  # noqa: N802 - the paper's symbol
    @property
    def T(self) -> Array: ...  # noqa: N802 - the paper's symbol


class MeasuredViews(Protocol):
    """The fields of ``calibration.observations.Observations`` that kernels read."""

    @property
    def uv(self) -> Array: ...
    @property
    def xy(self) -> Array: ...
    @property
    def mask(self) -> Array: ...
    @property
    def whitening(self) -> Array | None: ...
    @property
    def is_unweighted(self) -> bool: ...
    def select_views(self, views: slice) -> MeasuredViews: ...


def pack_views(observations: MeasuredViews) -> Views:
    """Return the views in the kernels' layout, one coordinate a row."""
    K, N = observations.mask.shape
    xyz = np.zeros((K, 3, N))
    xyz[:, : observations.xy.shape[-1]] = np.swapaxes(observations.xy, 1, 2)
    weight = np.zeros((K, 4, 0 if observations.is_unweighted else N))
    if observations.whitening is not None:
        weight[:] = np.swapaxes(observations.whitening.reshape(K, N, 4), 1, 2)
    elif weight.size:
        weight[:, 0] = weight[:, 3] = observations.mask
    return Views(np.array(np.swapaxes(observations.uv, 1, 2), order="C"), xyz, weight)
