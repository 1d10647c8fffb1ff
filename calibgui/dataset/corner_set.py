"""corners.json: located corners with their places on the plate, from this or any program.

    {"size": [w, h], "views": [{"image", "uv": [[u, v], ...], "board": [[x, y], ...], "cov"}]}

Reader: `read_corners`, and any JSON reader. Positions are pixels in the array frame (0-based,
integer at pixel centres, v down), `board` millimetres on the plate, `cov` (optional) 2 x 2
covariances in px^2. This program adds the board as `target` (``pattern_json.py``) and per view
what ``views_json.py`` lists; a reader may ignore all of it. Views without corners have empty lists.
Cannot hold: a calibration (see ``result_json.py``).
"""

from __future__ import annotations

from dataclasses import dataclass

from calibgui.dataset.view import View
from calibgui.engine.arrays import Size
from calibgui.engine.boards import Board


@dataclass(frozen=True, eq=False, slots=True)
class CornerSet:
    """Views of one camera and the board that they show."""

    size: Size
    """Of the images, px."""
    views: tuple[View, ...]
    board: Board | None = None
    """The board, where the corners are of one of known layout."""
