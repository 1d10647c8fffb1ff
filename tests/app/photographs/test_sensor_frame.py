"""One frame for all photographs of a camera, however it was held when they were taken."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pillow

from calibgui.app.outputs.resampling import rectify_files, undistort_files
from calibgui.app.photographs.detection import find_views
from calibgui.app.photographs.paths import find_images
from calibgui.app.photographs.sensor_frame import share_frame
from calibgui.dataset import Result, View, ViewStatus, find_orientation
from calibgui.engine.calibration.calibrate import calibrate
from calibgui.engine.camera.distortion import project_points
from calibgui.engine.images.reading import read_image
from tests.photographs import BOARD, CAMERA, COUNT, draw_poses

pytestmark = pytest.mark.usefixtures("search_here")

UPRIGHT, UPSIDE_DOWN, PORTRAIT = 1, 3, 6
"""EXIF orientations of a telephone: held level, level the other way round, and upright."""


def write(folder: Path, name: str, size: tuple[int, int], orientation: int, make: str) -> View:
    """Write an image whose EXIF states an orientation, and a camera's maker."""
    exif = Pillow.Exif()
    exif[0x0112] = orientation
    if make:
        exif[0x010F] = make
    Pillow.new("L", size, orientation).save(folder / name, exif=exif)
    return View(str(folder / name))


@pytest.mark.parametrize(
    ("widths", "reason"),
    [
        ((64, 32, 64, 32), "32 x 20 pixels, others have 64 x 20."),
        ((64, 64, 64, 32), "32 x 20 pixels, most have 64 x 20."),
        ((64, 32, 40, 50), "The images have 4 different sizes, as if they were cropped"),
    ],
)
def test_an_image_of_another_size_is_told_what_sizes_there_are(
    tmp_path: Path, widths: tuple[int, ...], reason: str
) -> None:
    views = [write(tmp_path, f"{k}.png", (w, 20), UPRIGHT, "") for k, w in enumerate(widths)]
    shared, size = share_frame(views)
    assert size == (64, 20)
    assert [view.reason.startswith(reason) for view in shared] == [w != 64 for w in widths]


