"""Corners searched again where a calibrated camera expects them.

The finder knows neither camera nor pose, and follows a board only from corner to corner. Once the
camera is calibrated, what was found in a view, or a fragment too small to be trusted by itself,
gives its pose, and the pose says where every other corner is (`prediction`):

1. Places whose prediction is sure to a fraction of a square are looked at. A corner is there if a
   saddle point near the prediction looks like the others (`corners.appearance`). With it the pose
   is better and the next places are surer, until none is left.
2. All are located by the edge model, along edges that run and bend as the prediction does.
3. What the model does not describe is dropped, and so is what the camera does not expect within
   4.65 standard deviations. Of corners found before only the gross errors are: a bent board or a
   lens model too simple moves many.
4. A view in which no board had been found must show as much of one as the finder asks for, and
   fit the camera as well as the views that it was calibrated from.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy

from calibgui.engine.arrays import Array, BoolArray, GreyImage, GridSize
from calibgui.engine.calibration.result import Calibration
from calibgui.engine.detection.checkerboard import verification, x_corner_fit
from calibgui.engine.detection.checkerboard.corner_template import placed, sectors, typical
from calibgui.engine.detection.checkerboard.find_checkerboard import (
    LocatedBoard,
    grey_levels,
    record,
)
from calibgui.engine.detection.checkerboard.numbering import Numbering, Sides, numberings
from calibgui.engine.detection.checkerboard.prefilter import plausible
from calibgui.engine.detection.checkerboard.pyramid_search import find_boards
from calibgui.engine.detection.checkerboard.saddle import at_saddles, refine_saddles, window
from calibgui.engine.detection.checkerboard.x_corner_fit import Fit
from calibgui.engine.detection.corners import Corners
from calibgui.engine.detection.lattice import Lattice, axes, bordered, crop, large_enough, supported
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.redetection.prediction import Sight, sight

_SURE = 1 / 12
"""Greatest standard deviation of a prediction that is looked at, squares."""
_SLACK = 1.0
"""Distance from the prediction that is allowed for saddle points anyway, px."""
_FINE = 4.65
"""Distance from the prediction, in standard deviations: 2e-5 of good corners are farther."""
_GROSS = 0.03
"""Distance beyond which corners found before are dropped as well, squares."""
_LOST = 0.25
"""Share of these beyond which the camera is not believed."""
_SMALLEST = 5.0
"""Least side of a square that is looked at, px."""
_SADDLE = 0.05
"""Standard deviation that saddle points have at least, px."""
_ROUNDS = 12
_FRAGMENT = 6
"""Corners from which a pose is tried."""
_WORSE = 3.0
"""How much larger than the calibration's the residuals of a view found now may be."""


def find_again(
    image: npt.ArrayLike,
    calibration: Calibration,
    grid_size: GridSize,
    corners: Corners | None = None,
) -> Corners:
    """Locate the corners of a board with the help of the calibrated camera.

    Args:
        image: (h, w) grey levels.
        calibration: of the camera that took it.
        board: rows and columns of inner corners.
        corners: what was found before; None if nothing.

    Returns:
        All corners found, under the numbers that they had. Where these were relative, more
        corners or the ends of the board may have decided them.

    Raises:
        NoBoardError: there is no board that the camera could see like this.
    """
    grey = grey_levels(image)
    tried = [
        _completed(grey, calibration, grid_size, seed, corners) for seed in _seeds(grey, corners)
    ]
    found = [more for more in tried if more is not None]
    if corners is not None and not (found and len(found[0]) > (1 - _LOST) * len(corners)):
        return corners
    if not found:
        raise NoBoardError(
            "Nothing in it is a board as the calibrated camera would see it.",
            "Mark its four outermost corners, or leave this picture out.",
        )
    return max(found, key=len)


def _seeds(grey: GreyImage, corners: Corners | None) -> list[Lattice]:
    """Where to start from: the corners found before, or fragments of what may be a board."""
    if corners is not None:
        return [_lattice(grey, corners)]
    *_, candidates = [[], *find_boards(grey, enough=lambda part: len(part) >= _FRAGMENT)]
    seeds = []
    for candidate in candidates:
        refined, at_saddle = at_saddles(grey, candidate.lattice)
        refined = refined.under(at_saddle)
        if len(refined) < _FRAGMENT:
            continue
        good = verification.sound(refined, grey)
        # Parts between which nothing was found need not be at the distance that was counted.
        parts, count = scipy.ndimage.label(good)
        seeds += [refined.under(parts == k + 1) for k in range(count)]
    return [seed for seed in seeds if len(seed) >= _FRAGMENT]


def _lattice(grey: GreyImage, corners: Corners) -> Lattice:
    """The board of which `corners` were found, with the colours that they show."""
    uv = np.full((*corners.shape, 2), np.nan)
    uv[corners.grid[:, 0], corners.grid[:, 1]] = corners.uv
    placed_corners = placed(supported(Lattice(uv, dark=True)))
    _, difference = sectors(grey, *placed_corners)
    return Lattice(uv, dark=bool(np.sum(difference) > 0))


