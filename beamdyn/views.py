"""How the results of this package are shown: tables, columns and pictures by the name of their class."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.console import Group

from beamdyn.common.edge.input_sweep import sweep_csv as sweep_of_inputs_csv
from beamdyn.common.edge.spread_tables import spread_csv, spread_table
from beamdyn.common.edge.views import View
from beamdyn.common.spreading.pictures import spread_figure
from beamdyn.decks.deck_tables import audit_tables, deck_tables
from beamdyn.tables.campbell import campbell_csv, campbell_tables
from beamdyn.tables.equilibria import branches_csv, branches_table, equilibrium_csv, equilibrium_table
from beamdyn.tables.linear_models import (
    matrices_csv,
    matrices_table,
    random_csv,
    random_table,
    response_csv,
    response_table,
)
from beamdyn.tables.loads import (
    cycles_table,
    loads_csv,
    random_loads_csv,
    random_loads_table,
    static_loads_table,
    steady_loads_table,
    transient_loads_table,
)
from beamdyn.tables.results import (
    critical_answer,
    crossings_table,
    limits_table,
    locus_table,
    modes_table,
    steady_table,
    sweep_table,
    transient_table,
)
from beamdyn.tables.rotor import rotor_csv, rotor_table
from beamdyn.tables.rows import crossings_csv, locus_csv, modes_csv, steady_csv, sweep_csv, transient_csv
from beamdyn.tables.sensitivities import sensitivities_csv, sensitivities_table
from beamdyn.tables.single_answers import (
    backbone_csv,
    backbone_table,
    bounds_csv,
    bounds_table,
    critical_csv,
    cycles_csv,
    limits_csv,
    terms_csv,
    terms_table,
)
from beamdyn.tables.studies import study_csv, study_table
from beamdyn.tables.tradeoffs import diagram_csv, diagram_table, tradeoff_csv, tradeoff_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from beamdyn.tradeoffs import Tradeoff


def _tradeoff_tables(result: Tradeoff) -> Group:
    return Group(*map(diagram_table, result.diagrams))


def _campbell_tables(result: Any) -> Group:
    return Group(*campbell_tables(result))


def _sweep_figure(result: Any) -> Figure:
    from beamdyn.common.curves import sweep_figure  # here, because matplotlib is slow to import

    return sweep_figure(result)


def _campbell_figure(result: Any) -> Figure:
    from matplotlib.figure import Figure  # here, because it is slow to import

    figure = Figure(figsize=(8.5, 6.0), layout="constrained")
    result.plot(figure.subplots())
    return figure


VIEWS = {
    "Backbone": View(backbone_table, backbone_csv, 2),
    "Campbell": View(_campbell_tables, campbell_csv, 1, _campbell_figure),
    "CriticalPoint": View(critical_answer, critical_csv),
    "Crossings": View(crossings_table, crossings_csv, 1),
    "Deck": View(lambda result: Group(*deck_tables(result))),
    "DeckAudit": View(lambda result: Group(*audit_tables(result))),
    "Diagram": View(diagram_table, diagram_csv),
    "Equilibrium": View(equilibrium_table, equilibrium_csv, 1),
    "EquilibriumBranches": View(branches_table, branches_csv, 2),
    "FrequencyBounds": View(bounds_table, bounds_csv, 1),
    "FrequencyResponse": View(response_table, response_csv, 1),
    "InputSweep": View(None, sweep_of_inputs_csv, 0, _sweep_figure),
    "LoadCycles": View(cycles_table, cycles_csv),
    "Locus": View(locus_table, locus_csv, 1),
    "Matrices": View(matrices_table, matrices_csv, 3),
    "Modes": View(modes_table, modes_csv, 1),
    "RandomLoads": View(random_loads_table, random_loads_csv, 2),
    "RandomResponse": View(random_table, random_csv, 1),
    "RotorDrawing": View(rotor_table, rotor_csv, 0, lambda result: result.figure()),
    "Sensitivities": View(sensitivities_table, sensitivities_csv, 1),
    "SettingAngleLimits": View(limits_table, limits_csv, 1),
    "Spread": View(spread_table, spread_csv, 0, spread_figure),
    "StaticLoads": View(static_loads_table, loads_csv, 3),
    "SteadyLoads": View(steady_loads_table, loads_csv, 3),
    "SteadyResponse": View(steady_table, steady_csv, 1),
    "Study": View(study_table, study_csv),
    "Sweep": View(sweep_table, sweep_csv, 1),
    "Terms": View(terms_table, terms_csv, 1),
    "Tradeoff": View(_tradeoff_tables, tradeoff_csv, 3, tradeoff_figure),
    "Transient": View(transient_table, transient_csv, 1),
    "TransientLoads": View(transient_loads_table, loads_csv, 3),
}
