"""How long does it take to see that there is no board, over the time that one takes to find?

    python -m tests.benchmarks.refusals [--size vga|12mp] [--targets NAME ...] [--all]

draws pictures without a board, or with one of another kind, searches each for every kind of board,
and for one that is stated with its rows and columns and all that is printed, and prints the time of
the processor over that of finding it in an easy picture of the same size. The worst stand last.
Pictures in which such a board is found are left out: a drawing of another kind may contain one.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable, Iterator
from typing import NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cv2
import numpy as np
from numpy.typing import NDArray

from calibgui.engine.arrays import GridSize
from calibgui.engine.boards.board import Board
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.boards.tagged_checkerboard import TaggedCheckerboard
from calibgui.engine.detection.find_corners import find_corners
from calibgui.engine.errors import NoBoardError
from tests.benchmarks.board_readers import BOARDS
from tests.scenes.perspective import photograph_pattern
from tests.scenes.without_board import KINDS as TEXTURES
from tests.scenes.without_board import draw_foliage, draw_without_board

Image = NDArray[np.uint8]
Size = tuple[int, int]
Search = Callable[[Image], bool]
_SIZES: dict[str, Size] = {"vga": (640, 480), "12mp": (4000, 3000)}
_BOARDS: dict[str, Board] = {
    name: board for name, board in BOARDS.items() if name != "bare-aprilgrid"
} | {"tagged-checkerboard": Board(8, 10, 20.0, TaggedCheckerboard("t36h11", 1, 2, from_top=True))}
"""The boards by the names of their kinds."""
_SHARE, _BLURS = 0.7, {"vga": 0.8, "12mp": 1.2}
"""Part of the picture that an easy board takes, and its blur, px."""
_STRONG_BLUR = 0.02
"""Blur at which no board can be found, widths of the picture: a third of a square."""
_BLURRED_SIZE = (640, 480)
"""Size at which pictures are blurred so much, px."""
_TEXTURES = 54
"""Number of VGA pictures without a board, six of each kind."""
_GRAINS = (1.0, 2.5, 6.25)
"""Sizes of what pictures of 12 MP show, over those in VGA: as fine, between, and as large."""
_MAX_RATIO = 5.0
"""Greatest time of a refusal over that of a found board: the project's goal."""
_SHOWN = 12
"""Number of refusals of a target that are shown."""
_ROUNDS = 3
"""Number of times that a picture is searched, if the first takes long: the least counts."""


class Refusal(NamedTuple):
    """A picture in which no board was found."""

    ratio: float
    """Time over that of a found board."""
    ms: float
    target: str
    """Kind of the board, and whether all of it is stated."""
    picture: str


def draw_boards(size_name: str) -> dict[str, Image]:
    """Draw an easy board of each kind."""
    size, blur = _SIZES[size_name], _BLURS[size_name]
    return {name: photograph_pattern(size, board, _SHARE, blur) for name, board in _BOARDS.items()}


def list_pictures(size_name: str, boards: dict[str, Image]) -> Iterator[tuple[str, Image]]:
    """List pictures that hold no board that can be found, or one kind of board only."""
    size = _SIZES[size_name]
    shape = size[::-1]
    yield from boards.items()
    for name in ("checkerboard", "aprilgrid", "circles"):
        small = cv2.resize(boards[name], _BLURRED_SIZE, interpolation=cv2.INTER_AREA)
        blurred = cv2.GaussianBlur(small, (0, 0), _STRONG_BLUR * _BLURRED_SIZE[0])
        yield f"{name}, out of focus", cv2.resize(blurred, size, interpolation=cv2.INTER_CUBIC)
    yield "foliage", draw_foliage(0, shape)
    yield "plain", np.full(shape, 127, np.uint8)
    if size_name == "vga":
        for seed in range(_TEXTURES):
            yield f"{TEXTURES[seed % len(TEXTURES)]} {seed}", draw_without_board(seed)
        return
    for kind, name in enumerate(TEXTURES):
        for i, grain in enumerate(_GRAINS if name != "noise" else (1.0,)):
            seed = kind + len(TEXTURES) * i
            yield f"{name} {seed} x{grain:g}", draw_without_board(seed, shape, grain)


def list_searches(kinds: list[str]) -> Iterator[tuple[str, str, Search]]:
    """List the searches for boards: what each is for, the board's kind, and a function that tells
    whether an image shows it."""
    for kind in kinds:
        board = _BOARDS[kind]
        yield kind, kind, search_for(KINDS[kind], None)
        yield f"{kind}, stated", kind, search_for(board.pattern, board.grid_size)


def search_for(pattern: Pattern, grid_size: GridSize | None) -> Search:
    """Return a function that tells whether an image shows a board."""

    def search(image: Image) -> bool:
        try:
            find_corners(image, grid_size, pattern=pattern)
        except NoBoardError:
            return False
        return True

    return search


def measure(search: Search, image: Image, enough: float) -> tuple[float, bool]:
    """Measure the least time of a search in s, which is taken once if that is below `enough`, and
    whether it found a board."""
    least, found = np.inf, False
    for _ in range(_ROUNDS):
        start = time.process_time()
        found = search(image)
        least = min(least, time.process_time() - start)
        if least < enough:
            break
    return least, found


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--size", choices=list(_SIZES), help="of the pictures; both if not given")
    parser.add_argument("--targets", nargs="+", choices=list(_BOARDS), default=list(_BOARDS))
    parser.add_argument("--all", action="store_true", help="print all pictures, not the worst only")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    for size_name in [options.size] if options.size else _SIZES:
        boards = draw_boards(size_name)
        searches: dict[str, Search] = {}
        easy: dict[str, float] = {}
        for name, kind, search in list_searches(options.targets):
            assert search(boards[kind]), name  # compiles, and draws dictionaries
            searches[name] = search
            easy[name], _ = measure(search, boards[kind], 0.0)
        refusals: list[Refusal] = []
        for picture, image in list_pictures(size_name, boards):
            for name, search in searches.items():
                seconds, found = measure(search, image, easy[name] * _MAX_RATIO / 2)
                if not found:
                    ratio = seconds / easy[name]
                    refusals.append(Refusal(ratio, 1e3 * seconds, name, picture))
        refusals.sort()
        print(f"{size_name}: found in ms: ", end="")
        print(", ".join(f"{name} {1e3 * s:.1f}" for name, s in easy.items()))
        for each in refusals if options.all else refusals[-_SHOWN * len(searches) :]:
            print(f"{each.ratio:8.2f}{each.ms:9.1f} ms  {each.target:28} in {each.picture}")
        for name in searches:
            ratios = [each.ratio for each in refusals if each.target == name]
            print(f"{name:28} refused {len(ratios):3d}", end="")
            print(f"  median {np.median(ratios):6.2f}  worst {max(ratios):6.2f}")


if __name__ == "__main__":
    main()
