"""Corners in files of rows, one a corner, and what all such formats leave to the user to state."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

import numpy as np

from calibgui.dataset import DEFAULT_SQUARE, CornerSet, View, ViewStatus
from calibgui.engine.arrays import Array, GridSize, IntArray, Size
from calibgui.engine.boards import Board
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import Corners
from calibgui.engine.images import read_image_size

_NO_CORNERS = "The file holds no corners of it."


@dataclass(frozen=True, slots=True)
class CornerText:
    """The text of a file of corners, and what the user said about it."""

    text: str
    file: str
    """Name of the file, for messages."""
    grid_size: GridSize | None = None
    """Rows and columns of the board as stated by the user."""
    size: Size | None = None
    """Width and height of the images as stated by the user, px."""

    def fail(self, fault: str, hint: str) -> NoReturn:
        """Raise a CalibrationError that names the file, its fault and the remedy."""
        raise CalibrationError(f"{self.file} {fault}", hint)

    def find_size(self, images: Iterable[str]) -> Size:
        """Return the images' width and height, px, as stated, or else of the first that is found.

        Raises:
            CalibrationError: if it is neither stated nor any of the images found.
        """
        if self.size is not None:
            return self.size
        folder = Path(self.file).parent
        places = (
            place
            for image in images
            for place in (folder / image, Path(image), folder / Path(image).name)
        )
        found = next((place for place in places if place.is_file()), None)
        if found is None:
            self.fail(
                "does not say how large its images are, and none of them is found.",
                "State their width and height in px, as --size 1280x720, or put one of them beside "
                "the file.",
            )
        return read_image_size(found)

    def check_stated(self, corner_set: CornerSet) -> None:
        """Raise a CalibrationError if the user has stated something else than the file says."""
        board = corner_set.board
        if self.size not in (None, corner_set.size):
            width, height = corner_set.size
            self.fail(f"is for images of {width} x {height} px.", "Leave the size out.")
        if self.grid_size not in (None, board and board.grid_size):
            self.fail("says itself where the corners are on the board.", "Leave --board out.")


def make_view(
    image: str, board: Board, grid: IntArray, uv: Array, cov: Array | None = None
) -> View:
    """Return the view of an image with the corners at rows and columns (n, 2) of a board, or with
    the reason that there are none."""
    if not len(uv):
        return View(image, ViewStatus.NO_BOARD, _NO_CORNERS)
    corners = Corners(board.grid_size, grid, uv, estimate=uv, cov=cov)
    return View(image, ViewStatus.FOUND, corners=corners)


def make_board(grid_size: GridSize) -> Board:
    """Return a board of squares whose side nobody has stated yet."""
    return Board(*grid_size, DEFAULT_SQUARE)


def scale_unit(variances: Array) -> Array:
    """Return covariances (n, 2, 2) of the same variances (n,) along both axes."""
    return variances[:, None, None] * np.eye(2)
