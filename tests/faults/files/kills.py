"""Programs that are killed while they write: `python -m tests.faults.files.kills FOLDER KILLS`.

A process writes two contents in turn to one file and is killed at a random moment. The file then
holds the one or the other, whole; a temporary file beside it shows that it was in the midst.
"""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from calibgui.app.projects.autosave import autosave, get_autosave_path
from calibgui.app.projects.project_file import read_project, write_project
from calibgui.formats.json_document import write_json
from calibgui.formats.result_json import encode_result_with_findings, read_result
from tests.faults.files.readers import GOLDEN

_ROOT = Path(__file__).parents[3]
_MAX_DELAY_S = 0.1
"""Longest time from the first content to the kill, s: that of some writes."""
KILLED = {"a project", "an autosave", "a result"}
"""What is written when programs are killed."""
_TEMPORARY = ".calibgui.*.tmp"

Write = Callable[[], object]


def make_kills_table(folder: Path, kills: int = 200) -> str:
    """Return a table in Markdown of what kills leave of each kind of file."""
    lines = [
        "| killed while writing | kills | in the midst | whole | torn |",
        "| --- | ---: | ---: | ---: | ---: |",
    ]
    for name, counts in run_kills(folder, kills).items():
        lines.append(
            f"| {name} | {kills} | {counts['midst']} | {counts['whole']} | {counts['torn']} |"
        )
    return "\n".join(lines)


def run_kills(folder: Path, kills: int) -> dict[str, Counter[str]]:
    """Kill writers of each kind of file; return by kind how many files are whole, and torn, and
    how many writers were in the midst of a file."""
    # Forked from a process without threads.
    command = [sys.executable, "-m", "tests.faults.files.kills", str(folder), str(kills)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=_ROOT)
    return {name: Counter(counts) for name, counts in json.loads(done.stdout).items()}


def main() -> None:
    """Kill writers, and print what is left."""
    folder, kills = Path(sys.argv[1]), int(sys.argv[2])
    draw = random.Random(0)
    found = {}
    for name, (file, writes) in _list_writers(folder).items():
        contents = []
        for write in writes:
            write()
            contents.append(file.read_bytes())
        assert contents[0] != contents[1]
        counts: Counter[str] = Counter()
        for _ in range(kills):
            _kill_writer(writes, draw.uniform(0, _MAX_DELAY_S))
            counts["whole" if file.read_bytes() in contents else "torn"] += 1
            left = list(file.parent.glob(_TEMPORARY))
            counts["midst"] += bool(left)
            for temporary in left:
                temporary.unlink()
        found[name] = counts
    print(json.dumps(found))


def _list_writers(folder: Path) -> dict[str, tuple[Path, list[Write]]]:
    """Return files by their kinds, each with two functions that write it."""
    file, result_file = folder / "killed.json", folder / "killed-result.json"
    project = read_project(GOLDEN / "project-3.json")
    projects = [project, replace(project, by_hand=not project.by_hand)]
    result = read_result(GOLDEN / "result-1.json")
    records = [
        encode_result_with_findings(replace(result, lengths_confirmed=known))
        for known in (True, False)
    ]
    return {
        "a project": (file, [lambda p=p: write_project(p, file) for p in projects]),
        "an autosave": (
            get_autosave_path(file),
            [lambda p=p: autosave(p, file) for p in projects],
        ),
        "a result": (result_file, [lambda r=r: write_json(result_file, r) for r in records]),
    }


def _kill_writer(writes: list[Write], delay: float) -> None:
    """Kill a process that writes in turn, some time after it has begun."""
    process = os.fork()
    if process == 0:
        while True:
            for write in writes:
                write()
    time.sleep(delay)
    os.kill(process, signal.SIGKILL)
    os.waitpid(process, 0)


if __name__ == "__main__":
    main()
