"""The body of `beamdyn study --spread`: ranges of an answer over tolerances of inputs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from beamdyn.cli.program import deliver

if TYPE_CHECKING:
    from beamdyn.common.edge.html_report import Question
    from beamdyn.common.edge.inputs import Input
    from beamdyn.common.edge.outputs import Outputs
    from beamdyn.common.edge.spread_options import SpreadOptions
    from beamdyn.scene.scene import Scene


def answer_spread(
    scene: Scene,
    inputs: list[Input],
    spreading: SpreadOptions,
    outputs: Outputs,
    question: Question,
    how: Mapping[str, Any],
) -> None:
    """Find a spread, write the files asked for and print it.

    Parameters
    ----------
    scene : Scene
        The scene.
    inputs : list of Input
        Inputs that may have a spread.
    spreading, outputs, question
        Options of the command, and what the report repeats.
    how : mapping
        Further arguments of `beamdyn.spread`.
    """
    from beamdyn import spread
    from beamdyn.common.edge.program import NoAnswer
    from beamdyn.common.edge.progress import at_work
    from beamdyn.common.edge.spread_options import in_units_of, parse_spreads
    from beamdyn.common.edge.spread_tables import spread_csv, spread_table
    from beamdyn.common.edge.wording import of_file
    from beamdyn.common.spreading.pictures import spread_figure
    from beamdyn.scene.numbers import unit_of
    from beamdyn.spreads.spread import nominal_value

    with at_work("designs") as progress, of_file({"spread": "--spread", "samples": "--samples"}):
        given = parse_spreads(
            inputs,
            spreading.spread,
            lambda entry: (nominal_value(scene, entry.path, how["speed"] or 0.0), unit_of(entry.path) or ""),
        )
        with in_units_of(given):
            result = spread(
                scene,
                {each.name: each.distribution for each in given},
                samples=spreading.samples,
                seed=spreading.seed,
                progress=progress,
                **how,
            )
    rows = spread_csv(result)
    deliver(
        result,
        outputs,
        question,
        [spread_table(result)],
        rows,
        lambda: spread_figure(result),
        result.warnings,
    )
    if (result.scatter.no_answer == 1).all():
        raise NoAnswer(f"none of {result.designs} random designs has an answer")
