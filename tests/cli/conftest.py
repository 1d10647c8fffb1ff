"""What the subcommands' tests share."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from calibgui.cli.main import main


@pytest.fixture(scope="module", autouse=True)
def search_always_here(search_here: None) -> None:
    """No subcommand starts workers."""


@pytest.fixture(scope="session")
def corners_file(photographs: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """corners.json of the photographs, as `calibgui detect` writes it."""
    file = tmp_path_factory.mktemp("corners") / "corners.json"
    assert main(["detect", str(photographs), "--square", "30", "-q", "-o", str(file)]) == 0
    return file


@pytest.fixture(scope="session")
def result_file(corners_file: Path) -> Path:
    """result.json of those corners."""
    file = corners_file.with_name("result.json")
    assert main(["calibrate", str(corners_file), "-q", "-o", str(file)]) == 0
    return file


@pytest.fixture
def content(corners_file: Path) -> Any:
    """The content of corners.json, free to be changed."""
    return json.loads(corners_file.read_text())
