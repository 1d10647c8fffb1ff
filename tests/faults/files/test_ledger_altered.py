"""Ledgers that people or damage have altered: columns are added, values are none, pages are torn.

A row that cannot be read costs that row and is named; a file that cannot be read ends in a message
that names it. Nothing ends in a traceback.
"""

from __future__ import annotations

import random
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path

import pytest

from calibgui.cli.main import main
from calibgui.dataset.fleet import FleetCamera, FleetEntry, FleetStatus
from calibgui.engine.errors import CalibrationError
from calibgui.formats.fleet_ledger import COLUMNS, open_ledger
from tests.formats.test_fleet_ledger import DONE, FIGURES, REFUSED

Capture = pytest.CaptureFixture[str]
CAMERA = replace(DONE, entry=FleetEntry("c1", "S", "2026-03-01", 21.5))
OTHERS = [replace(CAMERA, entry=FleetEntry(name, "S", "2026-02-01")) for name in ("c0", "c2")]
BAD_VALUES = (
    None,
    "x",
    "",
    b"\xff",
    -1,
    2**62,
    1.5,
    float("inf"),
    "[" * 5000,
    "{}",
    "[]",
    '{"fx": "a"}',
    '{"fx": [1, 2, 3]}',
    '["a", 1]',
    '{"calibgui": 1}',
    "\0/..\n",
)


@pytest.fixture
def ledger(tmp_path: Path) -> Path:
    file = tmp_path / "fleet.db"
    with open_ledger(file, create=True) as opened:
        opened.write([*OTHERS, CAMERA])
    return file


def alter(file: Path, command: str, *values: object) -> None:
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.execute(command, values)


def read(file: Path) -> list[FleetCamera]:
    with open_ledger(file) as opened:
        return list(opened.read())


def test_a_column_that_people_add_is_kept(ledger: Path, capsys: Capture) -> None:
    alter(ledger, "ALTER TABLE cameras ADD COLUMN note TEXT")
    alter(ledger, "UPDATE cameras SET note = 'new lens' WHERE id = 'c1'")
    assert main(["fleet", str(ledger), "-o", str(ledger.with_suffix(".html"))]) == 0
    assert capsys.readouterr().err == ""
    again = replace(CAMERA, photographs=13)
    with open_ledger(ledger, create=True) as opened:
        opened.write([again, REFUSED])
    with closing(sqlite3.connect(ledger)) as connection:
        notes = dict(connection.execute("SELECT id, note FROM cameras"))
    assert notes == {"c0": None, "c1": "new lens", "c2": None, REFUSED.id: None}
    assert again in read(ledger)


def test_columns_may_stand_in_any_order(ledger: Path) -> None:
    with closing(sqlite3.connect(ledger)) as connection, connection:
        names = ", ".join(sorted(COLUMNS))
        connection.execute(f"CREATE TABLE sorted AS SELECT {names} FROM cameras")
        connection.execute("DROP TABLE cameras")
        connection.execute("ALTER TABLE sorted RENAME TO cameras")
    assert read(ledger) == [OTHERS[0], CAMERA, OTHERS[1]]
    # It has lost its key as well, without which no row has a place of its own.
    with (
        pytest.raises(CalibrationError, match=r"fleet\.db is not as it was made") as caught,
        open_ledger(ledger, create=True) as opened,
    ):
        opened.write([CAMERA])
    assert caught.value.hint


def test_a_column_that_is_gone_is_named(ledger: Path) -> None:
    alter(ledger, "ALTER TABLE cameras RENAME COLUMN noise_px TO noise")
    with pytest.raises(CalibrationError, match=r"fleet\.db lacks columns .*: noise_px\."):
        read(ledger)


