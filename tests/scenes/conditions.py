"""What a rendered photograph is taken of, and how."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Conditions:
    """What a photograph is taken of, and how. Angles in degrees, lengths in pixels."""

    grid_size: tuple[int, int] = (6, 9)
    size: tuple[int, int] = (640, 480)
    square: float = 30.0
    """Side of a square at the board's centre."""
    aspect: float = 1.0
    """Height over width of what should be squares."""
    tilt: float = 25.0
    """Of the board against the sensor, about a random axis in its plane."""
    shift: float = 25.0
    """Largest displacement of the board's centre along u and v."""
    turn: float = 180.0
    """Largest rotation in the image."""
    focal: float = 1.1
    """Over the image's width."""
    distortion: float = 0.0
    """d in p (1 + d r^2) = ideal point, r over the half diagonal; barrel if positive."""
    k1: float = 0.0
    """Of a lens p = (1 + k1 r^2) ideal point, r that point's over the focal length."""
    fisheye: bool = False
    """Equidistant lens instead of a pinhole."""
    blur: float = 0.7
    """Standard deviation of the point spread."""
    blur_end: float | None = None
    """At the image's right edge, growing from `blur` at its left."""
    motion: float = 0.0
    """Length of the path during exposure, along a random direction."""
    ink: float = 0.0
    """Growth of the dark squares on every side, squares."""
    dark: float = 45.0
    bright: float = 205.0
    light: float = 0.0
    """0 even, 1 from full to a third across the image, with a bright spot."""
    gamma: float = 1.0
    clutter: bool = False
    """Random polygons instead of a plain background, up to a narrow quiet zone."""
    quiet: float = 1.0
    """Width of the white margin, squares."""
    noise: float = 2.0
    deep: bool = False
    """16 bits instead of 8."""
    centre: tuple[float, float] = (0.0, 0.0)
    """Of the board, from the image's, before the random shift."""
    occluder: str = ""
    """What covers some of the board: an "object" in its middle, a "hand" at its border."""
    marks: bool = False
    """Dots, triangles or letters are printed in the middle of some of the bright squares."""
    parts: int = 4
    """Into which each pixel is divided both ways. One will do where corners are only counted."""
