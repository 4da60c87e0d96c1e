"""The command ``beamdyn``.  What is heavy is imported by the commands that need it."""

from __future__ import annotations

import csv
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import App, CycloptsError, Parameter

from beamdyn import __version__

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes

    from beamdyn.results import Result
    from beamdyn.scene import Scene
    from beamdyn.spectrum import Locus, Modes

DONE, NO_ANSWER, BAD_INPUT = 0, 1, 2

_MOST_SPEEDS = 100_000
_UNIT = re.compile(r"[A-Za-zµ°%]+(\s*/\s*[A-Za-z]+)?$")
_NUMBER = re.compile(r"[-+]?[\d.]+([eE][-+]?\d+)?")
_SUFFIXES = {"plot": (".png", ".svg", ".pdf"), "shapes": (".vtu", ".xdmf")}

_Scene = Annotated[Path, Parameter(name="SCENE.toml")]
_Text = Annotated[str, Parameter(allow_leading_hyphen=True)]
_Method = Literal["ritz", "fem"]
_Flag = Annotated[bool, Parameter(negative="")]

app = App(
    name="beamdyn",
    version=__version__,
    help="""Vibration of rotating cantilevers: natural frequencies over speed, buckling, setting angles.

A scene is a TOML file with units; `beamdyn COMMAND --help` lists the options of a command.""",
    help_epilogue="Exit codes: 0 done; 1 the model has no answer (the message says which mode and where); "
    "2 bad input.",
    help_format="markdown",
)


class NoAnswer(Exception):
    """The model has no answer; the message says which mode and where."""


@Parameter(name="*")
@dataclass(frozen=True)
class Outputs:
    """Files to write.

    Parameters
    ----------
    plot : Path, optional
        Draw the result into this file: .png, .svg or .pdf.
    json : Path, optional
        Write the result with its error estimate and provenance into this file.
    csv : Path, optional
        Write a table for other programs into this file.
    force : bool
        Overwrite files that exist.
    """

    plot: Path | None = None
    json: Path | None = None
    csv: Path | None = None
    force: _Flag = False

    def check(self, **more: Path | None) -> None:
        """Refuse, before anything is computed, a file that cannot be written."""
        paths = {"plot": self.plot, "json": self.json, "csv": self.csv, **more}
        given = {option: path for option, path in paths.items() if path is not None}
        for option, path in given.items():
            _check_output(option, path, self.force)
        if len({path.absolute() for path in given.values()}) < len(given):
            raise ValueError(f"{' and '.join('--' + o for o in given)}: give each its own file")


@app.command
def modes(
    scene: _Scene,
    /,
    *,
    speed: _Text | None = None,
    modes: int = 3,
    method: _Method = "ritz",
    shapes: Path | None = None,
    outputs: Outputs = Outputs(),
) -> None:
    """Natural frequencies, errors and stability at one speed.

    Parameters
    ----------
    scene
        The scene.
    speed
        With its unit, e.g. "50 rad/s" or "525 rpm"; if not given, that of the scene's motion, or rest.
    modes
        How many modes.
    method
        Assumed modes or finite elements: each checks the other.
    shapes
        Write the mode shapes into this file for ParaView: .vtu or .xdmf.
    outputs
        Files to write.
    """
    from beamdyn import load_scene, natural_modes
    from beamdyn.report import console, modes_table

    outputs.check(shapes=shapes)
    loaded = load_scene(scene)
    found = natural_modes(loaded, _asked_speed(loaded, speed), modes, method)
    console().print(modes_table(found))
    _write(found, outputs, _modes_csv(found), found.plot)
    if shapes is not None:
        _write_shapes(found, shapes, outputs.force)
    _warn(w for w in found.warnings if not w.startswith("unstable"))
    _refuse_unstable(found)


