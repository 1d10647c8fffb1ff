from __future__ import annotations

import tempfile
from pathlib import Path

import pytest

from calibgui.app.projects.recent import Recent, list_recent, remember_project
from calibgui.app.system.state_folder import find_state_folder, is_state_lasting


@pytest.fixture
def no_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A HOME that nobody can make, root neither."""
    (tmp_path / "file").touch()
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "file" / "home"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


@pytest.mark.usefixtures("no_home")
def test_without_a_home_notes_are_temporary(tmp_path: Path) -> None:
    folder = find_state_folder()
    assert folder.parent == tmp_path and folder.stat().st_mode & 0o777 == 0o700
    assert find_state_folder() == folder and not is_state_lasting()
    project = tmp_path / "a.json"
    project.touch()
    remember_project(project)
    assert list_recent() == [Recent(project, "")]


def test_notes_last_where_the_system_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "home"))
    assert is_state_lasting()
    assert tmp_path / "home" in find_state_folder().parents
