"""The pinned versions are complete, within the project's bounds, and each with its SHA-256."""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

FOLDER = Path(__file__).resolve().parents[2] / "packaging"
PROJECT = tomllib.loads((FOLDER.parent / "pyproject.toml").read_text(encoding="utf-8"))
with pytest.MonkeyPatch.context() as patch:
    patch.setattr(sys, "path", [str(FOLDER), *sys.path])
    import refresh_constraints
    from bootstrap import EXTRAS, NEXT_EXTRA


def read_parts(python: str) -> list[dict[str, Requirement]]:
    """The pinned packages of each extra on Linux, by name."""
    text = (FOLDER / "constraints" / f"python{python}.txt").read_text(encoding="utf-8")
    here = {"python_version": python, "python_full_version": f"{python}.1", "sys_platform": "linux"}
    parts = []
    for part in text.split(NEXT_EXTRA):
        lines = re.findall(r"^([^\s#].*?)(?: \\)?$", part, re.MULTILINE)
        pinned = [Requirement(line) for line in lines]
        parts.append(
            {
                canonicalize_name(one.name): one
                for one in pinned
                if one.marker is None or one.marker.evaluate(here)
            }
        )
    return parts


@pytest.mark.parametrize("python", refresh_constraints.PYTHONS)
def test_everything_that_the_project_needs_is_pinned_within_its_bounds(python: str) -> None:
    parts = read_parts(python)
    assert len(parts) == len(EXTRAS)
    known: dict[str, Requirement] = {}
    for part, needs in zip(parts, refresh_constraints.read_requirements(), strict=True):
        known |= part
        for need in map(Requirement, needs):
            if need.marker is None or need.marker.evaluate({"python_version": python}):
                pinned = str(known[canonicalize_name(need.name)].specifier)
                assert pinned.startswith("==")
                assert need.specifier.contains(pinned[2:]), need


@pytest.mark.parametrize("python", refresh_constraints.PYTHONS)
def test_every_package_has_its_digests_and_no_place_is_named(python: str) -> None:
    text = (FOLDER / "constraints" / f"python{python}.txt").read_text(encoding="utf-8")
    for block in refresh_constraints.split_packages(text, python).values():
        head, *lines = block.splitlines()
        assert re.match(r"[a-z0-9-]+==\S+", head)
        assert lines
        assert all(re.fullmatch(r"    --hash=sha256:[0-9a-f]{64}(?: \\)?", line) for line in lines)
    assert "://" not in text


def test_the_pythons_are_those_that_are_tried() -> None:
    names = {f"python{python}.txt" for python in refresh_constraints.PYTHONS}
    assert {path.name for path in (FOLDER / "constraints").iterdir()} == names
    assert "3.11" in refresh_constraints.PYTHONS, "the Python of .ci/run on hosted machines"


def test_packages_for_later_pythons_are_left_out() -> None:
    text = (
        "a==1 ; python_full_version < '3.12' \\\n    --hash=sha256:0\n"
        "a==2 ; python_full_version >= '3.12' \\\n    --hash=sha256:1\n"
        "b==3 ; sys_platform == 'win32' \\\n    --hash=sha256:2\n"
    )
    assert list(refresh_constraints.split_packages(text, "3.11")) == [
        "a==1 ; python_full_version < '3.12'",
        "b==3 ; sys_platform == 'win32'",
    ]
