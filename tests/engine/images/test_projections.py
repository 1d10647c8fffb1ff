"""Rays of ideal cameras against formulas written anew, images of wide lenses against a painting.

The painting is a colour for every direction of sight. A fisheye's image of it is painted pixel by
pixel through the lens's printed formula; brought back by ``undistort_image``, each output pixel
must have the colour of the direction that it shows.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from calibgui.engine.arrays import Array
from calibgui.engine.camera.camera import Camera
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.outline import prepare_tracing
from calibgui.engine.images.projections import IdealCamera, Projection, list_cube_rotations
from calibgui.engine.images.smooth_map import MAP_TOLERANCE_PX, interpolate_map
from calibgui.engine.images.undistortion import (
    FieldOfView,
    choose_ideal_cameras,
    make_ideal_image,
    undistort_image,
)

SINGLE = [projection for projection in Projection if projection is not Projection.CUBE]
FISHEYE = Camera((500, 400), [120.0, 123.0, 245.0, 203.0, 0.0, 0.0, 0.0, 0.0], "kannala-brandt")
"""Equidistant, 235 by 186 degrees: theta = |((u - cx) / fx, (v - cy) / fy)|."""


def see_equidistantly(uv: Array, camera: Camera) -> Array:
    """Rays of an equidistant fisheye, from its definition."""
    x, y = np.moveaxis((uv - camera.centre) / camera.focal, -1, 0)
    theta, phi = np.hypot(x, y), np.arctan2(y, x)
    return np.stack(
        [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1
    )


def mesh(size: tuple[int, int]) -> Array:
    return np.stack(np.meshgrid(*map(np.arange, size)), axis=-1).astype(float)


def paint(rays: Array) -> Array:
    """A smooth colour (..., 3) float32 of every direction, different for all of them."""
    unit = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    return (100 * unit + 20 * np.sin(5 * unit[..., [1, 2, 0]])).astype(np.float32)


def angle_between(a: Array, b: Array) -> Array:
    cross = np.linalg.norm(np.cross(a, b), axis=-1)
    return np.arctan2(cross, np.sum(a * b, axis=-1))


def see_ideally(projection: Projection, x: float, y: float) -> Array:
    """The ray of an image point, as rotations and trigonometry tell it."""
    if projection is Projection.PERSPECTIVE:
        return np.array([x, y, 1.0])
    if projection is Projection.STEREOGRAPHIC:
        # From the point opposite to the axis on the unit sphere, through the plane that touches it.
        theta, phi = 2 * math.atan(math.hypot(x, y) / 2), math.atan2(y, x)
        return np.array(
            [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]
        )
    latitude = math.atan(y) if projection is Projection.CYLINDRICAL else y
    # Up or down first (about -X), then to the side (about Y).
    return Rotation.from_euler("xy", [-latitude, x]).apply([0.0, 0.0, 1.0])


def make_ideal(projection: Projection) -> IdealCamera:
    matrix = np.array([[110.0, 0, 180.0], [0, 90.0, 140.0], [0, 0, 1]])
    return IdealCamera((400, 300), matrix, projection)


@pytest.mark.parametrize("projection", SINGLE)
@given(u=st.floats(0, 399), v=st.floats(0, 281))
def test_rays_of_pixels_and_back(projection: Projection, u: float, v: float) -> None:
    ideal = make_ideal(projection)
    expected = see_ideally(projection, (u - 180) / 110, (v - 140) / 90)
    rays = ideal.find_rays(np.array([u, v]))
    assert angle_between(rays, expected) < 1e-12
    np.testing.assert_allclose(ideal.find_pixels(3.7 * expected), [u, v], atol=1e-9)


@pytest.mark.parametrize("projection", SINGLE)
def test_the_scale_on_the_axis_is_the_focal_length(projection: Projection) -> None:
    rays = np.array([[1e-6, 0, 1], [0, 1e-6, 1]])
    moved = make_ideal(projection).find_pixels(rays) - [180, 140]
    np.testing.assert_allclose(moved * 1e6, [[110, 0], [0, 90]], rtol=1e-6, atol=1e-3)


def test_directions_are_shown_once() -> None:
    f, off = 10.0, np.array([[-0.1, 5.0], [0.1, 5.0]])
    matrix = np.array([[f, 0, f * np.pi], [0, f, f * np.pi / 2], [0, 0, 1]])
    for projection in (Projection.CYLINDRICAL, Projection.EQUIRECTANGULAR):
        whole = IdealCamera((64, 32), matrix, projection)
        np.testing.assert_array_equal(np.isnan(whole.find_rays(off)).any(axis=-1), [True, False])
        right = whole.find_rays(np.array([[2 * f * np.pi + 0.1, 5.0]]))
        assert np.isnan(right).all()
    globe = IdealCamera((64, 32), matrix, Projection.EQUIRECTANGULAR)
    beyond_the_pole = globe.find_rays(np.array([[20.0, -0.1], [20.0, f * np.pi + 0.1]]))
    assert np.isnan(beyond_the_pole).all()
    np.testing.assert_allclose(globe.find_pixels(np.array([0.0, 1.0, 0.0]))[1], f * np.pi)
    assert np.isnan(make_ideal(Projection.PERSPECTIVE).find_pixels(np.array([1.0, 0, 0]))).all()


@pytest.mark.parametrize("projection", SINGLE)
@pytest.mark.parametrize("view", [*FieldOfView, 120.0])
def test_every_direction_has_its_colour(projection: Projection, view: FieldOfView | float) -> None:
    image = paint(see_equidistantly(mesh(FISHEYE.size), FISHEYE))
    stated = np.deg2rad(view) if isinstance(view, float) else None
    kept = FieldOfView.ALL if isinstance(view, float) else view
    made = undistort_image(image, FISHEYE, kept, None, projection, stated)
    (f1, f2), c = made.matrix[[0, 1], [0, 1]], made.matrix[:2, 2]
    points = (mesh(FISHEYE.size) - c) / [f1, f2]
    v, u = np.nonzero(made.valid)
    some = np.random.default_rng(1).integers(0, len(v), 2000)
    rays = np.array([see_ideally(projection, *points[v[i], u[i]]) for i in some])
    # Bilinear interpolation, in steps of 1/32 px in OpenCV 4, of up to 2 levels a pixel.
    error = np.abs(made.image[v[some], u[some]] - paint(rays))
    x, y = np.moveaxis((mesh(FISHEYE.size)[v[some], u[some]] - c) / [f1, f2], -1, 0)
    assert error.max() < 0.6, (x[error.max(axis=1).argmax()], y[error.max(axis=1).argmax()])
    if view is FieldOfView.NO_BORDER:
        assert made.valid.all()
    if isinstance(view, float):
        left, right = (see_ideally(projection, (edge - c[0]) / f1, 0.0) for edge in (-0.5, 499.5))
        assert angle_between(left, right) == pytest.approx(stated, abs=1e-9)


@pytest.mark.parametrize("projection", SINGLE)
def test_valid_is_what_the_lens_sees(projection: Projection) -> None:
    """Each output pixel is valid if its ray falls on the image, by the fisheye's formula."""
    made = undistort_image(np.zeros((400, 500), np.uint8), FISHEYE, "all", (600, 300), projection)
    ideal = IdealCamera((600, 300), made.matrix, projection)
    X, Y, Z = np.moveaxis(ideal.find_rays(mesh((600, 300))), -1, 0)
    scale = np.arctan2(np.hypot(X, Y), Z) / np.hypot(X, Y)
    uv = FISHEYE.centre + FISHEYE.focal * (scale[..., None] * np.stack([X, Y], axis=-1))
    inside = ((uv >= -0.5) & (uv <= np.array(FISHEYE.size) - 0.5)).all(axis=-1)
    to_edge = np.minimum(uv + 0.5, np.array(FISHEYE.size) - 0.5 - uv).min(axis=-1)
    is_sure = ~(np.abs(to_edge) < 0.02)
    np.testing.assert_array_equal(made.valid[is_sure], inside[is_sure])
    assert 0.2 < inside.mean()