@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("failures", "x", "failures"),
        ("parameters", None, "parameters is nothing"),
        ("width_px", None, "width_px is nothing"),
        ("width_px", "abc", "width_px is 'abc', not a whole number"),
        ("rms_px", "abc", "rms_px is 'abc', not a number"),
        ("versions", "x", "versions"),
        ("temperature_c", "warm", "temperature_c is 'warm'"),
        ("date", b"\xff", r"date is b'\\xff', not text"),
        ("grade", None, "grade is nothing"),
        ("grade", "BEST", "grade is 'BEST', not one of"),
        ("status", "", "status is '', not one of done, refused"),
    ],
)
def test_a_row_that_cannot_be_read_costs_that_row(
    ledger: Path, column: str, value: object, words: str, capsys: Capture
) -> None:
    alter(ledger, f"UPDATE cameras SET {column} = ? WHERE id = 'c1'", value)
    first, bad, last = read(ledger)
    assert [first, last] == OTHERS
    assert (bad.id, bad.status) == ("c1", FleetStatus.UNREADABLE)
    assert words.replace("\\\\", "\\") in bad.problem
    assert not bad.passed
    page = ledger.with_suffix(".html")
    assert main(["fleet", str(ledger), "-o", str(page)]) == 0
    printed = " ".join(capsys.readouterr().err.split())
    assert "c1: Its row of the ledger cannot be read" in printed
    assert "Its row of the ledger cannot be read" in page.read_text(encoding="utf-8")
    # The next batch writes it anew, as it does with a camera that it does not know.
    with open_ledger(ledger, create=True) as opened:
        opened.write([CAMERA])
    assert read(ledger) == [OTHERS[0], CAMERA, OTHERS[1]]


def test_text_that_is_not_unicode_costs_its_row(ledger: Path) -> None:
    alter(ledger, "UPDATE cameras SET problem = CAST(x'ff41' AS TEXT) WHERE id = 'c1'")
    alter(ledger, "UPDATE cameras SET id = x'ff' WHERE id = 'c2'")
    first, second, third = read(ledger)
    assert first == OTHERS[0]
    assert "not text in UTF-8" in second.problem
    assert third.id.startswith("row ")


@pytest.mark.slow
def test_no_value_in_any_column_ends_in_a_traceback(ledger: Path, tmp_path: Path) -> None:
    """Each value stands in a row of its own."""
    named = [replace(CAMERA, entry=FleetEntry(f"bad {k}", "S")) for k in range(len(BAD_VALUES))]
    with open_ledger(ledger, create=True) as opened:
        opened.write(named)
    copy = tmp_path / "copy.db"
    for column in COLUMNS:
        shutil.copy(ledger, copy)
        for camera, value in zip(named, BAD_VALUES, strict=True):
            # NULL where there may be none is left out.
            with suppress(sqlite3.IntegrityError):
                alter(copy, f"UPDATE cameras SET {column} = ? WHERE id = ?", value, camera.id)
        assert main(["fleet", str(copy), "-o", str(tmp_path / "fleet.html")]) == 0, column
        rows = read(copy)
        assert len(rows) == len(OTHERS) + 1 + len(named)
        assert all(other in rows for other in OTHERS), column


def list_damages(count: int, size: int) -> Iterator[tuple[int, list[tuple[int, int]], int]]:
    """Yield places with the bytes that are written there, and the size that is left."""
    for seed in range(count):
        rng = random.Random(seed)
        start = 0 if rng.random() < 0.3 else rng.randrange(size)
        length = rng.choice([1, 4, 64, 4096])
        places = [(min(start + k, size - 1), rng.randrange(256)) for k in range(length)]
        yield seed, places, size if rng.random() < 0.8 else rng.randrange(size)


@pytest.mark.slow
def test_damaged_pages_end_in_a_message(tmp_path: Path, capsys: Capture) -> None:
    """70 damages of bytes, pages and ends: what is read is as it was, or the file is named."""
    whole = tmp_path / "whole.db"
    figures = [replace(FIGURES, reason=f"{k} " * 100) for k in range(60)]
    cameras = [
        replace(DONE, entry=FleetEntry(f"c{k:02}", "S", "2026-03-01"), figures=one)
        for k, one in enumerate(figures)
    ]
    with open_ledger(whole, create=True) as opened:
        opened.write(cameras)
    content = whole.read_bytes()
    ended = []
    for seed, places, size in list_damages(70, len(content)):
        damaged = bytearray(content)
        for place, value in places:
            damaged[place] = value
        file = tmp_path / f"damaged{seed}.db"
        file.write_bytes(damaged[:size])
        said = ""
        try:
            read(file)
        except CalibrationError as error:
            said = error.message
            assert str(file) in said, seed
        if seed < 12:  # the command takes a hundred times as long as to read
            code = main(["fleet", str(file), "-o", str(tmp_path / f"{seed}.html")])
            assert code == bool(said), seed
            printed = capsys.readouterr().err
            assert not code or (str(file) in printed and printed.count("\n") <= 8), seed
        ended.append(bool(said))
        file.unlink()
    assert 0 < sum(ended) < len(ended), "some damages are found, and some are in unused pages"
