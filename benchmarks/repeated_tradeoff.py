"""Is the advice of a trade-off the same from run to run?  Run: python -m benchmarks.repeated_tradeoff

Takes two minutes.  The advice on a digit is the same in two runs if it names the same setting, or if either
run names the other's as a tie.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from itertools import combinations

import beamdyn as bd
from beamdyn.studies.tradeoffs.measurements import Digit
from benchmarks.cases.scenes import HARVESTER, ROLLING
from benchmarks.rows import Row, show

RUNS, BUDGET = 5, 10.0


def agree(one: Digit, other: Digit) -> bool:
    """Return whether two runs give the same advice on a digit, or name each other's setting as a tie."""
    return one.advice == other.advice or other.advice in one.ties or one.advice in other.ties


def compare(runs: int = RUNS) -> Iterator[Row]:
    """Count, diagram by diagram, the digits on which all runs agree."""
    for scene, speed in ((HARVESTER, 55.0), (ROLLING, None)):
        found = [bd.tradeoff(scene, speed, budget=BUDGET) for _ in range(runs)]
        for each in zip(*(run.diagrams for run in found), strict=True):
            digits = list(zip(*(diagram.per_digit for diagram in each), strict=False))
            same = sum(len({digit.advice for digit in of_runs}) == 1 for of_runs in digits)
            agreed = sum(all(agree(*pair) for pair in combinations(of_runs, 2)) for of_runs in digits)
            title = f"{each[0].title}: digits with the same advice in {runs} runs, or a tie"
            yield title, f"{same} + {agreed - same} of {len(digits)}", str(len(digits))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=RUNS)
    show("trade-offs again", lambda: compare(parser.parse_args().runs))


if __name__ == "__main__":
    main()
