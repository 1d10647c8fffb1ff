from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.app.projects import autosave as autosave_module
from calibgui.app.projects.autosave import (
    autosave,
    discard_autosave,
    find_unsaved_work,
    get_autosave_path,
    get_discarded_folder,
    get_substitute_path,
    keep_discarded,
    keep_discarded_work,
    read_unsaved_work,
)
from calibgui.app.projects.project import Project
from calibgui.app.projects.project_file import read_project, write_project
from tests.app import examples


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("XDG_STATE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "home"))


def test_what_is_not_saved_is_unsaved_work_whatever_the_clock_says(tmp_path: Path) -> None:
    project, file = examples.calibrated(tmp_path), tmp_path / "project.json"
    assert find_unsaved_work(file) is None
    autosave(project, file)
    assert find_unsaved_work(file) == get_autosave_path(file)
    assert read_project(get_autosave_path(file)).views[0].image == project.views[0].image
    write_project(project, file)
    assert find_unsaved_work(file) is None, "the file holds the same"
    autosave(replace(project, square=31.0), file)
    later = file.stat().st_mtime + 10
    os.utime(file, (later, later))
    assert find_unsaved_work(file) is not None, "the clock went back between both"
    discard_autosave(file)
    discard_autosave(file)
    assert find_unsaved_work(file) is None


def test_beside_a_file_that_nothing_can_be_written_to(tmp_path: Path) -> None:
    folder = tmp_path / "images"
    folder.mkdir()
    file = folder / "project.json"
    project = examples.calibrated(folder)
    get_autosave_path(file).mkdir()  # as a folder that is read-only, for any user
    autosave(project, file)
    work = find_unsaved_work(file)
    assert work == get_substitute_path(file)
    assert read_unsaved_work(work, file).views[0].image == project.views[0].image
    assert get_substitute_path(tmp_path / "project.json") != work
    discard_autosave(file)
    assert find_unsaved_work(file) is None


def test_what_is_given_up_is_kept_and_opens_like_any_project(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(autosave_module, "MAX_DISCARDED", 3)
    project, file = examples.calibrated(tmp_path), tmp_path / "project.json"
    autosave(project, file)
    kept = keep_discarded_work(get_autosave_path(file), file)
    assert kept.parent == get_discarded_folder() and kept.name.startswith("project ")
    assert read_project(kept).views[0].image == project.views[0].image
    for _ in range(4):
        newest = keep_discarded(Project(), "other")
    assert newest.exists() and not kept.exists()
    assert len(list(get_discarded_folder().iterdir())) == 3


def test_damaged_work_is_kept_as_it_is(tmp_path: Path) -> None:
    work = get_autosave_path(tmp_path / "project.json")
    work.write_text('{"format": "calibgui-pro', encoding="utf-8")
    kept = keep_discarded_work(work, tmp_path / "project.json")
    assert kept.read_bytes() == work.read_bytes()
