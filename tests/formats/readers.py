"""Programs other than this one that read its files, run in their own Python."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from functools import cache
from typing import Any

import numpy as np
import pytest

RAYS = np.array([[0.0, 0.0, 1.0], [0.3, 0.2, 1.0], [-0.6, 0.4, 1.5], [0.1, -0.7, 2.0]])
"""Points in front of a camera, which every reader is asked to project."""
_CANDIDATES = (os.environ.get("CALIBGUI_OTHER_PYTHON", ""), "/usr/bin/python3")
"""Interpreters with other programs' libraries, the first that serves is taken."""


def in_other_python(script: str, *arguments: object, needs: str) -> Any:
    """What `script` prints as JSON, in an interpreter where the statement `needs` succeeds.

    The test is skipped where there is none.
    """
    for python in filter(shutil.which, _CANDIDATES):
        if _serves(python, needs):
            done = _run(python, script, *arguments)
            assert done.returncode == 0, done.stderr
            return json.loads(done.stdout)
    pytest.skip(f"no Python for {needs!r}: set CALIBGUI_OTHER_PYTHON to one")


@cache
def _serves(python: str, needs: str) -> bool:
    return _run(python, needs).returncode == 0


def _run(python: str, script: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    return subprocess.run(
        [python, "-c", script, *map(str, arguments)],
        capture_output=True,
        text=True,
        env=environment,
        cwd=tempfile.gettempdir(),  # not the checkout: its packages are not theirs
        timeout=120,
        check=False,
    )
