from __future__ import annotations

import os
from pathlib import Path

from calibgui.app.autosave import autosave, discard_autosave, find_unsaved_work, get_autosave_path
from calibgui.app.project_file import read_project, write_project
from tests.app import examples


def test_only_a_newer_autosave_is_unsaved_work(tmp_path: Path) -> None:
    project, file = examples.calibrated(tmp_path), tmp_path / "project.json"
    assert find_unsaved_work(file) is None
    autosave(project, file)
    assert find_unsaved_work(file) == get_autosave_path(file)
    assert read_project(get_autosave_path(file)).views[0].image == project.views[0].image
    write_project(project, file)
    later = file.stat().st_mtime + 10
    os.utime(file, (later, later))
    assert find_unsaved_work(file) is None
    os.utime(get_autosave_path(file), (later + 10, later + 10))
    assert find_unsaved_work(file) is not None
    discard_autosave(file)
    discard_autosave(file)
    assert find_unsaved_work(file) is None
