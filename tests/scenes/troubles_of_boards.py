"""Photographs of boards that are unusual, damaged or in unusual places, with their truth."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cv2
import numpy as np

from tests.scenes.camera import Camera
from tests.scenes.checkerboards import Dress, draw
from tests.scenes.conditions import Conditions
from tests.scenes.photograph import (
    Array,
    Photograph,
    Trouble,
    add_noise,
    as_bytes,
    as_grey,
    vary,
)
from tests.scenes.troubles_of_cameras import bend_image

_PIXELS = 40
"""To a square, of what is drawn around a board."""


def _dressed(seed: int, conditions: Conditions, dress: Dress | None = None) -> Photograph:
    """The photograph of what is drawn. What is covered, or too near to the image's border, is
    hidden."""
    scene = draw(conditions, seed, dress)
    return Photograph(scene.photograph(seed), (scene.uv,), ~scene.visible)


def _paste(paper: Array, x: Array, y: Array, picture: Array, x0: float, y0: float) -> Array:
    """`paper` with a `picture` of `_PIXELS` a square whose upper left corner lies at (x0, y0); NaN
    in it shows the paper."""
    col, row = (np.clip((c - c0) * _PIXELS, -1e6, 1e6) for c, c0 in ((x, x0), (y, y0)))
    inside = (col >= 0) & (row >= 0) & (col < picture.shape[1]) & (row < picture.shape[0])
    seen = picture[row[inside].astype(int), col[inside].astype(int)]
    result = paper.copy()
    result[inside] = np.where(np.isnan(seen), paper[inside], seen)
    return result


def _write(text: str, height: float) -> Array:
    """A line of `text`, black on what is there, of a `height` in squares."""
    scale = height * _PIXELS / 22
    thick = max(1, round(scale * 2))
    (width, tall), base = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, scale, thick)
    picture = np.zeros((tall + base + thick, width + thick), np.uint8)
    cv2.putText(picture, text, (0, tall), cv2.FONT_HERSHEY_SIMPLEX, scale, 255, thick)
    return np.where(picture > 0, 0.0, np.nan)


def hand(seed: int) -> Photograph:
    """Fingers that hold the board, over corners at its border."""
    return _dressed(seed, vary(seed, occluder="hand"))


def held_object(seed: int) -> Photograph:
    """Something that lies on the board, over corners in its middle."""
    return _dressed(seed, vary(seed, occluder="object"))


def clips(seed: int) -> Photograph:
    """Metal clips or tape over squares at the border."""
    rng = np.random.default_rng([seed, 60])
    conditions = vary(seed)
    rows, cols = conditions.grid_size
    hidden = np.zeros((rows, cols), np.bool_)
    row, col = np.mgrid[:rows, :cols]
    covers = []
    for _ in range(rng.integers(1, 5)):
        half, depth = rng.uniform(0.4, 1.0), rng.uniform(-0.7, 1.2)
        side, along = rng.integers(4), rng.uniform(0, 1)
        middle, size = [
            ((along * cols - 0.5, (depth - 2) / 2), (half, (depth + 2) / 2)),
            ((along * cols - 0.5, rows - 1 - (depth - 2) / 2), (half, (depth + 2) / 2)),
            (((depth - 2) / 2, along * rows - 0.5), ((depth + 2) / 2, half)),
            ((cols - 1 - (depth - 2) / 2, along * rows - 0.5), ((depth + 2) / 2, half)),
        ][side]
        covers.append((middle, size, rng.uniform(0, 1)))
        near = (abs(col - middle[0]) < size[0] + 0.4) & (abs(row - middle[1]) < size[1] + 0.4)
        hidden |= near

    def cover(paper: Array, x: Array, y: Array) -> Array:
        for middle, size, shade in covers:
            on = (abs(x - middle[0]) < size[0]) & (abs(y - middle[1]) < size[1])
            paper = np.where(on, np.clip(shade + 0.3 * np.sin(6 * np.where(on, x, 0)), 0, 1), paper)
        return paper

    scene = draw(conditions, seed, cover)
    return Photograph(scene.photograph(seed), (scene.uv,), hidden)


def stained(seed: int) -> Photograph:
    """Blots, scratches and missing ink, also on corners."""
    rng = np.random.default_rng([seed, 61])
    conditions = vary(seed)
    rows, cols = conditions.grid_size
    hidden = np.zeros((rows, cols), np.bool_)
    row, col = np.mgrid[:rows, :cols]
    blots = []
    for _ in range(rng.integers(3, 12)):
        x, y, r = rng.uniform(-1, cols), rng.uniform(-1, rows), rng.uniform(0.05, 0.35)
        blots.append((x, y, r, rng.choice([0.0, 1.0, 0.4])))
        hidden |= np.hypot(col - x, row - y) < r + 0.45

    def blot(paper: Array, x: Array, y: Array) -> Array:
        for bx, by, r, shade in blots:
            paper = np.where(np.hypot(x - bx, y - by) < r, shade, paper)
        return paper

    scene = draw(conditions, seed, blot)
    return Photograph(scene.photograph(seed), (scene.uv,), hidden)


def framed(seed: int) -> Photograph:
    """A thick black frame around the board, up to its squares or a part of a square away."""
    rng = np.random.default_rng([seed, 62])
    conditions = vary(seed)
    rows, cols = conditions.grid_size
    gap, width = rng.choice([0.0, rng.uniform(0.1, 1.0)]), rng.uniform(0.3, 2.0)
    shade = rng.choice([0.0, 0.1])

    def frame(paper: Array, x: Array, y: Array) -> Array:
        out = np.maximum(
            abs(x - (cols - 1) / 2) - (cols + 1) / 2, abs(y - (rows - 1) / 2) - (rows + 1) / 2
        )
        paper = np.where((out > gap) & (out < gap + width), shade, paper)
        return np.where((out >= gap + width) & (out < gap + width + 0.5), 1.0, paper)

    return _dressed(seed, conditions, frame)


def _lay(kind: str, x: Array, y: Array, rng: np.random.Generator) -> Array:
    """Reflectance of a surface at points (x, y), squares."""
    turn, size = rng.uniform(0, np.pi), rng.uniform(0.6, 3.0)
    a = (np.cos(turn) * x + np.sin(turn) * y) / size
    b = (np.cos(turn) * y - np.sin(turn) * x) / size
    if kind == "wood":
        rings = np.sin(8 * b + 2 * np.sin(0.7 * a) + np.sin(0.31 * a + 3 * b))
        return 0.45 + 0.2 * rings + 0.1 * np.sin(40 * b + 3 * np.sin(a))
    if kind == "tiles":
        joint = np.minimum(a % 1, b % 1) < 0.06
        return np.where(joint, rng.uniform(0, 0.4), rng.uniform(0.5, 0.9))
    if kind == "keyboard":
        b = b * 1.1
        a = a + 0.4 * np.floor(b)
        key = (abs(a % 1 - 0.5) < 0.42) & (abs(b % 1 - 0.5) < 0.42)
        sign = key & (np.hypot(a % 1 - 0.4, b % 1 - 0.4) < 0.12)
        return np.where(sign, 0.9, np.where(key, 0.12, 0.35))
    if kind == "cloth":  # gingham: woven of white and coloured threads
        return 1.0 - 0.35 * (np.floor(a) % 2) - 0.35 * (np.floor(b) % 2)
    return np.where((np.floor(a) + np.floor(b)) % 2 == 0, 0.15, 0.85)  # floor


def no_margin(seed: int) -> Photograph:
    """Boards cut out at their squares' edges, on wood, tiles, a keyboard, a chequered cloth or a
    floor of black and white tiles."""
    rng = np.random.default_rng([seed, 63])
    kind = ("wood", "tiles", "keyboard", "cloth", "floor")[seed // 5 % 5]
    conditions = vary(seed, quiet=float(rng.choice([0.0, rng.uniform(0, 0.5)])))
    rows, cols = conditions.grid_size
    quiet = conditions.quiet

    def lay(paper: Array, x: Array, y: Array) -> Array:
        out = np.maximum(
            abs(x - (cols - 1) / 2) - (cols + 1) / 2, abs(y - (rows - 1) / 2) - (rows + 1) / 2
        )
        return np.where(
            out > quiet, _lay(kind, np.clip(x, -99, 99), np.clip(y, -99, 99), rng), paper
        )

    return _dressed(seed, conditions, lay)


def printed_margin(seed: int) -> Photograph:
    """Text, a logo, a ruler and a code in the margin of the board."""
    rng = np.random.default_rng([seed, 64])
    conditions = vary(seed, quiet=float(rng.uniform(1.0, 2.0)))
    rows, cols = conditions.grid_size
    code = np.kron(rng.integers(0, 2, (9, 9)).astype(float), np.ones((5, 5)))
    logo = np.full((60, 60), np.nan)
    cv2.circle(logo, (30, 30), 28, 0.0, -1)
    cv2.circle(logo, (30, 30), 16, 0.7, -1)
    text = _write(f"{rows} x {cols} | checker size 25 mm | calib.example", rng.uniform(0.3, 0.7))
    mark = rng.uniform(0.1, 0.5)

    def print_around(paper: Array, x: Array, y: Array) -> Array:
        paper = _paste(paper, x, y, text, -0.9, rows + rng.uniform(0.1, 0.2))
        paper = _paste(paper, x, y, logo, cols + 0.05, -0.8)
        paper = _paste(paper, x, y, code, cols + 0.05, rows - 2.0)
        ruler = (y < -1.02) & (y > -1.4) & (x > -1) & (x < cols)
        return np.where(ruler & (np.where(ruler, x, 0) / mark % 1 < 0.2), 0.0, paper)

    return _dressed(seed, conditions, print_around)


def coloured(seed: int) -> Photograph:
    """Squares in two colours, of which grey hardly tells one from the other, compressed."""
    rng = np.random.default_rng([seed, 65])
    pairs = (
        ((40, 30, 190), (20, 20, 20)),  # red and black
        ((150, 60, 30), (230, 230, 230)),  # blue and white
        ((60, 60, 200), (80, 160, 70)),  # red and green
        ((40, 210, 230), (240, 240, 240)),  # yellow and white
        ((30, 60, 110), (90, 150, 190)),  # two woods
    )
    dark, bright = map(np.array, pairs[int(rng.integers(len(pairs)))])
    scene = draw(vary(seed), seed)
    share = np.clip((scene.clean - 45) / 160, 0, 1)
    colour = dark + share[..., None] * (bright - dark)
    noisy = as_bytes(add_noise(colour, scene.conditions.noise, seed))
    quality = [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(50, 96))]
    coded = cv2.imencode(".jpg", noisy, quality)[1]
    return Photograph(as_grey(cv2.imdecode(coded, cv2.IMREAD_COLOR)), (scene.uv,))


def tablet(seed: int) -> Photograph:
    """A board that fills a screen, with a bar of symbols, and a bright or dark bezel around it."""
    rng = np.random.default_rng([seed, 66])
    conditions = vary(seed, quiet=float(rng.uniform(0.0, 0.4)))
    rows, cols = conditions.grid_size
    quiet, width = conditions.quiet, rng.uniform(0.3, 1.0)
    bezel, room = rng.choice([0.02, 1.3]), rng.uniform(0.1, 0.8)
    bar = bool(rng.integers(2))

    def show(paper: Array, x: Array, y: Array) -> Array:
        out = np.maximum(
            abs(x - (cols - 1) / 2) - (cols + 1) / 2, abs(y - (rows - 1) / 2) - (rows + 1) / 2
        )
        paper = np.where(out > quiet, bezel, paper)
        paper = np.where(out > quiet + width, room, paper)
        if bar:
            on = (y < -0.85) & (out < quiet)
            symbol = on & (np.where(on, x, 0) % 0.4 < 0.2) & (np.where(on, x, 0) > cols - 3)
            paper = np.where(symbol, 0.9, np.where(on, 0.3, paper))
        return paper

    return _dressed(seed, conditions, show)


def second_board(seed: int) -> Photograph:
    """A smaller board in the background, or another beside."""
    rng = np.random.default_rng([seed, 67])
    small = rng.choice([0.35, 0.5, 0.8])
    grid = (int(rng.integers(4, 8)), int(rng.integers(4, 9)))
    rows, cols = vary(seed).grid_size
    conditions = vary(
        seed,
        square=310 / (cols + 2),
        centre=(-140.0, 0.0),
        tilt=rng.uniform(0, 25),
        turn=15.0,
        shift=5.0,
    )
    x0, y0 = cols + 1.3, rng.uniform(0, max(0.1, rows - small * grid[0]))

    def hang(paper: Array, x: Array, y: Array) -> Array:
        a, b = (x - x0) / small - 1, (y - y0) / small - 1
        near = (a > -1.5) & (a < grid[1] + 0.5) & (b > -1.5) & (b < grid[0] + 0.5)
        on = (a > -1) & (a < grid[1]) & (b > -1) & (b < grid[0])
        a, b = np.where(on, a, 0), np.where(on, b, 0)
        dark = on & ((np.floor(a) + np.floor(b)) % 2 == 0)
        return np.where(dark, 0.0, np.where(near, 1.0, paper))

    scene = draw(conditions, seed, hang)
    n, m = np.meshgrid(np.arange(1.0, grid[1] + 1), np.arange(1.0, grid[0] + 1))
    camera = Camera(conditions, np.random.default_rng(seed))
    other = camera.image_from_board(x0 + small * n, y0 + small * m)
    return Photograph(scene.photograph(seed), (scene.uv, other))


def pile(seed: int) -> Photograph:
    """A smaller board lies over a part of the other."""
    rng = np.random.default_rng([seed, 69])
    rows, cols = int(rng.integers(4, 7)), int(rng.integers(5, 8))
    below = draw(vary(seed), seed)
    conditions = vary(
        seed,
        grid_size=(rows, cols),
        square=rng.uniform(14, 20),
        tilt=rng.uniform(0, 30),
        centre=(float(rng.uniform(-120, 120)), float(rng.uniform(-90, 90))),
        shift=5.0,
        quiet=0.5,
    )
    sheet = np.empty(0)

    def cut_out(paper: Array, x: Array, y: Array) -> Array:
        nonlocal sheet
        inside = (abs(2 * x - cols + 1) < cols + 2) & (abs(2 * y - rows + 1) < rows + 2)
        sheet = inside.astype(np.float64)
        return paper

    above = draw(conditions, seed, cut_out)
    cover = cv2.resize(sheet, (640, 480), interpolation=cv2.INTER_AREA)
    cover = cv2.GaussianBlur(cover, (0, 0), conditions.blur)
    levels = add_noise(cover * above.clean + (1 - cover) * below.clean, conditions.noise, seed)
    reach = int(0.7 * below.conditions.square) | 1
    near = cv2.dilate(cover, np.ones((reach, reach)))
    at = np.clip(np.rint(below.uv), 0, (639, 479)).astype(int)
    hidden = near[at[..., 1], at[..., 0]] > 0.01
    return Photograph(as_bytes(levels), (below.uv, above.uv), hidden)


def curled(seed: int) -> Photograph:
    """Paper that is curled or wavy: up to a sixth of a square from flat, from one corner to the
    fourth after it."""
    rng = np.random.default_rng([seed, 68])
    scene = draw(vary(seed), seed)
    square = scene.conditions.square
    terms = [
        (
            rng.uniform(0, 2 * np.pi),
            rng.uniform(6, 16) * square,
            rng.uniform(0, 6),
            rng.uniform(0.03, 0.12)
            * square
            * np.array([np.cos(a := rng.uniform(0, 6)), np.sin(a)]),
        )
        for _ in range(3)
    ]

    def offset(u: Array, v: Array) -> tuple[Array, Array]:
        waves = [
            np.sin(2 * np.pi * (np.cos(turn) * u + np.sin(turn) * v) / wave + phase)
            for turn, wave, phase, _ in terms
        ]
        du, dv = (
            np.asarray(sum(w * t[3][k] for w, t in zip(waves, terms, strict=True))) for k in (0, 1)
        )
        return du, dv

    bent = bend_image(scene, offset)
    noisy = add_noise(bent.image, scene.conditions.noise, seed)
    return Photograph(as_bytes(noisy), bent.boards)


def _settings(choose: Callable[[int, np.random.Generator], dict[str, Any]]) -> Trouble:
    """Photographs under settings that are chosen by a seed and random numbers."""

    def photograph(seed: int) -> Photograph:
        return _dressed(seed, vary(seed, **choose(seed, np.random.default_rng([seed, 69]))))

    return photograph


def _choose_many(seed: int, rng: np.random.Generator) -> dict[str, Any]:
    grid_size = ((20, 30), (17, 24), (24, 19))[seed % 3]
    return {
        "grid_size": grid_size,
        "size": (800, 600),
        "square": rng.uniform(0.65, 0.8) * 600 / (max(grid_size) + 2),
        "blur": rng.uniform(0.5, 0.9),
        "distortion": rng.choice([0.0, 0.2]),
    }


def _choose_few(seed: int, rng: np.random.Generator) -> dict[str, Any]:
    grid_size = ((3, 3), (3, 4), (4, 4), (3, 5), (4, 5))[seed % 5]
    return {"grid_size": grid_size, "square": rng.uniform(12, 80), "distortion": 0.1}


def _choose_tiny(_: int, rng: np.random.Generator) -> dict[str, Any]:
    square, blur = rng.uniform(6, 8), rng.uniform(0.4, 0.8)
    return {"square": square, "blur": blur, "tilt": rng.uniform(0, 20), "noise": 2.0}


def _choose_oblong(seed: int, rng: np.random.Generator) -> dict[str, Any]:
    aspect = rng.choice([rng.uniform(0.5, 0.8), rng.uniform(1.25, 1.6)])
    square = 0.7 * 480 / (max(6, (seed % 5 + 5)) + 6) / max(1.0, aspect)
    return {"aspect": aspect, "square": square, "quiet": rng.uniform(0.5, 1)}


def _choose_filling(seed: int, rng: np.random.Generator) -> dict[str, Any]:
    grid_size = ((5, 7), (8, 11), (11, 15))[seed % 3]
    square = 480 / (grid_size[0] + rng.uniform(0.35, 0.9))
    return {
        "grid_size": grid_size,
        "square": square,
        "tilt": rng.uniform(0, 4),
        "turn": 1.0,
        "shift": 0.0,
    }


BOARDS: dict[str, Trouble] = {
    "hand": hand,
    "object": held_object,
    "clips": clips,
    "stains": stained,
    "frame": framed,
    "no margin": no_margin,
    "printed margin": printed_margin,
    "colours": coloured,
    "tablet": tablet,
    "second board": second_board,
    "pile": pile,
    "curled": curled,
    "many squares": _settings(_choose_many),
    "few squares": _settings(_choose_few),
    "tiny squares": _settings(_choose_tiny),
    "oblong squares": _settings(_choose_oblong),
    "fills the image": _settings(_choose_filling),
}
"""What is odd about boards and their places, by name."""