@pytest.fixture(scope="module")
def held_in_three_ways(photographs: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The photographs as a telephone stores them that is turned now and then."""
    folder = tmp_path_factory.mktemp("turned")
    ways = [UPRIGHT, UPSIDE_DOWN, UPRIGHT, PORTRAIT, UPRIGHT, UPSIDE_DOWN]
    for path, orientation in zip(sorted(photographs.glob("*.png")), ways, strict=True):
        exif = Pillow.Exif()
        exif[0x0112], exif[0x010F] = orientation, "Maker"
        Pillow.open(path).save(folder / path.name, exif=exif)
    return folder


def test_photographs_that_were_held_differently_are_of_one_camera(
    held_in_three_ways: Path, tmp_path: Path
) -> None:
    images = find_images([str(held_in_three_ways)])
    found = find_views(images, BOARD.grid_size)
    assert [view.status for view in found.views] == [ViewStatus.FOUND] * COUNT
    assert [view.orientation for view in found.views] == [UPRIGHT] * COUNT
    turned = [bool(view.note) for view in found.views]
    assert turned == [False, True, False, True, False, True]
    corner_set = found.corner_set(BOARD.square)
    calibration = calibrate(
        [view.observation(corner_set.board) for view in found.views], CAMERA.size
    )
    sigma = np.sqrt(np.diag(calibration.covariance))[:4]
    assert np.all(np.abs(calibration.camera.params[:4] - CAMERA.params[:4]) < 4 * sigma)
    assert calibration.camera.params[2] == pytest.approx(CAMERA.params[2], abs=1.0)

    result = Result(calibration, found.views, corner_set.board)
    assert find_orientation(result.used) == UPRIGHT
    made = rectify_files(result, images, tmp_path / "rectified", pixels_per_mm=1.0)
    pictures = [read_image(image.paths[""]).pixels.astype(float) for image in made]
    unlike = [np.mean(np.abs(picture - pictures[0])) for picture in pictures]
    assert max(unlike) < 25, "every board is square to the camera, none is upside down"
    straight = undistort_files(CAMERA, images, tmp_path / "u", orientation=UPRIGHT)
    assert {read_image(image.paths[""]).size for image in straight} == {CAMERA.size}


def test_most_photographs_decide(tmp_path: Path) -> None:
    views = [write(tmp_path, f"{k}.jpg", (40, 30), PORTRAIT, "M") for k in range(3)]
    views.append(write(tmp_path, "level.jpg", (40, 30), UPRIGHT, "M"))
    shared, size = share_frame(views)
    assert size == (30, 40)
    assert [view.orientation for view in shared] == [PORTRAIT] * 4
    assert [bool(view.note) for view in shared] == [False, False, False, True]


def test_photographs_are_turned_alike_where_images_of_another_size_are_more(
    photographs: Path, tmp_path: Path
) -> None:
    """What a camera takes, held upright or level, is of one size."""
    for k in range(3):
        write(tmp_path, f"depth{k}.png", (40, 30), UPRIGHT, "")
    for k, orientation in ((1, PORTRAIT), (2, UPRIGHT)):
        exif = Pillow.Exif()
        exif[0x0112], exif[0x010F] = orientation, "Maker"
        Pillow.open(photographs / f"view{k}.png").save(tmp_path / f"view{k}.png", exif=exif)
    write(tmp_path, "other.png", (50, 30), UPRIGHT, "")
    found = find_views(find_images([str(tmp_path)]), BOARD.grid_size)
    views = {view.name: view for view in found.views}
    assert {views[f"view{k}.png"].status for k in (1, 2)} == {ViewStatus.FOUND}
    assert len({views[f"view{k}.png"].orientation for k in (1, 2)}) == 1
    assert views["depth0.png"].reason.startswith("40 x 30 pixels, others have ")


def test_photographs_that_come_later_are_turned_like_those_before(tmp_path: Path) -> None:
    later = [write(tmp_path, f"{k}.jpg", (40, 30), UPSIDE_DOWN, "M") for k in range(3)]
    shared, _ = share_frame(later, (40, 30), UPRIGHT)
    assert [view.orientation for view in shared] == [UPRIGHT] * 3


def test_what_another_program_wrote_is_left_as_it_is(tmp_path: Path) -> None:
    """It may have turned the pixels, and states no camera."""
    views = [write(tmp_path, f"{k}.jpg", (40, 30), UPSIDE_DOWN, "M") for k in range(3)]
    views.append(write(tmp_path, "edited.jpg", (40, 30), UPRIGHT, ""))
    views.append(write(tmp_path, "exchanged.jpg", (30, 40), UPRIGHT, ""))
    shared, _ = share_frame(views)
    assert [view.orientation for view in shared[:4]] == [UPSIDE_DOWN] * 3 + [UPRIGHT]
    assert shared[4].status is ViewStatus.WRONG_SIZE
    assert "as the camera wrote it" in shared[4].reason


def test_the_orientation_of_a_set_is_that_of_its_boards() -> None:
    found = [View(f"{k}", ViewStatus.FOUND, orientation=PORTRAIT) for k in range(2)]
    others = [View(f"{k}", ViewStatus.NO_BOARD, orientation=UPRIGHT) for k in range(3)]
    assert find_orientation([*found, *others]) == PORTRAIT
    assert find_orientation(others) is None
    assert find_orientation([View("a", ViewStatus.FOUND)]) is None


def test_the_poses_are_those_of_the_sensor(held_in_three_ways: Path) -> None:
    """The fourth photograph is shown upright, and searched as it was stored."""
    (view,) = find_views(
        [held_in_three_ways / "view4.png"], BOARD.grid_size, size=CAMERA.size, orientation=UPRIGHT
    ).views
    assert view.corners is not None
    projected = project_points(BOARD.points(), CAMERA, draw_poses()[3])
    ends = view.corners.uv.min(axis=0), view.corners.uv.max(axis=0)
    np.testing.assert_allclose(ends[0], projected.min(axis=0), atol=0.3)
    np.testing.assert_allclose(ends[1], projected.max(axis=0), atol=0.3)
