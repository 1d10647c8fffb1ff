"""Manifests: what a table or a folder says of cameras, and what it cannot say."""

from __future__ import annotations

from pathlib import Path

import pyarrow
import pytest
from pyarrow import parquet

from calibgui.app.calibrating.settings import Settings
from calibgui.app.fleet.manifest import BoardSought, read_board_words, read_manifest
from calibgui.dataset.fleet import FleetCamera, FleetEntry, FleetStatus
from calibgui.engine.boards.charuco import Charuco
from calibgui.engine.boards.checkerboard import CHECKERBOARD
from calibgui.engine.boards.kinds import KINDS
from calibgui.engine.errors import CalibrationError
from calibgui.formats.circle_list import read_circle_list
from calibgui.formats.fleet_table import write_fleet_table

BOARD = BoardSought(30.0)
SETTINGS = Settings(robust=True)


def write(folder: Path, *lines: str) -> Path:
    file = folder / "manifest.csv"
    file.write_text("\n".join(lines), encoding="utf-8")
    return file


def test_a_table_says_what_holds_for_a_camera(tmp_path: Path) -> None:
    file = write(
        tmp_path,
        "id,paths,board,model,serial,date,temperature",
        "a,shots; /other/*.png,charuco 5x7 25.5mm,kannala-brandt,S1,20260301,-3.5",
        'b,"s3://bucket/b;more",,,,2026-03-01T08:30+02:00,',
    )
    first, second = read_manifest(file, BOARD, SETTINGS)
    assert first.entry == FleetEntry("a", "S1", "2026-03-01", -3.5)
    assert first.paths == (str(tmp_path / "shots"), "/other/*.png")
    assert first.board == BoardSought(25.5, (5, 7), KINDS["charuco"])
    assert first.settings == Settings(robust=True, model="kannala-brandt")
    assert second.entry == FleetEntry("b", "", "2026-03-01T06:30:00", None)
    assert second.paths == ("s3://bucket/b", str(tmp_path / "more"))
    assert (second.board, second.settings) == (BOARD, SETTINGS)


def test_a_table_names_the_list_of_a_boards_circles(tmp_path: Path) -> None:
    (tmp_path / "boards").mkdir()
    places = [(20 * k + 10 * (row % 2), 17 * row) for row in range(4) for k in range(5)]
    circles = "\n".join(["x,y", *(f"{x},{y}" for x, y in places)])
    (tmp_path / "boards" / "dots.csv").write_text(circles)
    (task,) = read_manifest(
        write(tmp_path, "id,paths,board", "a,.,boards/dots.csv"), BOARD, SETTINGS
    )
    expected, pitch = read_circle_list(tmp_path / "boards" / "dots.csv")
    assert task.board == BoardSought(pitch, expected.grid_size, expected)
    with pytest.raises(CalibrationError, match=r"line 2: .*nowhere.csv"):
        read_manifest(write(tmp_path, "id,paths,board", "a,.,nowhere.csv"), BOARD, SETTINGS)


def test_a_folder_of_folders_is_a_manifest(tmp_path: Path) -> None:
    for name in ("b", "a", ".hidden"):
        (tmp_path / name).mkdir()
    (tmp_path / "notes.txt").touch()
    tasks = read_manifest(tmp_path, BOARD, SETTINGS)
    assert [(task.entry.id, task.paths) for task in tasks] == [
        ("a", (str(tmp_path / "a"),)),
        ("b", (str(tmp_path / "b"),)),
    ]


def test_a_folder_of_photographs_is_no_manifest(tmp_path: Path) -> None:
    (tmp_path / "1.png").touch()
    with pytest.raises(CalibrationError, match="a folder of photographs for each camera"):
        read_manifest(tmp_path, BOARD, SETTINGS)


def test_words_of_a_board_replace_what_is_known() -> None:
    stated = BoardSought(30.0, (5, 7), Charuco(marker=0.7))
    assert read_board_words("", stated) == stated
    assert read_board_words("charuco 20mm", stated) == BoardSought(20.0, (5, 7), stated.pattern)
    assert read_board_words("checkerboard", stated).pattern == CHECKERBOARD
    certain, uncertain = BoardSought(30.0), BoardSought(30.0, square_sigma=0.02)
    for text in ("30+-0.02mm", "30±.02mm", "30+/-0.02mm"):
        assert read_board_words(text, certain) == uncertain
    assert read_board_words("30mm", uncertain) == certain
    # The size alone leaves open what is printed, as on the command line.
    assert read_board_words("6x7", BoardSought(30.0, None, None)).pattern is None


