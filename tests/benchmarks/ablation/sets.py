"""The pictures that the ablation searches, by kind of board, kept on disk once they are drawn.

Rendered boards with their truth: checkerboards under every trouble, every condition of the corner
benchmark, few corners with large squares, boards that the image cuts or something covers, fisheyes
and 12 megapixels; boards of other kinds under the conditions of their benchmark, in shadows and in
trouble. Photographs of the real sets, and pictures without a board.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from calibgui.engine.arrays import GridSize
from calibgui.engine.boards.april_grid import AprilGrid
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.circle_grid import Circles
from calibgui.engine.boards.pattern import Pattern
from calibgui.engine.images.reading import read_image
from tests.benchmarks import board_readers, boards, corner_partial, corner_unseen, corners
from tests.benchmarks.board_readers import BOARDS
from tests.conftest import find_data_dir
from tests.scenes.boards_in_trouble import (
    BEFORE_TEXTURE,
    BOARD_TROUBLES,
    photograph_in_trouble,
)
from tests.scenes.checkerboards import draw
from tests.scenes.conditions import Conditions
from tests.scenes.perspective import photograph_pattern
from tests.scenes.photograph import vary
from tests.scenes.shadows import cast_shadow
from tests.scenes.troubles import TROUBLES
from tests.scenes.without_board import draw_foliage, draw_without_board

Array = NDArray[np.float64]
Pictures = Iterator["Picture"]
RENDERED, REAL, WITHOUT = "rendered", "real", "without"
"""The groups of pictures."""
_VARIANTS = 3
"""Number of photographs of every trouble and, of other kinds, of every condition."""
_UNSEEN = 24
"""Number of conditions drawn at random."""
_MAX_WIDTH = 4000
"""Width of the largest of these, px."""
_WITHOUT = {"checkerboard": 190}
"""Number of pictures without a board; of other kinds `_WITHOUT_OTHERS`."""
_WITHOUT_OTHERS = 45
_FOLIAGE = 10
"""Number of pictures of foliage, for every kind half of it."""
_LARGE = (4000, 3000)
_FRAMES = 8
"""Number of frames that are taken of each video."""
_SHADOWS = ((0.5, 4.0), (0.8, 1.0))
"""Depth, and penumbra in px, of the shadows over boards of other kinds."""
_IN_TROUBLE = 20
"""Number of photographs of each trouble of boards of other kinds."""
_STATED: dict[str, Pattern] = {
    "checkerboard": CHECKERBOARD,
    "charuco": Charuco(),
    "aprilgrid": AprilGrid(),
    "bare-aprilgrid": AprilGrid(),
    "circles": Circles(),
    "asymmetric-circles": Circles(asymmetric=True),
}
"""What is stated of boards; of others all that is printed."""
_MODULES = (boards, board_readers, corners, corner_partial, corner_unseen)
_SOURCES = [Path(__file__), *(Path(str(module.__file__)) for module in _MODULES)]
"""Files that say, beside the renderers, what is drawn."""
KINDS = {
    "checkerboard": ("checkerboard",),
    "charuco": ("charuco",),
    "aprilgrid": ("aprilgrid", "bare-aprilgrid"),
    "puzzleboard": ("puzzleboard",),
    "circles": ("circles", "asymmetric-circles"),
}
"""The kinds of boards, and the boards that are drawn of each."""


@dataclass(frozen=True, eq=False)
class Picture:
    """An image that is searched."""

    name: str
    group: str
    image: NDArray[Any]
    pattern: Pattern
    grid_size: GridSize | None = None
    """What is stated of it."""
    boards: tuple[Array, ...] = ()
    """(rows, cols, 2) px, the true corners of each board; none where they are not known."""
    seen: NDArray[np.bool_] | None = None
    """(rows, cols) the corners of the first board that are to be found."""
    bound: Array | None = None
    """(rows, cols, 2, 2) px^2, the Cramer-Rao bound of the first board's corners."""


def load_pictures(kind: str, seed: int, cache: Path) -> list[Picture]:
    """Load the pictures of a kind of board from a folder, or draw them and keep them there.

    Args:
        kind: one of `KINDS`.
        seed: the first of the random ones.
        cache: the folder. What it holds is drawn again when the renderers change, but for what
            they import: the product may move.
    """
    digest = hashlib.sha256()
    for source in [*_SOURCES, *sorted(Path(__file__).parents[2].glob("scenes/*.py"))]:
        lines = source.read_text(encoding="utf-8").splitlines()
        digest.update("\n".join(line for line in lines if "import" not in line).encode())
    file = cache / f"{kind}-{seed}-{digest.hexdigest()[:12]}.pickle"
    if not file.is_file():
        pictures = list(draw_pictures(kind, seed))
        assert len({picture.name for picture in pictures}) == len(pictures)
        cache.mkdir(parents=True, exist_ok=True)
        draft = file.with_suffix(".draft")
        draft.write_bytes(pickle.dumps(pictures, protocol=5))
        draft.replace(file)
    loaded: list[Picture] = pickle.loads(file.read_bytes())
    return loaded


