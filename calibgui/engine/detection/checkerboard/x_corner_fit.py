"""Corners at the physical limit: the two blurred edges fitted to the pixels.

The unknowns of the model (`edge_model`), c, the edges' directions and blurs, m, a and rho, are
found by Gauss-Newton steps, all corners at once. Under point reflection about c the derivatives
by c are odd, those by all other unknowns even: they decouple, and the covariance of c is what it
would be if the rest were known, the Cramer-Rao bound

    cov c = noise^2 (sum of (grad I)(grad I)^T)^-1.

For the same reason only the odd part of what the model leaves unexplained says how well c is
known: a blur that is not Gaussian leaves an even one. So noise^2 is half the mean square
difference of opposite pixels, unless that is more than the mean square itself: in a sharp image
no two pixels are quite opposite.

What is odd too and would not decouple - curvature and the light's gradients gm, ga - comes from
the whole board (`surroundings`), as does the spread w of the ink. What tells the blurs of a
corner's edges apart is mostly the camera's: they are held near what the board shows
(`anisotropy`), lest they take up what the model leaves out.

The model lights the blurred pattern, where a camera blurs the lit one. Under light L that rises
by l = grad L / L,

    (L f) * h = L (f * h) + s^2 L l.grad (f * h) = L (f * h)(q + s^2 l)

for a blur h of variance s^2: its far side sends in more light, and the pattern seems to stand
s^2 l farther into the dark. It is put back, with l = ga / a, the relative gradient of contrast.

How much the blurs of a corner's two edges differ, from the whole board.

A camera's blur, and that of a motion, is one for the neighbourhood of every corner: with the
covariance Sigma = s^2 I + D of its spread, D symmetric and free of trace, the edge with normal n_i
is blurred by s_i^2 = s^2 + n_i^T D n_i. The size s varies with the focus over the board; the
anisotropy D is taken to be one, and is the least-squares solution of

    s_1^2 - s_2^2 = n_1^T D n_1 - n_2^T D n_2

over all corners.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calibgui.engine import kernels
from calibgui.engine.arrays import Array, GreyImage
from calibgui.engine.detection.checkerboard import edge_profiles
from calibgui.engine.detection.checkerboard.board_priors import Foreseen, Surroundings
from calibgui.engine.detection.checkerboard.x_corner_model import (
    BLUR,
    RHO,
    SHARPEST,
    THETA,
    UNKNOWNS,
    A,
    C,
    Edges,
    M,
    normal_equations,
)
from calibgui.engine.detection.lattice import Lattice

_LONGEST = 18.0
"""Longest arm that is read on a board of many corners, px."""
_ARMS = 4000.0
"""Sum of the longest arms of a board's corners, px: fewer corners may have longer ones."""
_NEAR = 9.0
"""Arm that is read for a first approximation, px."""
_LEAST_SPREAD, _MOST_SPREAD = 0.002, 0.2
"""Spreads that are told from none and that are believed, squares."""
_PAIRS = 20
"""Opposite pixels from which their differences tell the noise."""
_MOST_RHO, _RHO_SPREAD = 0.95, 0.3
"""Largest rho, and how far it is expected from that of a blur alike in all directions."""
_BLUR_SPREAD = 0.03
"""How far the difference of a corner's blurs is expected from what the board shows, blurs."""
_DAMPING = 1e-9
"""What is added to the diagonal of the normal equations, over its largest entry."""
_BLURRED = 1.5
"""How far from where a square's colour ends its blur is felt, blurs."""


@dataclass(frozen=True, eq=False, slots=True)
class Fit:
    """The edge model fitted at n corners."""

    edges: Edges
    covariance: Array
    """(n, 2, 2) of c, px^2."""
    residual: Array
    """(n,) standard deviation of what the model leaves unexplained, grey levels."""

    @property
    def uv(self) -> Array:
        """(n, 2) the corners, px."""
        return self.edges.unknowns[C]

    @property
    def blur(self) -> Array:
        """(n,) root mean square of the edges' blurs, pixel included, px."""
        return np.sqrt(np.mean(self.edges.unknowns[BLUR] ** 2, axis=1))

    @property
    def contrast(self) -> Array:
        """(n,) bright minus dark, grey levels."""
        return 2 * self.edges.unknowns[A]


