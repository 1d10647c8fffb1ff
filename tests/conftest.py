"""What all tests share: where the real image sets are, and how hypothesis takes its examples.

CI takes the same 50 examples each time; ``CALIBGUI_HYPOTHESIS=random pytest tests/engine/geometry``
takes 2000 new ones for each invariant and prints how to repeat the one that fails.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Generator, Iterator
from pathlib import Path

import pytest
from _pytest.doctest import DoctestModule
from hypothesis import HealthCheck, settings

from calibgui.app.system.workers import do_tasks_here
from calibgui.engine.kernels import COMPILED
from calibgui.engine.threads import limit_blas_threads
from tests.photographs import write_photographs

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,
    max_examples=50,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile(
    "random",
    derandomize=False,
    deadline=None,
    max_examples=2000,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile(os.environ.get("CALIBGUI_HYPOTHESIS", "repeatable"))

_REPOSITORY = Path(__file__).resolve().parents[1]

_KEPT_BYTES = 1 << 28
_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD = -1, -3
"""Options of glibc's ``mallopt``: beyond how many bytes it returns what is free, and a block."""


def pytest_configure(config: pytest.Config) -> None:
    """Keep the memory of freed arrays for later ones, and one thread of BLAS in this process.

    A drawn photograph has arrays of 40 MB. To have each of them from the system anew takes half
    of the time of drawing. Other C libraries than glibc are left as they are. Threads of BLAS that
    wait for a processor, which xdist keeps busy, wait in a loop: small products cost twice as much.
    The program is left as it is where its speed is measured.
    """
    if config.getoption("benchmark_only"):
        return
    limit_blas_threads()
    if sys.platform == "linux":
        with contextlib.suppress(AttributeError):  # only glibc has it
            for option in (_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD):
                ctypes.CDLL(None).mallopt(option, _KEPT_BYTES)


def pytest_ignore_collect(collection_path: Path) -> bool | None:
    """Keep the search for examples in docstrings from importing what is no test.

    Nor are the tests of kernels imported where there is no numba to compile them.
    """
    name = collection_path.name
    if not name.endswith(".py"):
        return None
    needs_numba = collection_path.parent.name == "kernels" and name != "test_fallback.py"
    is_test = name.startswith("test_") and (COMPILED or not needs_numba)
    return None if is_test else True


@pytest.hookimpl(wrapper=True)
def pytest_collect_file() -> Generator[None, list[pytest.Collector], list[pytest.Collector]]:
    """Look for no examples in tests.

    The search for examples imports a module first, and passes over one that cannot be imported; the
    search for tests then takes what is left of it for a module without tests, and nobody is told.
    """
    return [collector for collector in (yield) if not isinstance(collector, DoctestModule)]


def find_data_dir() -> Path:
    """Find the folder of the real image sets, which may not be there."""
    return Path(os.environ.get("CALIBGUI_DATA", _REPOSITORY.parent / "shared" / "data"))


@pytest.fixture(scope="module")
def search_here() -> Iterator[None]:
    """Let photographs be searched in the test's own process.

    Starting workers takes longer than searching a few photographs, and xdist keeps the processors
    busy. What workers do is tested in tests/app and by subcommands in processes of their own.
    """
    with do_tasks_here():
        yield


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """Folder of the real image sets: CALIBGUI_DATA, or shared/data beside the checkout."""
    folder = find_data_dir()
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
    write_photographs(folder)
    return folder
