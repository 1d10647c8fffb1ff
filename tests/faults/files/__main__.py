"""Is every damaged file refused by name? `python -m tests.faults.files [--tries N] [--seed S]`.

Each reader of the project reads damaged files of its format, in a process of its own with limits
of time and memory. The tables say what became of them. A try is repeated by its reader, kind of
damage and seed, which are printed with what was said where it was wrong.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tests.faults.files.campaign import RIGHT, list_tries, make_table, run_tries
from tests.faults.files.kills import make_kills_table
from tests.faults.files.large import make_sizes_table
from tests.faults.files.readers import find_readers


def main() -> int:
    """Run the campaign and print its tables; return 1 if anything was wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tries", type=int, default=25, help="of each reader and kind of damage")
    parser.add_argument("--seed", type=int, default=0, help="the first try's seed")
    parser.add_argument("--reader", action="append", help="this reader alone")
    parser.add_argument("--fuzz", action="store_true", help="damaged files alone")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        readers = arguments.reader or list(find_readers(folder))
        outcomes = []
        for outcome in run_tries(list_tries(readers, arguments.tries, arguments.seed), folder):
            outcomes.append(outcome)
            if outcome.word not in RIGHT:
                print(f"{outcome.tried}: {outcome.word}\n{outcome.said}", file=sys.stderr)
        print(f"{make_table(outcomes)}\n\n{make_table(outcomes, by='kind')}")
        if not (arguments.fuzz or arguments.reader):
            print(f"\n{make_kills_table(folder)}\n\n{make_sizes_table(folder)}")
    return int(any(outcome.word not in RIGHT for outcome in outcomes))


if __name__ == "__main__":
    sys.exit(main())
