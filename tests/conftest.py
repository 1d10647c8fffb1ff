"""What all tests share: where the real image sets are, and a repeatable hypothesis."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.photographs import take

settings.register_profile(
    "calibgui",
    derandomize=True,
    deadline=None,
    max_examples=50,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("calibgui")

_REPOSITORY = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Folder of the real image sets: CALIBGUI_DATA, or shared/data beside the checkout."""
    folder = Path(os.environ.get("CALIBGUI_DATA", _REPOSITORY.parent / "shared" / "data"))
    if not folder.is_dir():
        pytest.skip(f"no real image sets: set CALIBGUI_DATA ({folder} does not exist)")
    return folder


@pytest.fixture(scope="session")
def bouguet(data_dir: Path) -> Path:
    """Bouguet's 25 images, the paper's own data."""
    return data_dir / "bouguet_calib_example"


@pytest.fixture(scope="session")
def photographs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of six rendered photographs, see `tests.photographs`; not to be changed."""
    folder = tmp_path_factory.mktemp("photographs")
    take(folder)
    return folder
