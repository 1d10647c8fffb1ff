"""Places to write to are checked before work begins."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from calibgui.app.outputs.output_files import (
    FIGURE_SUFFIXES,
    check_figures,
    check_outputs,
    check_writable,
    make_folder,
    save_figure,
)
from calibgui.engine.errors import CalibrationError
from calibgui.engine.images.reading import read_image_size


def test_a_file_in_an_existing_folder_is_fine(tmp_path: Path) -> None:
    check_writable(tmp_path / "result.json")
    assert not (tmp_path / "result.json").exists()


def test_a_missing_folder_and_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="does not exist"):
        check_writable(tmp_path / "missing" / "result.json")
    with pytest.raises(CalibrationError, match="is a folder"):
        check_writable(tmp_path)


def test_a_folder_closed_to_writing_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The administrator may write everywhere, so the system's answer is replaced.
    monkeypatch.setattr(os, "access", lambda *_: False)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(CalibrationError, match=f"may not write to {re.escape(str(tmp_path))}\\."):
        check_writable(Path("result.json"))


def test_a_protected_file_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "result.json"
    path.touch()
    check_writable(path)
    monkeypatch.setattr(os, "access", lambda name, _: Path(name) != path)
    with pytest.raises(CalibrationError, match=r"result\.json is protected"):
        check_writable(path)


def test_a_folder_is_made_with_those_above_it_unless_a_file_is_there(tmp_path: Path) -> None:
    make_folder(tmp_path / "a" / "b")
    make_folder(tmp_path / "a" / "b")
    (tmp_path / "file").touch()
    with pytest.raises(CalibrationError, match="cannot be made"):
        make_folder(tmp_path / "file")


def test_a_folder_that_is_closed_to_writing_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(CalibrationError, match=f"the folder {re.escape(str(tmp_path))}\\."):
        make_folder(tmp_path)


def test_a_figure_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    figure = Figure(figsize=(2, 1))
    save_figure(figure, tmp_path / "figure.png")
    assert read_image_size(tmp_path / "figure.png") == (220, 110)
    with pytest.raises(CalibrationError, match="cannot be written"):
        save_figure(figure, tmp_path / "missing" / "figure.svg")
    assert [path.name for path in tmp_path.iterdir()] == ["figure.png"]


def test_an_output_takes_no_other_files_place(tmp_path: Path) -> None:
    photograph, result = tmp_path / "a.png", (tmp_path / "r.json", "result")
    photograph.write_bytes(b"a photograph")
    check_outputs([result, (tmp_path / "r.yaml", "ros")], [photograph])
    for overwrite in (False, True):
        with pytest.raises(CalibrationError, match=r"a\.png is one of the files to read"):
            again = tmp_path / ".." / tmp_path.name / "a.png"
            check_outputs([(again, "figure")], [photograph], overwrite)
        with pytest.raises(CalibrationError, match=r"r\.json would be written twice"):
            check_outputs([result, (tmp_path / "." / "r.json", "result")], [], overwrite)


@pytest.mark.skipif(os.name != "posix", reason="links of POSIX")
def test_no_input_is_written_to_through_a_link(tmp_path: Path) -> None:
    photograph = tmp_path / "a.png"
    photograph.write_bytes(b"a photograph")
    (tmp_path / "soft.json").symlink_to(photograph)
    (tmp_path / "hard.json").hardlink_to(photograph)
    for name in ("soft.json", "hard.json"):
        with pytest.raises(CalibrationError, match=f"{name} is one of the files to read"):
            check_outputs([(tmp_path / name, "result")], [photograph], overwrite=True)


@pytest.mark.skipif(os.name != "posix", reason="links of POSIX")
def test_a_link_leads_to_no_other_file_that_is_replaced(tmp_path: Path) -> None:
    photograph, result, link = tmp_path / "a.png", tmp_path / "r.json", tmp_path / "link.json"
    photograph.write_bytes(b"a photograph that the corners came from")
    result.write_bytes(b'{"format": "calibgui-result", "version": 1}')
    link.symlink_to(photograph)
    for overwrite in (False, True):
        with pytest.raises(CalibrationError, match=r"leads to .*a\.png.*remove the link"):
            check_outputs([(link, "result")], [], overwrite)
    link.unlink()
    link.symlink_to(result)
    check_outputs([(link, "result")], [])


def test_only_files_of_the_same_kind_are_replaced(tmp_path: Path) -> None:
    file = tmp_path / "a"
    for content, is_replaced in (
        (b"", True),  # as mktemp makes it
        (b'{"format": "calibgui-result", "version": 1}', True),
        (
            b'{\n "format": "calibgui-project", "results": {"a": {"format": "calibgui-result"}}}',
            False,
        ),
        (b'{"format": "calibgui-plate"}', False),
        (b'{"origin": "Written by calibgui as corners."}', False),
        (b"\x89PNG a photograph", False),
    ):
        file.write_bytes(content)
        if is_replaced:
            check_outputs([(file, "result")], [])
        else:
            with pytest.raises(CalibrationError, match=r"is not a result\.json that.*--overwrite"):
                check_outputs([(file, "result")], [])
        check_outputs([(file, "result")], [], overwrite=True)
        assert file.read_bytes() == content


@pytest.mark.parametrize("suffix", FIGURE_SUFFIXES)
def test_a_figure_says_that_it_is_one_of_ours(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"figure{suffix.upper()}"
    save_figure(Figure(figsize=(2, 1)), path)
    check_figures([path], [])
    with pytest.raises(CalibrationError, match=r"is not a result\.json that calibgui wrote"):
        check_outputs([(path, "result")], [])
    Figure(figsize=(2, 1)).savefig(path, format=suffix[1:])
    with pytest.raises(CalibrationError, match="is not a figure that calibgui wrote"):
        check_figures([path], [])


@pytest.mark.skipif(os.name != "posix", reason="devices of POSIX")
def test_a_device_and_an_endless_name_are_refused(tmp_path: Path) -> None:
    with pytest.raises(CalibrationError, match="/dev/null cannot be written: it is a device"):
        check_writable(Path("/dev/null"))
    with pytest.raises(CalibrationError, match="cannot be written: File name too long"):
        check_writable(tmp_path / ("x" * 5000))
