"""The pattern of brakes' answers: what a command, a screen and a report take from it holds for every type."""

import tomllib

import numpy as np
import pytest

from brakes.answers import STANDARD
from brakes.answers.base import BrakeType
from brakes.answers.caliper import CALIPER, MECHANISM
from brakes.answers.forklift import FORKLIFT, TYPES
from brakes.app.bases import base

MODULES = {name: load() for name, (_, load) in STANDARD.items()}
BRAKES: list[BrakeType] = [*MODULES.values(), FORKLIFT, *TYPES.values(), CALIPER, MECHANISM]
by_type = pytest.mark.parametrize("brake", BRAKES, ids=lambda brake: brake.title)


def example(brake):
    tables = tomllib.loads(base(brake.name))
    return tables, brake.read(tables, brake.name)


def test_standard_brakes_are_named_as_their_modules():
    assert {name: brake.name for name, brake in MODULES.items()} == {name: name for name in STANDARD}


@by_type
def test_outputs_have_names_of_their_own_and_are_numbers(brake):
    _, design = example(brake)
    answer, outputs = brake.solve(design), brake.outputs(design)
    assert len({output.name for output in outputs}) == len(outputs)
    assert all(np.shape(output.shown(answer)) == () for output in outputs)
    assert not answer.refusals


@by_type
def test_results_of_a_sweep_by_default_are_outputs(brake):
    _, design = example(brake)
    names = {output.name for output in brake.outputs(design)}
    assert set(brake.default_results(design).split(",")) <= names


@by_type
def test_a_sweep_has_a_value_for_each_case(brake):
    """All cases at once or one by one: a value for each case, over the input named."""
    tables, design = example(brake)
    (axis,) = (i for i in brake.sweep_inputs(design, tables) if i.path == brake.example_sweep.split("=")[0])
    made, _ = brake.sweep(tables, brake.name, [brake.example_sweep])
    assert made.inputs == (axis.path,)
    assert all(values.shape == made.values[0].shape for values in made.found)
    assert np.isfinite(made.found[0]).all()


def test_a_sweep_says_where_there_is_no_answer():
    brake = MODULES["drum"]
    made, warnings = brake.sweep(example(brake)[0], "drum", ["brake.friction=0.2:1.2:3"], "torque")
    assert made.warnings == tuple(warnings) and "locked in 1 of 3 cases" in made.warnings[0]
