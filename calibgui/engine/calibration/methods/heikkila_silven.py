"""Heikkilä and Silvén's four steps: linear start, non-linear fit, circles' centres, inverse model.

J. Heikkilä and O. Silvén, A four-step camera calibration procedure with implicit image correction,
IEEE Conference on Computer Vision and Pattern Recognition (1997) 1106-1112; J. Heikkilä, Geometric
camera calibration using circular control points, IEEE Transactions on Pattern Analysis and Machine
Intelligence 22 (2000) 1066-1077. What the 1997 paper does, and what becomes of it here:

1. **Linear start.** They solve the direct linear transformation (DLT) for the 3 x 4 matrix from
   space to image and decompose it. Its equations are singular for the points of one plane, as its
   third column multiplies Z = 0. The 3 x 3 matrix that is left tells a part of the parameters
   only; the others must be known. Several tilted planes tell more: the start here takes the centre
   from the image, and focal lengths in closed form from all planes together (``bouguet.py``).

2. **Non-linear fit** of fx, fy, cx, cy, k1, k2, p1, p2 and all poses to least squared distances in
   the image, by Levenberg-Marquardt. Their lens acts on the ideal point (x, y), r^2 = x^2 + y^2,

       x' = x (1 + k1 r^2 + k2 r^4) + 2 p1 x y + p2 (r^2 + 2 x^2)
       y' = y (1 + k1 r^2 + k2 r^4) + p1 (r^2 + 2 y^2) + 2 p2 x y,

   which is "brown-conrady-4" with the skew held at 0. They count x and y in mm on the sensor, so
   that k1 is divided by the focal length squared, and so on; here f = 1.

3. **Centres of circles.** The centre of a circle's image is not the image of its centre. They
   correct the observations for it with the camera of step 2, and fit again. Corners of squares
   have no such error. For grids of circles the detector has corrected it before the calibration:
   it returns the images of the circles' centres, for perspective and lens, from the map of the
   grid alone (``detection/circles/circle_map.py``). The step is empty here.

4. **Inverse model.** The lens above has no inverse in closed form. To correct many image points
   they fit a rational one with eight implicit coefficients a1 ... a8: with (x', y') measured and
   r^2 = x'^2 + y'^2,

       x = (x' (1 + a1 r^2 + a2 r^4) + 2 a3 x' y' + a4 (r^2 + 2 x'^2)) / G
       y = (y' (1 + a1 r^2 + a2 r^4) + a3 (r^2 + 2 y'^2) + 2 a4 x' y') / G
       G = (a5 r^2 + a6 x' + a7 y' + a8) r^2 + 1.

   Multiplied by G this is linear in the coefficients: each point gives two rows of T a = e,

       T = [-x' r^2, -x' r^4, -2 x' y', -(r^2 + 2 x'^2), x r^4, x x' r^2, x y' r^2, x r^2]
           [-y' r^2, -y' r^4, -(r^2 + 2 y'^2), -2 x' y', y r^4, y x' r^2, y y' r^2, y r^2]
       e = [x' - x]
           [y' - y],

   solved by least squares. They distort a grid of ideal points; here the points are a grid of
   pixels over the image, corrected by the exact inverse (Newton's method, ``camera/inverse.py``),
   so that the fit ends where the image does. The same exact inverse tells how far the model is
   off, between the points that it was fitted to.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from calibgui.engine.arrays import Array, Size, freeze
from calibgui.engine.calibration.methods.bouguet import initialise_from_vanishing_points
from calibgui.engine.calibration.methods.method import Method, refine_by_bundle_adjustment
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.camera import Camera
from calibgui.engine.camera.distortion import undistort_points
from calibgui.engine.errors import CalibrationError

_MODEL = "brown-conrady-4"
_TIE_POINTS = 40
"""Points of the fitted grid along either axis."""
_CHECKED_POINTS = 101
"""Points along either axis at which the error is measured; the image's corners are among them."""


@dataclass(frozen=True, eq=False, slots=True)
class InverseModel:
    """The eight coefficients that correct image points, and how far they are off."""

    camera: Camera
    """The camera whose lens is inverted."""
    coefficients: Array
    """(8,) a1 ... a8, dimensionless."""
    max_error: float
    """Largest distance from the exactly corrected point over the image, px."""
    rms_error: float
    """Root mean square distance from the exactly corrected points over the image, px. Neither
    measures how well the camera itself is known."""

    def __post_init__(self) -> None:
        freeze(self, "coefficients")

    def correct_points(self, uv: npt.ArrayLike) -> Array:
        """Map measured pixels (..., 2) to ideal pixels (..., 2), array frame."""
        f, c = self.camera.focal, self.camera.centre
        return _correct(_remove_skew(uv, self.camera), self.coefficients) * f + c


