"""Linear models at one speed: matrices, frequency response, random response, and their excitations."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses.analysis import AsText, analysis
from beamdyn.analyses.options import AtFinalSpeed, Count, CountOrAuto, Discretization, Named, RoadClass, Text
from beamdyn.analyses.values import in_unit_of, parse_positive, parse_quantity, parse_speed
from beamdyn.common.edge.command_options import NO_FILES, Outputs
from beamdyn.common.edge.data_text import read_csv, read_data
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.linear import inputs_outputs
from beamdyn.scene.motion.rolling import RollingWheel

# Excitations -----------------------------------------------------------------------------------------


Axes = Literal["log", "linear"]
_AT = re.compile(r"(force|deflection|acceleration)@(.+?)( across)?")
_SQUARED = re.compile(r"\(([^()]*)\)\s*(?:\^|\*\*)?2")
_POWER = re.compile(r"([A-Za-z]+)(?:\^|\*\*)?(\d?)")
_STANDARD_GRAVITY = re.compile(r"(?<=\s)g(?=(\^|\*\*)?2\s*/)")


@Parameter(name="*")
@dataclass(frozen=True)
class RandomInput:
    """A random input of a turning beam: its spectral density, where it acts, and the speed.

    Parameters
    ----------
    psd : Path, optional
        One-sided power spectral density of the input: a CSV file with the columns f [Hz] and psd [m2/s4/Hz]
        or psd [g2/Hz] for an acceleration, or psd [N2/Hz] for a force.
    psd_axes : str, optional
        Axes on which the density is interpolated linearly between the points of --psd: log, as in standards,
        or linear, which may begin at 0 Hz; default: log.
    road : str, optional
        Class of a random road by ISO 8608, from A, very good, to H.
    roughness : str, optional
        Random road, given by its spectral density at 0.1 1/m, e.g. "64e-6 m3".
    highest : str, optional
        Highest spatial frequency of the road; default: 2.83 1/m, as in the standard.
    speed : str, optional
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's motion.
    velocity : str, optional
        Velocity of the rolling wheel in place of its speed, e.g. "90 km/h".
    input : str, optional
        Acceleration of the base in a direction: bending, across, n1, n2 or n3; or a force at a position:
        force@20 mm or force@tip, with " across" at the end if it acts across. Default: bending, or n2 for a
        road.
    """

    psd: Path | None = None
    psd_axes: Axes | None = None
    road: RoadClass | None = None
    roughness: Text | None = None
    highest: Text | None = None
    speed: Text | None = None
    velocity: Text | None = None
    input: Text | None = None

    @property
    def drive(self) -> inputs_outputs.Excitation | None:
        """Return the excitation in `input`; None if not given: the default depends on the density."""
        return None if self.input is None else parse_input(self.input)

    @property
    def density(self) -> bd.PowerSpectrum | bd.RoadRoughness:
        """Read the spectral density of the input: from a file, or of a standard road profile.

        Raises
        ------
        ValueError
            If not exactly one of `psd`, `road` and `roughness` is given, or `highest` without a road.
        """
        if sum(given is not None for given in (self.psd, self.road, self.roughness)) != 1:
            raise ValueError("--psd, --road, --roughness: give one of the three")
        if self.psd is not None:
            if self.highest is not None:
                raise ValueError(
                    f'--highest = "{self.highest}": it limits a road; --psd has a range itself; leave it out'
                )
            drive = self.drive
            unit = "N2/Hz" if drive is not None and drive.unit == "N" else "m2/s4/Hz"
            return read_spectrum(self.psd, unit, self.psd_axes or "log")
        if self.psd_axes is not None:
            raise ValueError(f"--psd-axes = {self.psd_axes}: give it with --psd; for a road, leave it out")
        limit = {} if self.highest is None else {"highest": parse_positive("--highest", self.highest, "1/m")}
        return bd.RoadRoughness(
            self.road or parse_positive("--roughness", self.roughness or "", "m3"), **limit
        )

    def shown(self, scene: bd.Scene) -> bd.Scene:
        """Return the scene, set so that results are displayed in the unit of the option `speed`, if given."""
        return in_unit_of(scene, self.speed)

    def speed_of(self, scene: bd.Scene) -> float:
        """Return the speed [rad/s]: from the option `speed` or `velocity`, else the scene's final speed."""
        if self.velocity is None:
            return scene.final_speed if self.speed is None else parse_speed("--speed", self.speed, scene)
        if self.speed is not None:
            raise ValueError("--speed, --velocity: give one of the two")
        if not isinstance(scene.motion, RollingWheel):
            remedy = "" if self.psd is None else ", or --speed"  # a road needs the wheel, too
            raise ValueError(
                f'--velocity: the scene has no rolling wheel; give motion.kind = "rolling"{remedy}'
            )
        return parse_positive("--velocity", self.velocity, "m/s") / scene.motion.rolling_radius