@app.command
def locus(
    scene: _Scene,
    /,
    *,
    speeds: _Text,
    modes: int = 3,
    method: _Method = "ritz",
    outputs: Outputs = Outputs(),
) -> None:
    """Natural frequencies over speed, each mode followed through crossings.

    Parameters
    ----------
    scene
        The scene.
    speeds
        With their unit: start:stop:count, e.g. "0:150:301 rad/s", or a list, e.g. "0, 50, 100 rad/s".
    modes
        How many modes.
    method
        Assumed modes or finite elements: each checks the other.
    outputs
        Files to write.
    """
    from beamdyn import frequency_locus, load_scene
    from beamdyn.report import console, locus_table

    outputs.check()
    asked = parse_speeds(speeds)
    found = frequency_locus(load_scene(scene), asked, modes, method)
    console().print(locus_table(found))
    _write(found, outputs, _locus_csv(found), partial(_draw_locus, found))
    _warn(found.warnings)


@app.command
def critical(
    scene: _Scene, /, *, method: _Method = "ritz", json: Path | None = None, force: _Flag = False
) -> None:
    """Speed at which the rotating beam buckles.

    Parameters
    ----------
    scene
        The scene.
    method
        Assumed modes or finite elements: each checks the other.
    json
        Write the result with its error estimate and provenance into this file.
    force
        Overwrite a file that exists.
    """
    from beamdyn import critical_point, load_scene
    from beamdyn.report import console, supported

    outputs = Outputs(json=json, force=force)
    outputs.check()
    found = critical_point(load_scene(scene), method)
    value = supported(found.speed, found.error * found.speed, 12)
    stiff = "no critical speed: at no speed does the beam buckle"
    console().print(stiff if value == "inf" else f"critical speed: {value} rad/s; above it the beam buckles")
    _write(found, outputs)


@app.command
def limits(
    scene: _Scene,
    /,
    *,
    top_speed: _Text,
    method: _Method = "ritz",
    json: Path | None = None,
    force: _Flag = False,
) -> None:
    """Setting angles at which the first frequency stops falling, and starts rising, with speed.

    Parameters
    ----------
    scene
        The scene; its own setting angle is not used.
    top_speed
        Speed up to which the second limit holds, with its unit, e.g. "400 rad/s".
    method
        Assumed modes or finite elements: each checks the other.
    json
        Write the result with its error estimate and provenance into this file.
    force
        Overwrite a file that exists.
    """
    from math import isnan

    from beamdyn import load_scene, setting_angle_limits
    from beamdyn.report import console, limits_table

    outputs = Outputs(json=json, force=force)
    outputs.check()
    asked = parse_speed("--top-speed", top_speed)
    if asked <= 0:
        raise ValueError(f'--top-speed = "{top_speed}": it must be greater than 0')
    found = setting_angle_limits(load_scene(scene), asked, method)
    _write(found, outputs)
    if isnan(found.first) or isnan(found.second):
        raise NoAnswer(found.warnings[0])
    console().print(limits_table(found))
    _warn(found.warnings)


