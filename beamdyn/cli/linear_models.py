"""Commands on linear models at one speed: matrices, response over frequency, random response."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

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

if TYPE_CHECKING:
    import numpy as np

    from beamdyn.linear_models.excitations import Excitation
    from beamdyn.linear_models.observations import Observation
    from beamdyn.linear_models.spectra import PowerSpectrum
    from beamdyn.scene.scene import Scene

RoadClass = Literal["A", "B", "C", "D", "E", "F", "G", "H"]
_AT = re.compile(r"(force|deflection|acceleration)@(.+?)( across)?")
_RANGE = re.compile(r"([^:]+):([^:]+):(\d{1,6})\s*(\S+)")
_MOST_FREQUENCIES = 100_000


@app.command
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
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.linear_models import matrices_csv, matrices_table

    outputs.check(scene)
    if outputs.plot is not None:
        raise ValueError("--plot: matrices have no picture; give --json or --csv")
    loaded = load_with(scene, physics)
    options = {"speed": speed, "modes": modes, "discretization": discretization, "physics": physics}
    question = Question.on_file("beamdyn matrices", scene, **options)
    result = matrices(loaded, speed_or_final(loaded, speed), modes, discretization)
    deliver(result, outputs, question, [matrices_table(result)], matrices_csv(result))


@app.command
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
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.linear_models import response_csv, response_table

    outputs.check(scene)
    given = parse_frequencies(frequencies)
    drive, seen = parse_input(input), parse_output(output)
    loaded = load_with(scene, physics)
    question = Question.on_file(
        "beamdyn response", scene, frequencies=frequencies, speed=speed, input=input, output=output,
        modes=modes, discretization=discretization, physics=physics,
    )  # fmt: skip
    at = speed_or_final(loaded, speed)
    result = frequency_response(loaded, at, given, drive, seen, modes, discretization=discretization)
    tables, rows, draw = [response_table(result)], response_csv(result), on_axes(result.plot)
    deliver(result, outputs, question, tables, rows, draw, result.warnings)


@app.command
def random(
    scene: SceneFile,
    /,
    *,
    psd: Path | None = None,
    road: RoadClass | None = None,
    roughness: Text | None = None,
    highest: Text | None = None,
    speed: Text | None = None,
    velocity: Annotated[Text | None, Parameter(help='Of a rolling wheel, e.g. "90 km/h".')] = None,
    input: Text | None = None,
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
    psd
        One-sided density of the input: a CSV file with the columns f [Hz] and psd [m2/s4/Hz], or [N2/Hz].
    road
        Class of a random road by ISO 8608, from A, very good, to H.
    roughness
        The same by its density at 0.1 1/m, e.g. "64e-6 m3".
    highest
        Spatial frequency at which the road ends; default: 2.83 1/m, that of the standard.
    speed
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's motion.
    velocity
        Velocity of the rolling wheel in place of its speed.
    input
        As for the command response; default: bending, of a road n2.
    output
        As for the command response.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-9 of the root mean square.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn import RoadRoughness, random_response
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.linear_models import random_csv, random_table

    outputs.check(scene, psd)
    if sum(given is not None for given in (psd, road, roughness)) != 1:
        raise ValueError("--psd, --road, --roughness: give one of the three")
    if highest is not None and psd is not None:
        raise ValueError(f'--highest = "{highest}": it is that of a road; leave it out with --psd')
    drive, seen = None if input is None else parse_input(input), parse_output(output)
    if psd is not None:
        spectrum = read_spectrum(psd, "N2/Hz" if drive is not None and drive.unit == "N" else "m2/s4/Hz")
    else:
        limit = {} if highest is None else {"highest": parse_positive("--highest", highest, "1/m")}
        spectrum = RoadRoughness(road or parse_positive("--roughness", roughness or "", "m3"), **limit)
    loaded = load_with(scene, physics)
    question = Question.on_file(
        "beamdyn random", scene, psd=psd, road=road, roughness=roughness, highest=highest, speed=speed,
        velocity=velocity, input=input, output=output, modes=modes, discretization=discretization,
        physics=physics,
    )  # fmt: skip
    at = speed_or_final(loaded, speed) if velocity is None else _rolling_speed(loaded, speed, velocity)
    result = random_response(loaded, at, spectrum, drive, seen, modes=modes, discretization=discretization)
    tables, rows, draw = [random_table(result)], random_csv(result), on_axes(result.plot)
    deliver(result, outputs, question, tables, rows, draw, result.warnings)


# Values of options --------------------------------------------------------------------------------


def parse_frequencies(text: str) -> np.ndarray:
    """Frequencies [Hz] of ``--frequencies``, at equal ratios or a list.

    Raises
    ------
    ValueError
        If there are none, a range does not rise from above 0, or the unit is none of frequency.
    """
    import numpy as np

    match = _RANGE.fullmatch(text.strip())
    if match:
        low, high = (
            parse_positive("--frequencies", f"{end.strip()} {match[4]}", "Hz") for end in match.group(1, 2)
        )
        if not (low < high and 2 <= int(match[3]) <= _MOST_FREQUENCIES):
            bound = f"start must be below stop, the count from 2 to {_MOST_FREQUENCIES}"
            raise ValueError(f'--frequencies = "{text}": {bound}')
        return np.geomspace(low, high, int(match[3]))
    numbers, _, unit = text.strip().rpartition(" ")
    parts = [part.strip() for part in numbers.split(",")]
    if not numbers or not all(parts) or ":" in text:
        raise ValueError(f'--frequencies = "{text}": give e.g. "1:1000:400 Hz" or "50, 60 Hz"')
    return np.array([parse_quantity("--frequencies", f"{part} {unit}", "Hz") for part in parts])


def parse_input(text: str) -> Excitation:
    """The excitation of ``--input``: a word, or a force at a position with its unit."""
    from beamdyn.linear_models.excitations import PointForce, as_excitation

    match = _AT.fullmatch(text.strip())
    if match is None or match[1] != "force":
        return as_excitation("--input", text.strip())
    return PointForce(_position("--input", match[2]), "across" if match[3] else "bending")


def parse_output(text: str) -> Observation:
    """The observation of ``--output``: a word, or a deflection or an acceleration at a position."""
    from beamdyn.linear_models.observations import AccelerationAt, DeflectionAt, as_observation

    match = _AT.fullmatch(text.strip())
    if match is None or match[1] == "force":
        return as_observation("--output", text.strip())
    made = AccelerationAt if match[1] == "acceleration" else DeflectionAt
    return made(_position("--output", match[2]), "across" if match[3] else "bending")


def _position(option: str, text: str) -> float | None:
    """A position on the beam [m]; None for the word "tip"."""
    return None if text.strip() == "tip" else parse_positive(option, text.strip(), "m")


def read_spectrum(path: Path, unit: str) -> PowerSpectrum:
    """Read a density from a CSV file with the columns f [Hz] and psd, in a unit such as m2/s4/Hz.

    Raises
    ------
    ConfigError
        If a head lacks its unit, a column is missing or a cell is no number: with the line.
    InvalidValue
        If the frequencies do not ascend, or a density is not above 0.
    """
    from beamdyn.common.edge.csv_columns import read_csv
    from beamdyn.common.edge.data_text import read_data
    from beamdyn.common.edge.inputs import Quantity
    from beamdyn.linear_models.spectra import PowerSpectrum

    text = read_data(path)
    known = {"f": Quantity("Hz", meaning="frequency"), "psd": Quantity(unit, meaning="density")}
    table = read_csv(text, known, {"f": "f", "frequency": "f", "psd": "psd"})
    columns = table.named()
    if len(columns) != 2:
        raise text.refusal(table.head_line, f"expected the columns f [Hz] and psd [{unit}]")
    return PowerSpectrum(columns["f"].values, columns["psd"].values)


def _rolling_speed(scene: Scene, speed: str | None, velocity: str) -> float:
    """Speed [rad/s] of a wheel that rolls at a velocity."""
    from beamdyn.scene.motion import RollingWheel

    if speed is not None:
        raise ValueError("--speed, --velocity: give one of the two")
    if not isinstance(scene.motion, RollingWheel):
        raise ValueError(
            '--velocity: the scene has no rolling wheel; give --speed, or motion.kind = "rolling"'
        )
    return parse_positive("--velocity", velocity, "m/s") / scene.motion.rolling_radius