NO_RANDOM_INPUT = RandomInput()


def parse_input(text: str) -> inputs_outputs.Excitation:
    """Read ``--input``: a direction of base acceleration, such as "n2", or a force, such as "force@20 mm"."""
    match = _AT.fullmatch(text.strip())
    if match is None or match[1] != "force":
        return inputs_outputs.as_excitation("--input", text.strip())
    return inputs_outputs.PointForce(_position("--input", match[2]), "across" if match[3] else "bending")


def parse_output(text: str) -> inputs_outputs.Observation:
    """Read ``--output``: a quantity, such as "root moment", or one at a position: "deflection@20 mm"."""
    match = _AT.fullmatch(text.strip())
    if match is None or match[1] == "force":
        return inputs_outputs.as_observation("--output", text.strip())
    made = inputs_outputs.AccelerationAt if match[1] == "acceleration" else inputs_outputs.DeflectionAt
    return made(_position("--output", match[2]), "across" if match[3] else "bending")


def _position(option: str, text: str) -> float | None:
    """Read a position along the beam [m]; return None for the word "tip"."""
    return None if text.strip() == "tip" else parse_positive(option, text.strip(), "m")


def read_spectrum(path: Path, unit: str, axes: Axes = "log") -> bd.PowerSpectrum:
    """Read a spectral density from a CSV file with the columns f [Hz] and psd (m2/s4/Hz, g2/Hz or the like).

    Between its points the density is interpolated linearly on logarithmic or linear `axes`.

    Raises
    ------
    ConfigError
        If a heading lacks its unit, a column is missing or a cell is not a number; the message names the
        line.
    InvalidValue
        If the frequencies do not ascend, or a density is negative, or 0 on logarithmic axes.
    """
    text = read_data(path)

    class Density(Quantity):
        """A spectral density, whose unit may also be written (m/s2)2/Hz or g2/Hz."""

        def convert(self, given: object) -> float:
            return super().convert(spell_density(given) if isinstance(given, str) else given)

    known = {"f": Quantity("Hz", meaning="frequency"), "psd": Density(unit, meaning="density")}
    table = read_csv(text, known, {"f": "f", "frequency": "f", "psd": "psd"})
    columns = table.named()
    if len(columns) != 2:
        raise text.refusal(table.head_line, f"expected the columns f [Hz] and psd [{unit}]")
    try:
        return bd.PowerSpectrum(columns["f"].values, columns["psd"].values, axes)
    except InvalidValue as refusal:
        refusal.remedy = refusal.remedy.replace('interpolation = "linear"', "--psd-axes linear")
        units = {"psd.values": unit, "psd.frequencies": "Hz"}
        refusal.unit = refusal.unit or units.get(refusal.field, "")
        raise


def spell_density(text: str) -> str:
    """Rewrite the unit of a density for parsing: m2/s4/Hz for (m/s2)2/Hz, gravity2/Hz for g2/Hz."""

    def squared(unit: re.Match[str]) -> str:
        return _POWER.sub(lambda factor: f"{factor[1]}{2 * int(factor[2] or 1)}", unit[1])

    return _STANDARD_GRAVITY.sub("gravity", _SQUARED.sub(squared, text))