def draw_pictures(kind: str, seed: int) -> Pictures:
    """Draw, or read, all pictures of a kind of board."""
    if kind == "checkerboard":
        yield from _draw_troubles(seed)
        yield from _draw_conditions(seed)
    else:
        for board in KINDS[kind]:
            yield from _draw_boards(board, seed)
    yield from _read_real(kind)
    stated = _STATED.get(kind, BOARDS[kind].pattern)
    for k in range(_WITHOUT.get(kind, _WITHOUT_OTHERS)):
        yield Picture(f"without/{seed + k}", WITHOUT, draw_without_board(seed + k), stated)
    for k in range(_FOLIAGE if kind in _WITHOUT else _FOLIAGE // 2):
        yield Picture(f"foliage/{seed + k}", WITHOUT, draw_foliage(seed + k), stated)


def _draw_troubles(seed: int) -> Pictures:
    """Draw checkerboards under every trouble."""
    for name, trouble in TROUBLES.items():
        for k in range(seed, seed + _VARIANTS):
            shot = trouble(k)
            seen = None if shot.hidden is None else ~shot.hidden
            yield Picture(
                f"{name}/{k}", RENDERED, shot.image, CHECKERBOARD, None, shot.boards, seen
            )


def _draw_conditions(seed: int) -> Pictures:
    """Draw checkerboards under the conditions of the corner benchmark."""
    large = {"size": _LARGE, "blur": 1.2, "parts": 2}
    cut = {"parts": 2, "shift": 300.0}
    chosen = {f"under {name}": Conditions(**each) for name, each in corners.CONDITIONS.items()}
    chosen |= {f"12 MP {name}": Conditions(**large, **each) for name, each in corners.LARGE.items()}
    chosen |= {name: Conditions(**each) for name, each in corners.SMALL.items()}
    chosen |= {f"cut {name}": Conditions(**cut, **each) for name, each in corners.CUT.items()}
    chosen |= {f"part {name}": vary(seed, **each) for name, each in corner_partial.KINDS.items()}
    unseen = {k: corner_unseen.conditions(seed + k) for k in range(_UNSEEN)}
    chosen |= {f"unseen {k}": each for k, each in unseen.items() if each.size[0] <= _MAX_WIDTH}
    for name, conditions in chosen.items():
        scene = draw(conditions, seed, with_bound=True)
        image, uv = scene.photograph(seed), (scene.uv,)
        yield Picture(
            f"{name}/{seed}", RENDERED, image, CHECKERBOARD, None, uv, scene.visible, scene.bound
        )


def _draw_boards(kind: str, seed: int) -> Pictures:
    """Draw boards of another kind under the conditions of their benchmark, in shadows and in
    trouble, and one in 12 megapixels, whose corners are not known."""
    board = BOARDS[kind]
    stated = _STATED.get(kind, board.pattern)
    size = board.grid_size
    for name, conditions in boards.CONDITIONS.items():
        if "circles" in kind and conditions.aside:
            continue  # a part of a grid of circles has no numbers
        for k in range(seed, seed + _VARIANTS):
            shot = boards.photograph(board, conditions, k)
            truth = (shot.truth,)
            yield Picture(
                f"{kind} {name}/{k}",
                RENDERED,
                shot.image,
                stated,
                size,
                truth,
                shot.in_view,
                shot.bound,
            )
    for depth, penumbra in _SHADOWS:
        for k in range(seed, seed + _VARIANTS):
            shade = cast_shadow(board, k, depth, penumbra)
            name = f"{kind} shadow {depth}/{k}"
            yield Picture(name, RENDERED, shade.image, stated, size, shade.boards)
    for trouble in BOARD_TROUBLES if "circles" not in kind else ():  # these have no numbers
        known = None if trouble == BEFORE_TEXTURE else size
        for k in range(seed, seed + _IN_TROUBLE):
            hard = photograph_in_trouble(board, k, trouble)
            assert hard.hidden is not None
            name = f"{kind} {trouble}/{k}"
            yield Picture(name, RENDERED, hard.image, stated, known, hard.boards, ~hard.hidden)
    image = photograph_pattern(_LARGE, board, 0.7, 1.2)
    yield Picture(f"{kind} 12 MP", REAL, image, stated, size)


def _read_real(kind: str) -> Pictures:
    """Read the photographs of the real sets that show a kind of board."""
    data = find_data_dir()
    for name, (of_kind, glob, pattern, grid_size) in _REAL_SETS.items():
        if of_kind == kind:
            for file in sorted((data / name).glob(glob)):
                yield Picture(
                    f"{name}/{file.name}", REAL, read_image(file).pixels, pattern, grid_size
                )
    if kind == "charuco":
        yield from _read_videos(data / "four_cameras_charuco_video")


def _read_videos(folder: Path) -> Pictures:
    """Read frames of videos of a ChArUco board, whose print is inverted."""
    for file in sorted(folder.rglob("*.mp4")):
        video = cv2.VideoCapture(str(file))
        step = max(int(video.get(cv2.CAP_PROP_FRAME_COUNT)) // _FRAMES, 1)
        for k in range(_FRAMES * step):
            good, frame = video.read()
            if good and k % step == 0:
                grey = 255 - cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY)
                yield Picture(f"{file.name}/{k}", REAL, grey, Charuco("DICT_4X4_1000"))


_REAL_SETS: dict[str, tuple[str, str, Pattern, GridSize | None]] = {
    "bouguet_calib_example": ("checkerboard", "Image[0-9]*.tif", CHECKERBOARD, None),
    "udacity_carnd_9x6_partial": ("checkerboard", "*.jpg", CHECKERBOARD, None),
    "gopro_udacity_wide": ("checkerboard", "*.jpg", CHECKERBOARD, None),
    "stereo_sourishg": ("checkerboard", "*.jpg", CHECKERBOARD, None),
    "fisheye_pairs_sourishg": ("checkerboard", "*.jpg", CHECKERBOARD, None),
    "phone_iphonex": ("checkerboard", "*.jpg", CHECKERBOARD, None),
    "handeye_cs_synthetic_1": ("checkerboard", "*.png", CHECKERBOARD, None),
    "zhang1998": ("checkerboard", "*.tif", CHECKERBOARD, None),
    "charuco_iphone_yzz": ("charuco", "*.jpg", Charuco("DICT_4X4_100"), None),
}
"""The real sets in which a kind of board is searched: that kind, the files, and what is stated."""
