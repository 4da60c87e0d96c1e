"""Work-precision diagrams: error against computing time, measured on a scene.

`measurements` has the results, their Pareto front and the cost per digit; `timing` measures settings within a
budget; `frequencies`, `physics`, `transients` and `steady` list the settings to choose from; `study` combines
them.
"""

from beamdyn.studies.tradeoffs.frequencies import frequency_diagram, physics_diagram
from beamdyn.studies.tradeoffs.measurements import Diagram, Digit, Measurement, cost_per_digit, pareto_front
from beamdyn.studies.tradeoffs.responses import (
    harmonics_diagram,
    integrators_diagram,
    steady_modes_diagram,
    transient_modes_diagram,
)
from beamdyn.studies.tradeoffs.study import Tradeoff, tradeoff

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
    "physics_diagram",
    "steady_modes_diagram",
    "tradeoff",
    "transient_modes_diagram",
]
