"""Effects that are off cost nothing: the same sizes, as many factorizations, the same bits."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import scipy.linalg
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes import buckling, setting_angles
from beamdyn.modes.modal import eigenproblem, large_parts
from benchmarks.cases.scenes import ROLLING

STIFFNESS = bd.Table((0, 0.4, 1), (2e-3, 1.5e-3, 1e-3))
OTHERS: dict[str, Any] = {
    "second_bending_stiffness": bd.Table((0, 0.7, 1), (3.0, 2.0, 1.0)),
    "twist": Polynomial([0.1, 0.4]),
    "shear_stiffness": bd.Table((0, 0.2, 1), (2e5, 1e5, 1e5)),
    "rotary_inertia": 1e-10,
    "second_rotary_inertia": 1e-7,
}
PLAIN = bd.Beam.from_stiffness(0.05, 0.0157, STIFFNESS, outer_fibre=1e-4)
FULL = bd.Beam.from_stiffness(0.05, 0.0157, STIFFNESS, outer_fibre=1e-4, **OTHERS)
SPEEDS = np.linspace(1.0, 60.0, 7)

ANALYSES: dict[str, Callable[[bd.Scene], list[np.ndarray | float]]] = {
    "modes": lambda s: [(m := bd.natural_modes(s, 50.0)).frequency, m.error, m.tip],
    "finite elements": lambda s: [(m := bd.natural_modes(s, 50.0, discretization="fem")).frequency, m.error],
    "locus": lambda s: [(m := bd.frequency_locus(s, SPEEDS)).frequency, m.error, m.confidence],
    "critical speed": lambda s: [(c := bd.critical_point(s)).speed, c.error],
    "limits": lambda s: [*bd.setting_angle_limits(s, 400.0)],
    "bounds": lambda s: [(b := bd.frequency_bounds(s, 50.0)).lower, b.upper],
    "transient": lambda s: [(r := bd.simulate(s, 1.0)).tip, r.time_error, r.mode_error, r.root_strain(r.t)],
    "sweep": lambda s: [bd.sweep(s, [10.0, 20.0], window=(0.5, 1.0), modes=3).peaks],
    "resonances": lambda s: [np.array([c.speed for c in bd.resonance_speeds(s, 60.0)])],
    "steady": lambda s: [(r := bd.steady_response(s, SPEEDS)).amplitude, r.growth_rate, r.bound],
}
FACTORIZATIONS: dict[ModuleType, tuple[str, ...]] = {  # by the module in which the name is looked up
    np.linalg: ("cholesky", "eigh", "eigvalsh", "solve", "eig"),
    scipy.linalg: ("eigh", "eig", "cho_factor"),
    setting_angles: ("eigh",),
    buckling: ("eigh",),
    large_parts: ("cho_factor", "solve_lower", "solve_lower_transposed"),
    eigenproblem: ("solve_lower", "solve_lower_transposed"),
}


def run(analysis: str, beam: bd.Beam) -> tuple[list[np.ndarray | float], Counter[tuple[str, object]]]:
    """Results, and how often matrices of each size were factorized."""
    counted: Counter[tuple[str, object]] = Counter()
    with pytest.MonkeyPatch.context() as patch:
        for module, names in FACTORIZATIONS.items():
            for name in names:
                original = getattr(module, name)
                patch.setattr(module, name, counting(f"{module.__name__}.{name}", original, counted))
        return ANALYSES[analysis](replace(ROLLING, beam=beam)), counted


def counting(name: str, original: Callable, counted: Counter) -> Callable:
    def call(a: np.ndarray, *rest: object, **options: object) -> object:
        counted[name, np.shape(a)] += 1
        return original(a, *rest, **options)

    return call


@pytest.mark.parametrize("analysis", ANALYSES)
def test_properties_of_effects_that_are_off_change_nothing(analysis: str) -> None:
    run(analysis, PLAIN)  # function spaces and quadrature rules are kept from then on
    (plain, few), (full, many) = (run(analysis, beam) for beam in (PLAIN, FULL))
    assert few == many and sum(few.values()) > 0
    for a, b in zip(plain, full, strict=True):
        np.testing.assert_array_equal(a, b)


def test_an_effect_that_is_on_is_seen() -> None:
    for physics in (bd.Physics(planes=2), bd.Physics(shear=True), bd.Physics(rotary_inertia=True)):
        mounted = replace(ROLLING, beam=FULL)
        modes = [
            bd.natural_modes(replace(mounted, physics=p), 50.0).frequency for p in (bd.Physics(), physics)
        ]
        assert (modes[0] != modes[1]).any()
