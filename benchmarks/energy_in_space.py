"""Energy of a beam in space over many periods of large motion, at rest and at constant speed.

Run: python -m benchmarks.energy_in_space [--periods 10].  An undamped, twisted and swept beam with torsion,
at an oblique angle, starts with a high velocity; its energy in the rotating frame is constant.  The largest
change of energy is relative to the initial energy.  Two modes, whose mass matrix depends on the deflection,
suffice to show a drift.  10 000 periods take a quarter of an hour of processor time per speed (--speed
measures one speed).
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from time import process_time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes.modal.model import ModalBasis, Model
from beamdyn.transient.beam_in_space_system import BeamInSpaceSystem
from beamdyn.transient.elastica_steps import propagate_elastica
from benchmarks.rows import Row, show

_MODES, _STAGES, _ON_PERIOD, _BOUND = 2, 10, 8, 1e-9
_BLOCK = 50  # number of periods kept in memory at a time
_START = np.array([0.8, 0.8])  # initial velocities of the modes
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
    """Return the equations of the beam at a speed [rad/s], and the period of its first mode [s]."""
    motion = bd.SteadyRotation(speed)
    physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
    scene = bd.Scene(BEAM, bd.Mount(0.5, 2.0, 0.4), motion, physics=physics)
    system = BeamInSpaceSystem.of_model(Model(scene, bd.Ritz(6)), ModalBasis(_MODES), motion)
    return system, 1 / float(bd.natural_modes(scene, speed, 1, bd.Ritz(6)).frequency[0])


def follow(system: BeamInSpaceSystem, period: float, periods: int) -> Iterator[tuple[np.ndarray, float]]:
    """Yield relative energies, and the largest deflection, for successive blocks of periods."""
    q, v, none = np.zeros(_MODES), _START, np.zeros((1, _MODES))
    scale = float(system.energy(np.zeros(1), none, _START[None])[0])
    for done in range(0, periods, _BLOCK):
        some = min(_BLOCK, periods - done)
        run = propagate_elastica(system, 0.0, some * period, _ON_PERIOD * some, q, v, stages=_STAGES)
        q, v = np.split(run.state[:, 1:], 2, axis=1)
        yield system.energy(np.zeros(len(q)), q, v) / scale, float(np.abs(system.deflections(q)).max())
        q, v = q[-1], v[-1]


def measure(periods: int, speeds: Sequence[float]) -> Iterator[Row]:
    """Yield the largest change of energy at each speed [rad/s], and the largest tip deflection."""
    for speed in speeds:
        start = process_time()
        energies, deflections = zip(*follow(*system_at(speed), periods), strict=True)
        what = f"{speed:g} rad/s, {periods} periods: largest change of the energy"
        yield what, f"{np.abs(np.concatenate(energies) - 1).max():.1e}", f"{_BOUND:g}"
        yield "... largest deflection over the length", f"{max(deflections):.2f}", ""
        yield "... processor time", f"{process_time() - start:.0f} s", ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--periods", type=int, default=10)
    parser.add_argument("--speed", type=float, action="append", help="[rad/s]; 0 and 2 if not given")
    given = parser.parse_args()
    show("energy of beams in space", lambda: measure(given.periods, given.speed or (0.0, 2.0)))


if __name__ == "__main__":
    main()
