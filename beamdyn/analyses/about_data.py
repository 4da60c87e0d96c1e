"""A scene and its data or wishes: comparison, identification, and design for wanted results."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses.analysis import READ_SECOND, WRITTEN, Answer, AsText, analysis
from beamdyn.analyses.options import Discretization, FrequencyTolerance, Text, none_given
from beamdyn.analyses.values import in_unit_of, parse_amounts, parse_quantity, parse_speed, parse_speeds
from beamdyn.common.edge.data_text import DataText
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.inputs import describe, of_file
from beamdyn.common.edge.varied_inputs import find_input, numbers
from beamdyn.common.results.files import write_text
from beamdyn.files.measured_curve_files import Frequency
from beamdyn.files.measured_data import half_unit, measurements_of
from beamdyn.files.scene_inputs import SceneInput
from beamdyn.files.scenes import check_numbers_in_file, with_numbers_in_file
from beamdyn.scene.measured_curves import MeasuredCurves
from beamdyn.scene.numbers import is_speed
from beamdyn.studies.questions import KINDS

Data = Annotated[
    Path | None,
    READ_SECOND,
    Parameter(
        name="DATA.csv",
        help='File of measured values. Its columns may have the headings "speed [rpm], frequency 1 [Hz]", '
        '"time [s], tip [mm]", "speed [rpm], from [s], to [s], largest tip [mm]", '
        '"position [m], moment [N m]", "frequency [Hz], tip by tip force [mm/N]" or '
        '"position [mm], shape at 62.1 Hz"; or it is an ANSYS listing, FAST output or a universal file.',
    ),
]
Measured = Annotated[
    str | None,
    Parameter(
        help="Measured frequencies at one speed in place of a file, in Hz or rad/s, "
        'e.g. "62.1, 389, 1090 Hz".',
        allow_leading_hyphen=True,
    ),
]
AtSpeeds = Annotated[
    Any,
    AsText(lambda _, text, scene: parse_speeds(text, scene), absent=none_given),
    Parameter(
        help='Speed of each row, if the data contain none, e.g. "0, 50 rad/s"; default: 0, but for loads '
        "and responses the final speed of the scene's motion."
    ),
]
ColumnsOfFile = Annotated[
    tuple[str, ...],
    Parameter(
        help='Column of the file for each quantity, separated by semicolons: "tip = TipDxb1; root moment = '
        'RootMyb1", with a unit if the file states none: "tip by tip force [mm/N] = UY_2".',
        negative="",
        consume_multiple=False,
        show_default=False,
    ),
]
Uncertainty = Annotated[
    str | None,
    Parameter(
        help='Standard uncertainty of the values, if the data contain none, e.g. "0.5 Hz" or "1 %".',
        allow_leading_hyphen=True,
    ),
]


def _beside(
    scene: bd.Scene,
    *,
    data: Path | DataText | None,
    measured: str | None,
    speeds: np.ndarray | None,
    uncertainty: str | None,
    columns: Sequence[str] = (),
    **_: Any,
) -> bd.FrequencyComparison | bd.CurveComparison:
    """Compare measured values with those computed for the scene, without fitting its inputs to them."""
    from beamdyn.studies.beside_data.compare import beside  # slow import, not needed for help texts

    given = _data(data, measured, speeds, uncertainty, columns)
    if isinstance(given, MeasuredCurves):
        return bd.compare(scene, given)
    return beside(in_unit_of(scene, f"0 {given.speed_unit}"), given)


@analysis(
    'beamdyn compare examples/tyre_harvester.toml --measured "62.1, 389, 1090 Hz"',
    "beamdyn compare examples/epps.toml examples/epps.csv",
    "beamdyn compare examples/rolling_harvester.toml examples/resonance_radau.csv",
    about_scene="The scene; its motion is used for time histories and peaks.",
    screen="Compare",
    sooner=_beside,
)
def compare(
    scene: bd.Scene,
    *,
    data: Data = None,
    measured: Measured = None,
    speeds: AtSpeeds,
    uncertainty: Uncertainty = None,
    columns: ColumnsOfFile = (),
) -> bd.FrequencyComparison | bd.CurveComparison:
    """Measured values compared with those of the scene: which agree, and what may explain deviations."""
    given = _data(data, measured, speeds, uncertainty, columns)
    unit = "" if isinstance(given, MeasuredCurves) else given.speed_unit
    source = data.path if isinstance(data, DataText) else data
    with of_file({each.name: f"{source}: {each.name}" for each in fields(given)} if source else {}):
        return bd.compare(in_unit_of(scene, f"0 {unit}"), given)


@analysis(
    'beamdyn identify examples/tyre_harvester.toml --free length --measured "62 Hz"',
    "beamdyn identify examples/epps.toml examples/epps.csv --free length",
    screen="Identify",
    sooner=_beside,
)
def identify(
    scene: bd.Scene,
    *,
    data: Data = None,
    free: Text,
    measured: Measured = None,
    speeds: AtSpeeds,
    uncertainty: Uncertainty = None,
    starts: int = 4,
    seed: int = 0,
    write: Annotated[Path | None, WRITTEN] = None,
    file: Path | None = None,
) -> Answer:
    """Unknown inputs of the scene, found from measured natural frequencies, with their intervals.

    Parameters
    ----------
    free
        Names of the unknown inputs in the file, separated by commas, each with or without bounds:
        "beam.thickness=0.1:0.3 mm, mount.root_stiffness".
    starts
        Largest number of points at which the search starts: of all random points, those that fit the data
        best.
    seed
        Seed of the random starting points.
    write
        Write the scene with the values found, and comments on their origin, into this file.
    """
    given = _data(data, measured, speeds, uncertainty)
    if isinstance(given, MeasuredCurves):
        source = data.path if isinstance(data, DataText) else data
        raise ValueError(f"{source}: identify takes natural frequencies; use this file with compare")
    numbers = parse_free(free)
    if write is not None and file is not None:
        check_numbers_in_file(file, scene, numbers, write)
    found = bd.identify(in_unit_of(scene, f"0 {given.speed_unit}"), given, numbers, starts, seed)
    untold = _untold(found)
    if write is not None and file is not None and not untold:
        ranges = ", ".join(found.says(k) for k in range(len(found.names)))
        said = f"95 % intervals: {ranges}; remaining deviation {100 * found.scatter:.2g} %."
        _write(found, file, write, "identify", f" from {given.source or 'given frequencies'}", said)
    return Answer(found, untold)


def _untold(found: bd.Identification) -> str:
    """Name the parameters that the data do not determine; empty if the data determine all of them."""
    lost = [name for name, value in zip(found.names, found.value, strict=True) if np.isnan(value)]
    return f"the data do not determine {' and '.join(lost)}: the result says what would help" if lost else ""


def _write(
    found: bd.Identification | bd.FoundDesign, scene: Path, to: Path, command: str, source: str, said: str
) -> None:
    """Write a copy of a scene's file with the numbers found; its head names the command and the source."""
    values = dict(zip(found.names, found.value.tolist(), strict=True))
    start = f"Found by beamdyn {command} ({found.provenance.version}){source}"
    head = [f"{start}; all other inputs are those of {scene.name}.", said]
    write_text(to, with_numbers_in_file(scene, values, to, head))


