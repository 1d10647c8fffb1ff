"""Distortion from the straightness of a board's rows and columns alone: the plumb line.

A camera without distortion images straight lines as straight lines, and only such a camera does.
The correction that makes rows and columns straight is therefore that of the lens, up to a
homography, which keeps lines straight: it knows neither focal length nor principal point nor pose,
and needs no millimetre of the board (D. C. Brown, Close-range camera calibration, Photogrammetric
Engineering 37 (1971) 855-866, whose lines were plumb). Both methods here seek

    n = d (1 + k1 r^2 + k2 r^4),      d = (u, v) - centre,

from the measured to the corrected image; their lines are fitted to the corrected points one by one,
and the sum of the squared distances of the points from them is minimised.

Devernay and Faugeras (2001) take the polynomial of the third order, kappa1 = k1 and k2 = 0 (their
paper also has the model of the field of view, which is not used here). Their radius is

    r^2 = ((u - cx) / sx)^2 + (v - cy)^2

with the aspect sx. They refine in stages as we do: kappa1 first, then centre and aspect with it.
Their lines are segments of edges in any scene, found again between passes; ours are given.

Stein (1993) calibrates from straight lines among other shapes. From him are K1, K2 and the centre
of distortion as unknowns; the aspect of the pixels is no unknown of the lines and is 1 here.

In the corrected image the plain sum of squares is the less the smaller the image becomes. The unit
scale at the centre keeps the image from shrinking to a point, and the distances are measured in px
of the measured image, so that to shrink its margins gains nothing either (``straight_lines.py``).
This division of the distances is ours, for both methods.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from calibgui.engine.arrays import Array, BoolArray, Size, freeze
from calibgui.engine.calibration.methods import straight_lines
from calibgui.engine.calibration.methods.method import Description
from calibgui.engine.calibration.methods.straight_lines import IDENTITY, LineFit
from calibgui.engine.calibration.observations import Observation
from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.inverse import make_polynomial_curve
from calibgui.engine.camera.projection import rays_from_pixels
from calibgui.engine.errors import CalibrationError
from calibgui.engine.geometry import frames
from calibgui.engine.geometry.homography import apply_homography, fit_homography

NAMES = ("cx", "cy", "k1", "k2", "aspect")
"""Names of all parameters of a correction."""

_MIN_SIGNIFICANCE = 3.0
"""Coefficients in their standard deviations (root mean square where there are two) below which the
lens counts as free of distortion; the centre is then held."""
_MIN_BEND_PX = 1e-6
"""Distance from straight lines, px, below which the lens counts as free of distortion: coordinates
are not good to more."""
_MAX_CENTRE_SIGMA = 0.25
"""Standard deviation of the centre, in half diagonals of the image, above which it is held."""


@dataclass(frozen=True, eq=False, slots=True)
class PlumbLine:
    """A correction that makes lines straight, n = d (1 + k1 r^2 + k2 r^4) about the centre.

    With (x, y) the pixel less the centre, d = (x, y) and r^2 = (x / aspect)^2 + y^2, all in px.
    """

    size: Size
    """Width and height of the images, px."""
    centre: Array
    """(2,) cx, cy: the centre of distortion, px, which is not the principal point."""
    k: Array
    """(1,) or (2,) k1 in px^-2, k2 in px^-4."""
    aspect: float
    """Width of a pixel against its height, as the distortion sees it."""
    names: tuple[str, ...]
    """(P,) names of the method's parameters: cx, cy, k1, and k2 or aspect."""
    sigma: Array
    """(P,) standard deviations in the order of `names`, in their units; NaN for what was held. They
    are those of the points' noise, estimated from the distances. They do not measure rows and
    columns that are bent on the board, nor what the correction cannot follow."""
    covariance: Array
    """(P, P) covariance that `sigma` is of; NaN for what was held."""
    straightness_before: float
    """Root mean square distance of the points from the best straight lines in the measured image,
    px."""
    straightness_after: float
    """Root mean square distance of the points, in the measured image to first order, from the
    curves that the correction makes straight, px. It is below `noise`, because two parameters of
    each line are fitted to the points."""
    noise: float
    """Standard deviation of a point across its line, estimated from the same distances, px."""
    lines: int
    """Number of lines."""
    points: int
    """Number of points on lines; a point where a row and a column cross counts twice."""
    iterations: int
    """Number of Gauss-Newton steps in all stages."""
    converged: bool
    """True if the last stage converged."""
    remarks: tuple[str, ...] = ()
    """Sentences on what the lines did not determine."""

    def __post_init__(self) -> None:
        freeze(self, "centre", "k", "sigma", "covariance")

    @property
    def estimated(self) -> tuple[str, ...]:
        """Names of the parameters that were not held."""
        return tuple(name for name, s in zip(self.names, self.sigma, strict=True) if np.isfinite(s))

    def correct_points(self, uv: Array) -> Array:
        """Return corrected pixels (..., 2) of measured ones, px; NaN beyond the correction's fold.

        The scale at the centre is 1. Straight lines of the scene are straight among them; angles
        and lengths are known up to a homography only.
        """
        return _correct(uv, self)[0]


