"""The rows of the ablation of assessment: what is said of the faults of `tests.faults`."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Sequence

from tests.benchmarks.ablation.patching import Switch, Watch, switched_off
from tests.faults.campaign import Answer, Verdict, count_verdicts, examine_fault
from tests.faults.causes import CLEAN, FAULTS

Draw = tuple[str, int]
COLUMNS = (
    "switched off",
    "asked",
    "changed",
    "named",
    "harmless",
    "another cause",
    "silent",
    "false alarms",
    "silent clean",
    "CPU s",
    "worst draw",
)
"""What the columns hold: number of draws in which the switch matters, and of those in which
anything else is said; of the faults those that are named first, that are not named and do no harm,
of which another cause is named first, and of which nothing is said though an intrinsic is wrong; of
the clean sets those with a finding, and those with a wrong intrinsic; processor time."""
_CLEAN_FACTOR = 10
"""Number of draws of the clean set for one of each fault."""
_FAULTY = (Verdict.RIGHT, Verdict.HARMLESS, Verdict.WRONG, Verdict.SILENT)
_OF_CLEAN = (Verdict.FALSE_ALARM, Verdict.SILENT)
_HARM = {Verdict.SILENT: 2, Verdict.FALSE_ALARM: 1, Verdict.WRONG: 1}
"""How bad an answer is."""


def make_rows(switches: Sequence[Switch], seed: int, draws: int) -> Iterator[str]:
    """Make the rows of the table one after another.

    Args:
        switches: what is switched off.
        seed: the first draw's.
        draws: number of draws of each fault; of the clean set ten times as many.
    """
    yield _join(COLUMNS)
    yield _join(["---", *["--:"] * (len(COLUMNS) - 2), "---"])
    chosen = [
        (name, k)
        for name in FAULTS
        for k in range(seed, seed + draws * (_CLEAN_FACTOR if name == CLEAN else 1))
    ]
    examine_fault(*chosen[0])  # compiles
    before, seconds = _examine_all(chosen)
    counts = _count(before)
    cells = [f"**baseline**, {len(chosen)} draws", str(len(chosen)), ""]
    yield _join([*cells, *map(str, counts), f"{sum(seconds.values()):.1f}", ""])
    watch = Watch(switches)
    matters: dict[str, list[Draw]] = {}
    with watch.watching():
        for draw in chosen:
            watch.start()
            examine_fault(*draw)
            for name in watch.mattering:
                matters.setdefault(name, []).append(draw)
    for switch in switches:
        if switch.name not in watch.called:
            yield _join([switch.name, "never called", *[""] * (len(COLUMNS) - 2)])
            continue
        where = matters.get(switch.name, [])
        with switched_off(switch):
            after, spent = _examine_all(where)
        changed = [draw for draw in where if after[draw].said != before[draw].said]
        moved = [
            f"{now - then:+d}" if now != then else ""
            for now, then in zip(_count(before | after), counts, strict=True)
        ]
        cpu = sum(spent.values()) - sum(seconds[draw] for draw in where)
        cells = [switch.name, str(len(where)), str(len(changed)), *moved, f"{cpu:+.1f}"]
        yield _join([*cells, _describe_worst(changed, before, after)])


def _examine_all(draws: Sequence[Draw]) -> tuple[dict[Draw, Answer], dict[Draw, float]]:
    """Examine draws; return the answers, and the processor time of each."""
    answers, seconds = {}, {}
    for draw in draws:
        start = time.process_time()
        try:
            answers[draw] = examine_fault(*draw)
        except Exception as error:  # a switch may break what it switches off
            said = (f"{type(error).__name__}: {error}",)
            answers[draw] = Answer(*draw, Verdict.WRONG, "", said, float("nan"))
        seconds[draw] = time.process_time() - start
    return answers, seconds


def _count(answers: dict[Draw, Answer]) -> list[int]:
    """Count the verdicts on faults and on clean sets."""
    of_faults, of_clean = (
        count_verdicts(each for each in answers.values() if (each.fault == CLEAN) == is_clean)
        for is_clean in (False, True)
    )
    pairs: list[tuple[Counter[Verdict], Verdict]] = [(of_faults, each) for each in _FAULTY]
    pairs += [(of_clean, each) for each in _OF_CLEAN]
    return [counter[verdict] for counter, verdict in pairs]


def _describe_worst(
    changed: Sequence[Draw], before: dict[Draw, Answer], after: dict[Draw, Answer]
) -> str:
    """Describe the draw whose answer suffers most."""

    def measure_harm(draw: Draw) -> int:
        return _HARM.get(after[draw].verdict, 0) - _HARM.get(before[draw].verdict, 0)

    if not changed or measure_harm(worst := max(changed, key=measure_harm)) <= 0:
        return ""
    said = (after[worst].said or ("nothing",))[0].split(":")[0]
    return f"{worst[0]} {worst[1]}: {after[worst].verdict.value}, says {said}"


def _join(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
