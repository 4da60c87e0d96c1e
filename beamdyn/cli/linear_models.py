"""Commands on linear models at one speed: matrices, response over frequency, random response."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from beamdyn.cli.excitations import NO_RANDOM_INPUT, RandomInput, parse_input, parse_output
from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import (
    BasisSize,
    Discretization,
    ModeCount,
    PhysicsOption,
    SceneFile,
    Text,
    load_with,
    parse_positive,
    parse_quantity,
    speed_or_final,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes
from beamdyn.common.edge.program import examples

if TYPE_CHECKING:
    import numpy as np

_UNIT = re.compile(r"[A-Za-z][A-Za-z/ ]*$")
_MOST_FREQUENCIES = 100_000


@app.command(
    help_epilogue=examples(
        "beamdyn matrices examples/rolling_harvester.toml --modes 2 --json m.json",
    )
)
def matrices(
    scene: SceneFile,
    /,
    *,
    speed: Text | None = None,
    modes: ModeCount | None = None,
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Matrices of the equations of motion at a steady speed, with what each coordinate means.

    Parameters
    ----------
    scene
        The scene.
    speed
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's motion.
    modes
        Number of modes as coordinates; default: all functions of the discretization.
    discretization
        ritz: assumed modes; fem: finite elements.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import matrices
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.linear_models import matrices_csv, matrices_table

    outputs.check(scene)
    if outputs.plot is not None:
        raise ValueError("--plot: matrices have no picture; give --json or --csv")
    loaded = load_with(scene, physics, speed)
    options = {"speed": speed, "modes": modes, "discretization": discretization, "physics": physics}
    question = Question.on_file("beamdyn matrices", scene, **options)
    result = matrices(loaded, speed_or_final(loaded, speed), modes, discretization)
    deliver(
        result, outputs, question, [matrices_table(result)], matrices_csv(result), None, warnings_of(result)
    )


@app.command(
    help_epilogue=examples(
        'beamdyn response examples/rough_road.toml --frequencies "1:100:50 Hz"',
    )
)
def response(
    scene: SceneFile,
    /,
    *,
    frequencies: Text,
    speed: Text | None = None,
    input: Text = "bending",
    output: Text = "tip",
    modes: BasisSize = "auto",
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Response over the frequency of an excitation, at a steady speed.

    Parameters
    ----------
    scene
        The scene.
    frequencies
        Frequencies with their unit: start:stop:count at equal ratios, e.g. "1:1000:400 Hz", or a list,
        e.g. "50, 60 Hz".
    speed
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's motion.
    input
        bending, across, n1, n2, n3: acceleration of the base; force@20 mm, force@tip, with " across" at the
        end for that direction.
    output
        tip, tip across, tip acceleration, root moment, root strain; deflection@20 mm, acceleration@20 mm.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-9 of the largest response.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import frequency_response
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.linear_models import response_csv, response_table

    outputs.check(scene)
    given = parse_frequencies(frequencies)
    drive, seen = parse_input(input), parse_output(output)
    loaded = load_with(scene, physics, speed)
    question = Question.on_file(
        "beamdyn response", scene, frequencies=frequencies, speed=speed, input=input, output=output,
        modes=modes, discretization=discretization, physics=physics,
    )  # fmt: skip
    at = speed_or_final(loaded, speed)
    result = frequency_response(loaded, at, given, drive, seen, modes, discretization=discretization)
    tables, rows, draw = [response_table(result)], response_csv(result), on_axes(result.plot)
    deliver(result, outputs, question, tables, rows, draw, warnings_of(result))


@app.command(
    help_epilogue=examples(
        'beamdyn random examples/rough_road.toml --road C --velocity "90 km/h"',
    )
)
def random(
    scene: SceneFile,
    /,
    *,
    random_input: RandomInput = NO_RANDOM_INPUT,
    output: Text = "tip",
    modes: BasisSize = "auto",
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Response to a random input at a steady speed: density over frequency, root mean square.

    Parameters
    ----------
    scene
        The scene, damped; with a rolling wheel for a road.
    random_input
        The input and the speed.
    output
        tip, tip across, tip acceleration, root moment, root strain; deflection@20 mm, acceleration@20 mm.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-9 of the root mean square.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import random_response
    from beamdyn.cautions import warnings_of
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.linear_models import random_csv, random_table

    outputs.check(scene, random_input.psd)
    seen = parse_output(output)
    drive, spectrum = random_input.drive, random_input.density
    loaded = load_with(scene, physics, random_input.speed)
    question = Question.on_file(
        "beamdyn random", scene, **random_input.options, output=output, modes=modes,
        discretization=discretization, physics=physics,
    )  # fmt: skip
    at = random_input.speed_of(loaded)
    result = random_response(loaded, at, spectrum, drive, seen, modes=modes, discretization=discretization)
    tables, rows, draw = [random_table(result)], random_csv(result), on_axes(result.plot)
    deliver(result, outputs, question, tables, rows, draw, warnings_of(result))


# Values of options --------------------------------------------------------------------------------


def parse_frequencies(text: str) -> np.ndarray:
    """Frequencies [Hz] of ``--frequencies``, at equal ratios or a list.

    Raises
    ------
    ValueError
        If there are none, a range does not rise from above 0, or the unit is none of frequency.
    """
    import numpy as np

    words, unit = f'--frequencies = "{text}"', _UNIT.search(text.strip())
    if unit is None:
        example = text.strip() if re.search(r"\d$", text.strip()) else "1:1000:400"
        raise ValueError(f'{words}: give a unit of frequency at its end, e.g. "{example} Hz"')
    numbers = text.strip()[: unit.start()]
    ends, several = numbers.split(":"), [part.strip() for part in numbers.split(",")]
    if len(ends) == 3 and ends[2].strip().isdecimal():
        low, high = (parse_positive("--frequencies", f"{end} {unit.group()}", "Hz") for end in ends[:2])
        if not (low < high and 2 <= int(ends[2]) <= _MOST_FREQUENCIES):
            raise ValueError(f"{words}: start must be below stop, the count from 2 to {_MOST_FREQUENCIES}")
        return np.geomspace(low, high, int(ends[2]))
    if len(ends) > 1 or not all(several):
        raise ValueError(f'{words}: give start:stop:count or a list, e.g. "1:1000:400 Hz" or "50, 60 Hz"')
    return np.array([parse_quantity("--frequencies", f"{part} {unit.group()}", "Hz") for part in several])
