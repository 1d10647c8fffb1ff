from __future__ import annotations

import json
from pathlib import Path

import pytest

from calibgui.app.projects.recent import Recent, list_recent, remember_project
from calibgui.app.system.state_folder import find_state_folder


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "home"))


def test_newest_first_each_once_and_only_what_exists(tmp_path: Path) -> None:
    assert list_recent() == []
    paths = [tmp_path / f"{i}.json" for i in range(12)]
    for path in paths:
        path.touch()
        remember_project(path)
    remember_project(paths[5])
    assert list_recent()[:2] == [Recent(paths[5], ""), Recent(paths[11], "")]
    assert len(list_recent()) == 10
    paths[11].unlink()
    assert Recent(paths[11], "") not in list_recent()


def test_damaged_notes_are_no_obstacle(tmp_path: Path) -> None:
    (find_state_folder() / "recent.json").write_text('{"no": ', encoding="utf-8")
    assert list_recent() == []
    project = tmp_path / "a.json"
    project.touch()
    remember_project(project)
    assert list_recent() == [Recent(project, "")]


def test_folders_and_first_images_are_remembered(tmp_path: Path) -> None:
    project, folder = tmp_path / "a.json", tmp_path / "images"
    project.touch()
    folder.mkdir()
    remember_project(project, "/photographs/1.png")
    remember_project(folder, str(folder / "1.png"))
    assert list_recent() == [
        Recent(folder, str(folder / "1.png")),
        Recent(project, "/photographs/1.png"),
    ]
    folder.rmdir()
    assert [entry.path for entry in list_recent()] == [project]


def test_notes_of_earlier_versions_are_read(tmp_path: Path) -> None:
    project = tmp_path / "a.json"
    project.touch()
    (find_state_folder() / "recent.json").write_text(json.dumps([str(project)]), "utf-8")
    assert list_recent() == [Recent(project, "")]


@pytest.mark.parametrize(
    "text",
    [
        "[" * 5000,
        '[{"path": 1, "image": ""}]',
        '["\\u0000"]',
        '["' + "x" * 5000 + '"]',
        '[["a"]]',
        '{"a": 1}',
        "3",
        "",
        "\x00" * 100,
        " " * (2 << 20),
    ],
)
def test_notes_of_any_kind_leave_the_window_without_recent_projects(text: str) -> None:
    (find_state_folder() / "recent.json").write_text(text, encoding="utf-8")
    assert list_recent() == []


def test_a_folder_in_place_of_the_notes_is_no_obstacle(tmp_path: Path) -> None:
    (find_state_folder() / "recent.json").mkdir()
    assert list_recent() == []
    remember_project(tmp_path)