# Reading of options -------------------------------------------------------------------------------


def _data(
    file: Path | DataText | None,
    measured: str | None,
    speeds: np.ndarray | None,
    uncertainty: str | None,
    columns: Sequence[str] = (),
) -> bd.MeasuredFrequencies | MeasuredCurves:
    """Read measured data from a file, or from the text of the option ``--measured``."""
    if (file is None) == (measured is None):
        raise ValueError('give either a file, such as measured.csv, or --measured "62.1, 389, 1090 Hz"')
    if file is None and columns:
        raise ValueError(
            f'--columns = "{"; ".join(columns)}": it names columns of a file, but none is given; leave it out'
        )
    named = _columns("; ".join(columns)) if columns else None
    if isinstance(file, DataText):
        data = measurements_of(file, speeds, named)
    elif file is not None:
        data = bd.read_measurements(file, speeds, named)
    else:
        data = _in_words(measured or "", speeds)
    return data if uncertainty is None else _with_uncertainty(data, uncertainty)


def _columns(text: str) -> dict[str, str]:
    """Read ``--columns``: return which heading in the file stands for each heading of this package."""
    parts = [part.partition("=") for part in text.split(";") if part.strip()]
    if not parts or not all(head.strip() and source.strip() for head, _, source in parts):
        raise ValueError(f'--columns = "{text}": give e.g. "tip = TipDxb1; root moment = RootMyb1"')
    return {head.strip(): source.strip() for head, _, source in parts}


