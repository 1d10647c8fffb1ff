"""A fleet of four small cameras, rendered and calibrated once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TypeVar

import pytest

from calibgui.app.calibrating.settings import Settings
from calibgui.app.fleet.batch import BatchSummary, run_batch
from calibgui.app.fleet.manifest import BoardSought, CameraTask, read_manifest
from calibgui.dataset.fleet import FleetCamera
from calibgui.dataset.limits import NO_LIMITS, Limits
from calibgui.formats.fleet_ledger import open_ledger
from tests.scenes.fleet import write_fleet

T = TypeVar("T")
R = TypeVar("R")
BOARD = BoardSought(30.0, (6, 7), pattern=None)


class Here:
    """A scheduler that does tasks in the test's own process, and counts them."""

    def __init__(self) -> None:
        self.done = 0

    def run(self, task: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[int, R]]:
        for k, item in enumerate(items):
            self.done += 1
            yield k, task(item)


def run(
    tasks: Sequence[CameraTask], ledger: Path, scheduler: object, limits: Limits = NO_LIMITS
) -> BatchSummary:
    """Run a batch on the ledger of a file."""
    with open_ledger(ledger, create=True) as opened:
        return run_batch(tasks, opened, scheduler, limits)  # type: ignore[arg-type]


def read_rows(ledger: Path) -> list[FleetCamera]:
    with open_ledger(ledger) as opened:
        return list(opened.read())


def read_results(ledger: Path) -> dict[str, bytes]:
    """Return the bytes of all results beside a ledger, by their names.

    Beside them may lie what a killed process was writing, which a later run removes.
    """
    folder = ledger.parent / f"{ledger.stem}.results"
    return {file.name: file.read_bytes() for file in folder.glob("*.json")}


@pytest.fixture(scope="session")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a folder of photographs for each camera, c0 to c3."""
    folder = tmp_path_factory.mktemp("fleet")
    write_fleet(folder, range(4))
    return folder


@pytest.fixture(scope="session")
def tasks(fleet: Path) -> tuple[CameraTask, ...]:
    return read_manifest(fleet, BOARD, Settings())


@pytest.fixture(scope="session")
def calibrated(tasks: tuple[CameraTask, ...], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The ledger of a run that nothing disturbed."""
    ledger = tmp_path_factory.mktemp("calibrated") / "fleet.db"
    run(tasks, ledger, Here())
    return ledger
