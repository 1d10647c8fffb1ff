"""Is it a board? A wrong grid is worse than none.

After refinement at full resolution every corner must
- have converged to a saddle,
- lie where its neighbours on the lattice expect it (regularity),
- look like a corner and like the board's others (`appearance`).
Corners that fail are left out; so many failures that the rest no longer holds together, or a
rest too small, condemn the board. So does a rest that `chance` explains.
"""

from __future__ import annotations

import numpy as np

from calibgui.engine.arrays import Array, BoolArray, GreyImage
from calibgui.engine.detection import grid_map
from calibgui.engine.detection.checkerboard.corner_template import placed, typical
from calibgui.engine.detection.checkerboard.numbering import Sides, turned
from calibgui.engine.detection.checkerboard.x_corner_fit import Fit
from calibgui.engine.detection.lattice import (
    Lattice,
    axes,
    bordered,
    in_steps,
    predict,
    supported,
    with_steps,
)
from calibgui.engine.images.sampling import sample

_IRREGULAR = 0.2
"""Greatest distance from the neighbours' prediction, steps of the lattice."""
_FAILING = 0.25
"""Share of corners that may fail before the board does."""
_UNEVEN = 0.1
"""Greatest rms distance of a board's corners from the smooth sheet through them, steps."""
_BROKEN = 0.1
"""Places between a board's corners, over these, that may show squares but no corner."""
WIDEST = 0.18
"""Greatest blur of a board's edges, squares: of a sine wave it would be 0.25."""
_WORST_MISFIT = 0.25
"""Greatest median residual over the contrast."""
_MOVED = 0.1
"""Farthest that the edge fit may move a corner, squares."""
_ASIDE = float(np.sin(np.radians(3.0)))
"""Sine of the angle that an edge may be off the step to its neighbours ..."""
_FARTHER_ASIDE = 10.0
"""... or the angle over the board's median, which distortion raises, whichever is more."""
_MORE = 2.5
"""Residual over the board's median that condemns a corner whose edges are."""
_WEAKEST = 0.2
"""Least contrast over the board's median."""
_UNEXPLAINED = 4.0
"""Greatest residual of the edge fit over the board's median residual ..."""
_MISFIT = 0.15
"""... or over the corner's contrast, whichever is more."""
_ASTRAY = 6.0
"""Farthest that a corner of such a residual may be from where those of less expect it, over their
own rms distance from there ..."""
_SLIGHTLY = 0.03
"""... or in px, whichever is more."""
_EDGE = 4.0
"""Width of the image's border in which no corner is expected to be found, px."""
_BESIDE, _BEFORE = 0.25, 0.2
"""Where the ends of the outermost squares are looked at, steps from the next line's places."""
_PRESENT = 0.4
"""Least difference of neighbouring squares over the contrast of the board's corners."""
_LEAST = 3
"""Places in the image that can show where a board ends."""
_AROUND = 1 / 3
"""Share of the places around a lattice that alternate where the pattern goes on."""
_SPARSE = 1 / 3
"""Share of a border line's places below which its corners are doubted."""
_MOSTLY = 0.6
"""Share of a line's places in the image that must show the end."""


def sound(lattice: Lattice, image: GreyImage, plain: float = 0.5) -> BoolArray:
    """(rows, cols) which corners of a lattice pass: see the head of this module.

    The squares are of one colour up to `plain` squares from their edges.
    """
    lattice = with_steps(lattice)
    good = lattice.found
    good[good], _ = typical(lattice, image, plain).shown(image, *placed(lattice).nearer(plain))
    # What does not look like a corner says nothing about where its neighbours should be.
    uv = lattice.under(good).uv
    irregular = in_steps(uv - predict(uv), *axes(uv)) >= _IRREGULAR
    return np.asarray(good & ~irregular)


def credible(failing: int, found: int) -> bool:
    """Whether few enough of the corners found fail for their board to be trusted."""
    return failing <= _FAILING * found