@app.command
def reproduce(*, output: Path = Path("beamdyn-reproduce"), tables: _Flag = False) -> None:
    """Published numbers beside ours, with deviations and verdicts; draws the paper's figures.

    Parameters
    ----------
    output
        Folder for the pictures; it is made if needed, and its pictures are replaced.
    tables
        Compare with the tables of rotating beams of other sources too; takes some ten seconds.
    """
    from beamdyn.report import console
    from beamdyn.reproduce import report

    if output.exists() and not output.is_dir():
        raise ValueError(f"--output = {output}: it is a file; give a folder")
    screen = console()
    checked = report(screen, output, tables)
    unexpected = sum(not row.as_expected for row in checked)
    if unexpected:
        raise NoAnswer(f"{unexpected} of {len(checked)} verdicts are not as expected; see the tables")
    screen.print(
        f"\nAll {len(checked)} verdicts are as expected: agreement, but for the differences explained above."
    )
    if not tables:
        screen.print("beamdyn reproduce --tables compares with the tables of other sources, too.")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        As on the command line, without the program's name; those of the process if not given.

    Returns
    -------
    int
        Exit code: 0 done, 1 the model has no answer, 2 bad input.
    """
    given = sys.argv[1:] if arguments is None else list(arguments)
    try:
        app(given, exit_on_error=False, print_error=False, result_action="return_value")
    except NoAnswer as error:
        return _complain("no answer: ", error, NO_ANSWER)
    except CycloptsError as error:
        return _complain("", f"{error} See beamdyn --help.", BAD_INPUT)
    except (ValueError, OSError) as error:
        return _refused(error)
    return DONE


def _refused(error: Exception) -> int:
    """Tell bad input from an eigenproblem that numpy, by a kind of ValueError, gives up."""
    from numpy.linalg import LinAlgError

    if isinstance(error, LinAlgError):
        return _complain(
            "no answer: ", f"{error}; check the size of the speed and of each property", NO_ANSWER
        )
    return _complain("", error, BAD_INPUT)


def _complain(prefix: str, error: object, code: int) -> int:
    print(f"beamdyn: {prefix}{error}", file=sys.stderr)
    return code


def _warn(warnings: Iterable[str]) -> None:
    for warning in warnings:
        print(f"beamdyn: warning: {warning}", file=sys.stderr)


# Arguments ----------------------------------------------------------------------------------------


def parse_speed(option: str, text: str) -> float:
    """A speed with its unit [rad/s], or a ValueError that names the option."""
    from beamdyn.common.units import quantity

    try:
        return quantity(text, "rad/s")
    except ValueError as error:
        raise ValueError(f"{option} = {error}") from None


def parse_speeds(text: str) -> np.ndarray:
    """Speeds [rad/s] of ``--speeds``: start:stop:count or a list, with a unit at the end.

    Parameters
    ----------
    text : str
        E.g. "0:150:301 rad/s" or "0, 50, 100 rad/s".

    Returns
    -------
    ndarray, shape (S,)

    Raises
    ------
    ValueError
        If there are none, they do not ascend, or lack a unit of angular speed.
    """
    if not text.strip(" ,:"):
        raise ValueError(
            f'--speeds = "{text}": it is empty; give e.g. "0:150:301 rad/s" or "0, 50, 100 rad/s"'
        )
    found = _UNIT.search(text.strip())
    if found is None:
        raise ValueError(f'--speeds = "{text}": give a unit at its end, e.g. "{text.strip()} rad/s"')
    unit, numbers = found.group(), text.strip()[: found.start()]
    return _range(text, numbers, unit) if ":" in numbers else _list(text, numbers, unit)


def _range(text: str, numbers: str, unit: str) -> np.ndarray:
    import numpy as np

    parts = [part.strip() for part in numbers.split(":")]
    if len(parts) != 3:
        raise ValueError(f'--speeds = "{text}": give start:stop:count, e.g. "0:150:301 rad/s"')
    start, stop = (_member(text, part, unit) for part in parts[:2])
    if not parts[2].isdecimal() or not 1 <= int(parts[2]) <= _MOST_SPEEDS:
        raise ValueError(
            f'--speeds = "{text}": the count {parts[2]!r} must be a whole number from 1 to {_MOST_SPEEDS}'
        )
    if start > stop or (start == stop) != (int(parts[2]) == 1):
        raise ValueError(f'--speeds = "{text}": start must be below stop (with a count of 1: equal to it)')
    return np.linspace(start, stop, int(parts[2]))


def _list(text: str, numbers: str, unit: str) -> np.ndarray:
    import numpy as np

    values = [_member(text, part.strip(), unit) for part in numbers.split(",")]
    for low, high in pairwise(values):
        if high <= low:
            raise ValueError(f"--speeds: {low:g} is followed by {high:g} rad/s; sort them and drop repeats")
    return np.array(values)


def _member(text: str, number: str, unit: str) -> float:
    """One of several speeds [rad/s]."""
    if not _NUMBER.fullmatch(number):
        raise ValueError(
            f"--speeds = \"{text}\": '{number}' is not a number; give numbers and one unit at their end, "
            'e.g. "0, 50, 100 rad/s"'
        )
    return parse_speed("--speeds", f"{number} {unit}")


def _asked_speed(scene: Scene, speed: str | None) -> float:
    """The speed asked for [rad/s], else that of a steady motion, else 0."""
    if speed is not None:
        return parse_speed("--speed", speed)
    return float(getattr(scene.motion, "speed", 0.0))


def _check_output(option: str, path: Path, force: bool) -> None:
    suffixes = _SUFFIXES.get(option)
    if suffixes and path.suffix.lower() not in suffixes:
        raise ValueError(
            f"--{option} = {path}: unknown suffix {path.suffix!r}; give one of {', '.join(suffixes)}"
        )
    if path.is_dir():
        raise ValueError(f"--{option} = {path}: it is a folder; give the name of a file")
    if not path.parent.is_dir():
        raise ValueError(f"--{option} = {path}: there is no folder {path.parent}; create it first")
    if path.exists() and not force:
        raise ValueError(
            f"--{option} = {path}: the file exists; add --force to overwrite it, or give another name"
        )


# Files and verdicts -------------------------------------------------------------------------------


def _write(
    found: Result,
    outputs: Outputs,
    rows: Iterable[Sequence[object]] = (),
    draw: Callable[[Axes], object] | None = None,
) -> None:
    """Write what was asked for; `rows` are those of the CSV file, `draw` makes the picture."""
    if outputs.json is not None:
        from beamdyn.results import to_json

        outputs.json.write_text(to_json(found.to_dict()), encoding="utf-8")
    if outputs.csv is not None:
        with outputs.csv.open("w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    if outputs.plot is not None and draw is not None:
        _save(draw, outputs.plot, outputs.force)


def _save(draw: Callable[[Axes], object], path: Path, force: bool) -> None:
    from matplotlib.figure import Figure

    from beamdyn.plots import save_figure

    figure = Figure(figsize=(7.5, 4.8), layout="constrained")
    draw(figure.subplots())
    save_figure(figure, path, force)


def _draw_locus(found: Locus, ax: Axes) -> None:
    from beamdyn import critical_speed
    from beamdyn.plots import mark_critical

    mark_critical(found.plot(ax), critical_speed(found.scene))


def _write_shapes(found: Modes, path: Path, force: bool) -> None:
    import numpy as np

    from beamdyn.export import write_shapes

    x = np.linspace(0, found.scene.beam.length, 101)
    write_shapes(path, x, np.real(found.shape(x)), found.labels(), force=force)


def _modes_csv(found: Modes) -> Iterator[Sequence[object]]:
    yield "mode", "speed_rad_per_s", "frequency_Hz", "relative_error", "growth_rate_per_s", "status"
    columns = found.frequency, found.error, found.growth_rate, found.status
    for mode, row in enumerate(zip(*(column.tolist() for column in columns), strict=True), 1):
        yield mode, found.speed, *row


def _locus_csv(found: Locus) -> Iterator[Sequence[object]]:
    names = ("frequency_Hz", "relative_error", "growth_rate_per_s", "status", "confidence")
    columns = found.frequency, found.error, found.growth_rate, found.status, found.confidence
    numbers = range(1, found.frequency.shape[1] + 1)
    yield "speed_rad_per_s", *(f"{name}_{mode}" for name in names for mode in numbers)
    for speed, *rows in zip(found.speeds.tolist(), *(column.tolist() for column in columns), strict=True):
        yield speed, *(value for row in rows for value in row)


def _refuse_unstable(found: Modes) -> None:
    """Say which mode grows, and from what speed on the beam does."""
    from beamdyn import critical_speed

    grows = [i for i, status in enumerate(found.status) if status in ("divergence", "flutter")]
    if not grows:
        return
    which = ", ".join(f"mode {i + 1} ({found.status[i]}, {found.growth_rate[i]:.4g} 1/s)" for i in grows)
    critical = critical_speed(found.scene)
    where = f"; the critical speed is {critical:.6g} rad/s" if critical <= found.speed else ""
    raise NoAnswer(f"unstable at {found.speed:g} rad/s: {which}{where}")