def test_pixels_beyond_the_poles_are_not_valid() -> None:
    """The lens sees some degrees beyond them, which other pixels of the globe show already."""
    f = 40.0
    matrix = [[f, 0, 149.5], [0, f, 79.5], [0, 0, 1]]
    globe = IdealCamera((300, 160), matrix, Projection.EQUIRECTANGULAR)
    made = make_ideal_image(np.ones((400, 500), np.uint8), FISHEYE, globe)
    is_shown = np.abs(np.arange(160) - 79.5) <= f * np.pi / 2
    np.testing.assert_array_equal(made.valid.any(axis=1), is_shown)


def test_straight_lines_stay_straight_in_perspective() -> None:
    made = undistort_image(np.zeros((400, 500), np.uint8), FISHEYE, field_of_view=np.deg2rad(130))
    ideal = IdealCamera(FISHEYE.size, made.matrix)
    # Points on a line in space; the fisheye bends it, the perspective image must not.
    line = np.array([-2.0, 0.7, 1.5]) + np.linspace(0, 1, 30)[:, None] * [4.0, -0.9, 0.4]
    uv = ideal.find_pixels(line)
    across = np.linalg.svd(uv - uv.mean(axis=0))[1][1]
    assert across < 1e-9
    theta = angle_between(line, np.array([0.0, 0.0, 1.0]))
    bent = FISHEYE.focal * (theta / np.hypot(*line[:, :2].T))[:, None] * line[:, :2]
    assert np.linalg.svd(bent - bent.mean(axis=0))[1][1] > 5


