"""The table of an ablation: a row for each switch, of what differs from the baseline."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tests.benchmarks.ablation.ledger import Entry, compare
from tests.benchmarks.ablation.runs import Score, score
from tests.benchmarks.ablation.sets import REAL, RENDERED, Picture

COLUMNS = (
    "switched off",
    "asked",
    "changed",
    "whole",
    "lost",
    "wrong",
    "false",
    "real lost",
    "real wrong",
    "less exact",
    "more exact",
    "error/bound",
    "95 %",
    "chi2",
    "95 %",
    "CPU s",
    "worst photograph",
)
"""What the columns hold: number of pictures in which the switch matters, with how many of them were
searched if it did so much harm that these were enough; of those in which corners changed; boards
found whole, corners lost and wrong in rendered pictures; boards where there are none, in all;
corners lost and wrong in real photographs, beside those of the baseline; pictures, rendered and
real, whose error has clearly grown or shrunk; of the error over the bound and of chi2 the median
and the 95th percentile over the rendered pictures; processor time, and the picture that suffers
most."""


@dataclass(frozen=True)
class Outcome:
    """What a run found in all pictures."""

    entries: Mapping[str, Entry]
    scores: Mapping[str, Score]

    @classmethod
    def of(cls, pictures: Sequence[Picture], entries: Mapping[str, Entry]) -> Outcome:
        """Score a run."""
        return cls(entries, {each.name: score(each, entries[each.name]) for each in pictures})

    def change(self, pictures: Sequence[Picture], entries: Mapping[str, Entry]) -> Outcome:
        """Score a run of some of the pictures; what it found of others is as before."""
        asked = [picture for picture in pictures if picture.name in entries]
        part = Outcome.of(asked, entries)
        return Outcome({**self.entries, **entries}, {**self.scores, **part.scores})


def make_head() -> str:
    """Make the head of the table."""
    return "\n".join((_join(COLUMNS), _join(["---", *["--:"] * (len(COLUMNS) - 2), "---"])))


def make_baseline_row(pictures: Sequence[Picture], outcome: Outcome) -> str:
    """Make the row of the product as it is: absolute numbers."""
    sums, middles = _sum_up(pictures, outcome)
    cpu = sum(each.seconds for each in outcome.entries.values())
    boards = sum(len(each.uv) > 0 for each in outcome.entries.values())
    cells = [f"**baseline**, {len(pictures)} pictures", str(len(pictures)), f"({boards} boards)"]
    cells += [str(value) for value in sums]
    cells += ["", "", *(f"{value:.3f}" for value in middles), f"{cpu:.1f}", ""]
    return _join(cells)


def make_idle_row(name: str) -> str:
    """Make the row of a switch whose functions are never called."""
    return _join([name, "never called", *[""] * (len(COLUMNS) - 2)])


def make_row(
    name: str,
    pictures: Sequence[Picture],
    matters: int,
    before: Outcome,
    entries: Mapping[str, Entry],
) -> str:
    """Make the row of a switch: differences from the baseline, empty where there are none.

    Args:
        name: of the switch.
        pictures: all of them.
        matters: number of those in which it matters.
        before: the baseline.
        entries: what was found with it switched off in those that it was asked of.
    """
    after = before.change(pictures, entries)
    changed = [each for each in entries if compare(before.entries[each], entries[each])]
    errors = [each for each in entries if entries[each].error]
    (sums, middles), (sums_before, middles_before) = (
        _sum_up(pictures, each) for each in (after, before)
    )
    worse = sum(before.scores[n].is_more_exact(after.scores[n]) for n in changed)
    better = sum(after.scores[n].is_more_exact(before.scores[n]) for n in changed)
    cpu = sum(entries[n].seconds - before.entries[n].seconds for n in entries)
    asked = str(matters) if matters == len(entries) else f"{len(entries)} of {matters}"
    cells = [name, asked, str(len(changed))]
    cells += [_sign(a - b, "d") for a, b in zip(sums, sums_before, strict=True)]
    cells += [str(worse or ""), str(better or "")]
    cells += [_sign(a - b, ".3f") for a, b in zip(middles, middles_before, strict=True)]
    cells += [_sign(cpu, ".1f"), _describe_worst(changed, before, after)]
    if errors:
        cells[-1] += f"; raises in {len(errors)}, as {errors[0]}: {entries[errors[0]].error}"
    return _join(cells)


def _sum_up(pictures: Sequence[Picture], outcome: Outcome) -> tuple[list[int], list[float]]:
    """Sum the counts up, and take the medians over the rendered pictures."""
    rendered, real = (
        [outcome.scores[each.name] for each in pictures if each.group == group]
        for group in (RENDERED, REAL)
    )
    counts = [
        sum(each.whole for each in rendered),
        sum(each.lost for each in rendered),
        sum(each.wrong for each in rendered),
        sum(each.false for each in outcome.scores.values()),
        sum(each.lost for each in real),
        sum(each.wrong for each in real),
    ]
    chi2 = [each.chi2 for each in rendered]
    ratios = [each.ratio for each in rendered]
    return counts, [
        float(np.nanpercentile(values, share)) if np.isfinite(values).any() else np.nan
        for values in (ratios, chi2)
        for share in (50, 95)
    ]


def _describe_worst(changed: Sequence[str], before: Outcome, after: Outcome) -> str:
    """Describe the picture that suffers most."""

    def measure_harm(name: str) -> tuple[float, ...]:
        one, other = before.scores[name], after.scores[name]
        grown = other.error / one.error if one.is_more_exact(other) else 0.0
        return other.false - one.false, other.wrong - one.wrong, other.lost - one.lost, grown

    if not changed:
        return ""
    worst = max(changed, key=measure_harm)
    harm = measure_harm(worst)
    if max(harm) <= 0:
        return ""
    said = [f"{v:.0f} {w}" for v, w in zip(harm[:3], ("false", "wrong", "lost"), strict=True) if v]
    if harm[3]:
        said.append(f"error x {harm[3]:.1f}")
    return f"{worst} ({', '.join(said)})"


def _sign(difference: float, form: str) -> str:
    """Write a difference with its sign, nothing if it is none."""
    text = format(difference, "+" + form)
    return "" if not float(text) or np.isnan(difference) else text


def _join(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
