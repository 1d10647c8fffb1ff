"""The faces of a cube as one picture, unfolded around the front."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

Grey = npt.NDArray[np.uint8]

_PLACES = {
    "top": (0, 1),
    "left": (1, 0),
    "front": (1, 1),
    "right": (1, 2),
    "back": (1, 3),
    "bottom": (2, 1),
}
"""Row and column of each face."""


def unfold_cube(faces: Mapping[str, Grey]) -> Grey:
    """Return the square faces of a cube as a cross, cut to those that there are, black between.

    Args:
        faces: (n, n) by their names, all of one size.
    """
    places = {name: _PLACES[name] for name in faces}
    first = np.min(list(places.values()), axis=0)
    rows, columns = np.max(list(places.values()), axis=0) + 1 - first
    side = len(next(iter(faces.values())))
    cross = np.zeros((rows * side, columns * side), np.uint8)
    for name, place in places.items():
        v, u = (place - first) * side
        cross[v : v + side, u : u + side] = faces[name]
    return cross
