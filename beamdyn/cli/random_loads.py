"""The command on loads along the span under a random input."""

from __future__ import annotations

from beamdyn.cli.cycles import LoadQuantity
from beamdyn.cli.excitations import NO_RANDOM_INPUT, RandomInput
from beamdyn.cli.loads import EVERYWHERE, SpanPlaces, check_drawn
from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import (
    BasisSize,
    Discretization,
    PhysicsOption,
    SceneFile,
    Text,
    load_with,
    parse_positive,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes
from beamdyn.common.edge.program import examples


@app.command(
    help_epilogue=examples(
        'beamdyn random-loads examples/rough_road.toml --road C --at "0, 10 mm"',
    )
)
def random_loads(
    scene: SceneFile,
    /,
    *,
    random_input: RandomInput = NO_RANDOM_INPUT,
    duration: Text = "1 h",
    places: SpanPlaces = EVERYWHERE,
    quantity: LoadQuantity | None = None,
    modes: BasisSize = "auto",
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Largest strains, stresses, moments and forces along the span that a random input makes expected.

    Parameters
    ----------
    scene
        The scene, damped; with a rolling wheel for a road.
    random_input
        The input and the speed.
    duration
        Duration within which the largest are expected, with its unit.
    places
        Stations, and points of the section.
    quantity
        What --plot and --report draw along the span; default: strain.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-4 of the largest along the span.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import random_loads
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.loads import random_loads_csv, random_loads_table

    outputs.check(scene, random_input.psd)
    check_drawn(quantity, outputs)
    drive, spectrum = random_input.drive, random_input.density
    loaded = load_with(scene, physics, random_input.speed)
    question = Question.on_file(
        "beamdyn random-loads", scene, **random_input.options, duration=duration, **places.options,
        modes=modes, discretization=discretization, physics=physics,
    )  # fmt: skip
    speed, lasting = random_input.speed_of(loaded), parse_positive("--duration", duration, "s")
    with places.named():
        result = random_loads(
            loaded, speed, spectrum, drive, lasting,
            **places.where, modes=modes, discretization=discretization,
        )  # fmt: skip
    draw = on_axes(lambda ax: result.plot(ax, quantity or "strain"))
    tables, rows = [random_loads_table(result)], random_loads_csv(result)
    deliver(result, outputs, question, tables, rows, draw, result.warnings)