def test_upright_lines_stay_straight_on_a_cylinder() -> None:
    ideal = make_ideal(Projection.CYLINDRICAL)
    pole = np.stack([np.full(20, -0.7), np.linspace(-1, 1, 20), np.full(20, -0.3)], axis=-1)
    assert np.ptp(ideal.find_pixels(pole)[:, 0]) < 1e-12


@pytest.mark.parametrize("x", [-1.2, 0.4])
@pytest.mark.parametrize("y", [-0.6, 0.9])
def test_small_shapes_are_kept_stereographically(x: float, y: float) -> None:
    """The map from the sphere is conformal: its Jacobian is a scaled rotation."""
    f = np.array([100.0, 100.0])
    ideal = IdealCamera(
        (1, 1), np.array([[100.0, 0, 0], [0, 100.0, 0], [0, 0, 1]]), "stereographic"
    )
    step = 1e-5
    rays = ideal.find_rays(f * [[x - step, y], [x + step, y], [x, y - step], [x, y + step]])
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    by_x, by_y = (rays[1] - rays[0]) / (2 * step), (rays[3] - rays[2]) / (2 * step)
    assert abs(by_x @ by_y) < 1e-8
    assert np.linalg.norm(by_x) == pytest.approx(np.linalg.norm(by_y), rel=1e-8)


def test_the_faces_of_a_cube_join() -> None:
    """Pixels on a common edge of two faces have the same ray from both."""
    image = paint(see_equidistantly(mesh(FISHEYE.size), FISHEYE))
    faces = choose_ideal_cameras(FISHEYE, projection="cube")
    assert list(faces) == ["front", "left", "right", "top", "bottom", "back"]
    made = {name: make_ideal_image(image, FISHEYE, face) for name, face in faces.items()}
    n = faces["front"].size[0]
    assert n == 240  # two focal lengths: the scale of the middle
    along = np.linspace(-0.5, n - 0.5, 25)
    sides = {
        "left": np.stack([np.full(25, -0.5), along], axis=-1),
        "right": np.stack([np.full(25, n - 0.5), along], axis=-1),
        "top": np.stack([along, np.full(25, -0.5)], axis=-1),
        "bottom": np.stack([along, np.full(25, n - 0.5)], axis=-1),
    }
    joined = compared = 0
    for (a, face_a), (b, face_b) in itertools.combinations(faces.items(), 2):
        for one, other in itertools.product(sides, repeat=2):
            p, q = sides[one], sides[other]
            rays = face_a.find_rays(p)
            for turned in (q, q[::-1]):
                if angle_between(rays, face_b.find_rays(turned)).max() < 1e-9:
                    joined += 1
                    ends = [np.clip(np.rint(s), 0, n - 1).astype(int) for s in (p, turned)]
                    levels = [
                        made[face].image[end[:, 1], end[:, 0]].astype(float)
                        for face, end in zip((a, b), ends, strict=True)
                    ]
                    seen = [
                        made[face].valid[end[:, 1], end[:, 0]]
                        for face, end in zip((a, b), ends, strict=True)
                    ]
                    both = seen[0] & seen[1]
                    # Half a pixel on either side of the edge, of up to 1.7 levels a pixel.
                    assert np.abs(levels[0] - levels[1])[both].max(initial=0.0) < 2.5
                    compared += both.sum()
    assert joined == 12
    assert compared > 200


