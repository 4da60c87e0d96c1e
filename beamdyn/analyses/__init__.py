"""Descriptions of the analyses of a scene; commands, help texts, reports and screens are made from them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from beamdyn.analyses.analysis import Analysis

# Modules of the commands, in the order of the manual: a command imports only the module with its analysis.
_COMMANDS = (
    ("about_modes", "equilibrium branches modes locus critical limits"),
    ("about_linear_models", "matrices response random"),
    ("about_loads", "loads random-loads"),
    ("about_scene", "draw terms tradeoff"),
    ("about_designs", "sensitivities"),
    ("about_motion", "resonances steady"),
    ("about_designs", "study"),
    ("about_motion", "simulate sweep harvest best-resistance"),
    ("about_stability", "floquet stability-chart stability-limits"),
    ("about_data", "compare identify design"),
)
COMMANDS = {name: module for module, names in _COMMANDS for name in names.split()}


def analyses(names: tuple[str, ...] = tuple(COMMANDS)) -> dict[str, Analysis]:
    """Import analyses by the names of their commands; all of them if no names are given."""
    each = {name: import_module(f"beamdyn.analyses.{COMMANDS[name]}") for name in names}
    return {name: vars(module)[name.replace("-", "_")] for name, module in each.items()}
