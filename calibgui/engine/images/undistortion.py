"""Undistortion: the image that an ideal camera would have taken (figure 9a).

The ideal camera has the position and the direction of the real one. It is a pinhole camera, or
one of the others of ``images.projections`` for lenses that see more than a pinhole camera can show.
Its focal lengths decide how much of the scene it shows. A perspective image keeps the ratio of the
real camera's; the others have square pixels. To show every measured pixel, or none that was not
measured, the outer edge of the image is undistorted and its extremes are fitted into the output.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import assert_never

import numpy as np

from calibgui.engine import opencv
from calibgui.engine.arrays import Array, Size
from calibgui.engine.camera.camera import Camera, check_image_size
from calibgui.engine.camera.models import find_model
from calibgui.engine.camera.plane import PlaneLens
from calibgui.engine.camera.sensor_mode import SensorMode
from calibgui.engine.errors import CalibrationError, parse_choice
from calibgui.engine.images.outline import (
    find_axis,
    find_outermost_pixels,
    prepare_tracing,
    sample_sides,
    trace_pixels,
)
from calibgui.engine.images.projections import (
    IdealCamera,
    Projection,
    find_widest_field_of_view,
    list_cube_rotations,
    project_ideally,
)
from calibgui.engine.images.resampling import (
    Pixels,
    ResampledImage,
    check_image,
    is_inside,
    make_matrix,
    resample_image,
)
from calibgui.engine.images.sampling import make_mesh

_WIDEST_PERSPECTIVE = np.deg2rad(120.0)
"""Field of view, radians, of a perspective image of a lens that sees 180 degrees and more. It is
stretched fourfold at its edges already, and twice as much at 140 degrees."""
_MAX_FITTED_LATITUDE = np.deg2rad(60.0)
"""Latitude, radians, up to which the width of a panorama is fitted to what the lens sees. Beyond,
meridians crowd: a lens of 181 degrees would ask for all 360 of a panorama, nearly all of it empty.
A cylinder, which is as high as the tangent of the latitude, ends there."""
_MAX_STEREOGRAPHIC_RADIUS = 2 * np.tan(np.deg2rad(150.0) / 2)
"""Radius to which a stereographic image is fitted: rays at 150 degrees off the axis."""
_FACE_SAMPLES = 129
"""Number of samples along the side of a cube's face that tell whether it shows anything."""


class FieldOfView(StrEnum):
    """The part of the measured image that an undistorted one shows."""

    ALL = "all"
    """Every measured pixel that the projection can show at a sensible size, and some border."""
    NO_BORDER = "no-border"
    """As much as fits without any pixel that was not measured."""
    SAME_SCALE = "same-scale"
    """The camera's own scale, so that the middle keeps its size."""


def undistort_image(
    image: Pixels,
    camera: Camera,
    view: FieldOfView | str = FieldOfView.ALL,
    size: Size | None = None,
    projection: Projection | str = Projection.PERSPECTIVE,
    field_of_view: float | None = None,
    square_pixels: bool = False,
) -> ResampledImage:
    """Make the image that an ideal camera would have taken, a pinhole camera by default.

    Args:
        image: (h, w) or (h, w, c) of the camera's size: 8 or 16 bits, or floating-point.
        camera: the camera that took it.
        view: how much to show.
        size: width and height of the output; those of the image if None.
        projection: how to show it.
        field_of_view: angle from the left edge of the output to the right one, radians, in place
            of `view`.
        square_pixels: whether a perspective output has equal focal lengths, and is stretched for
            that, where the camera's differ; the other projections have square pixels anyway.

    Raises:
        CalibrationError: if the image has another size than the camera, or what
            `choose_ideal_cameras` refuses, or the projection is a cube, which is several images.

    Example:
        >>> import numpy as np
        >>> from calibgui.engine.camera import Camera
        >>> from calibgui.engine.images import undistort_image
        >>> camera = Camera((64, 48), [50.0, 50.0, 31.5, 23.5, 0.1, 0, 0, 0, 0, 0])
        >>> grey = np.full((48, 64), 200, np.uint8)
        >>> undistorted = undistort_image(grey, camera, "no-border")
        >>> undistorted.image.shape, bool(undistorted.valid.all())
        ((48, 64), True)
        >>> ideal_focal_length = undistorted.matrix[0, 0]
    """
    image = check_image(image, camera)
    if projection == Projection.CUBE:
        raise CalibrationError(
            "A cube is several images.",
            "Make one with each camera of choose_ideal_cameras, by make_ideal_image.",
        )
    chosen = choose_ideal_cameras(camera, view, size, projection, field_of_view, square_pixels)
    (ideal,) = chosen.values()
    return make_ideal_image(image, camera, ideal)


def make_ideal_image(image: Pixels, camera: Camera, ideal: IdealCamera) -> ResampledImage:
    """Make the image that an ideal camera would have taken from the place of the real one.

    Raises:
        CalibrationError: if the image has another size than the camera.
    """
    image = check_image(image, camera)
    trace_rays = prepare_tracing(camera)
    return resample_image(
        image,
        ideal.size,
        ideal.matrix,
        lambda p: trace_rays(ideal.continue_rays(p)),
        ideal.shown,
    )