def _completed(
    grey: GreyImage,
    calibration: Calibration,
    grid_size: GridSize,
    seed: Lattice,
    corners: Corners | None,
) -> Corners | None:
    """All that is seen of the board of which `seed` is a part; None if it is none."""
    known = corners is not None and not corners.relative
    if not known:
        seed = Lattice(bordered(seed.uv, max(grid_size)), seed.dark)
    kept = seed.found if corners is not None else np.zeros(seed.shape, dtype=np.bool_)
    try:
        grown = _grown(grey, calibration, seed)
        found = _located(grey, calibration, grown, kept)
    except CalibrationError:  # too little, or nothing that a camera sees
        return None
    if found is None or (corners is None and not _trusted(grey, calibration, found)):
        return None
    part = crop(found.lattice)
    if known:
        row, col = np.argwhere(found.lattice.found).min(axis=0).tolist()
        ways = [Numbering(part, 0, grid_size, (row, col))]
    else:
        ways = numberings(part, grid_size, _ends(grey, part))
    return record(grey, LocatedBoard(part, (), found.fit), ways, None, []) if ways else None


def _ends(grey: GreyImage, part: Lattice) -> Sides:
    """On which sides of `part` the board is seen to end."""
    dense = supported(part)
    return verification.ends(dense, grey) if dense.shape == part.shape else (False,) * 4


def _view(calibration: Calibration, lattice: Lattice, cov: Array | None = None) -> Sight:
    """The pose of the view in which a lattice was found; a square is the unit of length.

    Raises:
        CalibrationError: too few corners, or corners that no pose explains.
    """
    if len(lattice) < _FRAGMENT:
        raise NoBoardError("Too little of the board is seen.", "Leave this picture out.")
    if cov is None:
        cov = np.broadcast_to(_SADDLE**2 * np.eye(2), (len(lattice), 2, 2))
    return sight(calibration, lattice.uv[lattice.found], _board_shape(lattice)[lattice.found], cov)


def _board_shape(lattice: Lattice) -> Array:
    """(rows, cols, 2) the places of a lattice on the plate, squares."""
    rows, cols = np.indices(lattice.shape)
    return np.stack([cols, rows], axis=-1).astype(np.float64)


def _grown(grey: GreyImage, calibration: Calibration, seed: Lattice) -> Lattice:
    """The lattice with every corner that shows where it is expected."""
    lattice, tried = _consistent(calibration, seed), seed.found
    for _ in range(_ROUNDS):
        places, spread = _view(calibration, lattice).expected(_board_shape(lattice))
        right, down = axes(places)
        spacing = np.fmin(np.linalg.norm(right, axis=2), np.linalg.norm(down, axis=2))
        sigma = np.sqrt(np.trace(spread, axis1=2, axis2=3))
        new = (sigma < _SURE * spacing) & (spacing > _SMALLEST) & ~tried
        new &= verification.in_image(places, grey.shape)
        if not new.any():
            break
        tried = tried | new
        near = np.minimum(spacing[new] / 4, _SLACK + _FINE * sigma[new])
        uv = lattice.uv.copy()
        uv[new], at_saddle = refine_saddles(grey, places[new], window(spacing[new]), near)
        new[new] = at_saddle
        dark = lattice.dark ^ (np.argwhere(new).sum(axis=1) % 2 == 1)
        look = typical(supported(lattice), grey)
        new[new], _ = look.shown(grey, uv[new], right[new], down[new], dark)
        lattice = Lattice(uv, lattice.dark).under(lattice.found | new)
        lattice = _consistent(calibration, lattice)
    return Lattice(np.where(seed.found[..., None], seed.uv, lattice.uv), lattice.dark)


def _consistent(calibration: Calibration, lattice: Lattice, cov: Array | None = None) -> Lattice:
    """The lattice without corners that the camera does not expect there."""
    while True:
        off = _view(calibration, lattice, cov).deviation
        if off.max() <= _FINE:
            return lattice
        good = off <= max(_FINE, off.max() / 2)
        cov = None if cov is None else cov[good]
        found = lattice.found
        found[found] = good
        lattice = lattice.under(found)


def _located(
    grey: GreyImage, calibration: Calibration, lattice: Lattice, kept: BoolArray
) -> LocatedBoard | None:
    """The corners that the edge model describes where the camera expects them, or those `kept`
    not far from there."""
    view = _view(calibration, _consistent(calibration, lattice))
    expected, _ = view.expected(_board_shape(lattice))
    far = _GROSS * np.fmin(*(np.linalg.norm(step, axis=2) for step in axes(expected)))
    for _ in range(_ROUNDS):
        fit = x_corner_fit.fit(
            grey, lattice, geometry=view.geometry(_board_shape(lattice)[lattice.found], 1.0)
        )
        good = verification.described(fit, lattice, expected)
        part = _moved(lattice, fit, good)
        agreed = _consistent(calibration, part, fit.covariance[good]).found
        agreed |= part.found & kept & (np.linalg.norm(part.uv - expected, axis=2) < far)
        if np.array_equal(agreed, lattice.found):
            return LocatedBoard(lattice, (), fit)
        lattice = lattice.under(agreed)
    return None


def _moved(lattice: Lattice, fit: Fit, good: BoolArray) -> Lattice:
    """The lattice with those of its corners (n,) that are `good` where the fit puts them."""
    found, uv = lattice.found, lattice.uv.copy()
    uv[found] = fit.uv
    found[found] = good
    return Lattice(uv, lattice.dark).under(found)


def _trusted(grey: GreyImage, calibration: Calibration, found: LocatedBoard) -> bool:
    """Whether it shows a board of this camera beyond doubt."""
    assert found.fit is not None
    every = np.ones(len(found), dtype=np.bool_)
    view = _view(calibration, _moved(found.lattice, found.fit, every), found.fit.covariance)
    usual = max(calibration.model_error, calibration.noise)
    return (
        large_enough(crop(found.lattice))
        and verification.stepped(found.fit)
        and plausible(found.lattice, grey)
        and bool(np.sqrt(view.tau2) <= _WORSE * usual)
    )
