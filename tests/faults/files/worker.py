"""The process in which damaged files are read: `python -m tests.faults.files.worker FOLDER`.

It takes a line of JSON with reader, damage and seed for each try and answers with its outcome. A
try that takes too much of the processor's time or of memory is told, and ends the process where
nothing else would; the one that started it (``campaign.py``) waits for no answer longer than that.
"""

from __future__ import annotations

import json
import resource
import shutil
import signal
import sys
import traceback
import zlib
from pathlib import Path

import numpy as np

from calibgui.engine.errors import CalibrationError
from tests.faults.files.damage import DAMAGES, PLACES
from tests.faults.files.readers import Reader, find_readers

MAX_SECONDS = 5.0
"""Processor time of a read, s, that counts as a hang; the slowest sound file takes a tenth."""
MAX_MEMORY = 500 << 20
"""Memory that a read takes, bytes, from which on it counts as too much."""
_ADDRESS_SPACE = 4 << 30
"""What the process may have in all, bytes, so that a bomb does not take the machine."""


class _TookTooLongError(BaseException):
    """An error that no reader catches: the time of a try is over."""


def main() -> None:
    """Answer tries until there are no more."""
    folder = Path(sys.argv[1])
    readers = find_readers(folder)
    resource.setrlimit(resource.RLIMIT_AS, (_ADDRESS_SPACE, _ADDRESS_SPACE))
    print("ready", flush=True)
    for line in sys.stdin:
        name, kind, seed = json.loads(line)
        outcome, said = attempt(readers[name], kind, seed, folder)
        print(json.dumps([outcome, said]), flush=True)


def attempt(reader: Reader, kind: str, seed: int, folder: Path) -> tuple[str, str]:
    """Read one damaged file; return the outcome as a word, and what was said."""
    place = folder / "try"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    file = place / reader.file
    if kind in PLACES:
        PLACES[kind](file)
    else:
        file.write_bytes(make_content(reader, kind, seed))
    before = _measure_peak()
    signal.signal(signal.SIGVTALRM, _stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, MAX_SECONDS)
    try:
        content = reader.read(file)
        outcome, said = "read" if reader.tells or content else "refused", ""
    except CalibrationError as error:
        is_named = reader.file in error.message
        outcome, said = "refused" if is_named else "names no file", str(error)
    except _TookTooLongError:
        outcome, said = "hang", traceback.format_exc(limit=-3)
    except MemoryError:
        outcome, said = "memory", traceback.format_exc(limit=-3)
    except Exception:
        outcome, said = "traceback", traceback.format_exc(limit=-6)
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
    if _measure_peak() - before > MAX_MEMORY and outcome in ("read", "refused"):
        outcome = "memory"
    return outcome, said[-2000:]


def make_content(reader: Reader, kind: str, seed: int) -> bytes:
    """Return the damaged content of a try: the same for the same reader, kind and seed."""
    rng = np.random.default_rng([seed, zlib.crc32(f"{reader.name} {kind}".encode())])
    return DAMAGES[kind](reader.sample, rng)


def _measure_peak() -> int:
    """Return the largest memory that the process had at any time, bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss << 10


def _stop(*_: object) -> None:
    raise _TookTooLongError


if __name__ == "__main__":
    main()
