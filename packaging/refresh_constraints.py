"""Pin what bootstrap.py installs: the newest versions that pyproject.toml allows, with SHA-256.

    .venv/bin/python -m pip install uv
    .venv/bin/python packaging/refresh_constraints.py

writes `packaging/constraints/python3.11.txt` and so on, for every system. uv resolves for Pythons
that are not there, which pip cannot: it evaluates markers for the Python that it runs under. The
bounds in pyproject.toml stay open; who installs calibgui by other means gets what these allow.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable
from pathlib import Path

from bootstrap import CONSTRAINTS, EXTRAS, NEXT_EXTRA, ROOT
from packaging.requirements import Requirement

PYTHONS = ("3.11", "3.12", "3.13")
EDITABLE = "editables"
"""What hatchling needs beside itself for an editable installation."""
HEADER = """\
# Written by packaging/refresh_constraints.py; read by packaging/bootstrap.py.
"""


def read_requirements() -> list[list[str]]:
    """Return what is needed without an extra, to build the project too, and with each of them."""
    content = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project = content["project"]
    needs = [[*project["dependencies"], *content["build-system"]["requires"], EDITABLE]]
    optional = project["optional-dependencies"]
    for extra in EXTRAS[1:]:
        added = list(optional[extra])
        for own in [need for need in added if need.startswith("calibgui")]:
            added.remove(own)
            # Those of EXTRAS are there anyway.
            for other in sorted(Requirement(own).extras - set(EXTRAS)):
                added.extend(optional[other])
        needs.append([*needs[-1], *added])
    return needs


def resolve(python: str, requirements: Iterable[str], held: str = "") -> str:
    """Return the packages that meet the requirements, with SHA-256, in the versions `held`."""
    with tempfile.TemporaryDirectory() as folder:
        wanted, constraints = Path(folder, "wanted.in"), Path(folder, "held.txt")
        wanted.write_text("\n".join(requirements), encoding="utf-8")
        constraints.write_text(re.sub(r"( \\)?\n +--hash=\S+", "", held), encoding="utf-8")
        command = [find_uv(), "pip", "compile", "--universal", "--python-version", python]
        command += ["--generate-hashes", "--no-header", "--no-annotate", "--quiet", "--no-config"]
        done = subprocess.run(
            [*command, "--constraint", str(constraints), str(wanted)],
            check=True,
            stdout=subprocess.PIPE,
            text=True,
        )
    return done.stdout


def find_uv() -> str:
    """Return uv's path, or end the program."""
    beside = shutil.which("uv", path=str(Path(sys.executable).parent))
    if (found := beside or shutil.which("uv")) is None:
        sys.exit("needs uv: pip install uv")
    return found


def split_packages(text: str, python: str) -> dict[str, str]:
    """Return each package's lines, by the line that names its version.

    Those that are for later Pythons only are left out.
    """
    blocks = re.findall(r"^[^\s#].*\n(?:[ \t]+.*\n)*", text, re.MULTILINE)
    named = {block.partition("\n")[0].removesuffix(" \\"): block for block in blocks}
    return {name: block for name, block in named.items() if is_for(Requirement(name), python)}


def is_for(package: Requirement, python: str) -> bool:
    """Return whether a package is for a Python on some system."""
    systems = [
        {"sys_platform": system, "python_version": python, "python_full_version": f"{python}.99"}
        for system in ("linux", "win32", "darwin")
    ]
    return package.marker is None or any(map(package.marker.evaluate, systems))


def pin(python: str) -> str:
    """Return the content of the file for a Python."""
    needs = read_requirements()
    held = resolve(python, needs[-1])
    parts: list[str] = []
    named: set[str] = set()
    for need in needs:
        packages = split_packages(resolve(python, need, held), python)
        parts.append("".join(block for name, block in packages.items() if name not in named))
        named |= packages.keys()
    return HEADER + NEXT_EXTRA.join(parts)


if __name__ == "__main__":
    CONSTRAINTS.mkdir(exist_ok=True)
    for version in PYTHONS:
        (CONSTRAINTS / f"python{version}.txt").write_text(pin(version), encoding="utf-8")
        print(f"{version}: pinned", flush=True)
