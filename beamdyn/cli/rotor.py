"""The command that draws a scene."""

from __future__ import annotations

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import SceneFile
from beamdyn.common.edge.outputs import NO_FILES, Outputs
from beamdyn.common.edge.program import examples


@app.command(help_epilogue=examples("beamdyn draw examples/tyre_harvester.toml --plot rotor.svg"))
def draw(scene: SceneFile, /, *, outputs: Outputs = NO_FILES) -> None:
    """Draw the rotor: axis of rotation, radius, and the beam at its angles, undeformed.

    Parameters
    ----------
    scene
        The scene.
    outputs
        Output files.
    """
    from beamdyn import draw, load_scene
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.rotor import rotor_csv, rotor_table

    outputs.check(scene)
    result = draw(load_scene(scene))
    question = Question.on_file("beamdyn draw", scene)
    deliver(
        result, outputs, question, [rotor_table(result)], rotor_csv(result), result.figure, result.warnings
    )
