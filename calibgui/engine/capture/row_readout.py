"""The time that a camera needs to read the rows of an image, from how a moving board is bent.

A rolling shutter reads one row after the other. Where the board moves by m px/s in the image, a
corner in row v of H is seen where it has come to by then,

    uv = projection(pose) + tau (v / H) m,

tau being the time from the first row to the last. Most of that looks like another pose. With P the
projection on what no pose explains (derivatives by the pose J: P = 1 - J (J^T J)^-1 J^T), g the
corners' (v / H) m and r the residuals of the best pose, one frame tells

    tau_k = g^T P r / g^T P g,     var(tau_k) = s^2 / g^T P g,

s^2 being what is left of the residuals. Frames in which nothing moves tell nothing, and weigh
nothing. What the camera so far has wrong bends all frames of one motion alike: the frames' scatter
about their mean counts where it is larger than these variances (`scattered_mean`). The sign tells
from which end the rows are read.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.calibration.observations import Observations
from calibgui.engine.calibration.refinement.residuals import State, compute_image_residuals
from calibgui.engine.camera.camera import Camera
from calibgui.engine.capture.scattered_mean import ScatteredMean
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.geometry.rotations import rotation_from_vector


class RowReadout:
    """Adds up what frames of a moving board tell of the time in which rows are read."""

    def __init__(self) -> None:
        self._time = ScatteredMean()

    def add_frame(self, camera: Camera, pose: Pose, xy: Array, uv: Array, motion: Array) -> None:
        """Add a frame.

        Args:
            camera: the camera, as far as it is known.
            pose: cam_from_board that fits best.
            xy: (n, 2) corners on the board, mm.
            uv: (n, 2) where they were found, px.
            motion: (n, 2) how they move in the image, px/s.
        """
        R = rotation_from_vector(np.array(pose.rvec))
        state = State(camera.params, R[None], np.array(pose.tvec)[None])
        view = Observations(uv[None], xy[None], np.ones((1, len(uv))), None)
        found = compute_image_residuals(state, view, camera.model)
        J, r = found.by_pose[0].reshape(-1, 6), -found.residual.ravel()
        g = (motion * (uv[:, 1:] / camera.size[1])).ravel()
        if not (np.isfinite(J).all() and np.isfinite(r).all()) or len(r) <= 7:
            return
        basis = np.linalg.qr(J)[0]
        g, r = (each - basis @ (basis.T @ each) for each in (g, r))
        information = float(g @ g)
        if not information:
            return
        time = float(g @ r) / information
        variance = float(np.sum((r - time * g) ** 2)) / (len(r) - 7)
        self._time.add(time, information / variance)

    def estimate(self) -> tuple[float, float]:
        """Return tau and its standard deviation, s; NaN and infinite before the second frame."""
        return self._time.estimate()

    def describe(self) -> str:
        """Say how long the rows take, where that is certain; else ""."""
        if not self._time.is_significant:
            return ""
        time, sigma = self.estimate()
        return (
            f"Rolling shutter: rows are read over {1000 * abs(time):.0f} ± {1000 * sigma:.0f} ms. "
            "Let the board stand by itself."
        )