@dataclass(frozen=True, kw_only=True)
class LineMethod(Description):
    """A method that estimates distortion from straight lines alone."""

    estimate: Callable[[Sequence[Observation], Size], PlumbLine]
    """Estimate the correction from views and the images' size.

    Raises:
        CalibrationError: if a view cannot be used, or the lines are too few.
    """


def estimate_plumb_line(
    views: Sequence[Observation | tuple[Array, Array]], size: Size, names: tuple[str, ...]
) -> PlumbLine:
    """Estimate the correction that makes rows and columns of the views straight.

    The coefficients are estimated with the centre in the middle of the image first, and all
    parameters then. Without distortion the centre moves nothing, so it is held if the coefficients
    are not told from 0, or if the lines leave it open; a remark says so.

    Args:
        views: the views; their covariances are not used.
        size: width and height of the images, px.
        names: the parameters to estimate, some of `NAMES`.

    Raises:
        CalibrationError: if a view cannot be used, or the lines are too few to tell the distortion.

    Examples:
        >>> import numpy as np
        >>> from calibgui.engine.boards import Board
        >>> from calibgui.engine.calibration import Observation
        >>> from calibgui.engine.camera import Camera, project_points
        >>> from calibgui.engine.geometry import Pose
        >>> board = Board(6, 8, 25.0)
        >>> camera = Camera((640, 480), [600.0, 600.0, 310.0, 250.0, 0.36, 0, 0, 0, 0])
        >>> pose = Pose([0.5, 0.2, 0.0], [-90.0, -60.0, 300.0])
        >>> views = [Observation(project_points(board.points(), camera, pose), board.points())]
        >>> found = estimate_plumb_line(views, camera.size, ("cx", "cy", "k1"))
        >>> found.centre.round(3), found.k
        (array([310., 250.]), array([1.e-06]))
    """
    size = check_image_size(size)
    lines = straight_lines.collect_lines(views)
    d = _normalise(lines.uv, size)
    free = np.array([NAMES.index(name) for name in names])
    _check_number_of_lines(len(d), lines.mask, len(free))
    solve = partial(straight_lines.solve_lines, d, lines.mask)
    straight = solve(IDENTITY, free[:0])
    first = solve(IDENTITY, np.array([i for i in free.tolist() if NAMES[i].startswith("k")]))
    if not first.is_determined:
        raise CalibrationError(
            "The rows and columns do not determine the distortion.",
            "Show the board larger, towards the image's corners, and from several directions.",
        )
    fits, remarks = [first], _remark_no_distortion(straight, first, size)
    if not remarks:
        full = solve(first.q, free)
        remarks = _remark_open_centre(full, size)
        fits.append(full)
    return _assemble(straight, fits, names, size, remarks)


LINE_METHODS: dict[str, LineMethod] = {
    method.name: method
    for method in (
        LineMethod(
            name="devernay-faugeras",
            label="Devernay, Faugeras",
            title="Devernay and Faugeras: straight lines, one coefficient and aspect",
            source="F. Devernay, O. Faugeras, Straight lines have to be straight, Machine Vision "
            "and Applications 13 (2001) 14-24",
            limits="It estimates distortion only, radial and of one coefficient, with its centre "
            "and aspect; it takes rows and columns as straight on the board.",
            estimate=partial(estimate_plumb_line, names=("cx", "cy", "k1", "aspect")),
        ),
        LineMethod(
            name="stein",
            label="Stein",
            title="Stein: straight lines, two coefficients",
            source="G. P. Stein, Internal camera calibration using rotation and geometric shapes, "
            "AITR-1426, MIT Artificial Intelligence Laboratory (1993)",
            limits="It estimates distortion only, radial and of two coefficients, with its centre; "
            "it takes pixels as square, and rows and columns as straight on the board.",
            estimate=partial(estimate_plumb_line, names=("cx", "cy", "k1", "k2")),
        ),
    )
}
"""The methods by name."""


