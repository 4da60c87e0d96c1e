"""The analyses of a scene, each described once: its command, help and report follow, and its screen."""

from beamdyn.analyses import (  # noqa: F401  (they enter themselves)
    equilibria,
    frequencies,
    linear_models,
    loads,
    scenes,
    sensitivities,
    steady_state,
    studies,
    transients,
)
from beamdyn.analyses.analysis import ANALYSES as ANALYSES
