"""The command that measures error against time."""

from __future__ import annotations

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import ModeCount, SceneFile, Text, naming_option, parse_positive, parse_speed
from beamdyn.common.edge.outputs import NO_FILES, Outputs
from beamdyn.common.edge.program import examples


@app.command(
    help_epilogue=examples(
        'beamdyn tradeoff examples/tyre_harvester.toml --budget "10 s" --plot t.png',
    )
)
def tradeoff(
    scene: SceneFile,
    /,
    *,
    speed: Text | None = None,
    modes: ModeCount = 3,
    t_end: Text | None = None,
    budget: Text = "60 s",
    outputs: Outputs = NO_FILES,
) -> None:
    """Error against computing time of bases, elements, physics, integrators, numbers of modes and harmonics.

    Parameters
    ----------
    scene
        The scene; transients and the steady response are measured if it has a motion.
    speed
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's motion,
        or 0 without one.
    modes
        Number of modes, from the lowest; at most 20.
    t_end
        End of the transients with its unit, e.g. "2 s"; default: a hundred periods of the first mode after
        the spin-up, or from rest if the spin-up is long.
    budget
        Approximate computing time, e.g. "60 s"; measurements that do not fit are left out and listed.
    outputs
        Output files.
    """
    from beamdyn import load_scene
    from beamdyn.common.edge.html_report import Question
    from beamdyn.common.edge.progress import at_work
    from beamdyn.tables.tradeoffs import diagram_table, tradeoff_csv, tradeoff_figure
    from beamdyn.tradeoffs import tradeoff

    outputs.check(scene)
    end = None if t_end is None else parse_positive("--t-end", t_end, "s")
    limit = parse_positive("--budget", budget, "s")
    loaded = load_scene(scene)
    given = None if speed is None else parse_speed("--speed", speed, loaded)
    question = Question.on_file(
        "beamdyn tradeoff", scene, speed=speed, modes=modes, t_end=t_end, budget=budget
    )
    with at_work("measuring") as progress, naming_option("t_end", "--t-end", t_end or ""):
        result = tradeoff(loaded, given, modes, end, limit, progress)
    tables, rows, draw = (
        [diagram_table(diagram) for diagram in result.diagrams],
        tradeoff_csv(result),
        lambda: tradeoff_figure(result),
    )
    deliver(result, outputs, question, tables, rows, draw, result.warnings)