def measure_straightness(
    views: Sequence[Observation | tuple[Array, Array]], plumb_line: PlumbLine
) -> float:
    """Measure how straight a correction makes rows and columns of other views.

    Returns:
        The root mean square distance of the points from their curves, px, as
        `PlumbLine.straightness_after`, and like it below the noise.

    Raises:
        CalibrationError: if a view cannot be used, none has a line, or the correction folds before
            it reaches a corner.
    """
    lines = straight_lines.collect_lines(views)
    if not np.isfinite(plumb_line.correct_points(lines.uv)).all():
        raise CalibrationError(
            "The correction by straight lines does not reach all corners.",
            "Estimate it from views that show the board towards the image's corners too.",
        )
    d = _normalise(lines.uv, plumb_line.size)
    fit = straight_lines.solve_lines(d, lines.mask, _make_q(plumb_line), np.arange(0))
    return fit.rms * _measure_half_diagonal(plumb_line.size)


def compare_with_camera(plumb_line: PlumbLine, camera: Camera, u: Array, v: Array) -> Array:
    """Compare a correction by straight lines with that of a camera, over the image.

    Both correct the pixels of a grid; the homography between the corrected images, which lines
    cannot know, is fitted to all of them by least squares. What remains is taken back to the
    measured image by the derivative of the correction by lines, to first order.

    Args:
        plumb_line: the correction by straight lines.
        camera: the camera to compare with.
        u: (n,) columns of the grid, px.
        v: (m,) rows of the grid, px.

    Returns:
        (m, n, 2) where the camera sees what the lines' correction puts at a pixel, less that pixel,
        px; NaN where one of the two has no correction, or the camera looks 90 degrees or more off
        its axis.

    Raises:
        CalibrationError: if both correct fewer than four pixels of the grid.
    """
    uv = np.stack(np.meshgrid(u, v), axis=-1)
    n, A = _correct(uv, plumb_line)
    with np.errstate(all="ignore"):
        rays = rays_from_pixels(uv, camera)
        seen = rays[..., :2] / np.where(rays[..., 2:] > 0, rays[..., 2:], np.nan)
    is_good = np.isfinite(n).all(axis=-1) & np.isfinite(seen).all(axis=-1)
    if is_good.sum() < 4:
        raise CalibrationError(
            "The correction by straight lines and the camera share no part of the image.",
            "Compare cameras of the same images.",
        )
    vector = np.full(uv.shape, np.nan)
    vector[is_good] = _fit_projected_difference(seen[is_good], n[is_good], A[is_good])
    return vector


def _fit_projected_difference(seen: Array, n: Array, A: Array) -> Array:
    """Return A^-1 (n - H seen) (N, 2) with the homography H for which it is least."""
    H = fit_homography(seen, n, np.ones(len(n)))
    to_measured = np.linalg.inv(A)

    def differ(h: Array) -> Array:
        missing = n - apply_homography(np.append(h, 1.0).reshape(3, 3), seen)
        return np.asarray((to_measured @ missing[..., None]).ravel())

    found = scipy.optimize.least_squares(differ, H.ravel()[:8], x_scale="jac")
    return differ(found.x).reshape(-1, 2)


def _measure_half_diagonal(size: Size) -> float:
    """Return half the diagonal of an image, px: the unit in which lines are solved."""
    return float(np.hypot(*size)) / 2


def _normalise(uv: Array, size: Size) -> Array:
    """Return points (..., 2) px in half diagonals from the middle of the image."""
    return (uv - frames.centre_of_array(size)) / _measure_half_diagonal(size)


def _make_units(size: Size) -> Array:
    """Return the px units (5,) of the parameters `NAMES`."""
    h = _measure_half_diagonal(size)
    return np.array([h, h, h**-2, h**-4, 1.0])