@pytest.mark.parametrize(
    ("lines", "problem"),
    [
        (["id,paths"], "lists no cameras"),
        (["id,folder", "a,b"], "column 'folder'"),
        (["id,board", "a,b"], "no column 'paths'"),
        (["id,paths", ",b"], "line 2: the cell 'id' is empty"),
        (["id,paths", "", "", "a,"], "line 4: the cell 'paths' is empty"),
        (["id,paths", "a,b", "A,c"], "line 3: the id 'A' is that of line 2"),
        (["id,paths", "a,b", "c,d,e"], "line 3: it has more cells"),
        (["id,paths,board", "a,b,6x7 30"], "line 2: '30' says nothing of a board"),
        (["id,paths,board", "a,b,1x7"], "line 2: a board of 1x7"),
        (["id,paths,board", f"a,b,{'9' * 5000}x7"], "line 2: .* says nothing of a board"),
        (["id,paths,board", "a,b,0mm"], "line 2: 0mm"),
        (["id,paths,board", f"a,b,{'9' * 400}mm"], "is not the side of a square"),
        (["id,paths,model", "a,b,pinhol"], "line 2: .*pinhol"),
        (["id,paths,date", "a,b,1 March"], "line 2: '1 March' is not a date"),
        (["id,paths,temperature", "a,b,warm"], "line 2: 'warm' is not a temperature"),
        (["id,paths,temperature", "a,b,nan"], "line 2: 'nan' is not a temperature"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(
    tmp_path: Path, lines: list[str], problem: str
) -> None:
    file = write(tmp_path, *lines)
    with pytest.raises(CalibrationError, match=problem) as caught:
        read_manifest(file, BOARD, SETTINGS)
    assert str(file) in caught.value.message
    assert caught.value.hint


def test_the_side_of_a_square_is_needed(tmp_path: Path) -> None:
    file = write(tmp_path, "id,paths,board", "a,b,20mm", "c,d,")
    with pytest.raises(CalibrationError, match="line 3: the side of a square") as caught:
        read_manifest(file, BoardSought(None), SETTINGS)
    assert "--square" in caught.value.hint


def test_parquet_is_read_or_the_library_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "manifest.parquet"
    with monkeypatch.context() as patch:
        patch.setitem(__import__("sys").modules, "pyarrow", None)
        with pytest.raises(CalibrationError, match="pyarrow is not installed") as caught:
            read_manifest(file, BOARD, SETTINGS)
    assert "CSV" in caught.value.hint
    parquet.write_table(
        pyarrow.table({"id": ["a", "b"], "paths": ["x", "y"], "temperature": [21.5, None]}), file
    )
    tasks = read_manifest(file, BOARD, SETTINGS)
    assert [task.entry.temperature for task in tasks] == [21.5, None]
    file.write_bytes(b"no table")
    with pytest.raises(CalibrationError, match="not a table in Parquet"):
        read_manifest(file, BOARD, SETTINGS)


def test_names_come_back_from_a_table_of_a_fleet(tmp_path: Path) -> None:
    """A spreadsheet computes none of them, and a manifest that is made of it has them again."""
    names = ["=1+1", "-a", "+49", "@home", "'=x", "plain"]
    rows = [FleetCamera(FleetEntry(name, name), FleetStatus.REFUSED, name) for name in names]
    write_fleet_table(rows, tmp_path / "fleet.csv")
    text = (tmp_path / "fleet.csv").read_text()
    assert [line.partition(",")[0] for line in text.splitlines()[1:]] == [
        "'=1+1", "'-a", "+49", "'@home", "''=x", "plain",
    ]  # fmt: skip
    with (tmp_path / "manifest.csv").open("w") as file:
        file.write("id,serial,paths\n")
        file.writelines(",".join(line.split(",")[:2]) + ",a\n" for line in text.splitlines()[1:])
    tasks = read_manifest(tmp_path / "manifest.csv", BOARD, Settings())
    assert [(task.entry.id, task.entry.serial) for task in tasks] == [(n, n) for n in names]