def test_the_cross_of_a_cube_joins() -> None:
    """Unfolded around the front, with the back at the far right, neighbours have common edges."""
    n = 240
    along = np.linspace(-0.5, n - 0.5, 9)
    first, last = np.full(9, -0.5), np.full(9, n - 0.5)
    faces = choose_ideal_cameras(FISHEYE, projection="cube")

    def see(face: str, u: Array, v: Array) -> Array:
        return faces[face].find_rays(np.stack([u, v], axis=-1))

    for left, right in itertools.pairwise(("left", "front", "right", "back")):
        a, b = see(left, last, along), see(right, first, along)
        assert angle_between(a, b).max() < 1e-12
    for above, below in itertools.pairwise(("top", "front", "bottom")):
        a, b = see(above, along, last), see(below, along, first)
        assert angle_between(a, b).max() < 1e-12


def test_the_poles_are_shown_if_they_are_seen() -> None:
    """The image's sides end at a latitude of 85 degrees, beyond the poles."""
    for size in ((500, 400), (2000, 500)):
        ideal = choose_ideal_cameras(FISHEYE, "all", size, "equirectangular")[""]
        _, top = ideal.find_pixels([0.0, -1.0, 0.0])
        _, bottom = ideal.find_pixels([0.0, 1.0, 0.0])
        assert -0.5 - 1e-9 <= top < bottom <= size[1] - 0.5 + 1e-9


def test_the_faces_of_a_cube_look_outwards() -> None:
    ahead = {
        "front": [0, 0, 1],
        "left": [-1, 0, 0],
        "right": [1, 0, 0],
        "top": [0, -1, 0],
        "bottom": [0, 1, 0],
        "back": [0, 0, -1],
    }
    rotations = list_cube_rotations()
    assert rotations.keys() == ahead.keys()
    for name, R in rotations.items():
        np.testing.assert_array_equal(R @ [0, 0, 1], ahead[name])
        assert np.linalg.det(R) == pytest.approx(1.0)
        np.testing.assert_array_equal(R @ R.T, np.eye(3))


def test_every_direction_of_a_cube_has_its_colour() -> None:
    image = paint(see_equidistantly(mesh(FISHEYE.size), FISHEYE))
    for name, face in choose_ideal_cameras(FISHEYE, size=(100, 100), projection="cube").items():
        made = make_ideal_image(image, FISHEYE, face)
        points = (mesh((100, 100)) - 49.5) / 50
        local = np.concatenate([points, np.ones((100, 100, 1))], axis=-1)
        rays = local @ list_cube_rotations()[name].T
        assert np.abs(made.image - paint(rays))[made.valid].max() < 0.6
        assert made.valid.any()


def test_faces_that_see_nothing_are_left_out() -> None:
    narrow = Camera((640, 480), [650.0, 650, 320, 240, -0.25, 0.12, 0, 0, -0.03], "brown-conrady")
    # Its polynomial folds at 56 degrees and would send rays from the sides back into the image.
    assert list(choose_ideal_cameras(narrow, projection="cube")) == ["front"]
    wide = Camera((640, 200), [320.0, 320, 320, 100, 0, 0, 0, 0], "kannala-brandt")
    assert list(choose_ideal_cameras(wide, projection="cube")) == ["front", "left", "right"]


def test_rays_from_beyond_a_fold_are_not_shown() -> None:
    folding = Camera((640, 480), [650.0, 650, 320, 240, -0.25, 0.12, 0, 0, -0.03], "brown-conrady")
    image = np.full((480, 640), 200, np.uint8)
    made = undistort_image(image, folding, projection="equirectangular", field_of_view=np.pi)
    u = np.nonzero(made.valid)[1]
    shown = (np.array([u.min(), u.max()]) - 319.5) / 640 * 180
    np.testing.assert_allclose(shown, [-28, 28], atol=2)


