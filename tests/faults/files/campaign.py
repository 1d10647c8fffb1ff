"""The campaign: every reader on every kind of damage, in a process that may fail, and its table."""

from __future__ import annotations

import itertools
import json
import select
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.faults.files.damage import DAMAGES, PLACES

_MAX_WAIT_S = 300.0
"""Time without an answer, s, after which a try counts as a hang that only an end stops: other
programs may have most of the processor."""
_ROOT = Path(__file__).parents[3]
RIGHT = ("refused", "read")
"""Outcomes that are right: what is left of a damaged file may be sound."""


@dataclass(frozen=True, slots=True)
class Try:
    """One damaged file: a reader's name, a kind of damage and a seed."""

    reader: str
    kind: str
    seed: int


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of it: a word, and what was said."""

    tried: Try
    word: str
    said: str


def list_tries(readers: Iterable[str], tries: int, seed: int) -> list[Try]:
    """List the tries of all readers: `tries` of each kind of damage, and one of each place."""
    found = []
    for reader in readers:
        found += [Try(reader, kind, 0) for kind in PLACES]
        found += [Try(reader, kind, seed + k) for kind in DAMAGES for k in range(tries)]
    return found


def run_tries(tries: Iterable[Try], folder: Path) -> Iterator[Outcome]:
    """Yield the outcome of each try; a worker that ends is followed by another one."""
    waiting = iter(tries)
    while True:
        batch = list(itertools.islice(waiting, 1))
        if not batch:
            return
        with _start_worker(folder) as worker:
            for tried in itertools.chain(batch, waiting):
                outcome = _ask(worker, tried)
                yield outcome
                if outcome.word not in (*RIGHT, "names no file", "traceback"):
                    break  # its memory's peak, or its state, is that of this try


@contextmanager
def _start_worker(folder: Path) -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, "-m", "tests.faults.files.worker", str(folder)]
    worker = subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,  # what OpenCV's libraries print on damaged images
        text=True,
        cwd=_ROOT,
    )
    try:
        assert worker.stdout is not None
        if worker.stdout.readline() != "ready\n":
            raise RuntimeError("the campaign's worker does not start")
        yield worker
    finally:
        worker.kill()
        worker.communicate()


def _ask(worker: subprocess.Popen[str], tried: Try) -> Outcome:
    assert worker.stdin is not None and worker.stdout is not None
    worker.stdin.write(json.dumps([tried.reader, tried.kind, tried.seed]) + "\n")
    worker.stdin.flush()
    if not select.select([worker.stdout], [], [], _MAX_WAIT_S)[0]:
        return Outcome(tried, "hang", f"no answer in {_MAX_WAIT_S:.0f} s")
    answer = worker.stdout.readline()
    if not answer:
        return Outcome(tried, "crash", f"the process ended: {worker.wait()}")
    return Outcome(tried, *json.loads(answer))


def make_table(outcomes: Iterable[Outcome], by: str = "reader") -> str:
    """Return a table in Markdown with a row for each reader, or each kind of damage.

    Args:
        outcomes: of all tries.
        by: "reader" or "kind".
    """
    rows: dict[str, Counter[str]] = {}
    for outcome in outcomes:
        rows.setdefault(getattr(outcome.tried, by), Counter())[outcome.word] += 1
    rows["all"] = sum(rows.values(), Counter())
    title = {"reader": "reader", "kind": "kind of damage"}[by]
    lines = [f"| {title} | tries | refused | read | wrong |", "| --- | ---: | ---: | ---: | --- |"]
    for name, counts in rows.items():
        wrong = ", ".join(f"{n} {word}" for word, n in counts.items() if word not in RIGHT)
        lines.append(
            f"| {name} | {counts.total()} | {counts['refused']} | {counts['read']} "
            f"| {wrong or '0'} |"
        )
    return "\n".join(lines)
