"""Redetection: the corners of a board, searched again where a calibrated camera expects them.

The detector knows neither camera nor pose, and follows a board only from corner to corner. Once the
camera is calibrated, the corners that were found in a view, or a fragment too small to be trusted
by itself, give its pose, and the pose tells where every other corner is (``prediction.py``):

1. Places whose prediction is certain to a fraction of a square are examined. A corner is there if a
   saddle point near the prediction looks like the others (``checkerboard/corner_template.py``).
   With it the pose becomes better and further places become certain, until none is left.
2. All corners are fitted by the X-corner model, with edges that run and bend as predicted.
3. A corner is dropped if the X-corner model does not describe it, or if it lies more than 4.65
   standard deviations from the prediction. Corners found before are dropped for gross errors only,
   and not for those where the residuals show that the models of lens or board are in doubt: these
   miss true corners by several percent of a square at the edge of a wide image. Then the edges are
   not taken from the camera either, but from the corners around, as in the first search.
4. A view in which no board had been found must show as much of one as the detector wants, and
   fit the camera as well as the views that it was calibrated from.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, BoolArray, GreyImage, GridSize
from calibgui.engine.boards.board import Board
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.corner_fit import verification, x_corner_fit
from calibgui.engine.corner_fit.board_priors import MANY_CORNERS
from calibgui.engine.corner_fit.x_corner_fit import XCornerFit
from calibgui.engine.detection.checkerboard.board_refinement import RefinedBoard
from calibgui.engine.detection.checkerboard.find_checkerboard import assemble_corners
from calibgui.engine.detection.detector_io import check_grey_levels
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.features.corner_template import (
    compare_sectors,
    estimate_template,
    orient_corners,
)
from calibgui.engine.features.corners import Corners
from calibgui.engine.features.lattice import (
    Lattice,
    add_border,
    crop_lattice,
    drop_isolated_and_crop,
    estimate_steps,
    is_large_enough,
)
from calibgui.engine.features.saddle import choose_weight_sigma, refine_lattice, refine_saddles
from calibgui.engine.geometry.pose import Pose
from calibgui.engine.lattices import board_ends
from calibgui.engine.lattices.numbering import Numbering, Sides, list_numberings
from calibgui.engine.lattices.prefilter import is_plausible
from calibgui.engine.lattices.pyramid_search import find_candidates
from calibgui.engine.redetection.prediction import (
    ResectedView,
    differentiate_edges,
    resect_view,
)

_MAX_PREDICTION_SIGMA = 1 / 12
"""Standard deviation of a prediction, in squares, beyond which a place is not examined yet."""
_SADDLE_TOLERANCE = 1.0
"""Distance between saddle point and prediction that is allowed beside the prediction's own, px."""
_MAX_DEVIATION = 4.65
"""Distance from the prediction, in standard deviations, beyond which a corner is dropped; 2e-5 of
good corners are farther."""
_MAX_GROSS_ERROR = 0.03
"""Distance from the prediction, in squares, beyond which corners found before are dropped too."""
_MAX_LOST_SHARE = 0.25
"""Share of the corners found before beyond whose loss the new ones are not believed."""
_MIN_SQUARE = 5.0
"""Side of a square below which a place is not examined, px."""
_SADDLE_SIGMA = 0.05
"""Standard deviation that saddle points are taken to have, px."""
_MAX_ROUNDS = 12
"""Number of rounds of growing, and of fitting, after which either ends."""
_MIN_CORNERS = 6
"""Number of corners below which no pose is estimated."""
_MAX_BEND = 3.0
"""Distance that edges of few corners are bent aside, in standard deviations of their corners,
beyond which the camera knows the bend better. At 30 % barrel, where it is hundreds, both searches
leave errors of 1.0 to 1.15 times the bound on 12 corners of 150 to 300 px squares."""
_MAX_NOISE_RATIO = 3.0
"""Ratio of a new view's residuals to the calibration's beyond which the view is refused."""


def redetect_corners(
    image: npt.ArrayLike,
    calibration: Calibration,
    grid_size: GridSize,
    corners: Corners | None = None,
) -> Corners:
    """Locate the corners of a checkerboard with the help of the calibrated camera.

    Args:
        image: (h, w) grey levels.
        calibration: the calibration of the camera that took the image.
        grid_size: rows and columns of inner corners.
        corners: the corners that were found before; None if there are none.

    Returns:
        All corners found, under the labels that they had. Where these were relative, more
        corners or the ends of the board may have decided them.

    Raises:
        NoBoardError: if there is no board that the camera could see like this.
    """
    grey = check_grey_levels(image)
    tried = [
        _complete_board(grey, calibration, grid_size, seed, corners)
        for seed in _find_seeds(grey, corners)
    ]
    found = [more for more in tried if more is not None]
    if corners is not None and not (found and len(found[0]) > (1 - _MAX_LOST_SHARE) * len(corners)):
        return corners
    if not found:
        raise NoBoardError(
            "Nothing in it is a board as the calibrated camera would see it.",
            "Mark its four outermost corners, or leave this picture out.",
        )
    return max(found, key=len)


