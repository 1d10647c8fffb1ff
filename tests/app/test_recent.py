from __future__ import annotations

from pathlib import Path

import pytest

from calibgui.app.recent import list_recent_projects, remember_project
from calibgui.app.state_folder import find_state_folder


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "home"))


def test_newest_first_each_once_and_only_what_exists(tmp_path: Path) -> None:
    assert list_recent_projects() == []
    paths = [tmp_path / f"{i}.json" for i in range(12)]
    for path in paths:
        path.touch()
        remember_project(path)
    remember_project(paths[5])
    assert list_recent_projects()[:2] == [paths[5], paths[11]]
    assert len(list_recent_projects()) == 10
    paths[11].unlink()
    assert paths[11] not in list_recent_projects()


def test_damaged_notes_are_no_obstacle(tmp_path: Path) -> None:
    (find_state_folder() / "recent.json").write_text('{"no": ', encoding="utf-8")
    assert list_recent_projects() == []
    project = tmp_path / "a.json"
    project.touch()
    remember_project(project)
    assert list_recent_projects() == [project]
