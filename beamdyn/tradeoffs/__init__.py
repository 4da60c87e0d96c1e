"""Error against time: what each digit costs, measured on a scene.

`measurements` has what is measured and what follows from it; `timing` runs cases within a budget;
`frequencies`, `transients` and `steady` know what there is to choose; `study` puts it together.
"""

from beamdyn.tradeoffs.frequencies import frequency_diagram
from beamdyn.tradeoffs.measurements import Diagram, Digit, Measurement, cost_per_digit, pareto_front
from beamdyn.tradeoffs.steady import harmonics_diagram, steady_modes_diagram
from beamdyn.tradeoffs.study import Tradeoff, tradeoff
from beamdyn.tradeoffs.transients import integrators_diagram, transient_modes_diagram

__all__ = [
    "Diagram",
    "Digit",
    "Measurement",
    "Tradeoff",
    "cost_per_digit",
    "frequency_diagram",
    "harmonics_diagram",
    "integrators_diagram",
    "pareto_front",
    "steady_modes_diagram",
    "tradeoff",
    "transient_modes_diagram",
]
