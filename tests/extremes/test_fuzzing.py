"""Mutated files and wrong calls are answered, or refused in a sentence; the check of it sees what fails."""

import tomllib
import warnings
from random import Random

import numpy as np
import pytest

import beamdyn as bd
from benchmarks import fuzzing
from benchmarks.cases.mutations import MUTATIONS, mutate
from benchmarks.cases.wrong_calls import right_calls


@pytest.mark.parametrize("cases", [range(30), pytest.param(range(100), marks=pytest.mark.slow)], ids=len)
@pytest.mark.parametrize("kind", fuzzing.CHECKS)
def test_cases_are_answered_or_refused_in_a_sentence(kind, cases):
    outcomes = fuzzing.check_all(fuzzing.CHECKS[kind], cases)
    assert [outcome for outcome in outcomes if outcome.failed] == []
    assert {outcome.verdict for outcome in outcomes} == {"answered", "refused"}


def test_right_calls_are_right():
    for call in right_calls():
        call.function(**call.arguments)


@pytest.mark.parametrize("name", MUTATIONS)
def test_every_mutation_changes_an_example(name):
    text = (fuzzing.ROOT / "examples/patched.toml").read_text()
    changed = [MUTATIONS[name](text, Random(seed)) for seed in range(10)]
    assert any(other != text for other in changed)


def test_many_mutated_files_are_still_toml_and_the_same_each_time():
    text, still = (fuzzing.ROOT / "examples/rolling_harvester.toml").read_text(), 0
    for seed in range(100):
        changed = mutate(text, Random(seed))
        assert changed == mutate(text, Random(seed))
        try:
            still += tomllib.loads(changed[0]) != tomllib.loads(text)
        except ValueError:
            continue
    assert still > 50


# The check itself ---------------------------------------------------------------------------------------


def foreign(*_):
    np.linalg.cholesky(-np.eye(2))


def careless(*_):
    np.log(np.zeros(1))
    return "answered", ""


def endless(*_):
    while True:
        pass


def warn_as(place):
    """A function in a file of that name which warns."""
    text = "import warnings\ndef run():\n    warnings.warn('look')\n    return 'answered', ''"
    names = {}
    exec(compile(text, str(fuzzing.ROOT / place), "exec"), names)
    return names["run"]


@pytest.mark.parametrize(
    ("run", "verdict"),
    [
        (lambda: ("answered", ""), "answered"),
        (lambda: bd.Mount(radius="x"), "refused"),
        (lambda: None + 1, "foreign message"),
        (lambda: {}["key"], "traceback"),
        (lambda: 1 / 0, "foreign message"),
        (foreign, "foreign message"),
        (careless, "warning"),
        (endless, "too long"),
        (warn_as("beamdyn/scene/beam.py"), "answered"),
        (warn_as("matplotlib/axes.py"), "warning"),
        (lambda: fuzzing._run(lambda _: 3, []), "exit code 3"),
        (lambda: fuzzing._run(lambda _: 2, []), "exit code 2"),
        (lambda: fuzzing._run(lambda _: warnings.warn("x", stacklevel=1) or 0, []), "warning"),
    ],
)
def test_what_fails_is_seen(run, verdict):
    outcome = fuzzing.watch("case", run, limit=0.2)
    assert outcome.verdict == verdict
    assert outcome.failed == (verdict not in ("answered", "refused"))
