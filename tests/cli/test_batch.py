"""`calibgui batch`: what it prints and writes, and its exit codes."""

from __future__ import annotations

import argparse
import csv
import json
import shutil
from pathlib import Path

import pytest
from pyarrow import parquet

from calibgui.app.fleet import schedulers
from calibgui.cli import batch
from calibgui.cli.main import main
from calibgui.formats.fleet_ledger import open_ledger
from calibgui.formats.result_json import read_result
from tests.scenes.fleet import write_fleet

BOARD = ["--square", "30", "--board", "6x7", "--workers", "1"]


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two cameras."""
    folder = tmp_path_factory.mktemp("fleet")
    write_fleet(folder, range(2))
    return folder


@pytest.fixture(scope="module")
def finished(fleet: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The ledger of both, made by a pool of processes."""
    ledger = tmp_path_factory.mktemp("ledger") / "fleet.db"
    assert main(["batch", str(fleet), "-o", str(ledger), *BOARD]) == 0
    return ledger


def test_everything_done_is_said_and_nothing_is_started(
    fleet: Path, finished: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["batch", str(fleet), "-o", str(finished), *BOARD]) == 0
    printed = capsys.readouterr().out
    assert "2 cameras: 2 done before, 2 pass, 0 fail." in printed
    with open_ledger(finished) as ledger:
        assert [camera.id for camera in ledger.read()] == ["c0", "c1"]


def test_the_boards_scale_may_be_uncertain(fleet: Path, tmp_path: Path) -> None:
    ledger = tmp_path / "fleet.db"
    manifest = tmp_path / "manifest.csv"
    manifest.write_text(f"id,paths,board\na,{fleet / 'c0'},6x7 30+-0.03mm\nb,{fleet / 'c0'},6x7\n")
    options = ["--workers", "1", "--square", "30+-0.06", "--once", "--model", "lucchese"]
    assert main(["batch", str(manifest), "-o", str(ledger), *options]) == 0
    with open_ledger(ledger) as kept:
        found = {camera.id: read_result(tmp_path / str(camera.result)) for camera in kept.read()}
    assert {name: result.scale_sigma for name, result in found.items()} == pytest.approx(
        {"a": 1e-3, "b": 2e-3}
    )


