"""Limits are chosen in the set-up, kept in the project, and the inspector says PASS or FAIL."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from calibgui.app.projects.project import set_limits
from calibgui.app.projects.project_file import read_project, write_project
from calibgui.app.projects.result_project import make_project
from calibgui.app.system.limit_presets import find_camera_limits
from calibgui.dataset.limits import Limits
from calibgui.formats.result_json import write_result
from calibgui.gui.settings.limits_choice import LimitsChoice
from calibgui.gui.window.main_window import MainWindow
from tests.app import examples


def choose(window: MainWindow, name: str) -> LimitsChoice:
    """Choose an entry in the set-up."""
    window.show_setup()
    found = window.setup.findChild(LimitsChoice)
    assert isinstance(found, LimitsChoice)
    row = found.choice.findText(name)
    found.choice.setCurrentIndex(row)
    found.choice.activated.emit(row)
    return found


def test_a_preset_gives_pass_or_fail_with_the_reason(full: MainWindow, qtbot: QtBot) -> None:
    row = full.verdict.limits
    assert row.isHidden(), "nothing is demanded"
    qtbot.waitUntil(lambda: full.verdict.verdict is not None)
    found = choose(full, "metrology")
    qtbot.waitUntil(lambda: row.text() != "")
    assert row.text().startswith("FAIL by the limits metrology.")
    assert "6 views are used, fewer than the limit of 20." in row.broken
    assert "at least 20" in found.words.text()
    choose(full, "nothing is demanded")
    assert row.isHidden()
    full.session.edit("", lambda p: set_limits(p, Limits(fewest_views=2, name="two")))
    qtbot.waitUntil(lambda: row.text() == "PASS by the limits two.")
    assert found.choice.currentText() == "two"
    full.session.document.undo()
    assert row.isHidden()


def test_a_length_has_one_field_in_sight(full: MainWindow) -> None:
    full.session.edit("", lambda p: replace(p, lengths_confirmed=False))
    row = full.verdict.square
    assert row.square.isVisible()
    place = full.verdict.figures.y()
    full.show_setup()
    assert not row.square.isVisible() and full.board.square.isVisible()
    assert full.verdict.figures.y() == place, "nothing moves"
    full.header.setup.setChecked(False)
    assert row.square.isVisible()


def test_a_file_of_limits_is_taken_and_a_bad_one_refused(
    full: MainWindow, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text("fewest_views = 3")
    name = str(file)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (name, ""))
    found = choose(full, "from a file…")
    assert full.session.project.limits == find_camera_limits(str(file))
    assert found.choice.currentText() == "mine"
    file.write_text("largest_change_px = 3")
    with qtbot.waitSignal(full.session.failed):
        choose(full, "from a file…")
    assert full.session.project.limits is not None
    assert full.session.project.limits.fewest_views == 3


def test_limits_are_kept_in_the_project_and_go_with_each_result(tmp_path: Path) -> None:
    limits = find_camera_limits("metrology")
    project = set_limits(examples.calibrated(tmp_path), limits)
    file = tmp_path / "calibgui.json"
    write_project(project, file)
    again = read_project(file)
    assert again.limits == limits
    assert all(result.limits == limits for result in again.results.values())
    result = next(iter(project.results.values()))
    write_result(result, tmp_path / "result.json")
    assert make_project(tmp_path / "result.json", "one").limits == limits
    write_project(replace(project, limits=None), file)
    assert '"limits"' not in file.read_text().split('"results"')[0]
