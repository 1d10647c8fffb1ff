"""Photographs: reading and writing, undistortion, rectification, rendering of synthetic views."""

from __future__ import annotations

from calibgui.engine.images.exif import Exif
from calibgui.engine.images.headers import Header
from calibgui.engine.images.lost_angles import (
    LostAngles,
    describe_lost_angles,
    measure_lost_angles,
)
from calibgui.engine.images.projections import IdealCamera, Projection, list_cube_rotations
from calibgui.engine.images.reading import (
    FORMATS,
    Image,
    Pixels,
    read_colour,
    read_image,
    read_image_header,
    read_image_size,
    stretch_levels,
    write_image,
)
from calibgui.engine.images.rectification import Extent, compute_board_extent, rectify_image
from calibgui.engine.images.rendering import Appearance, render_view
from calibgui.engine.images.resampling import ResampledImage
from calibgui.engine.images.sampling import make_mesh
from calibgui.engine.images.undistortion import (
    FieldOfView,
    choose_ideal_cameras,
    make_ideal_image,
    undistort_image,
)

__all__ = [
    "FORMATS",
    "Appearance",
    "Exif",
    "Extent",
    "FieldOfView",
    "Header",
    "IdealCamera",
    "Image",
    "LostAngles",
    "Pixels",
    "Projection",
    "ResampledImage",
    "choose_ideal_cameras",
    "compute_board_extent",
    "describe_lost_angles",
    "list_cube_rotations",
    "make_ideal_image",
    "make_mesh",
    "measure_lost_angles",
    "read_colour",
    "read_image",
    "read_image_header",
    "read_image_size",
    "rectify_image",
    "render_view",
    "stretch_levels",
    "undistort_image",
    "write_image",
]
