"""Commands on equilibria: how far rotation bends the beam, and where its equilibrium turns back."""

from __future__ import annotations

from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import Discretization, SceneFile, Text, load_with, parse_positive, speed_or_final
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes
from beamdyn.common.edge.program import examples


@app.command(
    help_epilogue=examples(
        'beamdyn equilibrium examples/rolling_harvester.toml --speed "50 rad/s"',
    )
)
def equilibrium(
    scene: SceneFile,
    /,
    *,
    speed: Text | None = None,
    branch: Text | None = None,
    discretization: Discretization = "ritz",
    outputs: Outputs = NO_FILES,
) -> None:
    """Where the rotation bends the beam to, by any angle, and whether it stays there.

    Parameters
    ----------
    scene
        The scene; large deflection is modelled in any case.
    speed
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's motion,
        or 0 without one.
    branch
        straight: the equilibrium that follows from rest as the speed rises; bent: the stable one beside it,
        at high speed. Default: that of the scene's physics.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    outputs
        Output files.
    """
    from beamdyn import equilibrium
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.equilibria import equilibrium_csv, equilibrium_table

    outputs.check(scene)
    loaded = load_with(scene, None, speed)
    given = {"speed": speed, "branch": branch, "discretization": discretization}
    question = Question.on_file("beamdyn equilibrium", scene, **given)
    result = equilibrium(loaded, speed_or_final(loaded, speed), branch, discretization)
    tables, rows = [equilibrium_table(result)], equilibrium_csv(result)
    deliver(result, outputs, question, tables, rows, on_axes(result.plot), result.warnings)


@app.command(
    help_epilogue=examples(
        'beamdyn branches examples/rolling_harvester.toml --top-speed "250 rad/s"',
    )
)
def branches(
    scene: SceneFile,
    /,
    *,
    top_speed: Text,
    discretization: Discretization = "ritz",
    outputs: Outputs = NO_FILES,
) -> None:
    """Branches of equilibria over speed: where the beam buckles, and where an equilibrium turns back.

    Parameters
    ----------
    scene
        The scene; large deflection is modelled in any case.
    top_speed
        Speed up to which the branches are followed, with its unit, e.g. "250 rad/s".
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    outputs
        Output files.
    """
    from beamdyn import equilibrium_branches
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.equilibria import branches_csv, branches_table

    outputs.check(scene)
    top = parse_positive("--top-speed", top_speed, "rad/s")
    given = {"top_speed": top_speed, "discretization": discretization}
    question = Question.on_file("beamdyn branches", scene, **given)
    result = equilibrium_branches(load_with(scene, None, top_speed), top, discretization)
    tables, rows = [branches_table(result)], branches_csv(result)
    deliver(result, outputs, question, tables, rows, on_axes(result.plot), result.warnings)