def _in_words(text: str, speeds: np.ndarray | None) -> bd.MeasuredFrequencies:
    """Read the frequencies in the option ``--measured``, all at one speed."""
    values, written = parse_amounts("--measured", text, Frequency("Hz"), "62.1, 389, 1090 Hz")
    if speeds is not None and len(speeds) != 1:
        raise ValueError(f"--speeds: give one speed with --measured, or a file; there are {len(speeds)}")
    halves = [half_unit(cell) * value / float(cell) for cell, value in zip(written, values, strict=True)]
    return bd.MeasuredFrequencies(values, (0.0,) if speeds is None else speeds, rounding=[halves])


def _with_uncertainty(
    data: bd.MeasuredFrequencies | MeasuredCurves, text: str
) -> bd.MeasuredFrequencies | MeasuredCurves:
    """Add the uncertainty in the option ``--uncertainty`` to data without uncertainties.

    A percentage refers to the measured frequency, or, in a column of another quantity, to the column's
    largest value.
    """
    share = text.strip().endswith("%")
    if isinstance(data, MeasuredCurves):
        if not share:
            raise ValueError(
                f'--uncertainty = "{text}": give a percentage, "1 %", or a column "tip uncertainty [mm]"'
            )
        sizes = np.abs(data.columns).max(axis=0)
    else:
        sizes = data.frequency
    known = np.asarray(getattr(data, "uncertainty"))  # noqa: B009  (of each kind of data)
    if share:
        try:
            spread = sizes * float(text.strip()[:-1]) / 100
        except ValueError:
            raise ValueError(f'--uncertainty = "{text}": give e.g. "0.5 Hz" or "1 %"') from None
    else:
        spread = np.full(known.shape, parse_quantity("--uncertainty", text, Frequency("Hz")))
    return replace(data, uncertainty=np.where(np.isfinite(known), known, spread))


def parse_free(text: str) -> dict[str, tuple[float, float] | None]:
    """Read the unknown parameters in the option ``--free``, each with bounds [SI units] or None.

    Raises
    ------
    ValueError
        If a name is unknown, or the bounds are not two values with a unit.
    """
    found: dict[str, tuple[float, float] | None] = {}
    known = {entry.path: entry for entry in numbers(describe(SceneInput))}
    for part in filter(None, (each.strip() for each in text.split(","))):
        words = f'--free = "{part}"'
        key, _, bounds = (each.strip() for each in part.partition("="))
        if is_speed(key):  # the analysis decides whether it accepts the name "speed"
            found[key] = None
            continue
        of_beam = f"beam.{key}"  # a name without a table means an input of [beam], not of [harvester]
        entry = known[of_beam] if of_beam in known else find_input([*known.values()], key, words)
        found[entry.path] = _bounds(bounds, entry.quantity.unit, words) if bounds else None
    if not found:
        raise ValueError('--free: give the unknown numbers, e.g. "beam.thickness, mount.root_stiffness"')
    return found


def _bounds(text: str, unit: str, words: str) -> tuple[float, float]:
    ends, _, given = text.partition(" ")
    low, _, high = ends.partition(":")
    try:
        if not unit:
            return float(low), float(high)
        least, most = (parse_quantity("--free", f"{end} {given}".strip(), unit) for end in (low, high))
    except ValueError:
        example = f"{words.partition('=')[2].strip().strip(chr(34)).partition('=')[0]}=1:2 {unit}".rstrip()
        raise ValueError(f'{words}: give two bounds and a unit, e.g. "{example}"') from None
    return least, most


# Numbers for wanted results ----------------------------------------------------------------------------