def _make_q(plumb_line: PlumbLine) -> Array:
    """Return the parameters (5,) of a correction, in half diagonals."""
    k = np.append(plumb_line.k, 0.0)[:2]
    centre = plumb_line.centre - frames.centre_of_array(plumb_line.size)
    return np.array([*centre, *k, plumb_line.aspect]) / _make_units(plumb_line.size)


def _correct(uv: Array, plumb_line: PlumbLine) -> tuple[Array, Array]:
    """Return corrected pixels (..., 2), NaN beyond the fold, and derivatives (..., 2, 2)."""
    q = _make_q(plumb_line)
    d = _normalise(uv, plumb_line.size)
    n, A = straight_lines.correct_points(d, q)
    n[_find_folded(d, q)] = np.nan
    return plumb_line.centre + _measure_half_diagonal(plumb_line.size) * n, A


def _find_folded(d: Array, q: Array) -> BoolArray:
    """Return (...) whether points (..., 2) lie at or beyond the radius where a correction folds."""
    folds = make_polynomial_curve(q[2:4]).folds
    radius = np.linalg.norm((d - q[:2]) / np.array([q[4], 1.0]), axis=-1)
    return np.asarray(radius >= folds[0] if len(folds) else np.zeros(radius.shape, dtype=bool))


def _check_number_of_lines(count: int, mask: Array, parameters: int) -> None:
    """Refuse fewer lines than tell the distortion: of each, little more than its bend is known."""
    if count <= parameters or mask.sum() <= 2 * count + parameters:
        raise CalibrationError(
            f"{count} rows and columns of at least 4 corners are too few to tell the distortion.",
            f"Give at least {parameters + 1}: show more of the board, or add views.",
        )


def _remark_no_distortion(straight: LineFit, first: LineFit, size: Size) -> tuple[str, ...]:
    """Return a remark if the lens has no distortion that these lines show."""
    k = first.q[first.free]
    excess = np.sum((first.J @ k) ** 2) - len(k) * (_MIN_SIGNIFICANCE * first.noise) ** 2
    if excess > 0 and straight.rms * _measure_half_diagonal(size) > _MIN_BEND_PX:
        return ()
    sigma = np.sqrt(np.diag(first.covariance))
    values = ", ".join(
        f"{NAMES[i]} = {value * unit:.2g} ± {s * unit:.2g} px^{power}"
        for i, value, s, unit, power in zip(
            first.free.tolist(), k, sigma, _make_units(size)[first.free], (-2, -4), strict=False
        )
    )
    return (
        f"The lines show no distortion: {values} cannot be told from 0. Nothing determines the "
        "centre of distortion, which is held at the middle of the image.",
    )


def _remark_open_centre(full: LineFit, size: Size) -> tuple[str, ...]:
    """Return a remark if the lines leave the centre of distortion open."""
    how = ""
    if full.converged and full.is_determined:
        sigma = float(np.sqrt(np.diag(full.covariance)[:2].max()))
        if sigma <= _MAX_CENTRE_SIGMA:
            return ()
        how = f" by ± {sigma * _measure_half_diagonal(size):.0f} px"
    return (
        f"The lines leave the centre of distortion open{how}. It is held at the middle of the "
        "image.",
    )


def _assemble(
    straight: LineFit,
    fits: Sequence[LineFit],
    names: tuple[str, ...],
    size: Size,
    remarks: tuple[str, ...],
) -> PlumbLine:
    """Return the record of the last fit, or of the first if a remark says that others failed."""
    fit = fits[0] if remarks else fits[-1]
    units, h = _make_units(size), _measure_half_diagonal(size)
    covariance = np.full((len(NAMES), len(NAMES)), np.nan)
    scale = np.outer(units[fit.free], units[fit.free])
    covariance[np.ix_(fit.free, fit.free)] = fit.covariance * scale
    q, places = fit.q * units, [NAMES.index(name) for name in names]
    return PlumbLine(
        size=size,
        centre=frames.centre_of_array(size) + q[:2],
        k=q[[i for i in places if NAMES[i].startswith("k")]],
        aspect=float(q[4]),
        names=names,
        sigma=np.sqrt(np.diag(covariance))[places],
        covariance=covariance[np.ix_(places, places)],
        straightness_before=straight.rms * h,
        straightness_after=fit.rms * h,
        noise=fit.noise * h,
        lines=len(fit.line),
        points=int(fit.mask.sum()),
        iterations=sum(each.iterations for each in fits),
        converged=fit.converged,
        remarks=remarks,
    )
