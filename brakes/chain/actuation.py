"""Actuation of brakes: from the force on the pedal to the force on the brakes' actuators, and back.

Force and stroke rise with the pedal's force, each by a formula that can be inverted. A given force on the
actuators also fixes the stroke of the pedal's rod, so that the pedal's force falls as 1 / ratio while its
travel rises in proportion to the ratio. So each inverse question has one answer or none.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, not_negative, together
from beamdyn.common.inputs.checks import InvalidValue, kind, refuse
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned, warned
from beamdyn.common.results.result import Result
from brakes.chain.lines import BrakeCable, HydraulicLine
from brakes.chain.pedal import Pedal
from brakes.common.limits import EDGE, passes, verdict
from brakes.vehicle.backwards import Needed, needed

Line = HydraulicLine | BrakeCable


@dataclass(frozen=True)
class Actuation(Result):
    """Forces and travel from pedal to actuators; arrays have one entry per case.

    Attributes
    ----------
    pedal, line : Pedal, HydraulicLine or BrakeCable
        The pedal, and the line or cable that it acts on.
    pedal_force : ndarray
        Force on the pedal [N].
    output_force : ndarray
        Force behind pedal and booster [N].
    pressure : ndarray
        Pressure of the line [Pa]; nan for a cable.
    actuator_force : ndarray
        Force on each actuator of a brake [N].
    pedal_travel : ndarray
        Travel of the pedal [m].

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> found = chain.actuate(chain.Pedal(ratio=5.0, force=450.0), line)
    >>> round(float(found.actuator_force), 1)  # N
    4593.9
    """

    pedal: Pedal
    line: Line
    pedal_force: Annotated[Numbers, Meaning("N", "force on pedal or lever")]
    output_force: Annotated[Numbers, Meaning("N", "force behind pedal or lever and booster")]
    pressure: Annotated[Numbers, Meaning("Pa", "pressure of the line", "MPa")]
    actuator_force: Annotated[Numbers, Meaning("N", "force on each actuator")]
    pedal_travel: Annotated[Numbers, Meaning("m", "travel of pedal or lever, by line or cable", "mm")]

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{spanned(self.pedal_force, 'N')} on the pedal"
        yield f"{spanned(self.actuator_force, 'N')} on each actuator"
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentence on a pedal force above the limit of the standards; empty if it is allowed."""
        return (f"the {self.verdict}",) if passes(self.pedal.operated_by, self.pedal_force) else ()

    @property
    def verdict(self) -> str:
        """One sentence that compares the pedal's force with the limit of the standards."""
        return verdict(self.pedal.operated_by, self.pedal_force)


def actuate(pedal: Pedal, line: Line) -> Actuation:
    """Compute forces and travel from the pedal to the actuators at the pedal's force.

    Parameters
    ----------
    pedal : Pedal
        The pedal and the force on it.
    line : HydraulicLine or BrakeCable
        Transmission of the force to the actuators.

    Returns
    -------
    Actuation
        Complete result, arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If the pedal would travel further than it can, or the pressure exceeds the largest that
        the cylinders bear.

    References
    ----------
    Standard formulas of a lever and of the volume of a fluid, in `Pedal` and `HydraulicLine`. Limits of the
    force: ISO 6292:2020.

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> found = chain.actuate(chain.Pedal(ratio=5.0, force=450.0, booster=3.0), line)
    >>> round(float(found.pressure) / 1e6, 3)  # MPa
    17.407
    """
    _check(pedal, line)
    output = pedal.output_force
    travel = pedal.ratio * line.stroke(output)
    if isinstance(line, HydraulicLine) and line.most_pressure is not None:
        over = np.asarray(output) > line.limit * (1 + EDGE)
        bound, remedy = "the pedal's force gives {limit}", "less force, or a larger master cylinder"
        refuse(over, "most_pressure", line.most_pressure, "Pa", bound, remedy, limit=line.pressure(output))
    if pedal.travel is not None:
        late = np.asarray(travel) > pedal.travel * (1 + EDGE)
        bound, remedy = "it needs a travel of {limit}", "less lost travel, or a smaller ratio"
        refuse(late, "travel", pedal.travel, "m", bound, remedy, limit=travel)
    force = pedal.force + 0.0 * output
    return Actuation(pedal, line, force, output, line.pressure(output), line.gain * output, travel)


