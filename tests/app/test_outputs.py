"""Places to write to are checked before work begins."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from calibgui.app.outputs import check_writable, make_folder, save_figure
from calibgui.engine import CalibrationError
from calibgui.engine.images import image_size


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
    with pytest.raises(CalibrationError, match="may not write"):
        check_writable(tmp_path / "result.json")


def test_a_folder_is_made_with_those_above_it_unless_a_file_is_there(tmp_path: Path) -> None:
    make_folder(tmp_path / "a" / "b")
    make_folder(tmp_path / "a" / "b")
    (tmp_path / "file").touch()
    with pytest.raises(CalibrationError, match="cannot be made"):
        make_folder(tmp_path / "file")


def test_a_figure_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    figure = Figure(figsize=(2, 1))
    save_figure(figure, tmp_path / "figure.png")
    assert image_size(tmp_path / "figure.png") == (220, 110)
    with pytest.raises(CalibrationError, match="cannot be written"):
        save_figure(figure, tmp_path / "missing" / "figure.svg")
    assert [path.name for path in tmp_path.iterdir()] == ["figure.png"]