def fit(
    image: GreyImage,
    lattice: Lattice,
    plain: float = 0.5,
    geometry: tuple[Array, Array] | None = None,
) -> Fit:
    """Fit the edge model at every corner of `lattice`, whose positions are the start.

    Args:
        image: (h, w) grey levels.
        lattice: the corners.
        plain: how far from their edges the squares are of one colour, squares.
        geometry: how edges run and bend where a camera that is known tells it better than the
            corners found; see ``Surroundings.geometry``.
    """
    found = lattice.found
    board = Surroundings(found) if geometry is None else Foreseen(found, geometry)
    edges = _start(image, lattice, board, plain)
    near = replace(edges, arm=np.minimum(edges.arm, _NEAR))
    first = _step(near, normal_equations(image, near, near)[0])[0]
    read = _surrounded(replace(edges, unknowns=first.unknowns), board)
    edges = _surrounded(_step(read, normal_equations(image, read, read)[0])[0], board)
    products, odd_part = normal_equations(image, read, edges, odd=True)
    edges, inverse, square = _step(edges, products)
    noise = _noise(square, odd_part)
    edges = _put_back(edges)
    return Fit(edges, noise[:, None, None] * inverse, np.sqrt(square))


def _start(image: GreyImage, lattice: Lattice, board: Surroundings, plain: float) -> Edges:
    """Parameters from the lattice and from profiles across the edges."""
    found = lattice.found
    cells = np.argwhere(found)
    n = len(cells)
    steps, curvature = board.geometry(lattice.uv[found])
    length = np.linalg.norm(steps, axis=2)
    unknowns = np.zeros((n, UNKNOWNS))
    unknowns[C] = lattice.uv[found]
    unknowns[THETA] = np.arctan2(steps[..., 1], steps[..., 0])
    edges = Edges(
        unknowns=unknowns,
        sign=np.where(lattice.dark ^ (cells.sum(axis=1) % 2 == 1), -1.0, 1.0),
        size=_heights(steps),
        arm=np.minimum(length / 2, max(_LONGEST, _ARMS / n)),
        room=plain * _heights(steps),
        curvature=curvature,
        spread=np.zeros(n),
        level_gradient=np.zeros((n, 2)),
        contrast_gradient=np.zeros((n, 2)),
        blur_gradient=np.zeros((n, 2, 2)),
        size_gradient=np.zeros((n, 2, 2)),
    )
    normals = edges.normals()
    seen = [
        edge_profiles.across_edge(
            image,
            edges.unknowns[C],
            steps[:, i],
            steps[:, 1 - i],
            edges.size[:, i],
            edges.sign,
            plain,
        )
        for i in (0, 1)
    ]
    low, high = (
        np.mean([getattr(side, name) for side in seen], axis=0) for name in ("low", "high")
    )
    blur = np.median([side.blur for side in seen], axis=1)
    unknowns[BLUR] = np.clip(blur, SHARPEST, edges.size / 4)
    unknowns[M], unknowns[A] = (high + low) / 2, (high - low) / 2
    unknowns[RHO] = np.sum(normals[:, 0] * normals[:, 1], axis=1)
    if plain < 0.5:  # what lies beyond is blurred into the room
        room = edges.room
        edges = replace(edges, room=np.maximum(room - _BLURRED * unknowns[BLUR], room / 2))
    spreads = np.column_stack([side.spread for side in seen])
    return replace(edges, spread=_common_spread(spreads))


def _common_spread(seen: Array) -> Array:
    """(n,) the board's spread from what every edge (n, 2) shows, 0 unless it is clear."""
    known = seen[np.isfinite(seen)]
    if len(known) < len(seen):  # fewer than half of the edges
        return np.zeros(len(seen))
    middle = float(np.median(known))
    error = 1.5 * float(np.median(abs(known - middle))) / np.sqrt(len(known) / 2)
    clear = _MOST_SPREAD > abs(middle) > max(3 * error, _LEAST_SPREAD)
    return np.full(len(seen), middle if clear else 0.0)


def _surrounded(edges: Edges, board: Surroundings) -> Edges:
    """`edges` with geometry and gradients as their positions, levels and blurs now say."""
    x = edges.unknowns
    steps, curvature = board.geometry(x[C])
    size = _heights(steps)
    gradients = board.gradients(steps, np.column_stack([x[M], x[A], x[BLUR], size]))
    # The edge at a fraction w of a square stands w S + w^2 S' / 2 away where the squares' height S
    # varies: w times the height half-way to it.
    normals, by_size = edges.normals(), gradients[:, 4:6]
    across = np.sum(normals * by_size, axis=2, keepdims=True)
    return replace(
        edges,
        size=size,
        curvature=curvature,
        level_gradient=gradients[:, 0],
        contrast_gradient=gradients[:, 1],
        blur_gradient=gradients[:, 2:4],
        size_gradient=by_size - normals * across / 2,
    )


def _heights(steps: Array) -> Array:
    """(n, 2) heights of a square over edges 1 and 2, from the `steps` (n, 2, 2) along them."""
    return np.asarray(abs(np.linalg.det(steps))[:, None] / np.linalg.norm(steps, axis=2))


