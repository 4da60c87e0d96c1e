"""The command ``beamdyn``.  What is heavy is imported by the commands that need it."""

from beamdyn.cli import (  # noqa: F401  (they add their commands to the app)
    campbell_diagram,
    decks,
    equilibria,
    frequencies,
    interactive,
    linear_models,
    loads,
    published,
    random_loads,
    rotor,
    sensitivities,
    steady_state,
    studies,
    tradeoff,
    transients,
)
from beamdyn.cli.program import app, main
from beamdyn.cli.values import parse_speeds
from beamdyn.common.edge.completion import add_completion
from beamdyn.common.edge.program import BAD_INPUT, DONE, INTERRUPTED, NO_ANSWER

__all__ = ["BAD_INPUT", "DONE", "INTERRUPTED", "NO_ANSWER", "app", "main", "parse_speeds"]

add_completion(app)
