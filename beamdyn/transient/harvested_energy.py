"""Energy harvested by piezoelectric layers during a transient, with voltage, current, power and strain."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, kind
from beamdyn.common.numerics import gauss_points_on, gauss_weights_on
from beamdyn.common.plots.curves import plot_load_over_time
from beamdyn.common.results.one_line import error_at_most, number
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.equations.circuit import Voltage
from beamdyn.equations.harvested import electric_rows, strain_rows
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.scene import Scene
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.transient import Transient

_POINTS = 4  # number of Gauss points between two samples of a run; each time step has several samples


@dataclass(frozen=True)
class TransientHarvest(JudgedByRepeating):
    """Electrical output of a harvester during a transient: voltage, current, power, energy; and strain.

    `left_out` contains the estimated relative change of the harvested energy by each neglected physical
    effect, `model_error` the magnitude of the sum of these changes; both are computed at first use.

    Parameters
    ----------
    t : ndarray, shape (T,)
        Times of the run [s].
    voltage, current, power : ndarray, shape (T,)
        Voltage across the load [V], current through it [A], power into it [W].
    energy : ndarray, shape (T,)
        Energy harvested since the beginning [J].
    strain : ndarray, shape (T,)
        Largest bending strain (magnitude) along the piezoelectric layers.
    provenance : Provenance
        How the run was computed.

    Examples
    --------
    >>> run = bd.simulate(bd.load_scene("examples/bimorph.toml"), t_end=0.2, modes=2)
    >>> found = bd.transient_harvest(run)
    >>> bool((np.diff(found.energy) >= 0).all())
    True
    """

    t: np.ndarray
    voltage: np.ndarray
    current: np.ndarray
    power: np.ndarray
    energy: np.ndarray
    strain: np.ndarray
    provenance: Provenance
    run: Transient = field(repr=False)

    judged_value = "the harvested energy"
    follows_stiffness = False

    @property
    def scene(self) -> Scene:
        """Scene of the transient."""
        return self.run.scene

    @property
    def mean_power(self) -> float:
        """Mean power [W]: harvested energy over the duration."""
        return float(self.energy[-1] / (self.t[-1] - self.t[0]))

    @cached_property
    def energy_error(self) -> float:
        """Estimated error of the harvested energy [J] by neglected modes, from a run with more modes."""
        if self.run.refined is None:
            return float("inf")
        return 2 * abs(float(transient_harvest(self.run.refined).energy[-1] - self.energy[-1]))

    def headline(self) -> Iterator[str]:
        """Yield duration, energy, largest voltage and strain for a one-line summary.

        See `Result.headline`.
        """
        yield f"{number(self.run.path.end, 's')}: {number(self.energy[-1], 'J')}"
        yield f"up to {number(np.abs(self.voltage).max(), 'V')}"
        yield f"strain to {number(self.strain.max(), '')}"
        yield f"time {error_at_most(self.run.time_error / (self.run.largest or 1.0))}"

    def judged(self, found: TransientHarvest) -> np.ndarray:
        """Return the harvested energy of `found`, shape (): the value whose model error is stated."""
        return np.array(found.energy[-1])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the voltage across the load over time."""
        return plot_load_over_time(self.t, self.voltage[:, None], ["voltage"], "voltage [V]", ax)


@repeatable
def transient_harvest(run: Transient) -> TransientHarvest:
    """Compute voltage, power, energy and strain of a harvester during a transient.

    Parameters
    ----------
    run : Transient
        Result of `simulate` for a beam with the piezoelectric layers of a `Harvester`.

    Returns
    -------
    TransientHarvest

    Raises
    ------
    ValueError
        If the beam carries no piezoelectric layers, or the run has large deflection.

    References
    ----------
    Circuit: docs/harvester.md.

    Examples
    --------
    >>> run = bd.simulate(bd.load_scene("examples/bimorph.toml"), t_end=0.2, modes=2)
    >>> bd.transient_harvest(run).mean_power > 0
    True
    """
    kind("run", run, Transient, "simulate makes one")
    beam, system = run.scene.beam, run.system
    if beam.electrodes is None or not isinstance(system, ModalSystem):
        bound = "the beam carries no piezoelectric layers, or has large deflection"
        raise InvalidValue("run", run, bound, "Harvester.on puts layers on a beam")
    rows = electric_rows(system.equations, run.request.model.equations, beam)
    voltage, current = (_at(row, run, run.t) for row in rows)
    samples = np.union1d(run.t, run.path.samples[0])
    places = gauss_points_on(samples, _POINTS)
    between = gauss_weights_on(samples, _POINTS).reshape(places.shape)
    v, i = (_at(row, run, places.ravel()).reshape(places.shape) for row in rows)
    energy = np.append(0.0, np.cumsum((between * v * i).sum(axis=1)))
    q, _ = run.path.at(run.t)
    return TransientHarvest(
        t=run.t,
        voltage=voltage,
        current=current,
        power=voltage * current,
        energy=energy[np.searchsorted(samples, run.t)],
        strain=np.abs(q @ strain_rows(system.equations, beam).T).max(axis=1),
        provenance=run.provenance,
        run=run,
    )


def _at(row: Voltage, run: Transient, t: np.ndarray) -> np.ndarray:
    """Evaluate a quantity of the circuit, such as its voltage, with the coefficients `row` at times t [s]."""
    return run.path.at(t)[row.order] @ row.row
