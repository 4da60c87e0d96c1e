"""How the results of this package are shown: tables, columns and pictures by the name of their class.

Those of the mechanics are shown by their fields.
"""

from __future__ import annotations

from rich.console import Group

from beamdyn.common.edge.input_sweep import sweep_csv
from beamdyn.common.edge.views import View
from beamdyn.common.plots.curves import sweep_figure
from brakes.answers.base import Answer, BrakeSweep
from brakes.answers.planar import MechanismFriction
from brakes.answers.tables import sweep_table


def _answer_tables(answer: Answer) -> Group:
    return Group(*answer.tables())


VIEWS = {
    Answer.__name__: View(_answer_tables, lambda answer: answer.rows(), 0, lambda answer: answer.figure()),
    MechanismFriction.__name__: View(MechanismFriction.table),
    BrakeSweep.__name__: View(sweep_table, sweep_csv, 0, sweep_figure),
}