def are_edges_bent(corners: Corners, calibration: Calibration, pose: Pose, board: Board) -> bool:
    """Return whether few corners have edges so bent that the camera places them better.

    A camera that misses corners by more than they are known to, as one from a board that is not as
    it was drawn, does not.

    Args:
        corners: the corners of a view, with places on the board.
        calibration: the calibration of the camera.
        pose: the view's.
        board: the board.
    """
    is_known = len(corners) >= MANY_CORNERS
    if is_known or corners.cov is None or corners.relative or _is_model_in_doubt(calibration):
        return False

    def locate(xy: Array) -> Array:
        return project_points(xy.reshape(-1, 2), calibration.camera, pose).reshape(xy.shape)

    steps, curvature = differentiate_edges(locate, board.points(corners.grid), board.square)
    bend = abs(curvature) * np.sum(steps**2, axis=2) / 24  # over arms of half a square
    sigma = np.sqrt(np.trace(corners.cov, axis1=1, axis2=2) / 2)
    if calibration.model_error > np.median(sigma):
        return False
    return bool(np.any(bend > _MAX_BEND * sigma[:, None]))


def _find_seeds(grey: GreyImage, corners: Corners | None) -> list[Lattice]:
    """Find lattices to start from: the corners found before, or fragments of possible boards."""
    if corners is not None:
        return [_make_lattice(grey, corners)]
    *_, candidates = [
        [],
        *find_candidates(grey, is_sufficient=lambda part: len(part) >= _MIN_CORNERS),
    ]
    seeds = []
    for candidate in candidates:
        refined, at_saddle = refine_lattice(grey, candidate.lattice)
        refined = refined.select(at_saddle)
        if len(refined) < _MIN_CORNERS:
            continue
        good = verification.find_sound_corners(refined, grey)
        # Parts with nothing between them need not be as many squares apart as the search counted.
        parts, count = opencv.label_parts(good)
        seeds += [refined.select(parts == k + 1) for k in range(count)]
    return [seed for seed in seeds if len(seed) >= _MIN_CORNERS]


def _make_lattice(grey: GreyImage, corners: Corners) -> Lattice:
    """Make the lattice of corners found before, with the colours that they show."""
    uv = np.full((*corners.shape, 2), np.nan)
    uv[corners.grid[:, 0], corners.grid[:, 1]] = corners.uv
    placed_corners = orient_corners(drop_isolated_and_crop(Lattice(uv, dark=True)))
    _, difference = compare_sectors(grey, *placed_corners)
    return Lattice(uv, dark=bool(np.sum(difference) > 0))


def _complete_board(
    grey: GreyImage,
    calibration: Calibration,
    grid_size: GridSize,
    seed: Lattice,
    corners: Corners | None,
) -> Corners | None:
    """Complete the board of which `seed` is a part; None if it is no board."""
    is_placed = corners is not None and not corners.relative
    if not is_placed:
        seed = Lattice(add_border(seed.uv, max(grid_size)), seed.dark)
    kept = seed.found if corners is not None else np.zeros(seed.shape, dtype=np.bool_)
    try:
        grown = _grow_lattice(grey, calibration, seed)
        found = _fit_corners(grey, calibration, grown, kept)
    except CalibrationError:  # too few corners, or none that a camera could see
        return None
    if found is None or (corners is None and not _is_trustworthy(grey, calibration, found)):
        return None
    part = crop_lattice(found.lattice)
    if is_placed:
        row, col = np.argwhere(found.lattice.found).min(axis=0).tolist()
        numberings = [Numbering(part, 0, grid_size, (row, col))]
    else:
        numberings = list_numberings(part, grid_size, _find_ends(grey, part))
    return (
        assemble_corners(grey, RefinedBoard(part, (), found.fit), numberings, None, [])
        if numberings
        else None
    )


def _find_ends(grey: GreyImage, part: Lattice) -> Sides:
    """Find the sides of `part` on which the board is seen to end."""
    dense = drop_isolated_and_crop(part)
    return board_ends.find_ends(dense, grey) if dense.shape == part.shape else (False,) * 4


def _resect_lattice(
    calibration: Calibration, lattice: Lattice, cov: Array | None = None
) -> ResectedView:
    """Estimate the pose of the view in which a lattice was found; a square is the unit of length.

    Raises:
        CalibrationError: if the corners are too few, or if no pose explains them.
    """
    if len(lattice) < _MIN_CORNERS:
        raise NoBoardError("Too little of the board is seen.", "Leave this picture out.")
    if cov is None:
        cov = np.broadcast_to(_SADDLE_SIGMA**2 * np.eye(2), (len(lattice), 2, 2))
    return resect_view(
        calibration, lattice.uv[lattice.found], _list_places(lattice)[lattice.found], cov
    )


def _list_places(lattice: Lattice) -> Array:
    """List the places (rows, cols, 2) of a lattice on the board, squares."""
    rows, cols = np.indices(lattice.shape)
    return np.stack([cols, rows], axis=-1).astype(np.float64)