# Analyses --------------------------------------------------------------------------------------------


_UNIT = re.compile(r"[A-Za-z][A-Za-z/ ]*$")
_MOST_FREQUENCIES = 100_000
Frequencies = Annotated[Any, AsText(lambda _, text, __: parse_frequencies(text))]
Input = Annotated[Any, AsText(lambda _, text, __: parse_input(text), default="bending")]
Output = Annotated[
    Any,
    AsText(lambda _, text, __: parse_output(text), default="tip"),
    Parameter(
        help="tip, tip across, tip acceleration, root moment, root strain; deflection@20 mm, "
        "acceleration@20 mm; for a harvester also voltage, current, layer strain."
    ),
]


@analysis("beamdyn matrices examples/rolling_harvester.toml --modes 2 --json m.json")
def matrices(
    scene: bd.Scene,
    *,
    speed: AtFinalSpeed,
    modes: Count | None = None,
    discretization: Named = "ritz",
    outputs: Outputs = NO_FILES,
) -> bd.Matrices:
    """Matrices of the equations of motion at a steady speed, with what each coordinate means.

    Parameters
    ----------
    modes
        Number of modes that serve as coordinates; by default, all functions of the discretization do.
    discretization
        ritz: assumed modes; fem: finite elements.
    """
    if outputs.plot is not None:
        raise ValueError("--plot: matrices have no picture; give --json or --csv")
    return bd.matrices(scene, speed, modes, discretization)


@analysis(
    'beamdyn response examples/rough_road.toml --frequencies "1:999:400 Hz"', screen="Frequency response"
)
def response(
    scene: bd.Scene,
    *,
    frequencies: Frequencies,
    speed: AtFinalSpeed,
    input: Input,
    output: Output,
    modes: CountOrAuto = "auto",
    discretization: Discretization = "ritz",
) -> bd.FrequencyResponse:
    """Response over the frequency of an excitation, at a steady speed.

    Parameters
    ----------
    frequencies
        Frequencies with their unit: start:stop:count at equal ratios, e.g. "1:1000:400 Hz", or a
        list, e.g. "50, 60 Hz".
    input
        Acceleration of the base in a direction: bending, across, n1, n2 or n3; or a force at a
        position: force@20 mm or force@tip, with " across" at the end if it acts across.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-9 of the largest response.
    """
    return bd.frequency_response(
        scene, speed, frequencies, input, output, modes, discretization=discretization
    )


@analysis(
    'beamdyn random examples/rough_road.toml --road C --velocity "90 km/h"',
    screen="Random road",
    opens_with=("--road", "A", "--velocity", "90 km/h", "--damping-ratio", "0.03"),
    about_scene="The scene; for --road, with a rolling wheel.",
)
def random(
    scene: bd.Scene,
    *,
    random_input: RandomInput = NO_RANDOM_INPUT,
    output: Output,
    damping_ratio: float | None = None,
    modes: CountOrAuto = "auto",
    discretization: Discretization = "ritz",
) -> bd.RandomResponse:
    """Response to a random input at a steady speed: density over frequency, root mean square.

    Parameters
    ----------
    damping_ratio
        Damping ratio of all modes, such as 0.01, for a scene without damping, whose response would be
        infinite.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-9 of the root mean square.
    """
    asked = random_input
    shown, speed = asked.shown(scene), asked.speed_of(scene)
    if damping_ratio is not None and not scene.is_damped:
        shown = replace(shown, damping_ratio=damping_ratio)
    return bd.random_response(
        shown, speed, asked.density, asked.drive, output, modes=modes, discretization=discretization
    )


# Reading of options -------------------------------------------------------------------------------


def parse_frequencies(text: str) -> np.ndarray:
    """Read the frequencies [Hz] in the option ``--frequencies``: a range at equal ratios, or a list.

    Raises
    ------
    ValueError
        If there are none, a range does not ascend from a positive frequency, or the unit is not a unit of
        frequency.
    """
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
