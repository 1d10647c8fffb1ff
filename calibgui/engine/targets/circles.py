"""Grids of circles, symmetric and asymmetric.

The grid is found among all parts that may be discs (``blobs.py``, ``dots.py``), coarsely and whole
or not at all. Every circle's ellipse is then fitted to the pixels of its edge (``ellipses.py``),
and the image of the circle's centre follows from the ellipse's (``plate_map.py``), for the diameter
that the ellipses show.

In a symmetric grid of M x N circles the one in row m, column n is at X = n, Y = m. In an asymmetric
one every second row is shifted by half: X = 2 n + m mod 2, Y = m; its pitch is the distance of the
rows, which is half the distance of neighbours in a row.

Circles have no colours to tell their corners apart. A symmetric grid is the same after half a turn,
and after a quarter if M = N. Half a turn of an asymmetric one takes row m to M - 1 - m and X to
2 N - 1 - X, which is the same grid if M is even; if M is odd its origin is unique. Reflections
are excluded: numbering is right-handed in the image. Among origins that cannot be told apart
the one that makes the grid upright is taken, or that nearest to the first of the marked points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.corners import roi as region
from calibgui.engine.corners.extract import grey_levels
from calibgui.engine.corners.located import rejections
from calibgui.engine.errors import CalibrationError, NoBoardError
from calibgui.engine.images import stretched
from calibgui.engine.opencv import Image
from calibgui.engine.targets import ellipses
from calibgui.engine.targets.blobs import blobs
from calibgui.engine.targets.dots import arranged
from calibgui.engine.targets.ellipses import Ellipses
from calibgui.engine.targets.ink import Discs, Ink
from calibgui.engine.targets.pattern import Pattern
from calibgui.engine.targets.plate_map import plate_map
from calibgui.engine.types import Ambiguity, Array, Board, BoolArray, Corners

_COARSE = 1200
"""Longer side of the image in which the grid is looked for first, px."""
_WINDOWS = (4, 16)
"""Of which part of the image's shorter side ink must be darker than the mean."""
_MOST = 400
"""Parts that are looked at where the number of circles is not known."""
_TURNS = 3
"""How often the map and the centres are found from each other."""
_DIFFERENT = 0.05
"""Difference of the diameter from the stated one that is no error of print, pitches."""
_MISPLACED = 0.1
"""Farthest that a circle may be from where the others expect it, pitches."""
_MISSHAPEN = 0.2
"""Greatest difference of an ellipse from what the others expect, over its size."""
_WEAKEST = 0.3
"""Least contrast over the median."""
_MISFIT = 0.12
"""Greatest residual over the contrast, or ..."""
_UNEXPLAINED = 4.0
"""... over the median residual."""
_FAILING = 0.25
"""Share of circles that may fail before the grid does."""


