"""Kannala and Brandt's fisheye model, and the same with decentering.

cv2.fisheye, ROS (equidistant), Kalibr (pinhole-equi), Basalt (kb4) and COLMAP (OPENCV_FISHEYE) use
it: the polynomial of the angle theta off the axis (Kannala and Brandt 2006)

    |d| = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8).

With R^2 = X^2 + Y^2, e = (X, Y) / R and L^2 = R^2 + Z^2 the equidistant projection is

    b = theta e,    theta = atan2(R, Z),
    db/d(X, Y) = (theta / R) (I - e e^T) + (Z / L^2) e e^T,    db/dZ = -(X, Y) / L^2,

which exists in all directions but straight behind (on the axis theta / R is 1 / Z), and
|b| = theta. The model is Brown's polynomial of b with four radial coefficients
(``camera.polynomial``), so that decentering p1, p2 can be added to it as to Brown's own model;
with it the model is COLMAP's THIN_PRISM_FISHEYE without thin prisms. Of the programs above none
but COLMAP can express it.

Back, theta is found by Newton's method in a bracket, and with decentering b by Newton's method
in the plane (``camera.inverse``); the ray is then (sin(theta) e, cos(theta)).

Limits: theta < 180 degrees. Where |d| has its first maximum the model folds: from there on an
image point has no ray. Rays beyond have the polynomial's value all the same.

Kannala, J., Brandt, S. (2006). A generic camera model and calibration method for conventional,
wide-angle, and fish-eye lenses. IEEE PAMI 28.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array
from calibgui.engine.camera.inverse import invert_map, make_polynomial_curve
from calibgui.engine.camera.model import Lens, LensProjection, LensUnprojection
from calibgui.engine.camera.polynomial import apply_polynomial
from calibgui.engine.camera.root import solve_in_bracket
from calibgui.engine.camera.tangent import invert_projection


class KannalaBrandt(Lens):
    """Kannala and Brandt's model with the coefficients k1 to k4, and p1, p2 if it decenters."""

    def __init__(self, decentering: bool = False) -> None:
        """Choose whether the model has p1 and p2."""
        self.title = "Kannala-Brandt (OpenCV fisheye, equidistant)"
        self.names: tuple[str, ...] = ("k1", "k2", "k3", "k4")
        self.powers: tuple[int, ...] = (2, 4, 6, 8)
        if decentering:
            self.title = "Kannala-Brandt with decentering"
            self.asymmetric = ("p1", "p2")
            self.names += self.asymmetric
            self.powers += (1, 1)

    def project(self, rays: Array, k: Array) -> LensProjection:
        """Map rays to image points."""
        xy, Z = rays[..., :2], rays[..., 2]
        R = np.hypot(xy[..., 0], xy[..., 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            on_axis = np.where(Z > 0, 1 / Z, np.nan)
            stretch = np.where(R > 0, np.arctan2(R, Z) / R, on_axis)
            e = np.where(R[..., None] > 0, xy / R[..., None], 0.0)
            L2 = R * R + Z * Z
            d, by_b, by_k = apply_polynomial(
                stretch[..., None] * xy, k[:4], k[4:] if self.asymmetric else np.zeros(2)
            )
            by_e = by_b[..., 0] * e[..., :1] + by_b[..., 1] * e[..., 1:]
            by_ray = np.empty((*xy.shape, 3))
            by_ray[..., :2] = (
                stretch[..., None, None] * by_b
                + by_e[..., None] * ((Z / L2 - stretch)[..., None] * e)[..., None, :]
            )
            by_ray[..., 2] = by_e * (-R / L2)[..., None]
        return LensProjection(d, by_ray, by_k[..., : len(k)])

    def unproject(self, d: Array, k: Array) -> LensUnprojection:
        """Map image points to rays of length 1, by Newton's method."""
        b = _invert_radial(d, k)
        if self.asymmetric and k[4:].any():
            radial = make_polynomial_curve(k[:4])
            b = invert_map(lambda b: apply_polynomial(b, k[:4], k[4:]), d, radial).points
        theta = np.hypot(b[..., 0], b[..., 1])
        theta = np.where(theta < np.pi, theta, np.nan)
        xy = np.sinc(theta / np.pi)[..., None] * b
        rays = np.concatenate([xy, np.cos(theta)[..., None]], axis=-1)
        return invert_projection(rays, self.project(rays, k))


def _invert_radial(d: Array, k: Array) -> Array:
    """Return the points b (..., 2) that the radial part alone takes to d; NaN beyond its fold."""
    length = np.hypot(d[..., 0], d[..., 1])
    goal = length.ravel()
    k1, k2, k3, k4 = k[:4]
    radial = make_polynomial_curve(k[:4])

    def curve(theta: Array) -> tuple[Array, Array]:
        s = theta * theta
        slope = 1 + s * (3 * k1 + s * (5 * k2 + s * (7 * k3 + s * 9 * k4)))
        return radial.evaluate(theta) - goal, slope

    end = np.full_like(goal, radial.folds.min(initial=np.pi))
    with np.errstate(invalid="ignore"):
        visible = curve(end)[0] > 0
    theta = solve_in_bracket(curve, goal, np.zeros_like(goal), end)
    theta = np.where(visible, theta, np.nan).reshape(length.shape)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(length > 0, theta / length, 1.0)[..., None] * d
