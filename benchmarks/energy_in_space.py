"""Energy of a beam in space over many periods of large motion, at rest and at constant speed.

Run: python -m benchmarks.energy_in_space [--periods 10].  A twisted and swept beam with torsion, at an
oblique angle, starts far from its equilibrium, undamped; the energy of the rotating frame is constant.  Its
largest change is over the kinetic energy at the largest of its samples.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from time import process_time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes.modal.modal_basis import ModalBasis
from beamdyn.modes.modal.model import Model
from beamdyn.transient.beam_in_space_system import BeamInSpaceSystem
from beamdyn.transient.elastica_steps import propagate_elastica
from benchmarks.rows import Row, show

_MODES, _STAGES, _ON_PERIOD, _BOUND = 3, 8, 24, 1e-9
_START = np.array([1.0, 1.0, 0.5])  # rates of the modes
BEAM = bd.Beam.from_stiffness(
    1.0,
    1.0,
    1.0,
    second_bending_stiffness=4.0,
    twist=Polynomial([0.0, 0.5]),
    sweep=Polynomial([0.0, 0.4]),
    rotary_inertia=0.002,
    second_rotary_inertia=0.004,
    torsion_stiffness=0.7,
)


def measure(periods: int) -> Iterator[Row]:
    """The largest change of the energy, at rest and turning, and how far the tip moves."""
    for speed in (0.0, 2.0):
        motion = bd.SteadyRotation(speed)
        physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
        scene = bd.Scene(BEAM, bd.Mount(0.5, 2.0, 0.4), motion, physics=physics)
        system = BeamInSpaceSystem.of_model(Model(scene, bd.Ritz(6)), ModalBasis(_MODES), motion)
        period = 1 / float(bd.natural_modes(scene, speed, 1, bd.Ritz(6)).frequency[0])
        start, steps = process_time(), _ON_PERIOD * periods
        end = periods * period
        run = propagate_elastica(system, 0.0, end, steps, np.zeros(_MODES), _START, stages=_STAGES)
        q, v = np.split(run.state[:, 1:], 2, axis=1)
        energy = system.energy(np.linspace(0.0, end, len(q)), q, v)
        scale = np.abs(energy - system.energy(np.zeros(len(q)), q, 0 * v)).max()
        what = f"{speed:g} rad/s, {periods} periods: largest change of the energy"
        yield what, f"{np.abs(energy - energy[0]).max() / scale:.1e}", f"{_BOUND:g}"
        yield "... largest deflection over the length", f"{np.abs(system.deflections(q)).max():.2f}", ""
        yield "... processor time", f"{process_time() - start:.0f} s", ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--periods", type=int, default=10)
    periods = parser.parse_args().periods
    show("energy of beams in space", lambda: measure(periods))


if __name__ == "__main__":
    main()
