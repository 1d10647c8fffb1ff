"""What is in the folder of new images stays, unless this program made it there."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from pathlib import Path

import pytest

from calibgui.app.outputs import resampling
from calibgui.app.outputs.output_folder import ForeignFilesError, OutputFolder
from calibgui.app.outputs.resampling import GEOMETRY_FILE, undistort_files
from calibgui.engine.errors import CalibrationError
from tests.photographs import CAMERA

FOREIGN = b"an old photograph"


@pytest.fixture
def images(photographs: Path) -> list[Path]:
    return [photographs / "view1.png", photographs / "view2.png"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "new"


def read_record(folder: Path) -> dict[str, str | None]:
    return json.loads((folder / GEOMETRY_FILE).read_text())["written"]


def test_photographs_of_the_same_name_stay_until_the_user_allows_it(
    images: list[Path], folder: Path
) -> None:
    folder.mkdir()
    (folder / "view2.png").write_bytes(FOREIGN)
    with pytest.raises(ForeignFilesError, match=r"new/view2\.png would be replaced.*--overwrite"):
        undistort_files(CAMERA, images, folder)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == {"view2.png": FOREIGN}
    undistort_files(CAMERA, images, folder, overwrite=True)
    assert (folder / "view2.png").read_bytes() != FOREIGN


def test_a_second_call_replaces_what_the_first_has_made(images: list[Path], folder: Path) -> None:
    undistort_files(CAMERA, images, folder)
    digests = {p.name: hashlib.sha256((folder / p.name).read_bytes()).hexdigest() for p in images}
    assert read_record(folder) == digests
    undistort_files(CAMERA, images[:1], folder)
    assert read_record(folder) == digests, "what the first call has made is still known"
    undistort_files(CAMERA, images, folder)
    (folder / "view1.png").write_bytes(FOREIGN)
    with pytest.raises(ForeignFilesError, match=r"view1\.png"):
        undistort_files(CAMERA, images, folder)
    assert (folder / "view1.png").read_bytes() == FOREIGN


def test_what_a_killed_call_has_left_is_replaced(
    images: list[Path], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Killed(BaseException):
        pass

    def kill(*_: object) -> None:
        raise Killed

    with monkeypatch.context() as patch:
        # The process ends after an image is in its place and before it is recorded.
        patch.setattr(OutputFolder, "record", kill)
        patch.setattr(OutputFolder, "close", lambda _: None)
        with pytest.raises(Killed):
            undistort_files(CAMERA, images[:1], folder)
    assert (folder / "view1.png").exists() and read_record(folder) == {"view1.png": None}
    undistort_files(CAMERA, images, folder)
    assert None not in read_record(folder).values()


@pytest.mark.skipif(os.name != "posix", reason="links of POSIX")
def test_nothing_is_written_through_links(images: list[Path], folder: Path, tmp_path: Path) -> None:
    originals = tmp_path / "originals"
    originals.mkdir()
    for path in images:
        shutil.copy(path, originals)
    before = {path.name: path.read_bytes() for path in originals.iterdir()}
    folder.mkdir()
    (folder / "view1.png").symlink_to(originals / "view1.png")
    for sources in (images, sorted(originals.iterdir())):
        with pytest.raises(CalibrationError, match=r"view1\.png is a link to .*originals/view1"):
            undistort_files(CAMERA, sources, folder, overwrite=True)
    # Photographs that are reached by links in the folder itself.
    with pytest.raises(CalibrationError, match="is a link"):
        undistort_files(CAMERA, [folder / "view1.png"], folder, overwrite=True)
    (folder / "view1.png").unlink()
    (folder / "view1.png").hardlink_to(originals / "view1.png")
    with pytest.raises(CalibrationError, match=r"view1\.png would be overwritten"):
        undistort_files(CAMERA, [originals / "view1.png"], folder, overwrite=True)
    assert {path.name: path.read_bytes() for path in originals.iterdir()} == before


def test_another_programs_geometry_file_stays(images: list[Path], folder: Path) -> None:
    folder.mkdir()
    (folder / GEOMETRY_FILE).write_text('{"images": "my own list"}')
    with pytest.raises(ForeignFilesError, match=GEOMETRY_FILE):
        undistort_files(CAMERA, images, folder)
    assert (folder / GEOMETRY_FILE).read_text() == '{"images": "my own list"}'


def test_a_call_that_makes_nothing_leaves_the_earlier_geometry(
    images: list[Path], folder: Path, tmp_path: Path
) -> None:
    broken = tmp_path / "broken.png"
    broken.write_bytes(b"no image")
    undistort_files(CAMERA, [broken], folder)
    assert list(folder.iterdir()) == []
    undistort_files(CAMERA, images, folder)
    before = json.loads((folder / GEOMETRY_FILE).read_text())
    undistort_files(CAMERA, [broken], folder)
    assert json.loads((folder / GEOMETRY_FILE).read_text()) == before
    assert resampling.GEOMETRY_FILE in {path.name for path in folder.iterdir()}