def fit_inverse_model(camera: Camera) -> InverseModel:
    """Fit the inverse model of step 4 to a camera of the lens model "brown-conrady-4".

    Raises:
        CalibrationError: if the camera has another lens model, or a lens that folds over within
            the image, so that some pixels have no ideal point.

    Examples:
        >>> from calibgui.engine.camera import Camera
        >>> params = [600, 600, 320, 240, -0.25, 0.1, 0, 0]
        >>> model = fit_inverse_model(Camera((640, 480), params, "brown-conrady-4"))
        >>> model.correct_points([[320, 240], [600, 400]]).round()
        array([[320., 240.],
               [622., 413.]])
        >>> model.max_error < 0.01
        True
    """
    if camera.model != _MODEL:
        raise CalibrationError(
            f"The inverse model is that of the lens model {_MODEL!r}, not of {camera.model!r}.",
            f"Calibrate with the lens model {_MODEL!r}.",
        )
    uv = _spread_pixels(camera.size, _TIE_POINTS)
    a = _solve_for_coefficients(_remove_skew(uv, camera), _find_ideal_points(uv, camera))
    checked = _spread_pixels(camera.size, _CHECKED_POINTS)
    off = _correct(_remove_skew(checked, camera), a) - _find_ideal_points(checked, camera)
    error = np.hypot(*(off * camera.focal).T)
    return InverseModel(camera, a, float(error.max()), float(np.sqrt(np.mean(error**2))))


def _spread_pixels(size: Size, count: int) -> Array:
    """Return (count^2, 2) pixels in equal distances over the image, its corners included."""
    u, v = (np.linspace(0, length - 1, count) for length in size)
    return np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)


def _remove_skew(uv: npt.ArrayLike, camera: Camera) -> Array:
    """Return the lens's image points (x', y') (..., 2) of measured pixels."""
    d = (np.asarray(uv, dtype=np.float64) - camera.centre) / camera.focal
    d[..., 0] -= camera.params[-1] * d[..., 1]
    return d


def _find_ideal_points(uv: Array, camera: Camera) -> Array:
    """Return the ideal points (x, y) (n, 2) of measured pixels, by the exact inverse.

    Raises:
        CalibrationError: if one has none.
    """
    n = (undistort_points(uv, camera) - camera.centre) / camera.focal
    if not np.isfinite(n).all():
        raise CalibrationError(
            "The lens folds over within the image, so that no inverse model follows it.",
            "Use views with corners up to the image's edges.",
        )
    return n


def _solve_for_coefficients(measured: Array, ideal: Array) -> Array:
    """Solve T a = e for the coefficients (8,) by least squares.

    Args:
        measured: (n, 2) points x', y'.
        ideal: (n, 2) the same points x, y.
    """
    x, y = measured.T[..., None]
    r2 = x**2 + y**2
    polynomial = np.concatenate(
        [
            np.hstack([x * r2, x * r2**2, 2 * x * y, r2 + 2 * x**2]),
            np.hstack([y * r2, y * r2**2, r2 + 2 * y**2, 2 * x * y]),
        ]
    )
    G = np.hstack([r2**2, x * r2, y * r2, r2])
    T = np.hstack([-polynomial, ideal.T.reshape(-1, 1) * np.concatenate([G, G])])
    e = (measured - ideal).T.ravel()
    scale = np.linalg.norm(T, axis=0)  # the columns' sizes differ by powers of the radius
    return np.asarray(np.linalg.lstsq(T / scale, e, rcond=None)[0] / scale)


def _correct(measured: Array, a: Array) -> Array:
    """Return the points (x, y) (..., 2) of measured points (x', y') (..., 2)."""
    x, y = np.moveaxis(measured, -1, 0)
    r2 = x**2 + y**2
    radial = 1 + a[0] * r2 + a[1] * r2**2
    G = (a[4] * r2 + a[5] * x + a[6] * y + a[7]) * r2 + 1
    x_corrected = x * radial + 2 * a[2] * x * y + a[3] * (r2 + 2 * x**2)
    y_corrected = y * radial + a[2] * (r2 + 2 * y**2) + 2 * a[3] * x * y
    return np.stack([x_corrected, y_corrected], axis=-1) / G[..., None]


def _list_remarks(calibration: Calibration) -> tuple[str, ...]:
    """Return the inverse model's coefficients and errors, or why there is none."""
    try:
        model = fit_inverse_model(calibration.camera)
    except CalibrationError as error:
        return (f"There is no inverse model. {error.message}",)
    values = ", ".join(f"a{i} = {a:.4g}" for i, a in enumerate(model.coefficients.tolist(), 1))
    return (
        f"The inverse model of step 4 has {values}, for image points divided by the focal length.",
        f"It is off by at most {model.max_error:.2g} px in the image, {model.rms_error:.2g} px "
        "rms, from the exact inverse of the lens.",
    )


HEIKKILA_SILVEN = Method(
    name="heikkila-silven",
    label="Heikkilä and Silvén",
    title="Heikkilä and Silvén: linear start, fit, inverse model",
    source="J. Heikkilä and O. Silvén, A four-step camera calibration procedure with implicit "
    "image correction, IEEE Conference on Computer Vision and Pattern Recognition (1997) 1106-1112",
    limits="It takes all corners as equally good, and starts from the centre of the image, as a "
    "flat board allows no DLT.",
    lens_models=(_MODEL,),
    initialise=initialise_from_vanishing_points,
    refine=refine_by_bundle_adjustment,
    held=("skew",),
    list_remarks=_list_remarks,
)
"""The method."""
