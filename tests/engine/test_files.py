"""A file is replaced whole or not at all, and nothing but a file is read or replaced."""

from __future__ import annotations

import errno
import os
import stat
import time
from pathlib import Path

import pytest

from calibgui.engine import files
from calibgui.engine.errors import CalibrationError
from calibgui.engine.files import (
    describe_read_error,
    open_regular,
    open_replacement,
    read_regular,
    write_atomically,
)

posix = pytest.mark.skipif(os.name != "posix", reason="links and pipes of POSIX")


def test_a_file_is_replaced_and_keeps_its_permissions(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"old")
    file.chmod(0o640)
    write_atomically(file, b"new")
    assert file.read_bytes() == b"new"
    if os.name == "posix":
        assert file.stat().st_mode & 0o777 == 0o640
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_failure_leaves_the_old_file_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(CalibrationError, match="No space left"):
        write_atomically(file, b"new")
    assert file.read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_file_system_that_is_read_only_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Linux says so of a file that is not there as well, when it is to be removed."""

    def refuse(*_: object, **__: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(os, "open", refuse)
    monkeypatch.setattr(os, "unlink", refuse)
    with pytest.raises(CalibrationError, match="cannot be written: Read-only file system"):
        write_atomically(tmp_path / "file", b"new")


def test_a_name_may_be_as_long_as_the_system_allows(tmp_path: Path) -> None:
    file = tmp_path / ("x" * 250)
    write_atomically(file, b"new")
    assert file.read_bytes() == b"new"


@posix
def test_a_link_stays_and_leads_to_the_new_content(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    link, file = tmp_path / "link", tmp_path / "elsewhere" / "file"
    link.symlink_to(file)
    for content in (b"first", b"second"):
        write_atomically(link, content)
        assert link.is_symlink()
        assert file.read_bytes() == content


@posix
def test_a_pipe_is_not_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(CalibrationError, match="a device or a pipe"):
        write_atomically(tmp_path / "pipe", b"new")
    assert (tmp_path / "pipe").is_fifo()


@posix
def test_the_mask_is_never_set_and_no_moment_shows_more_than_it_allows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = os.umask(0o027)
    try:
        monkeypatch.setattr(os, "umask", lambda _: pytest.fail("the mask of all threads was set"))
        write_atomically(tmp_path / "new", b"new")
        assert (tmp_path / "new").stat().st_mode & 0o777 == 0o640
        (tmp_path / "old").touch(mode=0o600)
        monkeypatch.setattr(Path, "chmod", lambda *_: None)  # the moment before it
        with open_replacement(tmp_path / "old") as file:
            assert os.fstat(file.fileno()).st_mode & 0o777 == 0o600
    finally:
        monkeypatch.undo()
        os.umask(before)


@posix
def test_the_file_and_then_its_folder_are_flushed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    flushed, fsync = [], os.fsync

    def note(descriptor: int) -> None:
        is_folder = stat.S_ISDIR(os.fstat(descriptor).st_mode)
        flushed.append("folder" if is_folder else "file")
        assert is_folder == (tmp_path / "new").exists()
        fsync(descriptor)

    monkeypatch.setattr(os, "fsync", note)
    write_atomically(tmp_path / "new", b"new")
    assert flushed == ["file", "folder"]


def test_what_a_killed_program_left_is_removed_by_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "_swept", set())
    names = {
        ".calibgui.0a1b2c3d.tmp": 7200,  # abandoned
        ".calibgui.4e5f_678.tmp": 7200,  # abandoned by an earlier version
        ".calibgui.9a8b7c6d.tmp": 60,  # another program is writing it
        ".calibgui.json.autosave": 7200,
        ".other.0a1b2c3d.tmp": 7200,
        "calibgui.0a1b2c3d.tmp": 7200,
    }
    for name, age in names.items():
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (time.time() - age,) * 2)
    write_atomically(tmp_path / "new", b"new")
    assert {path.name for path in tmp_path.iterdir()} == {"new", *list(names)[2:]}


@posix
def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path("/dev/zero")):
        with pytest.raises(CalibrationError, match=f"{path} is a device or a pipe"):
            read_regular(path, 10)
    with pytest.raises(CalibrationError, match=r"a\\x00b' is no name of a file"):
        open_regular("a\0b")


def test_why_a_file_cannot_be_read_is_said(tmp_path: Path) -> None:
    for path, reason in (
        (tmp_path / "absent.json", "absent.json does not exist. Check its spelling."),
        (tmp_path, f"{tmp_path.name} is a folder. Name a file."),
        (tmp_path / ("x" * 5000), "cannot be read: File name too long."),
    ):
        with pytest.raises(OSError) as caught:
            read_regular(path, 10)
        assert reason in str(describe_read_error(path, caught.value))


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    file = tmp_path / "large"
    file.write_bytes(b"12345")
    assert read_regular(file, 5) == b"12345"
    with pytest.raises(CalibrationError, match=r"large is too large: more than 0 MB"):
        read_regular(file, 4)
