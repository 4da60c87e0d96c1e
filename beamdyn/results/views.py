"""How the results of this package are shown: tables, columns and pictures by the name of their class."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any

from rich.console import Group

from beamdyn.common.edge.views import View

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from beamdyn.studies.tradeoffs import Tradeoff


def _late(place: str) -> Callable[[Any], Any]:
    """A function of this package, whose module is imported when it is called: a command shows one result."""
    module, _, name = place.rpartition(".")
    return lambda result: getattr(import_module(f"beamdyn.{module}"), name)(result)


def _all_of(tables: Callable[[Any], Any]) -> Callable[[Any], Group]:
    """What shows several tables one below the other."""
    return lambda result: Group(*tables(result))


def _tradeoff_tables(result: Tradeoff) -> Group:
    return Group(*map(_late("results.tables.tradeoffs.diagram_table"), result.diagrams))


def _campbell_figure(result: Any) -> Figure:
    from matplotlib.figure import Figure  # here, because it is slow to import

    figure = Figure(figsize=(8.5, 6.0), layout="constrained")
    result.plot(figure.subplots())
    return figure


VIEWS = {
    "Backbone": View(
        _late("results.tables.single_answers.backbone_table"),
        _late("results.tables.single_answers.backbone_csv"),
        2,
    ),
    "Campbell": View(
        _all_of(_late("results.tables.campbell.campbell_tables")),
        _late("results.tables.campbell.campbell_csv"),
        1,
        _campbell_figure,
    ),
    "CriticalPoint": View(
        _late("results.tables.results.critical_answer"), _late("results.tables.single_answers.critical_csv")
    ),
    "Crossings": View(
        _late("results.tables.results.crossings_table"), _late("results.tables.rows.crossings_csv"), 1
    ),
    "Deck": View(_all_of(_late("files.decks.deck_tables.deck_tables"))),
    "DeckAudit": View(_all_of(_late("files.decks.deck_tables.audit_tables"))),
    "Diagram": View(
        _late("results.tables.tradeoffs.diagram_table"), _late("results.tables.tradeoffs.diagram_csv")
    ),
    "Equilibrium": View(
        _late("results.tables.equilibria.equilibrium_table"),
        _late("results.tables.equilibria.equilibrium_csv"),
        1,
    ),
    "EquilibriumBranches": View(
        _late("results.tables.equilibria.branches_table"), _late("results.tables.equilibria.branches_csv"), 2
    ),
    "FrequencyBounds": View(
        _late("results.tables.single_answers.bounds_table"),
        _late("results.tables.single_answers.bounds_csv"),
        1,
    ),
    "FrequencyResponse": View(
        _late("results.tables.linear_models.response_table"),
        _late("results.tables.linear_models.response_csv"),
        1,
    ),
    "InputSweep": View(
        None, _late("common.edge.input_sweep.sweep_csv"), 0, _late("common.plots.curves.sweep_figure")
    ),
    "LoadCycles": View(
        _late("results.tables.loads.cycles_table"), _late("results.tables.single_answers.cycles_csv")
    ),
    "Locus": View(_late("results.tables.results.locus_table"), _late("results.tables.rows.locus_csv"), 1),
    "Matrices": View(
        _late("results.tables.linear_models.matrices_table"),
        _late("results.tables.linear_models.matrices_csv"),
        3,
    ),
    "Modes": View(_late("results.tables.results.modes_table"), _late("results.tables.rows.modes_csv"), 1),
    "RandomLoads": View(
        _late("results.tables.loads.random_loads_table"), _late("results.tables.loads.random_loads_csv"), 2
    ),
    "RandomResponse": View(
        _late("results.tables.linear_models.random_table"),
        _late("results.tables.linear_models.random_csv"),
        1,
    ),
    "RotorDrawing": View(
        _late("results.tables.rotor.rotor_table"),
        _late("results.tables.rotor.rotor_csv"),
        0,
        lambda result: result.figure(),
    ),
    "Sensitivities": View(
        _late("results.tables.sensitivities.sensitivities_table"),
        _late("results.tables.sensitivities.sensitivities_csv"),
        1,
    ),
    "SettingAngleLimits": View(
        _late("results.tables.results.limits_table"), _late("results.tables.single_answers.limits_csv"), 1
    ),
    "Spread": View(
        _late("common.edge.spread_tables.spread_table"),
        _late("common.edge.spread_tables.spread_csv"),
        0,
        _late("common.spreading.result.spread_figure"),
    ),
    "StaticLoads": View(
        _late("results.tables.loads.static_loads_table"), _late("results.tables.loads.loads_csv"), 3
    ),
    "SteadyLoads": View(
        _late("results.tables.loads.steady_loads_table"), _late("results.tables.loads.loads_csv"), 3
    ),
    "SteadyResponse": View(
        _late("results.tables.results.steady_table"), _late("results.tables.rows.steady_csv"), 1
    ),
    "Study": View(_late("results.tables.studies.study_table"), _late("results.tables.studies.study_csv")),
    "Sweep": View(_late("results.tables.results.sweep_table"), _late("results.tables.rows.sweep_csv"), 1),
    "Terms": View(
        _late("results.tables.single_answers.terms_table"),
        _late("results.tables.single_answers.terms_csv"),
        1,
    ),
    "Tradeoff": View(
        _tradeoff_tables,
        _late("results.tables.tradeoffs.tradeoff_csv"),
        3,
        _late("results.tables.tradeoffs.tradeoff_figure"),
    ),
    "Transient": View(
        _late("results.tables.results.transient_table"), _late("results.tables.rows.transient_csv"), 1
    ),
    "TransientLoads": View(
        _late("results.tables.loads.transient_loads_table"), _late("results.tables.loads.loads_csv"), 3
    ),
}