_WORDS = {"frequency": "frequencies", "critical speed": "critical_speed", "resonance speed": "crossings"}
_WORDS |= {name: name for name in ("amplitude", "peak", "strain", "power")}
_TARGET = re.compile(
    rf"(?P<what>{'|'.join(_WORDS)})(?: (?P<mode>\d+))?(?: with (?P<line>.+?))?(?: at (?P<speed>.+?))?"
    r" *(?:(?P<sign>=|>=|<=) *(?P<value>.+)|(?<= )(?P<best>largest|smallest))"
)
_SIGNS = {"=": "equals", ">=": "at_least", "<=": "at_most"}
_EXAMPLE = 'give e.g. "frequency 1 at 50 rad/s = 80 Hz", "critical speed >= 90 rad/s" or "amplitude smallest"'


@analysis(
    'beamdyn design examples/epps.toml --free length --so-that "frequency = 3 Hz"',
    'beamdyn design examples/bir.toml --free length --so-that "frequency 2 = 9 Hz"',
    screen="Design",
    opens_with=("--free", "length=30:60 mm", "--so-that", "frequency 1 = 80 Hz"),
)
def design(
    scene: bd.Scene,
    *,
    free: Text,
    so_that: Annotated[
        tuple[str, ...], Parameter(negative="", consume_multiple=False, show_default=False)
    ] = (),
    seed: int = 0,
    discretization: Discretization = "ritz",
    tolerance: FrequencyTolerance = None,
    write: Annotated[Path | None, WRITTEN] = None,
    file: Path | None = None,
) -> Answer:
    """Inputs of the scene, within bounds, for which its results are as wanted.

    Parameters
    ----------
    free
        Names of the inputs to choose, separated by commas, each with its bounds:
        "beam.thickness=0.1:0.3 mm, beam.length=40:60 mm"; without bounds, from half to twice its value.
    so_that
        A wanted result; give the option once for each: the result, then =, >= or <= and a value, or largest
        or smallest. Results are "frequency 1 at 50 rad/s", of the first mode; "critical speed"; "resonance
        speed 1 with road +", of a mode and a line of the excitation; "amplitude", "peak", "strain" and
        "power", with "at" and a speed. Without a speed, frequencies are those at rest, and
        responses those at the final speed of the motion.
    seed
        Seed of the random designs with which a search over several inputs begins.
    write
        Write the scene with the values found, and comments on the wanted results, into this file.
    """
    if not so_that:
        raise ValueError(f"--so-that: say what is wanted; {_EXAMPLE}")
    asked = [_match(text.strip()) for text in so_that]
    scene = in_unit_of(scene, *(each["speed"] for each in asked))
    targets = [_target(each, scene) for each in asked]
    how = {"discretization": discretization, "tolerance": tolerance}
    numbers = parse_free(free)
    if write is not None and file is not None:
        check_numbers_in_file(file, scene, numbers, write)
    found = bd.design(scene, numbers, targets, seed=seed, **how)
    if write is not None and file is not None:
        wanted = ", ".join(each.says for each in found.targets)
        said = f"This scene {'has' if found.found else 'comes nearest to'}: {wanted}."
        _write(found, file, write, "design", "", said)
    return Answer(found, "" if found.found else in_files(found.sentences()[0], found.display_units))


def _match(text: str) -> re.Match[str]:
    """Split the text of the option ``--so-that`` into its parts; raise an error for an invalid text."""
    found = _TARGET.fullmatch(text)
    if found is None:
        raise ValueError(f'--so-that = "{text}": {_EXAMPLE}')
    return found


def _target(found: re.Match[str], scene: bd.Scene) -> bd.Target:
    """Make the target that the option ``--so-that`` describes."""
    what, unit = _WORDS[found["what"]], KINDS[_WORDS[found["what"]]].unit
    wanted: dict[str, Any] = {"best": found["best"]}
    if found["sign"]:
        wanted = {_SIGNS[found["sign"]]: _value(found["value"], unit, scene)}
    speed = None if found["speed"] is None else parse_speed("--so-that", found["speed"], scene)
    return bd.Target(what, **wanted, speed=speed, mode=int(found["mode"] or 1), line=found["line"] or "")


def _value(text: str, unit: str, scene: bd.Scene) -> float:
    """Convert the text of a wanted value, such as "80 Hz", to a number in SI units."""
    if unit == "rad/s":
        return parse_speed("--so-that", text, scene)
    return parse_quantity("--so-that", text, unit) if unit else float(text)
