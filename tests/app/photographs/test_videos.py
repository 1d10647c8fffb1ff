"""Frames of videos: sharp ones, in different poses, written once and without loss."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
import pytest

from calibgui.app.photographs.detection import Detection, find_views
from calibgui.app.photographs.videos import (
    DecodingProgress,
    FrameChoice,
    choose_views,
    sample_video,
    search_photographs,
)
from calibgui.dataset import View, ViewStatus
from calibgui.engine import opencv
from calibgui.engine.errors import CalibrationError
from calibgui.engine.features import Corners
from calibgui.engine.images import read_colour, write_image

pytestmark = pytest.mark.usefixtures("search_here")

_WIDTH, _HEIGHT = 320, 240
_POSES = 6


@contextmanager
def _say_nothing(*_: str) -> Iterator[DecodingProgress]:
    yield lambda *_: None


def _search(images: Sequence[Path]) -> Detection:
    return find_views(images, (5, 6))


def _draw(pose: int, blur: float = 0.7) -> np.ndarray:
    """Draw a board of 5 x 6 inner corners, further to the right and turned further at each pose."""
    squares = (np.add.outer(np.arange(6), np.arange(7)) % 2 * 200 + 30).astype(np.uint8)
    board = cv2.copyMakeBorder(
        np.kron(squares, np.ones((16, 16), np.uint8)),
        16,
        16,
        16,
        16,
        cv2.BORDER_CONSTANT,
        value=230,
    )
    A = cv2.getRotationMatrix2D((72, 64), 5.0 * pose, 1.0)
    A[:, 2] += [12 + 26 * pose, 45]
    grey = cv2.warpAffine(board, A, (_WIDTH, _HEIGHT), borderValue=120, flags=cv2.INTER_AREA)
    grey = cv2.GaussianBlur(grey, (0, 0), blur)
    noise = np.random.default_rng(pose).normal(0, 1.5, grey.shape)
    return np.clip(grey + noise, 0, 255).astype(np.uint8)


@pytest.fixture(scope="module")
def video(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A video of six poses, each for five frames: the third one sharp, the others blurred."""
    file = tmp_path_factory.mktemp("video") / "clip.avi"
    codec = cv2.VideoWriter_fourcc(*"FFV1")
    writer = cv2.VideoWriter(str(file), codec, 10, (_WIDTH, _HEIGHT))
    assert writer.isOpened()
    for pose in range(_POSES):
        for k in range(5):
            grey = _draw(pose, 0.7 if k == 2 else 2.5)
            writer.write(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR))
    writer.release()
    return file


def test_sharp_frames_in_different_poses_are_taken(video: Path, tmp_path: Path) -> None:
    choice = FrameChoice(4, tmp_path)
    detection = search_photographs([str(video)], choice, _search, _say_nothing)
    assert len(detection.views) == 4
    numbers = []
    for view in detection.views:
        assert view.status is ViewStatus.FOUND
        file = Path(view.image)
        assert file.parent == tmp_path / "clip-frames"
        numbers.append(int(file.stem.removeprefix("frame-")))
        pixels = read_colour(file)
        assert np.abs(pixels[..., 1].astype(int) - _draw(numbers[-1] // 5)).max() <= 1
    assert all(number % 5 == 2 for number in numbers), "a blurred one is taken"
    assert numbers == sorted(set(numbers))
    assert {0, 5} <= {number // 5 for number in numbers}, "the poses farthest apart are left out"
    assert "30 frames" in detection.remark
    assert "4 in which it differs most" in detection.remark


def test_what_adds_nothing_is_not_taken(video: Path, tmp_path: Path) -> None:
    """All thirty frames may be taken, but the poses are six."""
    choice = FrameChoice(30, tmp_path)
    views = search_photographs([str(video)], choice, _search, _say_nothing).views
    poses = {int(Path(view.image).stem[-6:]) // 5 for view in views}
    assert poses == set(range(_POSES))


def test_photographs_beside_a_video_are_all_kept(video: Path, tmp_path: Path) -> None:
    write_image(tmp_path / "a.png", _draw(3))
    names = [str(tmp_path / "a.png"), str(video)]
    views = search_photographs(names, FrameChoice(2, tmp_path), _search, _say_nothing).views
    assert Path(views[0].image).name == "a.png"
    assert len(views) == 3


def test_a_second_time_keeps_the_files_and_others_are_not_replaced(
    video: Path, tmp_path: Path
) -> None:
    choice = FrameChoice(2, tmp_path)
    first = search_photographs([str(video)], choice, _search, _say_nothing).views
    states = [Path(view.image).stat().st_mtime_ns for view in first]
    again = search_photographs([str(video)], choice, _search, _say_nothing).views
    assert [Path(view.image).stat().st_mtime_ns for view in again] == states
    write_image(first[1].image, np.zeros((3, 3), np.uint8))
    with pytest.raises(CalibrationError, match="exists and is another picture") as caught:
        search_photographs([str(video)], choice, _search, _say_nothing)
    assert "--frames-folder" in caught.value.hint


def test_a_video_of_unknown_length_is_sampled_evenly(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its frames become sharper up to the last of each fifty: these are kept, and few files."""
    frames = [np.full((8, 8, 3), k % 50, np.uint8) for k in range(1000)]
    monkeypatch.setattr(opencv, "decode_video", lambda _: (0, iter(frames)))
    monkeypatch.setattr(opencv, "measure_sharpness", lambda frame: float(frame[0, 0, 0]))
    kept, count = sample_video(Path("clip.avi"), tmp_path, 5, lambda *_: None)
    assert count == 1000
    assert 5 <= len(kept) <= 10
    assert sum(each.number % 50 == 49 for each in kept) >= 5
    assert sorted(tmp_path.iterdir()) == [each.file for each in kept]


def test_a_video_that_is_none_inside_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "clip.mp4"
    file.write_bytes(b"\0\0\0\x18ftypisom" + bytes(100))
    with pytest.raises(CalibrationError, match=r"clip\.mp4 cannot be decoded"):
        search_photographs([str(file)], FrameChoice(), _search, _say_nothing)


def test_of_two_frames_of_a_pose_the_one_with_less_noise_is_taken() -> None:
    grid = np.argwhere(np.ones((5, 6), bool))

    def make_view(name: str, shift: float, noise: float) -> View:
        uv = 10.0 * grid[:, ::-1] + shift
        cov = np.tile(noise**2 * np.eye(2), (len(grid), 1, 1))
        return View(name, ViewStatus.FOUND, corners=Corners((5, 6), grid, uv, uv, cov))

    views = [make_view("first", 0, 0.05), make_view("blurred", 51, 0.5), make_view("a", 50, 0.1)]
    assert [view.image for view in choose_views(views, 2)] == ["first", "a"]
    assert len(choose_views(views, 3)) == 3
    still = [make_view("first", 0, 0.05), make_view("again", 0.05, 0.1)]
    assert [view.image for view in choose_views(still, 2)] == ["first"]
