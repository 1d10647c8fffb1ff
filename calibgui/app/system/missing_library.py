"""The command that installs a library of the system, or an extra of this program."""

from __future__ import annotations

import re
import shlex
import sys

_LIBRARY = re.compile(r"(lib[\w.+-]+?)\.so\.(\d+)")
"""The name and the version of a shared library of Linux."""
_OLD_NAMES = {"libglib-2.0": "libglib2.0-0", "libgthread-2.0": "libglib2.0-0"}
"""Packages of Debian that are older than its policy, by the names of their libraries."""


def describe_missing_library(problem: str) -> str:
    """Return what to install, from what the loader said; empty if it named no library.

    Debian's packages are called as their policy wants it: the library's name and version, with a
    hyphen between two digits.

    >>> describe_missing_library("libxcb-cursor.so.0: cannot open shared object file")
    'The library libxcb-cursor.so.0 is missing. On Debian and Ubuntu: apt install libxcb-cursor0'
    """
    found = _LIBRARY.search(problem)
    if found is None:
        return ""
    name, version = found.groups()
    by_policy = name.lower() + ("-" if name[-1].isdigit() else "") + version
    package = _OLD_NAMES.get(name, by_policy)
    return f"The library {found[0]} is missing. On Debian and Ubuntu: apt install {package}"


def describe_missing_extra(extra: str) -> str:
    """Return how to install what an extra of ``pyproject.toml`` names, into this Python."""
    python = shlex.quote(sys.executable)
    return (
        "Give this command in the folder that calibgui was installed from: "
        f"{python} -m pip install '.[{extra}]'"
    )