def choose_ideal_cameras(
    camera: Camera,
    view: FieldOfView | str = FieldOfView.ALL,
    size: Size | None = None,
    projection: Projection | str = Projection.PERSPECTIVE,
    field_of_view: float | None = None,
    square_pixels: bool = False,
) -> dict[str, IdealCamera]:
    """Choose the ideal cameras of which undistorted images are made.

    A perspective image of a lens that sees 180 degrees and more shows 120 of them at most, unless
    `field_of_view` says otherwise; a cylindrical one ends at 60 degrees above and below the axis.

    Args:
        camera, view, size, projection, field_of_view, square_pixels: as for `undistort_image`. Of a
            cube, the faces that show anything are made, whatever the view; they are square, and as
            wide as keeps the scale of the image's middle if `size` is None.

    Returns:
        The faces of a cube by their names, or one camera by the name "".

    Raises:
        CalibrationError: if the lens model is not one-to-one over the image (but for the same scale
            and for a stated field of view, where such pixels are invalid), or the projection cannot
            show that field of view.
    """
    view = parse_choice(FieldOfView, view, "field of view")
    projection = parse_choice(Projection, projection, "projection")
    if square_pixels:  # an ideal camera of the stretched images is one of the scene as well
        camera = SensorMode.squaring_pixels(camera).adapt_camera(camera)
    if projection is Projection.CUBE:
        return _choose_cube_faces(camera, size, field_of_view)
    size = check_image_size(size or camera.size)
    if field_of_view is not None:
        matrix = _span_field_of_view(camera, size, projection, field_of_view)
        return {"": IdealCamera(size, matrix, projection)}
    match view:
        case FieldOfView.SAME_SCALE:
            axis, scale = find_axis(camera)
            scale = scale if projection is Projection.PERSPECTIVE else np.full(2, scale[0])
            matrix = make_matrix(scale, axis + (np.array(size) - camera.size) / 2)
        case FieldOfView.ALL | FieldOfView.NO_BORDER:
            matrix = _fit_outline(camera, size, projection, view is FieldOfView.ALL)
        case _:
            assert_never(view)
    return {"": IdealCamera(size, matrix, projection)}


def _choose_cube_faces(
    camera: Camera, size: Size | None, field_of_view: float | None
) -> dict[str, IdealCamera]:
    """Return the cube's faces that see anything."""
    if field_of_view is not None:
        raise CalibrationError(
            "The faces of a cube show 90 degrees each.",
            "Leave the field of view out, or choose another projection.",
        )
    if size is None:
        _, scale = find_axis(camera)
        width = height = int(np.clip(np.rint(2 * scale[0]), 1, opencv.MAX_SIDE))
    else:
        width, height = check_image_size(size)
    if width != height:
        raise CalibrationError("The faces of a cube are square.", "Give one width and height.")
    matrix = make_matrix(np.full(2, width / 2), np.full(2, (width - 1) / 2))
    along = np.linspace(-0.5, width - 0.5, _FACE_SAMPLES)
    trace_rays = prepare_tracing(camera)

    def shows_anything(face: IdealCamera) -> bool:
        pixels = trace_rays(face.find_rays(make_mesh(along, along)))
        return bool(is_inside(pixels, camera.size).any())

    faces = {
        name: IdealCamera((width, height), matrix, Projection.PERSPECTIVE, rotation)
        for name, rotation in list_cube_rotations().items()
    }
    return {name: face for name, face in faces.items() if shows_anything(face)}


def _span_field_of_view(
    camera: Camera, size: Size, projection: Projection, field_of_view: float
) -> Array:
    """Return the matrix of an output as wide as `field_of_view`, radians, the axis in its middle.

    Raises:
        CalibrationError: if the projection cannot show so much.
    """
    widest = find_widest_field_of_view(projection)
    is_bounded = projection in (Projection.CYLINDRICAL, Projection.EQUIRECTANGULAR)
    if not (0 < field_of_view < widest or (is_bounded and field_of_view == widest)):
        raise CalibrationError(
            f"A {projection} image cannot show {np.rad2deg(field_of_view):.4g} degrees.",
            f"Choose a field of view above 0 and {'up to' if is_bounded else 'below'} "
            f"{np.rad2deg(widest):.0f} degrees, or another projection.",
        )
    half = field_of_view / 2
    right, _ = project_ideally(np.array([np.sin(half), 0.0, np.cos(half)]), projection)
    ratio = _choose_ratio(camera, projection)
    return make_matrix(size[0] / 2 / right * ratio / ratio[0], (np.array(size) - 1) / 2)


def _choose_ratio(camera: Camera, projection: Projection) -> Array:
    """Return (2,) numbers in the ratio of an output's focal lengths."""
    return camera.focal if projection is Projection.PERSPECTIVE else np.ones(2)