def force_for(pedal: Pedal, line: Line, actuator_force: Numbers) -> Needed:
    """Find the force on the pedal [N] that gives a wanted force on the actuators.

    Parameters
    ----------
    pedal : Pedal
        The pedal; its own force is not used.
    line : HydraulicLine or BrakeCable
        Transmission of the force to the actuators.
    actuator_force : float or ndarray
        Wanted force on each actuator [N].

    Returns
    -------
    Needed
        The force; none if the line's pressure or the pedal's travel reaches its limit first.

    Raises
    ------
    ValueError
        If the force is negative, or the shapes do not broadcast.

    References
    ----------
    Standard formulas of a lever and of the volume of a fluid, as in `actuate`, solved in closed form.

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> round(float(chain.force_for(chain.Pedal(ratio=5.0, force=1.0), line, 11650.0).value), 2)  # N
    1141.19
    """
    output = _output_for(pedal, line, actuator_force)
    travel = pedal.ratio * line.stroke(output)
    return needed(pedal.rod_force_for(output) / pedal.ratio, *_ends(pedal, line, output, travel))


def ratio_for(pedal: Pedal, line: Line, actuator_force: Numbers) -> Needed:
    """Find the pedal ratio that gives a wanted force on the actuators at the pedal's force.

    Parameters
    ----------
    pedal : Pedal
        The pedal; its own ratio is not used.
    line : HydraulicLine or BrakeCable
        Transmission of the force to the actuators.
    actuator_force : float or ndarray
        Wanted force on each actuator [N].

    Returns
    -------
    Needed
        The ratio; none if the pedal's travel, which rises with the ratio, reaches its limit first.

    Raises
    ------
    ValueError
        If the force is negative, or the shapes do not broadcast.

    References
    ----------
    Standard formulas of a lever and of the volume of a fluid, as in `actuate`, solved in closed form.

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175, lost_travel=0.02)
    >>> pedal = chain.Pedal(ratio=1.0, force=450.0, travel=0.15)
    >>> chain.ratio_for(pedal, line, 11650.0).message
    'none: the pedal reaches the end of its travel first; a higher ratio or force needs more travel'
    """
    output = _output_for(pedal, line, actuator_force)
    ratio = pedal.rod_force_for(output) / pedal.force
    return needed(ratio, *_ends(pedal, line, output, ratio * line.stroke(output)))


def _check(pedal: Pedal, line: Line) -> None:
    kind("pedal", pedal, Pedal)
    if not isinstance(line, HydraulicLine | BrakeCable):
        raise InvalidValue("line", line, "give a HydraulicLine or a BrakeCable")
    together(pedal=pedal.output_force, line=line.gain + line.stroke(1.0))


def _output_for(pedal: Pedal, line: Line, actuator_force: Numbers) -> Numbers:
    """Compute the force behind the booster [N] that gives a wanted force on the actuators."""
    _check(pedal, line)
    wanted = not_negative("actuator_force", actuator_force, "N")
    together(actuator_force=wanted, pedal=pedal.output_force * line.gain)
    return wanted / line.gain


def _ends(pedal: Pedal, line: Line, output: Numbers, travel: Numbers) -> tuple[tuple[Numbers, str], ...]:
    """Find the cases without a solution (pressure or travel at the limit), and the reasons."""
    over = output > line.limit * (1 + EDGE)
    far = travel > (np.inf if pedal.travel is None else pedal.travel * (1 + EDGE))
    return (
        (over, "the pressure, which rises with the force, would exceed the largest that the cylinders bear"),
        (far, "the pedal reaches the end of its travel first; a higher ratio or force needs more travel"),
    )
