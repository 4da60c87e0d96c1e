"""Linear models at one speed: matrices, response over frequency, random response."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses.analysis import AsText, analysis
from beamdyn.analyses.excitations import NO_RANDOM_INPUT, RandomInput, parse_input, parse_output
from beamdyn.analyses.options import AtFinalSpeed, Count, CountOrAuto, Discretization, Named
from beamdyn.analyses.values import parse_positive, parse_quantity
from beamdyn.common.edge.outputs import NO_FILES, Outputs

if TYPE_CHECKING:
    import numpy as np

    from beamdyn.linear.frequency_response import FrequencyResponse
    from beamdyn.linear.matrices import Matrices
    from beamdyn.linear.random_response import RandomResponse
    from beamdyn.scene.scene import Scene

_UNIT = re.compile(r"[A-Za-z][A-Za-z/ ]*$")
_MOST_FREQUENCIES = 100_000
Frequencies = Annotated[Any, AsText(lambda _, text, __: parse_frequencies(text))]
Input = Annotated[Any, AsText(lambda _, text, __: parse_input(text), default="bending")]
Output = Annotated[
    Any,
    AsText(lambda _, text, __: parse_output(text), default="tip"),
    Parameter(
        help="tip, tip across, tip acceleration, root moment, root strain; deflection@20 mm, "
        "acceleration@20 mm.",
    ),
]


@analysis("beamdyn matrices examples/rolling_harvester.toml --modes 2 --json m.json")
def matrices(
    scene: Scene,
    *,
    speed: AtFinalSpeed,
    modes: Count | None = None,
    discretization: Named = "ritz",
    outputs: Outputs = NO_FILES,
) -> Matrices:
    """Matrices of the equations of motion at a steady speed, with what each coordinate means.

    Parameters
    ----------
    modes
        Number of modes as coordinates; default: all functions of the discretization.
    discretization
        ritz: assumed modes; fem: finite elements.
    """
    if outputs.plot is not None:
        raise ValueError("--plot: matrices have no picture; give --json or --csv")
    return bd.matrices(scene, speed, modes, discretization)


@analysis('beamdyn response examples/rough_road.toml --frequencies "1:100:50 Hz"')
def response(
    scene: Scene,
    *,
    frequencies: Frequencies,
    speed: AtFinalSpeed,
    input: Input,
    output: Output,
    modes: CountOrAuto = "auto",
    discretization: Discretization = "ritz",
) -> FrequencyResponse:
    """Response over the frequency of an excitation, at a steady speed.

    Parameters
    ----------
    frequencies
        Frequencies with their unit: start:stop:count at equal ratios, e.g. "1:1000:400 Hz", or a
        list, e.g. "50, 60 Hz".
    input
        bending, across, n1, n2, n3: acceleration of the base; force@20 mm, force@tip, with "
        across" at the end for that direction.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-9 of the largest response.
    """
    return bd.frequency_response(
        scene, speed, frequencies, input, output, modes, discretization=discretization
    )


@analysis(
    'beamdyn random examples/rough_road.toml --road C --velocity "90 km/h"',
    about_scene="The scene, damped; with a rolling wheel for a road.",
)
def random(
    scene: Scene,
    *,
    random_input: RandomInput = NO_RANDOM_INPUT,
    output: Output,
    modes: CountOrAuto = "auto",
    discretization: Discretization = "ritz",
) -> RandomResponse:
    """Response to a random input at a steady speed: density over frequency, root mean square.

    Parameters
    ----------
    modes
        Number of modes; auto: the fewest that keep the error below 1e-9 of the root mean square.
    """
    asked = random_input
    shown, speed = asked.shown(scene), asked.speed_of(scene)
    return bd.random_response(
        shown, speed, asked.density, asked.drive, output, modes=modes, discretization=discretization
    )


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
