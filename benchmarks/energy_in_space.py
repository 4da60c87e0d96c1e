"""Energy of a beam in space over many periods of large motion, at rest and at constant speed.

Run: python -m benchmarks.energy_in_space [--periods 10].  A twisted and swept beam with torsion, at an
oblique angle, starts fast, undamped; the energy of the rotating frame is constant.  Its largest change is
over the energy at the start.
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

_MODES, _STAGES, _ON_PERIOD, _BOUND = 3, 12, 10, 1e-9
_BLOCK = 50  # periods that are kept at a time
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


def system_at(speed: float) -> tuple[BeamInSpaceSystem, float]:
    """The equations of the beam at a speed [rad/s], and the period of its first mode [s]."""
    motion = bd.SteadyRotation(speed)
    physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
    scene = bd.Scene(BEAM, bd.Mount(0.5, 2.0, 0.4), motion, physics=physics)
    system = BeamInSpaceSystem.of_model(Model(scene, bd.Ritz(6)), ModalBasis(_MODES), motion)
    return system, 1 / float(bd.natural_modes(scene, speed, 1, bd.Ritz(6)).frequency[0])


def follow(system: BeamInSpaceSystem, period: float, periods: int) -> Iterator[tuple[np.ndarray, float]]:
    """Energies over the scale, and the largest deflection, of blocks of some periods, one after another."""
    q, v, none = np.zeros(_MODES), _START, np.zeros((1, _MODES))
    scale = float(system.energy(np.zeros(1), none, _START[None])[0])
    for done in range(0, periods, _BLOCK):
        some = min(_BLOCK, periods - done)
        run = propagate_elastica(system, 0.0, some * period, _ON_PERIOD * some, q, v, stages=_STAGES)
        q, v = np.split(run.state[:, 1:], 2, axis=1)
        yield system.energy(np.zeros(len(q)), q, v) / scale, float(np.abs(system.deflections(q)).max())
        q, v = q[-1], v[-1]


def measure(periods: int) -> Iterator[Row]:
    """The largest change of the energy, at rest and turning, and how far the tip moves."""
    for speed in (0.0, 2.0):
        start = process_time()
        energies, deflections = zip(*follow(*system_at(speed), periods), strict=True)
        what = f"{speed:g} rad/s, {periods} periods: largest change of the energy"
        yield what, f"{np.abs(np.concatenate(energies) - 1).max():.1e}", f"{_BOUND:g}"
        yield "... largest deflection over the length", f"{max(deflections):.2f}", ""
        yield "... processor time", f"{process_time() - start:.0f} s", ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--periods", type=int, default=10)
    periods = parser.parse_args().periods
    show("energy of beams in space", lambda: measure(periods))


if __name__ == "__main__":
    main()
