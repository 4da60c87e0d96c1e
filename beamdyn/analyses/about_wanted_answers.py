"""Inverse design: values of a scene's inputs for which its results are as wanted."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses.about_data import parse_free
from beamdyn.analyses.analysis import WRITTEN, Answer, analysis
from beamdyn.analyses.options import Discretization, FrequencyTolerance, Text
from beamdyn.analyses.values import in_unit_of, parse_quantity, parse_speed
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.results.files import write_text
from beamdyn.files.scenes import check_numbers_in_file, with_numbers_in_file
from beamdyn.studies.questions import KINDS

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
        _write(found, file, write)
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


def _write(found: bd.FoundDesign, scene: Path, to: Path) -> None:
    wanted = ", ".join(each.says for each in found.targets)
    head = [
        f"Found by beamdyn design ({found.provenance.version}); all other inputs are those of {scene.name}.",
        f"This scene {'has' if found.found else 'comes nearest to'}: {wanted}.",
    ]
    values = dict(zip(found.names, found.value.tolist(), strict=True))
    write_text(to, with_numbers_in_file(scene, values, to, head))