def unbroken(lattice: Lattice, image: GreyImage) -> Lattice:
    """The lattice without border lines where squares are seen that form no corners in more places
    than corners; empty if many such places are left, or if the corners lie on no smooth sheet.

    Something may hide a corner, but where even squares are seen that do not alternate there is
    none: beyond the border of the board, and in textures of squares at random.
    """
    cells = np.argwhere(lattice.found).astype(np.float64)
    off = np.linalg.norm(
        grid_map.fit_grid_map(lattice).at(cells) - lattice.uv[lattice.found], axis=1
    )
    if np.sqrt(np.mean((off / lattice.spacing()[lattice.found]) ** 2)) > _UNEVEN:
        return supported(lattice.under(np.zeros(lattice.shape, dtype=np.bool_)))
    broken = _broken(lattice, image)
    kept = np.ones(lattice.shape, dtype=np.bool_)
    while kept.any():
        rows, cols = np.flatnonzero(kept.any(axis=1)), np.flatnonzero(kept.any(axis=0))
        borders = ((rows[0], cols), (rows[-1], cols), (rows, cols[0]), (rows, cols[-1]))
        excess = [int(broken[line].sum() - lattice.found[line].sum()) for line in borders]
        if max(excess) <= 0:
            break
        kept[borders[int(np.argmax(excess))]] = False
    if np.count_nonzero(broken & kept) > _BROKEN * np.count_nonzero(lattice.found & kept):
        kept[:] = False
    return without_strays(supported(lattice.under(kept)), image)


def without_strays(lattice: Lattice, image: GreyImage) -> Lattice:
    """The lattice without border lines of few corners before which the board is seen to end."""
    for k in range(4):
        turn = turned(lattice, k)
        if len(turn.uv) and np.count_nonzero(turn.found[0]) < _SPARSE * turn.shape[1]:
            rest = supported(Lattice(turn.uv[1:], not turn.dark))
            if len(rest) and _ends_above(rest, image, _PRESENT * typical(rest, image).contrast):
                lattice = turned(rest, -k)
    return lattice


def _broken(lattice: Lattice, image: GreyImage) -> BoolArray:
    """(rows, cols) where there is no corner, and nothing hides one."""
    right, down = axes(lattice.uv)
    missing = ~lattice.found & np.isfinite(right + down).all(axis=2)
    places = np.argwhere(missing)
    if not len(places):
        return missing
    uv = grid_map.fit_grid_map(lattice).at(places.astype(np.float64))
    dark = lattice.dark ^ (places.sum(axis=1) % 2 == 1)
    look = typical(lattice, image)
    none = look.contradicted(image, uv, right[missing], down[missing], dark)
    missing[missing] = none & in_image(uv, image.shape)
    return np.asarray(missing)


def goes_on(lattice: Lattice, image: GreyImage) -> bool:
    """Whether the pattern goes on around a lattice that could not grow there: in another look."""
    uv = bordered(lattice.uv, 1)
    place, (right, down) = predict(uv), axes(uv)
    around = np.isnan(uv[..., 0]) & np.isfinite(place + right + down).all(axis=2)
    around &= in_image(place, image.shape)
    dark = lattice.dark ^ (np.argwhere(around).sum(axis=1) % 2 == 1)
    look = typical(lattice, image)
    alternate, _ = look.alternate(image, place[around], right[around], down[around], dark)
    return bool(np.count_nonzero(alternate) > _AROUND * len(alternate))


def described(fit: Fit, lattice: Lattice, expected: Array | None = None) -> BoolArray:
    """(n,) which corners of `lattice` the edge model fitted there describes: it stayed near, its
    edges are as strong as the board's, and it leaves no more unexplained; still less if they
    do not point to its neighbours, or to where these are `expected` (rows, cols, 2) px."""
    found = lattice.found
    moved = np.linalg.norm(fit.uv - lattice.uv[found], axis=1)
    typical = float(np.median(fit.residual))
    around = lattice.uv if expected is None else expected
    right, down = (step[found] for step in axes(around))
    steps = np.stack([right, down], axis=1)
    spacing = np.fmin(np.linalg.norm(right, axis=1), np.linalg.norm(down, axis=1))
    aside = np.abs(np.sum(fit.edges.normals() * steps, axis=2)) / np.linalg.norm(steps, axis=2)
    askew = (aside > np.maximum(_ASIDE, _FARTHER_ASIDE * np.median(aside, axis=0))).any(axis=1)
    return np.asarray(
        (moved <= np.maximum(_MOVED * spacing, 1.0))
        & ~(askew & (fit.residual > _MORE * typical))
        & (fit.contrast > _WEAKEST * np.median(fit.contrast))
        & (fit.residual <= np.maximum(_UNEXPLAINED * typical, _MISFIT * fit.contrast))
        & np.isfinite(fit.covariance).all(axis=(1, 2))
    )


