"""The command that installs a library of the system, or an extra of this program."""

from __future__ import annotations

import ctypes
import re
import shlex
import sys

from calibgui.app.system.resources import find_resource
from calibgui.engine.errors import CalibrationError

_LIBRARY = re.compile(r"(lib[\w.+-]+?)\.so\.(\d+)")
"""The name and the version of a shared library of Linux."""
_OLD_NAMES = {"libglib-2.0": "libglib2.0-0", "libgthread-2.0": "libglib2.0-0"}
"""Packages of Debian that are older than its policy, by the names of their libraries."""


def describe_missing_library(problem: str) -> str:
    """Return what to install, from what the loader said; empty if it named no library.

    The loader names the first library that it misses: if that is one of those that the window
    needs, all of these that are missing are named. Of others the package is called as Debian's
    policy wants it: the library's name and version, with a hyphen between two digits.

    >>> describe_missing_library("libnew_one2.so.0: cannot open shared object file")
    'The library libnew_one2.so.0 is missing. On Debian and Ubuntu: apt install libnew-one2-0'
    """
    found = _LIBRARY.search(problem)
    if found is None:
        return ""
    packages = _list_missing_packages()
    if len(packages) > 1 and found[0] in packages:
        listed = " ".join(dict.fromkeys(packages.values()))
        return (
            f"These libraries are missing: {', '.join(packages)}. On Debian and Ubuntu: "
            f"apt install {listed}"
        )
    name, version = found.groups()
    by_policy = name.lower().replace("_", "-") + ("-" if name[-1].isdigit() else "") + version
    package = _OLD_NAMES.get(name, by_policy)
    return f"The library {found[0]} is missing. On Debian and Ubuntu: apt install {package}"


def _list_missing_packages() -> dict[str, str]:
    """Return Debian's packages of the libraries that the window needs and that cannot be loaded."""
    try:
        text = find_resource("system/debian-packages.txt").read_text(encoding="utf-8")
    except CalibrationError:
        return {}
    rows = [line.split() for line in text.splitlines() if line and not line.startswith("#")]
    return {library: package for package, library, _ in rows if not _can_be_loaded(library)}


def _can_be_loaded(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def describe_missing_extra(extra: str) -> str:
    """Return how to install what an extra of ``pyproject.toml`` names, into this Python."""
    python = shlex.quote(sys.executable)
    return (
        "Give this command in the folder that calibgui was installed from: "
        f"{python} -m pip install '.[{extra}]'"
    )
