"""What a user may call images, and what is found."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from calibgui.app.photographs import paths
from calibgui.app.photographs.paths import (
    NoImagesError,
    choose_images,
    count_images_below,
    describe_unread_folders,
    describe_unread_photographs,
    find_images,
    make_natural_key,
)
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images import photo_libraries
from calibgui.engine.images.reading import write_image


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("Image10.tif", "Image2.tif", "image1.TIF", "notes.txt", "._Image2.tif"):
        (tmp_path / name).touch()
    (tmp_path / "more.png").mkdir()
    return tmp_path


def names(paths: tuple[Path, ...]) -> list[str]:
    return [path.name for path in paths]


def test_a_folder_means_its_images_in_natural_order(folder: Path) -> None:
    assert names(find_images([str(folder)])) == ["image1.TIF", "Image2.tif", "Image10.tif"]


def test_a_pattern_means_the_files_that_match(folder: Path) -> None:
    assert names(find_images([str(folder / "Image*.tif")])) == ["Image2.tif", "Image10.tif"]


def test_a_pattern_may_go_through_folders(tmp_path: Path) -> None:
    (tmp_path / "a" / "b").mkdir(parents=True)
    (tmp_path / "a" / "b" / "deep.png").touch()
    assert names(find_images([str(tmp_path / "**" / "*.png")])) == ["deep.png"]


def test_a_named_file_is_taken_whatever_it_holds(folder: Path) -> None:
    assert names(find_images([str(folder / "notes.txt")])) == ["notes.txt"]


def test_every_image_comes_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    again = [str(folder), "Image2.tif", "./Image2.tif", str(folder / "Image*.tif")]
    if os.name == "posix":
        Path("link.tif").symlink_to("Image2.tif")
    assert len(find_images(again)) == 3


def test_names_are_any_text(tmp_path: Path) -> None:
    strange = ["Bild [1] é.png", "фото 2.png", "照片 10.png", "照片 9.png"]
    for name in strange:
        (tmp_path / name).touch()
    assert set(names(find_images([str(tmp_path)]))) == set(strange)
    assert names(find_images([str(tmp_path / "照片*")])) == ["照片 9.png", "照片 10.png"]
    # A name that looks like a pattern is a name if there is such a file.
    assert names(find_images([str(tmp_path / strange[0])])) == [strange[0]]


def test_natural_order_compares_numbers_as_numbers() -> None:
    ordered = ["a1", "a2", "A10", "b", "b1x2", "b1x10"]
    mixed = ["b1x10", "A10", "a2", "b", "a1", "b1x2"]
    assert sorted(mixed, key=make_natural_key) == ordered


@pytest.mark.parametrize("what", ["missing.tif", "missing*.tif", "empty"])
def test_what_stands_for_nothing_is_named(tmp_path: Path, what: str) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(CalibrationError, match=r"missing|empty") as caught:
        find_images([str(tmp_path / what)])
    assert caught.value.hint


def test_an_unset_variable_does_not_mean_the_folder_one_is_in(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    with pytest.raises(CalibrationError, match="'' does not exist"):
        find_images([""])


@pytest.mark.skipif(os.name != "posix", reason="links, pipes and rights of POSIX")
class TestSpecialFiles:
    def test_a_link_to_nowhere_is_missed_if_its_folder_is_named(self, folder: Path) -> None:
        (folder / "lost.png").symlink_to("nowhere.png")
        (folder / "ring.png").symlink_to("ring.png")
        assert {"lost.png", "ring.png"} < set(names(find_images([str(folder)])))

    def test_a_pipe_is_no_image(self, folder: Path) -> None:
        os.mkfifo(folder / "pipe.png")
        assert "pipe.png" not in names(find_images([str(folder)]))
        with pytest.raises(CalibrationError, match=r"pipe\.png is a device or a pipe"):
            find_images([str(folder / "pipe.png")])

    @pytest.mark.parametrize("what", ["", "image.png", "*.png"])
    def test_what_may_not_be_looked_at_is_named(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, what: str
    ) -> None:
        closed = tmp_path / "closed"
        closed.mkdir()

        def deny(*_: object, **__: object) -> None:
            raise PermissionError(13, "Permission denied", str(closed))

        # The administrator may look everywhere, so the system's answer is replaced.
        monkeypatch.setattr(os, "stat" if what else "listdir", deny)
        monkeypatch.setattr(os, "scandir", deny)
        with pytest.raises(CalibrationError, match=r"closed.*Permission denied"):
            find_images([str(closed / what)])

    def test_a_name_that_no_file_can_have_is_named(self) -> None:
        with pytest.raises(CalibrationError, match="cannot be read"):
            find_images(["x" * 5000])


@pytest.fixture
def no_photo_libraries(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the libraries that read HEIC and raw images seem not to be installed."""
    monkeypatch.setattr(photo_libraries, "find_spec", lambda _: None)


