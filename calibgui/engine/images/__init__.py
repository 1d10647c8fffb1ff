"""Photographs: reading, writing, undistorting, rectifying, drawing axes, rendering views."""

from __future__ import annotations

from typing import TYPE_CHECKING

from calibgui.engine.faces import load_on_demand

if TYPE_CHECKING:
    from calibgui.engine.images.drawn_axes import draw_axes as draw_axes
    from calibgui.engine.images.exif import Exif as Exif
    from calibgui.engine.images.fields import Field as Field, keep_field as keep_field
    from calibgui.engine.images.headers import Header as Header
    from calibgui.engine.images.hidden_angles import (
        HiddenAngles as HiddenAngles,
        describe_hidden_angles as describe_hidden_angles,
        measure_hidden_angles as measure_hidden_angles,
    )
    from calibgui.engine.images.image_circle_search import find_image_circle as find_image_circle
    from calibgui.engine.images.photo_libraries import (
        SUFFIXES as SUFFIXES,
        list_suffixes as list_suffixes,
    )
    from calibgui.engine.images.projections import (
        IdealCamera as IdealCamera,
        Projection as Projection,
        list_cube_rotations as list_cube_rotations,
    )
    from calibgui.engine.images.reading import (
        FORMATS as FORMATS,
        Image as Image,
        Pixels as Pixels,
        is_video as is_video,
        mirror_orientation as mirror_orientation,
        read_colour as read_colour,
        read_image as read_image,
        read_image_header as read_image_header,
        read_image_size as read_image_size,
        read_small_image as read_small_image,
        stretch_levels as stretch_levels,
        write_image as write_image,
    )
    from calibgui.engine.images.rectification import (
        Extent as Extent,
        compute_board_extent as compute_board_extent,
        rectify_image as rectify_image,
    )
    from calibgui.engine.images.rendering import (
        Appearance as Appearance,
        render_view as render_view,
    )
    from calibgui.engine.images.resampling import ResampledImage as ResampledImage
    from calibgui.engine.images.sampling import make_mesh as make_mesh
    from calibgui.engine.images.undistortion import (
        FieldOfView as FieldOfView,
        choose_ideal_cameras as choose_ideal_cameras,
        make_ideal_image as make_ideal_image,
        undistort_image as undistort_image,
    )

load_on_demand(
    __name__,
    {
        "drawn_axes": ["draw_axes"],
        "exif": ["Exif"],
        "fields": ["Field", "keep_field"],
        "headers": ["Header"],
        "hidden_angles": ["HiddenAngles", "describe_hidden_angles", "measure_hidden_angles"],
        "image_circle_search": ["find_image_circle"],
        "photo_libraries": ["SUFFIXES", "list_suffixes"],
        "projections": ["IdealCamera", "Projection", "list_cube_rotations"],
        "reading": [
            "FORMATS",
            "Image",
            "Pixels",
            "is_video",
            "mirror_orientation",
            "read_colour",
            "read_image",
            "read_image_header",
            "read_image_size",
            "read_small_image",
            "stretch_levels",
            "write_image",
        ],
        "rectification": ["Extent", "compute_board_extent", "rectify_image"],
        "rendering": ["Appearance", "render_view"],
        "resampling": ["ResampledImage"],
        "sampling": ["make_mesh"],
        "undistortion": [
            "FieldOfView",
            "choose_ideal_cameras",
            "make_ideal_image",
            "undistort_image",
        ],
    },
)
