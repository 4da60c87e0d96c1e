"""A field is added by its own module and the list alone: no analysis, integrator or result knows its name."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.equations import assembly
from beamdyn.equations.discretization import CLAMPED, Spaces
from beamdyn.equations.fields import FIELDS
from beamdyn.equations.fields.field import Field, FieldEquations, Load, Term
from beamdyn.scene.scene import Scene
from benchmarks.cases.scenes import HARVESTER, ROLLING


class Sway(Field):
    """Bending in a second direction, four times as stiff, without tension: at 2 omega_i at any speed."""

    name = "sway"
    explanations = {}  # noqa: RUF012

    def is_modelled(self, scene: Scene) -> bool:
        return True

    def complete(self, scene: Scene) -> Scene:
        return scene

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        beam, space = scene.beam, spaces.functions(CLAMPED)
        M = space.gram(beam.mass_per_length, 0) * beam.length
        K = 4 * space.gram(beam.bending_stiffness, 2) / beam.length**3
        load = space.load(beam.mass_per_length) * beam.length
        terms = Term("mass", "sway", "sway", 2, M), Term("stiffness", "sway", "sway", 0, K)
        return FieldEquations(space, terms, (Load("load", "sway", load, "root_transverse", 0.5),))


PLAIN = bd.natural_modes(HARVESTER, 50.0, 3).frequency
AT_REST = bd.natural_modes(HARVESTER, 0.0, 1).frequency[0]
RUN = bd.simulate(ROLLING, 2.0, modes=3)
STEADY = bd.steady_response(ROLLING, [55.0], modes=3).amplitude


@pytest.fixture(autouse=True, params=[(*FIELDS, Sway()), (Sway(), *FIELDS)], ids=["last", "first"])
def fields(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(assembly, "FIELDS", request.param)
    yield


@pytest.mark.parametrize("discretization", ["ritz", "fem"])
def test_its_modes_stand_among_the_others(discretization: str) -> None:
    modes = bd.natural_modes(HARVESTER, 50.0, 3, discretization)
    expected = [PLAIN[0], 2 * AT_REST, PLAIN[1]]
    np.testing.assert_allclose(modes.frequency, expected, rtol=1e-6)  # finite elements: 3e-7
    tip = np.abs(modes.shape([HARVESTER.beam.length])[:, 0])
    assert tip.argmin() == 1 and tip[1] < 1e-6 * tip[0]  # it does not deflect the beam in its plane


def test_it_leaves_the_motion_of_the_beam_alone() -> None:
    run, t = bd.simulate(ROLLING, 2.0, modes=3), np.linspace(0, 2, 300)
    bound = run.time_error + RUN.time_error
    assert np.abs(run.deflection(t) - RUN.deflection(t)).max() <= bound <= 2e-5 * RUN.largest
    assert (np.abs(run.coordinates).max(axis=0) > 0).all() and run.coordinates.shape[1] == 6  # it moves


def test_batches_and_harmonic_balance_carry_it() -> None:
    peaks = bd.sweep(ROLLING, [55.0], window=(1.0, 2.0), modes=3).peaks
    np.testing.assert_allclose(peaks, RUN.peak(1.0, 2.0), rtol=2e-5)  # the tolerance of each is 1e-5
    np.testing.assert_allclose(bd.steady_response(ROLLING, [55.0], modes=3).amplitude, STEADY, rtol=1e-9)
    assert bd.critical_speed(HARVESTER) == pytest.approx(159.818332659, rel=1e-9)