def _grow_lattice(grey: GreyImage, calibration: Calibration, seed: Lattice) -> Lattice:
    """Grow a lattice by every corner that shows where it is predicted."""
    lattice, tried = _drop_inconsistent(calibration, seed), seed.found
    for _ in range(_MAX_ROUNDS):
        places, spread = _resect_lattice(calibration, lattice).predict_corners(
            _list_places(lattice)
        )
        right, down = estimate_steps(places)
        spacing = np.fmin(np.linalg.norm(right, axis=2), np.linalg.norm(down, axis=2))
        sigma = np.sqrt(np.trace(spread, axis1=2, axis2=3))
        new = (sigma < _MAX_PREDICTION_SIGMA * spacing) & (spacing > _MIN_SQUARE) & ~tried
        new &= board_ends.are_in_image(places, grey.shape)
        if not new.any():
            break
        tried = tried | new
        near = np.minimum(spacing[new] / 4, _SADDLE_TOLERANCE + _MAX_DEVIATION * sigma[new])
        uv = lattice.uv.copy()
        uv[new], at_saddle = refine_saddles(
            grey, places[new], choose_weight_sigma(spacing[new]), near
        )
        new[new] = at_saddle
        dark = lattice.dark ^ (np.argwhere(new).sum(axis=1) % 2 == 1)
        look = estimate_template(drop_isolated_and_crop(lattice), grey)
        new[new], _ = look.match(grey, uv[new], right[new], down[new], dark)
        lattice = Lattice(uv, lattice.dark).select(lattice.found | new)
        lattice = _drop_inconsistent(calibration, lattice)
    return Lattice(np.where(seed.found[..., None], seed.uv, lattice.uv), lattice.dark)


def _drop_inconsistent(
    calibration: Calibration, lattice: Lattice, cov: Array | None = None
) -> Lattice:
    """Drop the corners that lie too far from where the camera predicts them, the worst first."""
    while True:
        off = _resect_lattice(calibration, lattice, cov).deviation
        if off.max() <= _MAX_DEVIATION:
            return lattice
        good = off <= max(_MAX_DEVIATION, off.max() / 2)
        cov = None if cov is None else cov[good]
        found = lattice.found
        found[found] = good
        lattice = lattice.select(found)


def _fit_corners(
    grey: GreyImage, calibration: Calibration, lattice: Lattice, kept: BoolArray
) -> RefinedBoard | None:
    """Fit the corners, and drop those that model or camera contradict until none is left.

    Args:
        grey: (h, w) the image.
        calibration: the calibration of the camera.
        lattice: the corners to fit.
        kept: (rows, cols) true for corners found before. The camera drops them for gross errors
            only, and not at all if its lens is in doubt.
    """
    view = _resect_lattice(calibration, _drop_inconsistent(calibration, lattice))
    expected, _ = view.predict_corners(_list_places(lattice))
    far = _MAX_GROSS_ERROR * np.fmin(
        *(np.linalg.norm(step, axis=2) for step in estimate_steps(expected))
    )
    is_doubted = _is_model_in_doubt(calibration)
    for _ in range(_MAX_ROUNDS):
        places = _list_places(lattice)[lattice.found]
        geometry = None if is_doubted else view.predict_edges(places, 1.0)
        fit = x_corner_fit.fit_x_corners(grey, lattice, geometry=geometry)
        good = verification.find_described_corners(fit, lattice)
        part = _move_corners(lattice, fit, good)
        agreed = _drop_inconsistent(calibration, part, fit.covariance[good]).found
        agreed |= part.found & kept & (is_doubted | (_measure_misses(part, expected) < far))
        if np.array_equal(agreed, lattice.found):
            return RefinedBoard(lattice, (), fit)
        lattice = lattice.select(agreed)
    return None


def _is_model_in_doubt(calibration: Calibration) -> bool:
    """Return whether the residuals show an error of lens or board that the models do not follow.

    Over few views a lens that its model does not follow looks like a board that is off.
    """
    return calibration.lens_error > 0 or calibration.board_shape_error > 0


def _measure_misses(lattice: Lattice, expected: Array) -> Array:
    """Measure the distances (rows, cols) of a lattice's corners from where they are expected."""
    return np.asarray(np.linalg.norm(lattice.uv - expected, axis=2))


def _move_corners(lattice: Lattice, fit: XCornerFit, good: BoolArray) -> Lattice:
    """Move the corners of a lattice to where the fit puts them, and keep those that are `good`."""
    found, uv = lattice.found, lattice.uv.copy()
    uv[found] = fit.uv
    found[found] = good
    return Lattice(uv, lattice.dark).select(found)


def _is_trustworthy(grey: GreyImage, calibration: Calibration, found: RefinedBoard) -> bool:
    """Return whether a board found without an earlier one certainly is one of this camera."""
    assert found.fit is not None
    every = np.ones(len(found), dtype=np.bool_)
    view = _resect_lattice(
        calibration, _move_corners(found.lattice, found.fit, every), found.fit.covariance
    )
    usual = max(calibration.model_error, calibration.noise)
    return (
        is_large_enough(crop_lattice(found.lattice))
        and verification.has_step_edges(found.fit)
        and is_plausible(found.lattice, grey)
        and bool(np.sqrt(view.tau2) <= _MAX_NOISE_RATIO * usual)
    )
