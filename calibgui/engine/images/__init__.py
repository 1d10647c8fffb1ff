"""Photographs: reading, sampling, undistorting, rectifying and rendering them."""

from __future__ import annotations

from calibgui.engine.images.reading import (
    FORMATS,
    Image,
    Pixels,
    image_size,
    read_colour,
    read_image,
    stretched,
    write_image,
)
from calibgui.engine.images.rendering import Appearance, render
from calibgui.engine.images.sampling import mesh
from calibgui.engine.images.undistortion import (
    Extent,
    FieldOfView,
    Resampled,
    board_extent,
    rectify_image,
    undistort_image,
)

__all__ = [
    "FORMATS",
    "Appearance",
    "Extent",
    "FieldOfView",
    "Image",
    "Pixels",
    "Resampled",
    "board_extent",
    "image_size",
    "mesh",
    "read_colour",
    "read_image",
    "rectify_image",
    "render",
    "stretched",
    "undistort_image",
    "write_image",
]
