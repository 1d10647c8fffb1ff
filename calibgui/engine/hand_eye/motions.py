"""Rigid motions, many at once: a robot's poses, a board's, and what joins them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector, vector_from_rotation


class Motions(NamedTuple):
    """Rigid motions b_from_a, one or many: X_b = R X_a + t."""

    R: Array
    """(..., 3, 3) rotations."""
    t: Array
    """(..., 3) translations, mm."""

    def invert(self) -> Motions:
        """Return the motions back, a_from_b."""
        back = np.swapaxes(self.R, -1, -2)
        return Motions(back, -(back @ self.t[..., None])[..., 0])

    def after(self, first: Motions) -> Motions:
        """Return the motions that do `first`, and these then."""
        return Motions(self.R @ first.R, (self.R @ first.t[..., None])[..., 0] + self.t)

    def move(self, points: Array) -> Array:
        """Return where points (n, 3) come to lie, (..., n, 3)."""
        return np.asarray(points @ np.swapaxes(self.R, -1, -2) + self.t[..., None, :])

    def select(self, which: Any) -> Motions:
        """Return some of the motions."""
        return Motions(self.R[which], self.t[which])

    def take_step(self, step: Array) -> Motions:
        """Return the motions after steps (..., 6): local rotations w, rad, R <- exp(w) R, and
        translations, mm, t <- t + tau."""
        return Motions(rotation_from_vector(step[..., :3]) @ self.R, self.t + step[..., 3:])

    def measure_step_from(self, other: Motions) -> Array:
        """Return the steps (..., 6) that lead from other motions to these."""
        turn = vector_from_rotation(self.R @ np.swapaxes(other.R, -1, -2))
        return np.concatenate([turn, self.t - other.t], axis=-1)

    def make_pose(self) -> Pose:
        """Return a single motion as a pose."""
        return Pose(vector_from_rotation(self.R), self.t)


def project_on_rotations(Z: Array) -> Array:
    """Return the rotations (..., 3, 3) nearest to matrices Z."""
    U, _, V = np.linalg.svd(Z)
    U[..., 2] *= np.linalg.det(U @ V)[..., None]
    return np.asarray(U @ V)