def astray(fit: Fit, lattice: Lattice) -> BoolArray:
    """(n,) which corners of `lattice` the edge model fitted there describes worse than the others
    and puts where these do not expect them.

    Where the edge of a shadow or of a reflection runs through a corner there are two crossing
    edges, and something that draws them aside by much more than noise would.
    """
    good = fit.residual <= _MORE * np.median(fit.residual)
    if good.all():
        return ~good
    cells = np.argwhere(lattice.found)
    uv = lattice.uv.copy()
    uv[lattice.found] = fit.uv
    mask = lattice.found
    mask[mask] = good
    expected = grid_map.fit_grid_map(Lattice(uv, lattice.dark).under(mask)).at(
        cells.astype(np.float64)
    )
    off = np.linalg.norm(fit.uv - expected, axis=1)
    usual = np.sqrt(np.mean(off[good] ** 2))
    return np.asarray(~good & ~(off <= max(_ASTRAY * usual, _SLIGHTLY)))


def stepped(fit: Fit) -> bool:
    """Whether the squares are flat inside and step at their edges: waves cross likewise, only
    wider, and are not described by steps."""
    widths = np.median(fit.edges.unknowns[:, 4:6] / fit.edges.size, axis=0)
    misfit = np.median(fit.residual / fit.contrast)
    return bool(widths.max() < WIDEST and misfit < _WORST_MISFIT)


def filled(lattice: Lattice, shape: tuple[int, ...]) -> Lattice:
    """The lattice with its gaps where the neighbours expect their corners, inside the image and not
    too far from all others."""
    expected = predict(lattice.uv)
    try_here = ~lattice.found & in_image(expected, shape)
    return with_steps(Lattice(np.where(try_here[..., None], expected, lattice.uv), lattice.dark))


def ends(lattice: Lattice, image: GreyImage) -> Sides:
    """On which sides of the lattice the image shows that the board ends there.

    Where the board leaves the image, or something hides it, that is not seen.
    """
    clear = _PRESENT * typical(lattice, image).contrast
    top, right, bottom, left = (_ends_above(turned(lattice, k), image, clear) for k in range(4))
    return top, right, bottom, left


def _ends_above(lattice: Lattice, image: GreyImage, clear: float) -> bool:
    """Whether the squares above the first row are seen in full, and no others behind them.

    In front of the next line the grey levels alternate by `clear` from square to square; behind
    it they do not, as they would if corners had been missed.
    """
    uv = bordered(lattice.uv, 1)
    place = predict(uv)[0]
    right, down = (step[0] for step in axes(uv))
    usable = np.isfinite(place + right + down).all(axis=1) & in_image(place, image.shape)
    if np.count_nonzero(usable) < _LEAST:
        return False
    left_is_dark = lattice.dark ^ (np.arange(len(place)) % 2 == 0)
    sign = np.where(left_is_dark, 1.0, -1.0)[usable]
    place, right, down = place[usable], _BESIDE * right[usable], _BEFORE * down[usable]
    before = sign * _difference(image, place + down, right)
    behind = -sign * _difference(image, place - down, right)
    return bool(np.mean((before > clear) & (behind < clear)) > _MOSTLY)


def _difference(image: GreyImage, uv: Array, offset: Array) -> Array:
    """(n,) grey levels at `uv` + `offset` less those at `uv` - `offset`, (n, 2) px."""
    return sample(image, uv + offset) - sample(image, uv - offset)


def in_image(uv: Array, shape: tuple[int, ...]) -> BoolArray:
    """Which positions (..., 2) lie in an image of `shape` (h, w), a little off its border."""
    limit = np.array(shape[::-1]) - 1.0 - _EDGE
    return np.asarray(np.all((uv > _EDGE) & (uv < limit), axis=-1))