def _fit_outline(camera: Camera, size: Size, projection: Projection, shows_all: bool) -> Array:
    """Return the matrix that fits all that the lens sees, or only what it sees, into an output.

    Raises:
        CalibrationError: if the lens model is not one-to-one over the image, or an output without
            a border would show nothing.
    """
    outline = _find_outline(camera)
    out, ratio = np.array(size, dtype=np.float64), _choose_ratio(camera, projection)
    least = 0.0
    if projection is Projection.PERSPECTIVE and (outline[..., 2] <= 0).any():
        matrix = _span_field_of_view(camera, size, projection, _WIDEST_PERSPECTIVE)
        if shows_all:
            return matrix
        low = high = np.zeros(2)
        zoom = least = matrix[0, 0] / ratio[0]
    else:
        points = project_ideally(outline, projection)
        if shows_all:
            low, high = _measure_extent(outline, points, camera, projection)
        else:
            left, top, right, bottom = points
            low = np.array([left[:, 0].max(), top[:, 1].max()])
            high = np.array([right[:, 0].min(), bottom[:, 1].min()])
        zoom = float(np.min(out / (ratio * (high - low))))

    def make_zoomed(zoom: float) -> Array:
        focal = zoom * ratio
        return make_matrix(focal, (out - 1) / 2 - focal * (low + high) / 2)

    if shows_all:
        return make_zoomed(zoom)
    edge, trace_rays = sample_sides(size), prepare_tracing(camera)

    def is_borderless(zoom: float) -> bool:
        rays = IdealCamera(size, make_zoomed(zoom), projection).find_rays(edge)
        pixels = trace_rays(rays)
        return bool((is_inside(pixels, camera.size) & camera.lights(pixels)).all())

    return make_zoomed(_find_least_zoom(is_borderless, zoom, least))


def _find_outline(camera: Camera) -> Array:
    """Return the rays (4, count, 3) of the image's sides, or of the last pixels before them.

    Raises:
        CalibrationError: if the lens model is one of the plane and not one-to-one over the image,
            or sees nothing at all.
    """
    sides = sample_sides(camera.size)
    rays = trace_pixels(sides, camera)
    is_unseen = np.isnan(rays).any(axis=-1)
    if is_unseen.any():
        outermost = find_outermost_pixels(sides[is_unseen], camera)
        # A fisheye's circle may end within its image; a lens without one has an image everywhere.
        if isinstance(find_model(camera.model), PlaneLens) and not _ends_image(outermost, camera):
            raise CalibrationError(
                "The lens model folds over within the image: some pixels have no ideal place.",
                f"Undistort with the view {FieldOfView.SAME_SCALE.value!r}, or calibrate again "
                "with corners closer to the image's edges.",
            )
        rays[is_unseen] = trace_pixels(outermost, camera)
    if np.isnan(rays).any():
        raise CalibrationError(
            "The lens model sees nothing around its axis.", "Check the camera's parameters."
        )
    return rays


def _ends_image(uv: Array, camera: Camera) -> bool:
    """Return whether pixels (n, 2) are those along the circle that the lens lights, within 1 px."""
    circle = camera.circle
    return circle is not None and not circle._replace(radius=circle.radius - 1).contains(uv).any()


def _measure_extent(
    outline: Array, points: Array, camera: Camera, projection: Projection
) -> tuple[Array, Array]:
    """Return the least and the greatest point (2,) of what the lens sees and is fitted."""
    x, y = np.moveaxis(points, -1, 0)
    X, Y, Z = np.moveaxis(outline, -1, 0)
    latitude = np.arctan2(Y, np.hypot(X, Z))
    match projection:
        case Projection.PERSPECTIVE | Projection.CUBE:  # a face of a cube is perspective
            pass
        case Projection.STEREOGRAPHIC:
            x, y = points.transpose(2, 0, 1) * np.minimum(
                1.0, _MAX_STEREOGRAPHIC_RADIUS / np.hypot(x, y)
            )
        case Projection.CYLINDRICAL:
            x = x[np.abs(latitude) <= _MAX_FITTED_LATITUDE]
            y = np.clip(y, -np.tan(_MAX_FITTED_LATITUDE), np.tan(_MAX_FITTED_LATITUDE))
        case Projection.EQUIRECTANGULAR:
            x = x[np.abs(latitude) <= _MAX_FITTED_LATITUDE]
            poles = np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
            is_seen = is_inside(prepare_tracing(camera)(poles), camera.size)
            y = np.append(y, (np.array([-1, 1]) * np.pi / 2)[is_seen])
        case _:
            assert_never(projection)
    return np.array([x.min(), y.min()]), np.array([x.max(), y.max()])


def _find_least_zoom(is_borderless: Callable[[float], bool], zoom: float, least: float) -> float:
    """Find by bisection, to 1e-6, the least zoom from `least` on without a border.

    Raises:
        CalibrationError: if there is none.
    """
    low = high = zoom
    while is_borderless(low):
        if low <= least:
            return least
        low = max(low / 1.25, least)
    while not is_borderless(high):
        high *= 1.25
        if high > 1e6 * zoom:
            raise CalibrationError(
                "The lens sees nothing in the middle of its image.",
                f"Undistort with the view {FieldOfView.ALL.value!r}.",
            )
    while high - low > 1e-6 * high:
        middle = (low + high) / 2
        low, high = (low, middle) if is_borderless(middle) else (middle, high)
    return high