@dataclass(frozen=True, slots=True)
class Circles:
    """A grid of circles; their diameter is measured in the images if it is None."""

    asymmetric: bool = False
    diameter: float | None = None
    """Over the pitch."""

    def __post_init__(self) -> None:
        if self.diameter is not None and not 0 < self.diameter < 2 * self.reach:
            raise CalibrationError(
                f"Circles of {self.diameter:.2f} of their distance would touch.",
                f"It must be below {2 * self.reach:.2f}: state diameter and distance in mm.",
            )

    @property
    def kind(self) -> str:
        return "asymmetric-circles" if self.asymmetric else "circles"

    @property
    def identified(self) -> bool:
        return False

    @property
    def squared(self) -> bool:
        return False

    @property
    def reach(self) -> float:
        """Half the distance of neighbours, pitches."""
        return 0.5**0.5 if self.asymmetric else 0.5

    def places(self, grid: Array) -> Array:
        """See ``Pattern``."""
        row, col = grid[:, 0], grid[:, 1]
        return np.column_stack([2 * col + row % 2 if self.asymmetric else col, row])

    def ambiguity(self, board: Board) -> Ambiguity:
        """See ``Pattern``."""
        rows, cols = board
        if self.asymmetric:
            return Ambiguity.NONE if rows % 2 else Ambiguity.HALF_TURN
        return Ambiguity.QUARTER_TURN if rows == cols else Ambiguity.HALF_TURN

    def completed(self, seen: Sequence[Pattern]) -> Circles:
        """See ``Pattern``."""
        diameters = [one.diameter for one in seen if isinstance(one, Circles) and one.diameter]
        if self.diameter is not None or not diameters:
            return self
        return Circles(self.asymmetric, round(float(np.median(diameters)), 4))

    def ink(self, board: Board) -> Ink:
        """See ``Pattern``."""
        if self.diameter is None:
            raise CalibrationError("The circles' diameter is not known.", "State it.")
        centres = self.places(_grid(board).astype(np.float64))
        right, bottom = (centres.max(axis=0) + 1).tolist()
        return Discs(centres, self.diameter / 2, (-1.0, -1.0, right, bottom))

    def find(
        self,
        image: Image,
        board: Board | None,
        roi: Array | None = None,
        method: str = "edges",  # noqa: ARG002 - circles have but one
    ) -> Corners:
        """See ``Pattern``."""
        grey = grey_levels(image)
        outline = None if roi is None else region.outline(roi)
        coarse = self._found(stretched(grey), board, outline)
        board = coarse.shape[0], coarse.shape[1]
        grid = _grid(board)
        xy = self.places(grid.astype(np.float64))
        first = self._numbered(coarse, xy, outline)
        start = plate_map(xy, first)
        beside = np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)])
        if not self.asymmetric:
            beside = np.array([(0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)])
        fit = ellipses.fit(grey, first, start.jacobian(xy), self.reach, beside)
        good, uv, radius = _verified(fit, xy, grey)
        if self.diameter is not None and abs(2 * radius - self.diameter) > _DIFFERENT:
            raise NoBoardError(
                f"The circles measure {2 * radius:.2f} of their distance, not {self.diameter:.2f}.",
                "State diameter and distance as measured, or leave the diameter out.",
            )
        whole = uv.reshape(*board, 2)
        return Corners(
            shape=board,
            grid=grid[good],
            uv=uv[good],
            estimate=first[good],
            cov=fit.covariance[good],
            ambiguity=self.ambiguity(board),
            roi=whole[[0, 0, -1, -1], [0, -1, -1, 0]] if outline is None else outline,
            method="ellipses",
            blur=fit.blur[good],
            contrast=fit.contrast[good],
            residual=fit.residual[good],
            rejected=tuple(rejections(fit.uv[~good], "not the image of a circle there")),
            pattern=Circles(self.asymmetric, 2 * radius),
        )

    def _found(self, image: Image, board: Board | None, outline: Array | None) -> Array:
        """(rows, cols, 2) px, the circles' centres, coarsely, in an 8-bit image (h, w)."""
        left, top = 0, 0
        if outline is not None:
            marked = region.enlarged(outline)
            left, top = np.maximum(np.floor(marked.min(axis=0)), 0).astype(int)
            right, bottom = np.ceil(marked.max(axis=0)).astype(int)
            image = image[top : bottom + 1, left : right + 1]
        levels = [image]
        while max(levels[-1].shape) > _COARSE:
            levels.append(opencv.half(levels[-1]))
        most = _MOST if board is None else 2 * board[0] * board[1] + 60
        largest = np.zeros((0, 0, 2))
        for depth in reversed(range(len(levels))):
            for seen in (levels[depth], 255 - levels[depth]):
                for part in _WINDOWS:
                    points = blobs(seen, max(int(min(seen.shape) / part), 9), most)
                    grid = arranged(points, board, asymmetric=self.asymmetric)
                    if grid is None or (grid.shape != board and 2 * grid.size <= largest.size):
                        continue
                    largest = (points[grid] + 0.5) * 2**depth - 0.5 + [left, top]
                    if grid.shape == board:
                        return largest
        if board is None and largest.size:
            return largest
        which = "" if board is None else f"{board[0]} x {board[1]} "
        instead = ", but one of {} x {}".format(*largest.shape) if largest.size else ""
        raise NoBoardError(
            f"No grid of {which}circles was found{instead}.",
            "All of it must be in view, sharp and evenly lit, with white around it."
            + (" Check the numbers of rows and columns." if board else ""),
        )

    def _numbered(self, dense: Array, xy: Array, outline: Array | None) -> Array:
        """The centres (rows, cols, 2) as the pattern counts them, for each of its places (n, 2)."""
        ways = [dense, dense[::-1], dense[:, ::-1], dense[::-1, ::-1]]
        if dense.shape[0] == dense.shape[1] and not self.asymmetric:
            ways += [way.transpose(1, 0, 2) for way in ways]
        rated = []
        for way in ways:
            flat = way.reshape(-1, 2)
            through = plate_map(xy, flat)
            J = through.jacobian(xy)
            if not (np.isfinite(J).all() and (np.linalg.det(J) > 0).all()):
                continue
            off = float(np.sqrt(np.mean((through.at(xy) - flat) ** 2)))
            right = J[..., 0].mean(axis=0)
            start = 0.0 if outline is None else float(np.linalg.norm(way[0, 0] - outline[0]))
            rated.append((off, start, -right[0] / np.linalg.norm(right), flat))
        if not rated:
            raise _untrusted()
        least = min(rate[0] for rate in rated)
        same = [rate for rate in rated if rate[0] < 2 * least + 0.1]
        return min(same, key=lambda rate: (rate[1], round(rate[2], 6)))[3]


