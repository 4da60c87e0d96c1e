"""Tables, columns and plots that show the results of this package.

`VIEWS` has a view for each class of results that it names. A result of any other class is shown as a table of
its fields.
"""

from __future__ import annotations

import numpy as np
from rich.console import Group

from beamdyn.common.edge.console import table
from beamdyn.common.edge.input_sweep import sweep_csv
from beamdyn.common.edge.views import View
from beamdyn.common.plots.curves import sweep_figure
from beamdyn.common.results.columns import Column, Columns
from brakes.answers.base import Answer, BrakeSweep
from brakes.answers.planar import MechanismFriction
from brakes.answers.tables import sweep_table
from brakes.common.solutions import Solutions


def _answer_tables(answer: Answer) -> Group:
    return Group(*answer.tables())


def _solution_tables(found: Solutions) -> Group:
    """Tabulate the inputs that give a wanted result, and the ranges over which the result rises or falls.

    These ranges show that no other input gives the wanted result.
    """
    heads = [f"{name} [{unit}]" if unit else name for name, unit in found.named]
    columns = (f"{found.input} from", "to", found.output, "from", "to")
    ends = ([f"{p.start:.6g}", f"{p.end:.6g}", *p.shown_ends] for p in found.pieces)
    courses = ([a, b, p.course, c, d] for p, (a, b, c, d) in zip(found.pieces, ends, strict=True))
    gaps = ([f"{gap.start:.6g}", f"{gap.end:.6g}", "none", "-", "-"] for gap in found.gaps)
    title = f"{heads[1]} over {heads[0]}; number of samples: {len(found.samples)}"
    rows = sorted((*courses, *gaps), key=lambda row: float(row[0]))
    course = table(title, columns, rows, (2,), 2)
    return Group(found.message, course, *found.lacking) if found.there else Group(course)


def _solution_columns(found: Solutions) -> Columns:
    """Make columns with one row per solution: start and end of the input's interval, and the residual.

    Where a single value of the input is the solution, start and end are equal. The residual is the result
    minus the wanted value.
    """
    name = found.input.replace(".", "_")
    ends = np.concatenate([np.stack([found.values] * 2, axis=-1), found.ranges])
    return Columns(
        Column(name, ends[:, 0], found.unit),
        Column(f"{name}_to", ends[:, 1], found.unit),
        Column("residual", np.append(found.residuals, np.zeros(len(found.ranges))), found.output_unit),
    )


VIEWS = {
    Answer.__name__: View(_answer_tables, lambda answer: answer.rows(), 0, lambda answer: answer.figure()),
    MechanismFriction.__name__: View(MechanismFriction.table),
    Solutions.__name__: View(_solution_tables, _solution_columns),
    BrakeSweep.__name__: View(sweep_table, sweep_csv, 0, sweep_figure),
}