def test_a_broken_limit_is_named_and_ends_with_3(
    fleet: Path, finished: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    limits = tmp_path / "limits.toml"
    limits.write_text("fewest_views = 7\n")
    command = ["batch", str(fleet), "-o", str(finished), *BOARD]
    assert main([*command, "--limits", str(limits)]) == 3
    printed = capsys.readouterr().out
    assert "0 pass, 2 fail" in printed
    assert "c0: 6 views are used, fewer than the limit of 7." in printed
    assert main([*command, "--limits", str(limits), "--json"]) == 3
    failed = json.loads(capsys.readouterr().out)["failed"]
    assert failed["c1"] == ["6 views are used, fewer than the limit of 7."]
    assert main([*command, "-q"]) == 0
    assert capsys.readouterr().out.startswith("2 cameras: 2 done before, 2 pass")
    limits.write_text("fewest = 7\n")
    assert main([*command, "--limits", str(limits)]) == 1
    assert "no limit 'fewest'" in capsys.readouterr().err


def test_a_camera_without_photographs_fails(
    fleet: Path, finished: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(finished.parent, tmp_path / "copy")
    manifest = tmp_path / "manifest.csv"
    manifest.write_text(f"id,paths\nc0,{fleet / 'c0'}\nlost,nowhere\n")
    ledger = tmp_path / "copy" / "fleet.db"
    assert main(["batch", str(manifest), "-o", str(ledger), *BOARD]) == 3
    printed = capsys.readouterr().out
    assert f"lost: {tmp_path / 'nowhere'} does not exist. Check its spelling." in " ".join(
        printed.split()
    )


def test_the_table_has_a_column_for_each_parameter(
    fleet: Path, finished: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "fleet.csv"
    command = ["batch", str(fleet), "-o", str(finished), *BOARD, "--parquet"]
    assert main([*command, str(table)]) == 0
    assert main([*command, str(table)]) == 0  # it replaces its like
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    with open_ledger(finished) as ledger:
        for row, camera in zip(rows, ledger.read(), strict=True):
            assert camera.figures is not None
            fx = camera.figures.parameters["fx"]
            assert (float(row["fx"]), float(row["sigma_fx"])) == (fx.value, fx.sigma)
            assert float(row["rms_px"]) == camera.figures.rms
    foreign = tmp_path / "mine.csv"
    foreign.write_text("id,grade\n")
    capsys.readouterr()
    assert main([*command, str(foreign)]) == 1
    assert main([*command, str(tmp_path / "fleet.xlsx")]) == 1
    printed = capsys.readouterr().err
    assert "mine.csv exists" in printed
    assert "fleet.xlsx is not named as a table" in printed
    assert foreign.read_text() == "id,grade\n"


def test_parquet_is_written_or_the_library_is_named(
    fleet: Path,
    finished: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    table = tmp_path / "fleet.parquet"
    command = ["batch", str(fleet), "-o", str(finished), *BOARD, "--parquet", str(table)]
    with monkeypatch.context() as patch:
        patch.setitem(__import__("sys").modules, "pyarrow", None)
        assert main(command) == 1
    assert "pyarrow is not installed. pip install pyarrow" in capsys.readouterr().err
    assert main(command) == 0
    assert main(command) == 0  # it replaces its like
    rows = parquet.read_table(table).to_pylist()
    with open_ledger(finished) as ledger:
        for row, camera in zip(rows, ledger.read(), strict=True):
            assert camera.figures is not None
            assert row["fx"] == camera.figures.parameters["fx"].value


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["--workers", "0"], "not a number of processes"),
        (["--workers", "2", "--scheduler", "tcp://x:1"], "not allowed with"),
        (["--scheduler", "head"], "no address such as tls://host:8786"),
        (["--square", "-1"], "not a length above 0"),
        (["--model", "pinhol"], "pinhol"),
    ],
)
def test_wrong_usage_is_named(
    fleet: Path, options: list[str], problem: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["batch", str(fleet), "-o", "fleet.db", *options])
    assert caught.value.code == 2
    assert problem in capsys.readouterr().err


def test_what_cannot_be_done_is_said_before_any_work(
    fleet: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ledger = tmp_path / "fleet.db"
    assert main(["batch", str(fleet), "-o", str(ledger)]) == 1
    assert "the side of a square is not known" in capsys.readouterr().err
    assert main(["batch", str(tmp_path / "no.csv"), "-o", str(ledger), *BOARD]) == 1
    assert "no.csv does not exist" in capsys.readouterr().err
    assert main(["batch", str(fleet), "-o", str(tmp_path / "no" / "f.db"), *BOARD]) == 1
    assert "does not exist" in capsys.readouterr().err
    assert not ledger.exists()
    monkeypatch.setattr(schedulers, "has_dask", lambda: False)
    command = ["batch", str(fleet), "-o", str(ledger), *BOARD[:4]]
    assert main([*command, "--scheduler", "tcp://x:1"]) == 1
    assert "needs Dask. Give this command" in capsys.readouterr().err


def test_the_square_has_a_unit_as_in_every_subcommand() -> None:
    parser = argparse.ArgumentParser()
    batch.configure(parser)
    options = parser.parse_args(["cameras.csv", "-o", "out", "--square", "0.025m"])
    assert options.square == pytest.approx(25)
    with pytest.raises(SystemExit):
        parser.parse_args(["cameras.csv", "-o", "out", "--square", "0.025"])


@pytest.mark.parametrize(
    ("address", "who"),
    [("tcp://127.0.0.1:9", "whoever can reach it"), ("tls://127.0.0.1:9", "who has a certificate")],
)
def test_what_a_scheduler_may_do_is_said_before_it_is_reached(
    address: str,
    who: str,
    fleet: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(schedulers, "has_dask", lambda: False)
    command = ["batch", str(fleet), "-o", str(tmp_path / "fleet.db"), *BOARD[:4]]
    assert main([*command, "--scheduler", address]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert f"The scheduler {address} is trusted" in printed
    assert f"{who} " in printed
    assert "can run code as you" in printed
    with pytest.raises(SystemExit):
        main(["batch", "--help"])
    assert "can run code as you" in " ".join(capsys.readouterr().out.split())
