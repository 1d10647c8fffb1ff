"""Photographs of boards as labs, robots and photographers take them, with their truth."""

from __future__ import annotations

import cv2
import numpy as np

from tests.scenes.camera import Camera
from tests.scenes.checkerboards import draw
from tests.scenes.photograph import (
    Array,
    Photograph,
    Trouble,
    add_noise,
    as_bytes,
    as_grey,
    shift_image,
    vary,
)


def _spread(levels: Array, sigma: float) -> Array:
    return np.asarray(cv2.GaussianBlur(levels, (0, 0), sigma))


def coarse_jpeg(seed: int) -> Photograph:
    """A dim picture of coloured noise, compressed at a quality of 10 to 25."""
    rng = np.random.default_rng([seed, 80])
    scene = draw(vary(seed), seed)
    colour = scene.clean[..., None] + rng.uniform(5, 15) * rng.standard_normal((480, 640, 3))
    blotches = rng.standard_normal((60, 80, 3))
    colour += rng.uniform(3, 10) * cv2.resize(blotches, (640, 480), interpolation=cv2.INTER_CUBIC)
    quality = [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(10, 26))]
    coded = cv2.imencode(".jpg", as_bytes(colour), quality)[1]
    return Photograph(as_grey(cv2.imdecode(coded, cv2.IMREAD_COLOR)), (scene.uv,))


def arc(seed: int) -> Photograph:
    """The camera rolls while the shutter is open: every point moves along an arc of 2 to 7 px."""
    rng = np.random.default_rng([seed, 81])
    scene = draw(vary(seed, square=rng.uniform(26, 40), grid_size=((6, 9), (5, 8))[seed % 2]), seed)
    centre = rng.uniform(-100, 740), rng.uniform(-100, 580)
    reach = float(np.linalg.norm(scene.uv - np.array(centre), axis=2).max())
    half = np.degrees(rng.uniform(2, 7) / reach / 2)
    total = np.zeros(scene.clean.shape)
    turns = np.linspace(-half, half, 25)
    for turn in turns:
        M = cv2.getRotationMatrix2D(centre, turn, 1.0)
        total += cv2.warpAffine(
            scene.clean, M, (640, 480), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
        )
    levels = add_noise(total / len(turns), scene.conditions.noise, seed)
    return Photograph(as_bytes(levels), (scene.uv,))


def tilted_focus(seed: int) -> Photograph:
    """One end of the board in focus, the other blurred by 3 to 5 px."""
    rng = np.random.default_rng([seed, 82])
    grid_size = ((6, 9), (5, 8), (5, 7))[seed % 3]
    settings = {"square": rng.uniform(26, 36), "blur": 0.6, "blur_end": rng.uniform(3, 5)}
    scene = draw(vary(seed, grid_size=grid_size, **settings), seed)
    return Photograph(scene.photograph(seed), (scene.uv,))


def dirty_lens(seed: int) -> Photograph:
    """Smears on the lens veil parts of the picture, dust on the sensor leaves dark rings."""
    rng = np.random.default_rng([seed, 83])
    scene = draw(vary(seed), seed)
    v, u = np.mgrid[:480, :640]
    levels = scene.clean.copy()
    for _ in range(rng.integers(2, 7)):
        place, size = rng.uniform(0, 1, 2) * (640, 480), rng.uniform(20, 80, 2)
        smear = np.exp(-(((u - place[0]) / size[0]) ** 2 + ((v - place[1]) / size[1]) ** 2))
        levels += smear * rng.uniform(0.2, 0.7) * (rng.uniform(60, 180) - levels)
    for _ in range(rng.integers(5, 25)):
        r = np.hypot(*(np.stack([u, v]).T - rng.uniform(0, 1, 2) * (640, 480)).T) / rng.uniform(
            2, 6
        )
        levels *= 1 - rng.uniform(0.1, 0.35) * np.exp(-((r - 1) ** 2) * 4)
    return Photograph(as_bytes(add_noise(levels, scene.conditions.noise, seed)), (scene.uv,))


