"""Damaged files and kills: a part of the campaign, and what holds it to the project's readers."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

pytest.importorskip("resource", reason="the campaign's limits are those of Linux")

from calibgui.engine.errors import CalibrationError
from calibgui.formats import IMPORTERS
from tests.faults.files.campaign import RIGHT, Outcome, Try, list_tries, make_table, run_tries
from tests.faults.files.kills import KILLED, run_kills
from tests.faults.files.readers import Reader, find_readers
from tests.faults.files.worker import attempt

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="the campaign's limits are those of Linux"
)

_TRIES = 2
"""Tries of each reader and kind of damage in the suite; the command's default is 25."""
_KILLS = 20
_ROOT = Path(__file__).parents[3]
_ROOMS = ("calibgui/formats", "calibgui/app", "calibgui/engine/images/reading.py")
_FIRST = ("path", "file", "work", "paths")
"""Names of the first argument of functions that read files."""
_STEPS = {
    "read_text": "the gate's first step, by which all texts are read",
    "read_json": "a language",
    "read_toml": "a language",
    "read_numbered_csv_rows": "a language",
    "read_known_camera": "as read_camera",
    "read_colour": "as read_image",
    "read_image_size": "as read_image_header",
    "read_thumbnail": "as read_image",
    "read_file_state": "the digest alone",
    "read_signature": "the time of the last change alone",
}
"""Functions that read files and are no readers of a format, with what they are."""

_PAGE = _ROOT / ".github" / "SECURITY.md"


@pytest.fixture(scope="module")
def readers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Reader]:
    return find_readers(tmp_path_factory.mktemp("readers"))


def test_every_reader_is_in_the_campaign(readers: dict[str, Reader]) -> None:
    """A new format brings a sound file of its own."""
    covered = {name for reader in readers.values() for name in reader.functions}
    assert _find_functions() - _STEPS.keys() - covered == set()
    titles = {importer.title for importer in IMPORTERS}
    assert {t for t in titles if not any(name.startswith(t) for name in readers)} == set()


def _find_functions() -> set[str]:
    """Find the names of public functions that read a file."""
    found = set()
    for room in _ROOMS:
        path = _ROOT / room
        for file in [path] if path.is_file() else path.rglob("*.py"):
            for node in ast.parse(file.read_text(encoding="utf-8")).body:
                if (
                    isinstance(node, ast.FunctionDef)
                    and node.name.startswith("read_")
                    and node.args.args
                    and node.args.args[0].arg in _FIRST
                ):
                    found.add(node.name)
    return found


def test_sound_files_are_read(readers: dict[str, Reader], tmp_path: Path) -> None:
    for reader in readers.values():
        file = tmp_path / reader.file
        file.write_bytes(reader.sample)
        assert reader.read(file) is not None


@pytest.mark.slow
def test_damaged_files_are_refused_by_name(readers: dict[str, Reader], tmp_path: Path) -> None:
    outcomes = list(run_tries(list_tries(readers, _TRIES, seed=0), tmp_path))
    wrong = [outcome for outcome in outcomes if outcome.word not in RIGHT]
    assert not wrong, f"{make_table(outcomes)}\n{wrong}"


@pytest.mark.slow
def test_a_kill_leaves_a_whole_file(tmp_path: Path) -> None:
    found = run_kills(tmp_path, _KILLS)
    assert all(counts["whole"] == _KILLS for counts in found.values()), found
    assert sum(counts["midst"] for counts in found.values()) > 0, "no kill came while it wrote"


def _raise(error: Exception) -> Callable[[Path], object]:
    def read(_file: Path) -> object:
        raise error

    return read


def _hang(_file: Path) -> object:
    while True:
        pass


@pytest.mark.parametrize(
    ("read", "word"),
    [
        (_raise(ZeroDivisionError()), "traceback"),
        (_raise(RecursionError()), "traceback"),
        (_raise(MemoryError()), "memory"),
        (_raise(CalibrationError("Something is wrong.")), "names no file"),
        (_raise(CalibrationError("a/limits.toml: a limit is wrong.")), "refused"),
        (Path.read_bytes, "read"),
        (_hang, "hang"),
    ],
)
def test_the_outcome_of_a_try_is_told(
    readers: dict[str, Reader],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    read: Callable[[Path], object],
    word: str,
) -> None:
    monkeypatch.setattr("tests.faults.files.worker.MAX_SECONDS", 0.2)
    reader = replace(readers["limits"], read=read)
    assert attempt(reader, "cut", 0, tmp_path)[0] == word


def test_the_table_counts_what_is_wrong() -> None:
    tried = Try("limits", "cut", 0)
    words = ["refused", "read", "hang", "refused", "hang"]
    lines = make_table([Outcome(tried, word, "") for word in words]).splitlines()
    assert lines[2:] == ["| limits | 5 | 2 | 1 | 2 hang |", "| all | 5 | 2 | 1 | 2 hang |"]


def test_the_page_has_the_campaigns_tables(readers: dict[str, Reader]) -> None:
    """The rows are those of today's readers, add up, and nothing is wrong in them."""
    cells = [line.strip("| ").split(" | ") for line in _PAGE.read_text("utf-8").splitlines()]
    rows = {row[0]: row[1:] for row in cells if len(row) == 5 and row[1].isdecimal()}
    assert rows.keys() == {*readers, "all"} | KILLED
    total = [sum(int(rows[name][k]) for name in readers) for k in range(3)]
    assert total == [int(count) for count in rows["all"][:3]]
    assert all(rows[name][-1] == "0" for name in rows)