@pytest.mark.usefixtures("no_photo_libraries")
def test_a_folder_of_other_formats_is_described(tmp_path: Path) -> None:
    for name in ("IMG_1.HEIC", "IMG_2.heic", "film.mov"):
        (tmp_path / name).touch()
    with pytest.raises(CalibrationError, match=r"2 of \.heic, 1 of \.mov\..* as PNG or as JPEG"):
        find_images([str(tmp_path)])


def make_cameras(folder: Path) -> None:
    """Make a folder of two cameras, one of them with two sessions, and things beside them."""
    for place, count in (("left/day 2", 3), ("left/day 10", 1), ("right", 2), (".cache", 4)):
        (folder / place).mkdir(parents=True)
        for k in range(count):
            (folder / place / f"{k}.png").touch()
    (folder / "notes").mkdir()
    (folder / "notes.txt").touch()


def test_of_a_folder_of_folders_those_with_images_are_named(tmp_path: Path) -> None:
    make_cameras(tmp_path)
    expected = [("left/day 2", 3), ("left/day 10", 1), ("right", 2)]
    counts = count_images_below(tmp_path)
    assert [(path.relative_to(tmp_path).as_posix(), n) for path, n in counts.items()] == expected
    for find in (find_images, choose_images):
        with pytest.raises(NoImagesError) as caught:
            find([str(tmp_path)])
        assert caught.value.folders == counts
        message = caught.value.message.replace(os.sep, "/")
        assert "in left/day 2 (3 images), left/day 10 (1 image), right (2 images)." in message
        assert str(tmp_path / "left" / "day 2") in caught.value.hint
        assert "of one camera" in caught.value.hint
    for name in ("one", "two", "three"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "image.png").touch()
    with pytest.raises(NoImagesError, match=r"and 1 more\."):
        find_images([str(tmp_path)])


def test_a_search_below_a_folder_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for k in range(5):
        (tmp_path / f"{k}").mkdir()
        (tmp_path / f"{k}" / "image.png").touch()
    if os.name == "posix":
        (tmp_path / "0" / "ring").symlink_to(tmp_path)
    assert len(count_images_below(tmp_path)) == 5
    monkeypatch.setattr(paths, "_MAX_FOLDERS", 3)
    assert [path.name for path in count_images_below(tmp_path)] == ["0", "1"]


def test_of_a_selection_only_images_are_taken(tmp_path: Path) -> None:
    """All that lies in a folder is dropped at once: notes, videos, folders of other things."""
    contents = {"photo.png": b"cut", "clip.mp4": b"\0\0\0 ftypisom", "notes.txt": b"hi"}
    for name, content in contents.items():
        (tmp_path / name).write_bytes(content)
    write_image(tmp_path / "scan.png", np.zeros((4, 6), np.uint8))
    (tmp_path / "scan.png").rename(tmp_path / "scan")  # an image by what it holds
    (tmp_path / "empty").mkdir()
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "2.png").touch()
    images, others = choose_images([str(path) for path in sorted(tmp_path.iterdir())])
    assert names(images) == ["2.png", "photo.png", "scan"]
    assert [Path(name).name for name in others] == ["clip.mp4", "empty", "notes.txt"]


def test_a_selection_without_images_is_refused_with_the_reason(tmp_path: Path) -> None:
    (tmp_path / "clip.mp4").write_bytes(b"\0\0\0 ftypisom")
    with pytest.raises(CalibrationError, match=r"clip\.mp4 is a video"):
        choose_images([str(tmp_path / "clip.mp4")])
    with pytest.raises(CalibrationError, match="does not exist"):
        choose_images([str(tmp_path / "nowhere")])


def test_folders_that_are_not_read_with_a_named_one_are_said(tmp_path: Path) -> None:
    for name in ("1.png", "a/1.png", "a/2.png", "a/b/1.png", "c/notes.txt"):
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).touch()
    whole, a, b = str(tmp_path), str(tmp_path / "a"), str(tmp_path / "a" / "b")
    said = describe_unread_folders([whole])
    assert f"Not read: {a} (2 images), {b} (1 image). " in said
    assert f"Not read: {a} (2 images). " in describe_unread_folders([whole, b])
    assert describe_unread_folders([whole, a, f"{b}/*.png"]) == ""
    assert f"Not read: {b} (1 image). " in describe_unread_folders([whole], [Path(a) / "1.png"])
    assert describe_unread_folders([b]) == ""
    assert describe_unread_folders([f"{whole}/*.png"]) == ""


@pytest.mark.usefixtures("no_photo_libraries")
def test_photographs_of_formats_that_are_not_read_are_said(tmp_path: Path) -> None:
    """A phone writes HEIC; a camera writes a raw image beside each JPEG, which is the same."""
    for name in ("1.jpg", "1.DNG", "2.HEIC", "3.heic", "4.nef", ".5.heic", "notes.txt"):
        (tmp_path / name).touch()
    said = describe_unread_photographs([str(tmp_path)])
    assert "Not read: photographs in other formats, 2 of .heic, 1 of .nef. Save them" in said
    assert describe_unread_photographs([str(tmp_path / "1.jpg")]) == ""
    (tmp_path / "2.jpg").touch()
    assert "1 of .heic" in describe_unread_photographs([str(tmp_path)])