def through_a_tube(seed: int) -> Photograph:
    """A microscope or an endoscope: bright in the middle, black around."""
    rng = np.random.default_rng([seed, 84])
    scene = draw(vary(seed), seed)
    v, u = np.mgrid[:480, :640]
    radius, soft = rng.uniform(150, 260), rng.uniform(5, 60)
    r = np.hypot(u - 320 - rng.uniform(-40, 40), v - 240 - rng.uniform(-40, 40))
    light = 1 / (1 + np.exp((r - radius) / soft))
    at = np.clip(np.rint(scene.uv), 0, (639, 479)).astype(int)
    dim = cv2.erode(light, np.ones((15, 15)))[at[..., 1], at[..., 0]]
    levels = add_noise(scene.clean * light + 4, scene.conditions.noise, seed)
    return Photograph(as_bytes(levels), (scene.uv,), dim < 0.5)


def window(seed: int) -> Photograph:
    """A window with its bars is reflected in the board's laminate, sharp or not."""
    rng = np.random.default_rng([seed, 85])
    scene = draw(vary(seed), seed)
    x, y = np.meshgrid(np.linspace(-1, 1, 200), np.linspace(-1, 1, 200))
    panes = ((abs(x) > 0.06) & (abs(y) > 0.06) & (abs(y - 0.5) > 0.04)).astype(float)
    seen = rng.uniform(0.2, 0.8, 2) * (640, 480) + rng.uniform(60, 200) * np.array(
        [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    ) * rng.uniform(0.6, 1.2, (4, 2))
    corners = np.array([(0, 0), (199, 0), (199, 199), (0, 199)], np.float32)
    H = cv2.getPerspectiveTransform(corners, seen.astype(np.float32))
    light = np.asarray(cv2.warpPerspective(panes, H, (640, 480)))
    levels = scene.clean + rng.uniform(20, 80) * _spread(light, rng.uniform(0.7, 4))
    return Photograph(as_bytes(add_noise(levels, scene.conditions.noise, seed)), (scene.uv,))


def bands_of_print(seed: int) -> Photograph:
    """A printer prints some of its bands, each 0.3 to 2 squares high, paler."""
    rng = np.random.default_rng([seed, 86])
    conditions = vary(seed)
    rows = conditions.grid_size[0]
    height = rng.uniform(0.3, 2)
    pale = rng.uniform(0, 0.25, 64)

    def print_bands(paper: Array, _: Array, y: Array) -> Array:
        band = (np.clip(y, -3, rows + 3) / height).astype(int) % 64
        return np.where(paper < 1, paper + pale[band] * (1 - paper), paper)

    scene = draw(conditions, seed, print_bands)
    return Photograph(scene.photograph(seed), (scene.uv,))


def show_through(seed: int) -> Photograph:
    """Thin paper with another board on its back, which shows through."""
    rng = np.random.default_rng([seed, 87])
    conditions = vary(seed)
    scale, x0, y0 = rng.uniform(0.4, 2.5), *rng.uniform(0, 1, 2)
    rows, cols = conditions.grid_size
    depth = rng.uniform(0.05, 0.25)

    def shine(paper: Array, x: Array, y: Array) -> Array:
        on = (x > -1.5) & (x < cols + 0.5) & (y > -1.5) & (y < rows + 0.5)
        a, b = (np.where(on, (c + c0) / scale, 0) for c, c0 in ((x, x0), (y, y0)))
        dark = on & ((np.floor(a) + np.floor(b)) % 2 == 0)
        return np.where(dark, paper * (1 - depth), paper)

    scene = draw(conditions, seed, shine)
    return Photograph(scene.photograph(seed), (scene.uv,))


def far_away(seed: int) -> Photograph:
    """A small board in a picture of 12 megapixels."""
    rng = np.random.default_rng([seed, 88])
    conditions = vary(
        seed,
        size=(4000, 3000),
        square=rng.uniform(10, 30),
        shift=1000.0,
        clutter=bool(seed % 2),
        blur=rng.uniform(0.7, 1.5),
        parts=1,
    )
    scene = draw(conditions, seed)
    return Photograph(scene.photograph(seed), (scene.uv,))


def twins(seed: int) -> Photograph:
    """Two boards of one size on one sheet, 1 to 3 squares apart in line."""
    rng = np.random.default_rng([seed, 89])
    rows, cols = (5, 6, 4, 7)[seed % 4], (4, 5, 6)[seed % 3]
    gap = float(rng.integers(1, 4))
    conditions = vary(
        seed,
        grid_size=(rows, cols),
        square=0.75 * 640 / (2 * cols + gap + 4),
        centre=(-0.75 * 160.0, 0.0),
        turn=10.0,
        tilt=rng.uniform(0, 30),
        shift=10.0,
        quiet=float(rng.uniform(0.3, 1.0)),
    )
    start = cols + 1 + gap

    def repeat(paper: Array, x: Array, y: Array) -> Array:
        on = (x > start - 1) & (x < start + cols) & (y > -1) & (y < rows)
        near = (x > cols - 0.2) & (x < start + cols + 0.7) & (y > -1.7) & (y < rows + 0.7)
        a, b = (np.where(on, c, 0) for c in (x - start, y))
        dark = on & ((np.floor(a) + np.floor(b)) % 2 == 0)
        return np.where(dark, 0.0, np.where(near & (on | (x > cols)), 1.0, paper))

    scene = draw(conditions, seed, repeat)
    n, m = np.meshgrid(np.arange(cols), np.arange(rows))
    camera = Camera(conditions, np.random.default_rng(seed))
    other = camera.image_from_board(start + n.astype(float), m.astype(float))
    return Photograph(scene.photograph(seed), (scene.uv, other))


def flicker(seed: int) -> Photograph:
    """Lamps that flicker while rows are read one after the other: brighter and darker bands."""
    rng = np.random.default_rng([seed, 90])
    scene = draw(vary(seed), seed)
    v = np.arange(480)[:, None]
    wave = np.sin(2 * np.pi * v / rng.uniform(30, 200) + rng.uniform(0, 6))
    levels = scene.clean * (1 + rng.uniform(0.1, 0.4) * wave)
    return Photograph(as_bytes(add_noise(levels, scene.conditions.noise, seed)), (scene.uv,))


def blinds(seed: int) -> Photograph:
    """Sun through slats: bands of light and shadow, 1.5 to 5 squares apart, hard or hardly blurred
    at their edges, over board and background."""
    rng = np.random.default_rng([seed, 96])
    turn, apart, start = rng.uniform(0, np.pi), rng.uniform(1.5, 5), rng.uniform(0, 1)
    share, depth = rng.uniform(0.3, 0.7), rng.uniform(0.3, 0.7)
    soft = rng.uniform(0.005, 0.1)
    conditions = vary(seed)

    def shade(paper: Array, x: Array, y: Array) -> Array:
        x, y = (np.clip(c, -99, 99) for c in (x, y))
        across = (np.cos(turn) * x + np.sin(turn) * y) / apart + start
        off = apart * (share / 2 - abs(across % 1 - 0.5))
        light = 1 / (1 + np.exp(-np.clip(off / soft, -50, 50)))
        return paper * (depth + (1 - depth) * light)

    scene = draw(conditions, seed, shade)
    return Photograph(scene.photograph(seed), (scene.uv,))


def half_in_the_sun(seed: int) -> Photograph:
    """A part of the board overexposed in the sun, the other in shade that gets an eighth to a
    quarter of that light, as of a camera that does not lift dark tones. Where the shadow ends
    corners need not be found."""
    rng = np.random.default_rng([seed, 98])
    scene = draw(vary(seed), seed)
    v, u = np.mgrid[:480, :640]
    turn, soft = rng.uniform(0, 2 * np.pi), rng.uniform(0.7, 6)
    across = (u - 320) * np.cos(turn) + (v - 240) * np.sin(turn)
    sun, shade = rng.uniform(1.2, 1.8), rng.uniform(0.12, 0.25)
    light = shade + (sun - shade) / (1 + np.exp(-across / soft))
    at = np.clip(np.rint(scene.uv), 0, (639, 479)).astype(int)
    near = abs(across) < 0.6 * scene.conditions.square + 3 * soft
    levels = add_noise(light * scene.clean, scene.conditions.noise, seed)
    return Photograph(as_bytes(levels), (scene.uv,), near[at[..., 1], at[..., 0]])


def fringes(seed: int) -> Photograph:
    """A lens that draws red and blue 0.5 to 2.5 px aside of green at the picture's corners."""
    rng = np.random.default_rng([seed, 91])
    scene = draw(vary(seed), seed)
    red, blue = rng.uniform(-1, 1, 2) * rng.uniform(0.5, 2.5) / 400
    v, u = np.mgrid[:480, :640].astype(np.float32)

    def scaled(by: float) -> Array:
        at = (319.5 + (u - 319.5) * (1 + by), 239.5 + (v - 239.5) * (1 + by))
        return np.asarray(
            cv2.remap(
                scene.clean,
                at[0].astype(np.float32),
                at[1].astype(np.float32),
                cv2.INTER_CUBIC,
                borderMode=cv2.BORDER_REPLICATE,
            )
        )

    colour = np.stack([scaled(blue), scene.clean, scaled(red)], axis=-1)
    noisy = as_bytes(colour + 2.0 * rng.standard_normal(colour.shape))
    return Photograph(as_grey(noisy), (scene.uv,))


def wires(seed: int) -> Photograph:
    """Cables, and the bars of a cage, before the board."""
    rng = np.random.default_rng([seed, 92])
    scene = draw(vary(seed), seed)
    mask = np.zeros((480, 640), np.uint8)
    width = int(rng.integers(2, 6))
    if seed % 2:
        turn, gap = rng.uniform(0, np.pi), rng.uniform(60, 160)
        along = np.array([np.cos(turn), np.sin(turn)])
        for k in range(-8, 9):
            p = np.array([320, 240]) + k * gap * np.array([-along[1], along[0]])
            a, b = (tuple((p + s * along).astype(int).tolist()) for s in (-900, 900))
            cv2.line(mask, a, b, 255, width)
    else:
        for _ in range(rng.integers(1, 4)):
            x = np.linspace(-20, 660, 60)
            y = rng.uniform(80, 400) + rng.uniform(20, 120) * np.sin(x / rng.uniform(60, 200))
            points = np.column_stack([x, y][:: rng.choice([1, -1])]).astype(np.int32)
            cv2.polylines(mask, [points.reshape(-1, 1, 2)], False, 255, width)
    cover = _spread(mask / 255.0, 0.7)
    levels = scene.clean * (1 - cover) + cover * rng.uniform(10, 230)
    near = cv2.dilate(mask, np.ones((15, 15), np.uint8))
    at = np.clip(np.rint(scene.uv), 0, (639, 479)).astype(int)
    hidden = near[at[..., 1], at[..., 0]] > 0
    image = as_bytes(add_noise(levels, scene.conditions.noise, seed))
    return Photograph(image, (scene.uv,), hidden)


def overlay(seed: int) -> Photograph:
    """A viewer's cross-hair, grid of lines and time drawn over the picture."""
    rng = np.random.default_rng([seed, 93])
    scene = draw(vary(seed), seed)
    image = scene.photograph(seed).copy()
    mask = np.zeros((480, 640), np.uint8)
    cv2.line(mask, (320, 0), (320, 479), 255, 1)
    cv2.line(mask, (0, 240), (639, 240), 255, 1)
    if seed % 2:
        for k in (1, 2):
            cv2.line(mask, (640 * k // 3, 0), (640 * k // 3, 479), 255, 1)
            cv2.line(mask, (0, 160 * k), (639, 160 * k), 255, 1)
    cv2.putText(mask, "2024-05-17 12:31:08", (20, 460), cv2.FONT_HERSHEY_SIMPLEX, 0.8, 255, 2)
    image[mask > 0] = rng.choice([0, 255])
    near = cv2.dilate(mask, np.ones((15, 15), np.uint8))
    at = np.clip(np.rint(scene.uv), 0, (639, 479)).astype(int)
    return Photograph(image, (scene.uv,), near[at[..., 1], at[..., 0]] > 0)


def ghost(seed: int) -> Photograph:
    """Two exposures merged, the second 1 to 6 px aside and at most a third as strong."""
    rng = np.random.default_rng([seed, 94])
    scene = draw(vary(seed), seed)
    share, turn = rng.uniform(0.1, 0.33), rng.uniform(0, 2 * np.pi)
    by = rng.uniform(1, 6) * np.array([np.cos(turn), np.sin(turn)])
    levels = (1 - share) * scene.clean + share * shift_image(scene.clean, by)
    return Photograph(as_bytes(add_noise(levels, scene.conditions.noise, seed)), (scene.uv,))


def laser(seed: int) -> Photograph:
    """Lines of a laser scanner over the board."""
    rng = np.random.default_rng([seed, 95])
    scene = draw(vary(seed), seed)
    light = np.zeros((480, 640))
    for _ in range(rng.integers(1, 4)):
        turn, place = rng.uniform(0, np.pi), rng.uniform(0.2, 0.8, 2) * (640, 480)
        d = 900 * np.array([np.cos(turn), np.sin(turn)])
        a, b = (tuple((place + s * d).astype(int).tolist()) for s in (-1, 1))
        cv2.line(light, a, b, 255.0, 2)
    at = np.clip(np.rint(scene.uv), 0, (639, 479)).astype(int)
    near = cv2.dilate(light, np.ones((19, 19)))[at[..., 1], at[..., 0]] > 0
    levels = scene.clean + rng.uniform(0.3, 1.0) * _spread(light, rng.uniform(0.8, 2))
    image = as_bytes(add_noise(levels, scene.conditions.noise, seed))
    return Photograph(image, (scene.uv,), near)


def drops(seed: int) -> Photograph:
    """Drops on the lens or on a pane before it, in each of which a part of the picture is seen
    small and upside down."""
    rng = np.random.default_rng([seed, 97])
    scene = draw(vary(seed), seed)
    v, u = np.mgrid[:480, :640].astype(np.float32)
    seen, near = np.stack([u, v]), np.zeros((480, 640), np.bool_)
    for _ in range(rng.integers(3, 12)):
        x, y = rng.uniform(0, 1, 2) * (640, 480)
        radius, shrunk = rng.uniform(6, 25), rng.uniform(2, 4)
        r = np.hypot(u - x, v - y)
        small = np.stack([x - (u - x) * shrunk, y - (v - y) * shrunk])
        seen = np.where(r < radius, small, seen)
        near |= r < radius + 0.45 * scene.conditions.square
    at_u, at_v = seen.astype(np.float32)
    levels = cv2.remap(
        scene.clean, at_u, at_v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT
    ).astype(np.float64)
    at = np.clip(np.rint(scene.uv), 0, (639, 479)).astype(int)
    image = as_bytes(add_noise(levels, scene.conditions.noise, seed))
    return Photograph(image, (scene.uv,), near[at[..., 1], at[..., 0]])


def chequered(seed: int) -> Photograph:
    """A board with a margin on a floor or a cloth of squares, from 0.8 to 3 times as large, that
    fills the image; every other one lies along the board and has squares of like size."""
    rng = np.random.default_rng([seed, 97])
    conditions = vary(seed, quiet=float(rng.uniform(0.2, 1.0)))
    rows, cols = conditions.grid_size
    is_alike = bool(seed % 2)
    turn = rng.uniform(-0.06, 0.06) if is_alike else rng.uniform(0, np.pi)
    size = rng.uniform(0.9, 1.1) if is_alike else rng.uniform(0.8, 3)
    dark, start = rng.uniform(0, 0.3), rng.uniform(0, 2, 2)
    bright = dark + rng.uniform(0.3, 0.65)

    def lay(paper: Array, x: Array, y: Array) -> Array:
        out = np.maximum(
            abs(x - (cols - 1) / 2) - (cols + 1) / 2, abs(y - (rows - 1) / 2) - (rows + 1) / 2
        )
        x, y = (np.clip(c, -99, 99) for c in (x, y))
        a = (x * np.cos(turn) + y * np.sin(turn)) / size + start[0]
        b = (y * np.cos(turn) - x * np.sin(turn)) / size + start[1]
        floor = np.where((np.floor(a) + np.floor(b)) % 2 == 0, dark, bright)
        return np.where(out > conditions.quiet, floor, paper)

    scene = draw(conditions, seed, lay)
    return Photograph(scene.photograph(seed), (scene.uv,))


PLACES: dict[str, Trouble] = {
    "coarse JPEG": coarse_jpeg,
    "arc": arc,
    "tilted focus": tilted_focus,
    "dirty lens": dirty_lens,
    "tube": through_a_tube,
    "window": window,
    "bands of print": bands_of_print,
    "show-through": show_through,
    "far away": far_away,
    "twins": twins,
    "flicker": flicker,
    "blinds": blinds,
    "half in the sun": half_in_the_sun,
    "fringes": fringes,
    "wires": wires,
    "overlay": overlay,
    "ghost": ghost,
    "laser": laser,
    "drops": drops,
    "chequered": chequered,
}
"""What happens to boards in labs, cells and studios, by name."""