def _step(edges: Edges, products: Array) -> tuple[Edges, Array, Array]:
    """The model after one Gauss-Newton step, the part (n, 2, 2) of the equations' inverse for c,
    and the mean square (n,) of what is left unexplained."""
    N, g = products[:, :UNKNOWNS, :UNKNOWNS], products[:, :UNKNOWNS, UNKNOWNS]
    _expect(edges, products)
    step, inverse = (_compiled_solved if kernels.COMPILED else _solved)(N, g)
    square = np.maximum(products[:, UNKNOWNS, UNKNOWNS] - np.sum(step * g, axis=1), 0.0)
    count = N[:, 6, 6]  # each pixel's derivative by m is 1
    square /= np.maximum(count - UNKNOWNS, 1)
    unknowns = edges.unknowns + _bounded(step, edges.unknowns)
    return replace(edges, unknowns=unknowns), inverse, square


def _expect(edges: Edges, products: Array) -> None:
    """Add to the `products` what is expected of rho and of the blurs' difference."""
    N, g = products[:, :UNKNOWNS, :UNKNOWNS], products[:, :UNKNOWNS, UNKNOWNS]
    normals, blurs = edges.normals(), edges.unknowns[BLUR]
    square = products[:, UNKNOWNS, UNKNOWNS] / N[:, 6, 6]
    # In a sharp image few pixels know rho: it stays near that of a blur alike in all directions.
    weight = square / _RHO_SPREAD**2
    N[:, 8, 8] += weight
    g[:, 8] += weight * (np.sum(normals[:, 0] * normals[:, 1], axis=1) - edges.unknowns[RHO])
    difference = np.array([1.0, -1.0])  # by the blurs
    weight = np.median(square) / (_BLUR_SPREAD**2 * np.mean(blurs**2, axis=1))
    N[:, 4:6, 4:6] += weight[:, None, None] * np.outer(difference, difference)
    lack = common_blur_difference(normals, blurs) - blurs @ difference
    g[BLUR] += (weight * lack)[:, None] * difference


def _put_back(edges: Edges) -> Edges:
    """`edges` with their corners back from where light and blur have moved them."""
    unknowns = edges.unknowns.copy()
    variance = np.mean(unknowns[BLUR] ** 2, axis=1)
    unknowns[C] += (variance / unknowns[A])[:, None] * edges.contrast_gradient
    return replace(edges, unknowns=unknowns)


def _noise(square: Array, odd_part: Array) -> Array:
    """(n,) noise^2 from the mean square (n,) of what is left unexplained and from its odd part."""
    total, pairs = odd_part.T
    noise = np.where(pairs > _PAIRS, total / np.maximum(pairs - 2, 1), square)
    return square if np.median(noise) > np.median(square) else noise


def _solved(N: Array, g: Array) -> tuple[Array, Array]:
    """N^-1 g (n, 9) of the normal equations N (n, 9, 9), and the part (n, 2, 2) of N^-1 for c."""
    largest = np.einsum("nkk->nk", N).max(axis=1) + 1e-300
    inverse = np.linalg.inv(N + _DAMPING * largest[:, None, None] * np.eye(UNKNOWNS))
    return np.einsum("nij,nj->ni", inverse, g), inverse[:, :2, :2]


def _compiled_solved(N: Array, g: Array) -> tuple[Array, Array]:
    """`_solved` by the compiled kernel."""
    from calibgui.engine.kernels import x_corner_fit

    return x_corner_fit.solved(N, g, _DAMPING)


def _bounded(step: Array, x: Array) -> Array:
    """A Gauss-Newton step (n, 9) kept where the linear model may hold."""
    bounded = np.array(step)
    bounded[C] = np.clip(step[C], -1.0, 1.0)
    bounded[THETA] = np.clip(step[THETA], -0.1, 0.1)
    s, rho = x[BLUR], x[RHO]
    bounded[BLUR] = np.clip(step[BLUR], np.maximum(-s / 3, SHARPEST - s), s / 2)
    bounded[RHO] = np.clip(step[RHO], -_MOST_RHO - rho, _MOST_RHO - rho)
    return bounded


def common_blur_difference(normals: Array, blurs: Array) -> Array:
    """(n,) the difference s_1 - s_2 that the corners of a board have in common, px.

    Args:
        normals: (n, 2, 2) unit normals n_1, n_2 of the edges.
        blurs: (n, 2) s_1, s_2 as they were measured, px.
    """
    x, y = np.moveaxis(normals, -1, 0)
    # n^T D n = D_uu (x^2 - y^2) + 2 D_uv x y
    by_edge = np.stack([x**2 - y**2, 2 * x * y], axis=-1)
    by_corner = by_edge[:, 0] - by_edge[:, 1]
    squares = blurs[:, 0] ** 2 - blurs[:, 1] ** 2
    D = np.linalg.lstsq(by_corner, squares)[0]
    return np.asarray(by_corner @ D / blurs.sum(axis=1))
