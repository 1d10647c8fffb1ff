"""The hosted CI's file says what the README and ``.ci/run`` say; what can be run of it here, is."""

from __future__ import annotations

import re
import shutil
import subprocess
import tomllib
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet

ROOT = Path(__file__).resolve().parents[2]
WORKFLOW = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8"))
JOBS: dict[str, dict[str, Any]] = WORKFLOW["jobs"]
MATRIX: dict[str, list[str]] = JOBS["tests"]["strategy"]["matrix"]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def commands(job: str) -> list[str]:
    return [step["run"] for step in JOBS[job]["steps"] if "run" in step]


def test_it_runs_when_something_changes() -> None:
    assert set(WORKFLOW[True]) == {"push", "pull_request"}  # YAML reads `on` as True


def test_systems_pythons_and_opencvs() -> None:
    assert MATRIX["os"] == ["ubuntu-latest", "windows-latest", "macos-latest"]
    assert MATRIX["python"] == ["3.11", "3.12", "3.13", "3.14"]
    assert MATRIX["opencv"] == ["4.14", "5"]
    assert all(SpecifierSet(PROJECT["requires-python"]).contains(p) for p in MATRIX["python"])
    assert not SpecifierSet(PROJECT["requires-python"]).contains("3.10")


def test_the_commands_are_those_of_the_readme_and_of_ci() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (command,) = commands("tests")
    assert f"\n{command.replace('python ', 'python3 ')}\n" in readme
    assert commands("checks") == ["bash .ci/run"]
    assert (ROOT / ".ci/run").is_file()
    assert commands("without-numba")[0].startswith("python packaging/bootstrap.py setup")


def test_every_opencv_has_its_constraint_and_the_project_allows_it() -> None:
    pattern = JOBS["tests"]["env"]["PIP_CONSTRAINT"]
    named = re.fullmatch(
        r"\$\{\{ github\.workspace \}\}/(.*)\$\{\{ matrix\.opencv \}\}(.*)", pattern
    )
    assert named is not None
    here = Requirement(f"opencv-python-headless=={version('opencv-python-headless')}")
    held = []
    for opencv in MATRIX["opencv"]:
        lines = (ROOT / f"{named[1]}{opencv}{named[2]}").read_text(encoding="utf-8").splitlines()
        (constraint,) = (Requirement(line) for line in lines if not line.startswith("#"))
        assert constraint.name == here.name
        newest = "5.0.0" if opencv == "5" else f"{opencv}.0"
        assert constraint.specifier.contains(newest)
        held.append(constraint.specifier.contains(next(iter(here.specifier)).version))
    assert sum(held) == 1, "the OpenCV that these tests run with is one of those in the matrix"


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
@pytest.mark.parametrize("job", JOBS)
def test_the_shell_can_read_the_commands(job: str) -> None:
    for command in commands(job):
        subprocess.run(["bash", "-n", "-c", command], check=True)
    subprocess.run(["bash", "-n", ROOT / ".ci/run"], check=True)


def test_every_job_takes_the_checkout_and_a_python_that_is_supported() -> None:
    for name, job in JOBS.items():
        checkout, python, *_ = job["steps"]
        assert checkout["uses"].startswith("actions/checkout@"), name
        assert python["uses"].startswith("actions/setup-python@"), name
        chosen = python["with"]["python-version"]
        assert chosen == "${{ matrix.python }}" or chosen in MATRIX["python"], name
        assert job["timeout-minutes"] <= 120, name