@pytest.mark.parametrize(
    ("projection", "degrees", "said"),
    [
        ("perspective", 180.0, "below 180 degrees"),
        ("stereographic", 360.0, "below 360 degrees"),
        ("cylindrical", 360.5, "up to 360 degrees"),
        ("equirectangular", -1.0, "up to 360 degrees"),
        ("cube", 90.0, "90 degrees each"),
    ],
)
def test_an_impossible_field_of_view_is_refused(projection: str, degrees: float, said: str) -> None:
    with pytest.raises(CalibrationError) as error:
        choose_ideal_cameras(FISHEYE, projection=projection, field_of_view=np.deg2rad(degrees))
    assert said in str(error.value)


def test_the_whole_globe() -> None:
    for projection in ("cylindrical", "equirectangular"):
        (globe,) = choose_ideal_cameras(
            FISHEYE, size=(360, 180), projection=projection, field_of_view=2 * np.pi
        ).values()
        assert globe.matrix[0, 0] == pytest.approx(180 / np.pi)
        assert np.isfinite(globe.find_rays(mesh((360, 180)))).all()


def test_a_cube_is_not_one_image() -> None:
    with pytest.raises(CalibrationError, match="several images"):
        undistort_image(np.zeros((400, 500), np.uint8), FISHEYE, projection="cube")
    with pytest.raises(CalibrationError, match="square"):
        choose_ideal_cameras(FISHEYE, size=(100, 90), projection="cube")
    with pytest.raises(CalibrationError, match="no projection 'mercator'"):
        choose_ideal_cameras(FISHEYE, projection="mercator")


@pytest.mark.parametrize("model", ["mei", "double-sphere"])
def test_the_same_scale_is_that_of_the_middle(model: str) -> None:
    """Models whose f is not the scale on the axis: a step of one pixel there is one pixel."""
    k = {"mei": [1.2, -0.1, 0.01, 0, 0], "double-sphere": [-0.2, 0.55]}[model]
    camera = Camera((640, 480), [400.0, 400, 320, 240, *k], model)
    for projection in SINGLE:
        (ideal,) = choose_ideal_cameras(camera, "same-scale", projection=projection).values()
        image = np.stack(np.meshgrid(np.arange(640), np.arange(480)), axis=-1).astype(np.float32)
        made = make_ideal_image(image, camera, ideal).image
        np.testing.assert_allclose(made[240, 320:322], [[320, 240], [321, 240]], atol=0.05)


def test_a_circle_within_the_image_is_fitted() -> None:
    """A model that ends within its image is shown as far as it goes."""
    camera = Camera((640, 480), [150.0, 150, 320, 240, 0.9, 1.0], "eucm")
    made = undistort_image(np.zeros((480, 640), np.uint8), camera, "all", None, "stereographic")
    assert made.valid.any()
    filled = [made.valid.any(axis=axis).mean() for axis in (0, 1)]
    assert max(filled) > 0.97


LENSES = {
    "equidistant": FISHEYE,
    "ends within the image": Camera((500, 400), [130.0, 128, 251, 196, 0.9, 1.0], "eucm"),
    "sees all directions but one": Camera(
        (500, 400), [95.0, 95, 249, 201, -0.2, 0.55], "double-sphere"
    ),
    "below 90 degrees": Camera(
        (500, 400), [420.0, 425, 240, 210, -0.25, 0.12, 3e-4, -5e-4, -0.03], "brown-conrady"
    ),
}


@pytest.mark.parametrize("camera", LENSES.values(), ids=LENSES)
@pytest.mark.parametrize("projection", Projection)
def test_the_interpolated_map_is_the_exact_one(camera: Camera, projection: Projection) -> None:
    """Also where the lens sees nothing: there, and only there, neither has a pixel."""
    size = (600, 600)
    low, high = np.full(2, -0.5), np.array(camera.size) - 0.5
    trace_rays = prepare_tracing(camera)
    for ideal in choose_ideal_cameras(camera, "all", size, projection).values():
        rows_of = interpolate_map(
            size, lambda p, ideal=ideal: trace_rays(ideal.continue_rays(p)), low, high
        )
        made = np.moveaxis(rows_of(slice(0, size[1])), 0, -1)
        exact = trace_rays(ideal.continue_rays(mesh(size)))
        is_seen = ((exact >= low) & (exact <= high)).all(axis=-1)
        assert np.abs(made - exact)[is_seen].max() < 1.2 * MAP_TOLERANCE_PX
        to_edge = np.minimum(made - low, high - made).min(axis=-1)
        assert not (to_edge[~is_seen] > MAP_TOLERANCE_PX).any()