def _grid(board: Board) -> np.ndarray:
    return np.indices(board).reshape(2, -1).T


def _verified(fit: Ellipses, xy: Array, image: Image) -> tuple[BoolArray, Array, float]:
    """Which circles pass, the images of their centres (n, 2) px, and their radius, pitches.

    Every ellipse must lie inside the image, be what a circle of the common radius looks like there,
    where the others expect it, with a contrast like theirs and no more unexplained.
    """
    if not (np.isfinite(fit.unknowns).all() and np.isfinite(fit.covariance).all()):
        raise _untrusted()
    half = np.sqrt(np.einsum("nii->ni", fit.spread)) + fit.blur[:, None]
    good = ((fit.uv > half) & (fit.uv + half < np.array(image.shape[::-1]) - 1)).all(axis=1)
    contrast, residual = fit.contrast, fit.residual
    sign = np.sign(np.median(fit.unknowns[:, 7]))
    good &= (sign * fit.unknowns[:, 7] > 0) & (contrast > _WEAKEST * np.median(contrast))
    good &= residual < np.maximum(_UNEXPLAINED * np.median(residual), _MISFIT * contrast)
    uv = fit.uv
    for _ in range(_TURNS):
        # What fails is not to bend the map for the others.
        if np.count_nonzero(~good) > _FAILING * len(good):
            raise _untrusted()
        through = plate_map(xy[good], uv[good])
        J = through.jacobian(xy)
        spread = np.linalg.solve(J, np.linalg.solve(J, fit.spread).transpose(0, 2, 1))
        radii2 = np.sqrt(np.maximum(np.linalg.det(spread), 0.0))
        radius = float(np.sqrt(np.median(radii2[good])))
        uv = fit.uv - through.bias(xy, radius)
        off = np.linalg.solve(J, (uv - through.at(xy))[..., None])[..., 0]
        shape = np.abs(spread / radius**2 - np.eye(2)).max(axis=(1, 2))
        good = good & (np.linalg.norm(off, axis=1) < _MISPLACED) & (shape < _MISSHAPEN)
    enough = np.count_nonzero(~good) <= _FAILING * len(good)
    if not enough or np.median(residual / contrast) > _MISFIT:
        raise _untrusted()
    return good, uv, radius


def _untrusted() -> NoBoardError:
    return NoBoardError(
        "What looks like a grid of circles is not regular enough to be trusted.",
        "Take the picture again, sharp and evenly lit, or leave it out.",
    )
