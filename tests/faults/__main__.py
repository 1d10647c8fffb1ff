"""Are faults named by their cause? `python -m tests.faults [--draws N] [--cause NAME] [--peers]`.

Faults of every kind are injected into the corners of rendered and real sets, from barely visible
to gross; each set is calibrated with the defaults and its findings are compared with what was
injected. A draw is repeated by its cause and seed.
"""

from __future__ import annotations

import argparse

from tests.faults.campaign import Answer, Verdict, examine_fault, inject_fault, make_table
from tests.faults.causes import FAULTS
from tests.faults.peers import count_peers


def main() -> None:
    """Run the campaign and print its table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--draws", type=int, default=20, help="draws of each cause")
    parser.add_argument("--seed", type=int, default=0, help="the first draw's seed")
    parser.add_argument("--cause", choices=FAULTS, action="append", help="this cause alone")
    parser.add_argument("--peers", action="store_true", help="what OpenCV and mrcal answer, too")
    parser.add_argument("-v", "--verbose", action="store_true", help="say what was answered")
    arguments = parser.parse_args()
    answers = []
    for name in arguments.cause or FAULTS:
        for seed in range(arguments.seed, arguments.seed + arguments.draws):
            answers.append(examine_fault(name, seed))
            if arguments.verbose:
                print(describe_answer(answers[-1]), flush=True)
    peers = None
    if arguments.peers:
        seeds = range(arguments.seed, arguments.seed + arguments.draws)
        names = arguments.cause or FAULTS
        peers = count_peers({n: [inject_fault(n, seed) for seed in seeds] for n in names})
    print(make_table(answers, peers))


def describe_answer(answer: Answer) -> str:
    """Describe an answer in a few lines."""
    head = f"{answer.fault} --seed {answer.seed}: {answer.verdict.value.upper()} ({answer.story})"
    if answer.verdict in (Verdict.HARMLESS, Verdict.SILENT):
        return f"{head}: nothing said at {answer.deviation:.1f} sigmas"
    return "\n    ".join([head, *answer.said])


if __name__ == "__main__":
    main()
