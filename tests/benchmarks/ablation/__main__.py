"""What is each rule of the product worth? `python -m tests.benchmarks.ablation [KIND ...]`.

Every rule, pass, cause and test in the lists of `switches` is switched off, alone and in groups,
and what that changes of a fixed set of pictures (`sets`), or of the faults of `tests.faults`, is
printed as a row of a Markdown table beside the product as it is. A row that is empty is a rule that
changes nothing; of a group that changes anything a row for each of its rules tells whether it is
needed where the others are off. `--scale` halves and doubles each tuned number instead. `--fresh`
draws pictures that nobody has looked at; its seed is printed, and repeats them as `--seed`.

    python -m tests.benchmarks.ablation checkerboard --ledger before.npz
    python -m tests.benchmarks.ablation checkerboard --against before.npz

write the corners that the product finds in all pictures to a ledger, and tell, after a change of
the code, which of them appeared, vanished or moved. That takes a minute and no switch.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import cv2
import numpy as np

from calibgui.app.system.kernel_preparation import compile_kernels
from tests.benchmarks.ablation import faults, ledger, runs, table
from tests.benchmarks.ablation.numbers import list_scalings
from tests.benchmarks.ablation.patching import Switch, combine
from tests.benchmarks.ablation.sets import KINDS, Picture, load_pictures
from tests.benchmarks.ablation.switches import SWITCHES
from tests.conftest import find_data_dir

_CACHE = Path(tempfile.gettempdir()) / "calibgui-ablation"
_SCALED_SHARE = 4
"""Of so many pictures one is searched with scaled numbers."""
_ASSESSMENT = "assessment"


def main() -> None:
    """Run the ablation, or write and compare ledgers."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"{', '.join(SWITCHES)}; all")
    parser.add_argument("--seed", type=int, default=0, help="of the pictures that are drawn")
    parser.add_argument("--fresh", action="store_true", help="draw pictures with a seed of chance")
    parser.add_argument("--cache", type=Path, default=_CACHE, help="folder of what was drawn")
    parser.add_argument("--ledger", type=Path, metavar="FILE", help="write the corners found")
    parser.add_argument("--against", type=Path, metavar="FILE", help="compare with this ledger")
    parser.add_argument("--switch", action="append", metavar="NAME", help="this switch alone")
    parser.add_argument("--scale", action="store_true", help="halve and double numbers instead")
    parser.add_argument("--thorough", action="store_true", help="ask harmful switches of all, too")
    parser.add_argument("--draws", type=int, default=3, help="of each fault")
    parser.add_argument("--output", type=Path, metavar="FILE", help="add the rows to a file, too")
    options = parser.parse_args()
    if unknown := set(options.kinds) - set(SWITCHES):
        parser.error(f"no such kind: {', '.join(unknown)}")
    cv2.setNumThreads(1)
    compile_kernels()  # without them the baseline is slower, and rounded otherwise
    if options.fresh:
        options.seed = int(np.random.default_rng().integers(1000, 1_000_000))
    print(f"seed {options.seed}, real photographs of {find_data_dir()}", flush=True)
    kinds = options.kinds or list(SWITCHES)
    if options.ledger or options.against:
        _keep_ledger(options, [kind for kind in kinds if kind in KINDS])
        return
    for kind in kinds:
        scalings = list_scalings(kind) if options.scale else SWITCHES[kind]
        chosen = [each for each in scalings if not options.switch or each.name in options.switch]
        if kind == _ASSESSMENT:
            rows = faults.make_rows(chosen, options.seed, options.draws)
        else:
            pictures = load_pictures(kind, options.seed, options.cache)
            step = _SCALED_SHARE if options.scale else 1
            rows = _make_rows(pictures[::step], chosen, is_thorough=options.thorough)
        for row in rows:
            print(row, flush=True)
            if options.output:
                with options.output.open("a", encoding="utf-8") as file:
                    file.write(f"{row}\n")


def _keep_ledger(options: argparse.Namespace, kinds: list[str]) -> None:
    """Search all pictures, write a ledger and compare with another, as far as that is asked for."""
    entries: runs.Entries = {}
    for kind in kinds:
        found = runs.search_all(load_pictures(kind, options.seed, options.cache))
        entries |= {f"{kind} {name}": entry for name, entry in found.items()}
    seconds = sum(each.seconds for each in entries.values())
    print(f"{len(entries)} pictures, {seconds:.1f} s of the processor")
    if options.ledger:
        ledger.write_ledger(options.ledger, entries)
    if options.against:
        print(ledger.describe_changes(ledger.read_ledger(options.against), entries))


def _make_rows(
    pictures: list[Picture], switches: list[Switch], *, is_thorough: bool
) -> Iterator[str]:
    """Make the rows of the table one after another."""
    entries = runs.search_all(pictures)
    pictures = runs.add_truth(pictures, entries)
    before = table.Outcome.of(pictures, entries)
    yield table.make_head()
    yield table.make_baseline_row(pictures, before)
    matters = runs.find_where_switches_matter(pictures, switches)
    for switch in switches:
        if switch.name not in matters:
            yield table.make_idle_row(switch.name)
            continue
        where = matters[switch.name]
        found = runs.search_without(switch, pictures, where, entries, is_thorough=is_thorough)
        yield table.make_row(switch.name, pictures, len(where), before, found)
        changed = {n for n, each in found.items() if ledger.compare(entries[n], each)}
        for part in switch.parts if changed else ():
            # Which of them is needed only where the others are off, too?
            rest = [each for each in switch.parts if each is not part]
            but = combine(f"{switch.name} but {part.name}", rest)
            found = runs.search_without(but, pictures, changed, entries, is_thorough=True)
            yield table.make_row(but.name, pictures, len(changed), before, found)


if __name__ == "__main__":
    main()
