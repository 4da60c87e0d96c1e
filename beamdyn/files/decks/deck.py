"""Decks: descriptions of a blade in input files of other programs or in CSV tables, read as scenes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.data_text import CsvTable, DataText, named_number, named_values, read_data
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.inputs.checks import InvalidValue, moderate, not_negative, size
from beamdyn.common.results.files import check_writable, write_text
from beamdyn.common.results.one_line import counted, number
from beamdyn.common.results.result import Result
from beamdyn.files.decks import beamdyn_blade, bmodes, elastodyn
from beamdyn.files.decks.audit import DeckAudit, ModePolynomial, audit, fit_mode_polynomials
from beamdyn.files.decks.blade import Blade, IgnoredProperty, ignore
from beamdyn.files.decks.elastodyn import named_file
from beamdyn.files.decks.scene_file import tables_of, text_of
from beamdyn.files.scenes import RADIUS, read_station_file, scene_from_dict
from beamdyn.scene.scene import Scene

_STRUCTURAL_TWIST = ("StrcTwst", "str_tw")  # headings of other programs, whose twist has the opposite sign
_MORE = {RADIUS: Quantity("m"), **dict.fromkeys(_STRUCTURAL_TWIST, Quantity("rad"))}
_NEEDED = ("mass_per_length", "bending_stiffness")
_SECTION = ("width", "thickness")


# Blades in CSV tables --------------------------------------------------------------------------------------


def is_csv(text: DataText) -> bool:
    """Return whether a text is a table, by its suffix or units in brackets in the first non-comment line."""
    first = next((line for n, line in enumerate(text.lines, 1) if not text.is_comment(n)), "")
    return text.path.suffix.lower() in (".csv", ".tsv") or ("[" in first and any(c in first for c in ",;\t"))


def read_csv_blade(text: DataText, table: CsvTable, length: float, hub_radius: float) -> Blade:
    """Read a blade from a CSV table.

    Parameters
    ----------
    text : DataText
        Text of the file.
    table : CsvTable
        Its table.
    length, hub_radius : float
        Length of the blade and radius of the hub [m], if they do not follow from the table.

    Raises
    ------
    ConfigError
        If data are missing or invalid.
    """
    stations, length, hub_radius = _positions(table, length, hub_radius)
    return Blade(
        kind="CSV table",
        title="",
        sources=(text.path,),
        length=length,
        hub_radius=hub_radius,
        stations=stations,
        columns=_properties(table),
        ignored=tuple(
            entry
            for column in table.columns
            if not column.name
            for entry in ignore(column.head, column.values, column.unit, "no property of a beam")
        ),
    )


def _positions(table: CsvTable, length: float, hub_radius: float) -> tuple[np.ndarray, float, float]:
    """Return stations x/L, the length, and the radius of the hub [m]."""
    named, text = table.named(), table.text
    if RADIUS in named:
        r = np.array(named[RADIUS].values)
        if r[0] < 0:
            raise text.refusal(table.lines[0], f"expected r of 0 or more at the root, found {r[0]:g} m")
        return _fractions(r - r[0], r[-1] - r[0]), float(r[-1] - r[0]), float(r[0])
    name = "x" if "x" in named else "x/L"
    x = np.array(named[name].values, dtype=float)
    last = 1.0 if name == "x/L" else float(x[-1])
    if x[0] != 0:
        raise text.refusal(table.lines[0], f"expected {name} = 0, the root, found {x[0]:g}")
    if x[-1] != last:
        raise text.refusal(table.lines[-1], f"expected {name} = 1, the tip, found {x[-1]:g}")
    return _fractions(x, last), (last if name == "x" else length), hub_radius


def _fractions(x: np.ndarray, length: float) -> np.ndarray:
    """Compute positions as fractions of the length, rounded like those in scene files."""
    return np.array([round(float(each) / length, 14) for each in x])


def _properties(table: CsvTable) -> dict[str, np.ndarray]:
    named, text = table.named(), table.text
    if given := [named[name].head for name in _SECTION if name in named]:
        said = f"expected columns of stiffness, found {given[0]}; a scene may name this file as beam.stations"
        raise text.refusal(table.head_line, said)
    if missing := [name for name in _NEEDED if name not in named]:
        words = {"mass_per_length": "mass [kg/m]", "bending_stiffness": "EI flap [N m2]"}
        found = ", ".join(column.head for column in table.columns)
        raise text.refusal(table.head_line, f"expected a column {words[missing[0]]}; headings: {found}")
    columns = {name: np.array(column.values, dtype=float) for name, column in named.items()}
    for name in (RADIUS, "x", "x/L"):
        columns.pop(name, None)
    return _with_twist(table, columns)


def _with_twist(table: CsvTable, columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the columns with the twist in degrees, with the sign convention of this package."""
    senses = {"twist": 1.0, **dict.fromkeys(_STRUCTURAL_TWIST, -1.0)}
    given = [name for name in senses if name in columns]
    if len(given) > 1:
        raise table.text.refusal(table.head_line, f"expected one twist, found {' and '.join(given)}")
    for name in given:
        if "second_bending_stiffness" not in columns:
            said = f"expected a column EI edge [N m2], too, as {name} turns both directions of bending"
            raise table.text.refusal(table.head_line, said)
        degrees = [round(senses[name] * math.degrees(value), 12) for value in columns.pop(name)]
        columns["twist"] = np.array(degrees)
    return columns


_ELASTODYN, _BEAMDYN = 1, 2  # values of the setting CompElast; 3 is a simplified ElastoDyn
_NO_TIP_MASS = "OpenFAST ignores this mass if BeamDyn computes the blades; to include it, give tip in [beam]"


def read_openfast_file(text: DataText) -> Blade:
    """Read the first blade of the turbine: from BeamDyn's file if BeamDyn computes it, else ElastoDyn's."""
    found = named_values(text, {"edfile", "compelast", "bdbldfile1"})
    model = named_number(text, found["compelast"]) if "compelast" in found else _ELASTODYN
    rotor = elastodyn.read_main_file(read_data(named_file(text, found["edfile"])))
    if model == _BEAMDYN and "bdbldfile1" in found:
        main = read_data(named_file(text, found["bdbldfile1"]))
        blade = beamdyn_blade.read_main_file(main, rotor.hub_radius)
        kept = {name: getattr(rotor, name) for name in ("pitch", "precone", "speed")}
        mass = rotor.tip.get("mass", 0.0)  # OpenFAST ignores this mass if BeamDyn computes the blades
        ignored = (*blade.ignored, *ignore("TipMass(1)", mass, "kg", _NO_TIP_MASS))
        return replace(blade, sources=(text.path, rotor.sources[0], *blade.sources), ignored=ignored, **kept)
    reason = "OpenFAST computes these blades by another module; this is the blade in ElastoDyn's files"
    ignored = (*ignore("CompElast", model if model != _ELASTODYN else 0.0, "", reason), *rotor.ignored)
    return replace(rotor, sources=(text.path, *rotor.sources), ignored=ignored)


_KINDS = (
    "a blade file or the main file of ElastoDyn, FAST 7, OpenFAST or BeamDyn, a .bmi or section properties "
    "of BModes, or a CSV table with units in its headings"
)


@dataclass(frozen=True)
class Deck(Result):
    """A blade that was read from the input files (deck) of another program.

    Parameters
    ----------
    kind : str
        Kind of the files, such as "ElastoDyn blade file".
    title : str
        Title in the files.
    sources : tuple of str
        The files that were read.
    scene : Scene
        The blade on its hub, pointing outward; flap is out of the plane of rotation, edge is in the plane.
    ignored : tuple of IgnoredProperty
        Properties in the files that the scene cannot hold.

    Examples
    --------
    >>> deck = bd.read_deck("examples/blade_stations.csv", length=40.0, hub_radius=1.25)
    >>> deck.kind, deck.scene.beam.length
    ('CSV table', 40.0)
    """

    kind: str
    title: str
    sources: tuple[str, ...]
    scene: Scene
    ignored: tuple[IgnoredProperty, ...]
    tables: dict[str, Any] = field(repr=False)
    blade: Blade = field(repr=False)

    def headline(self) -> Iterator[str]:
        """Yield kind and title of the deck, and length of its blade, for the one-line summary.

        See `Result.headline`.
        """
        yield self.kind
        yield repr(self.title) if self.title else ""
        yield f"{number(self.scene.beam.length, 'm')} long"
        yield f"{counted(len(self.ignored), 'property', 'properties')} ignored" if self.ignored else ""

    @cached_property
    def audit(self) -> DeckAudit:
        """Return mass, moments, steep steps, and the mode shapes in the files compared with computed ones."""
        return audit(self.blade, self.scene)

    def fit_mode_polynomials(self, speed: float | None = None) -> tuple[ModePolynomial, ...]:
        """Fit polynomials to the mode shapes that a blade file of ElastoDyn states: flap 1, flap 2, edge 1.

        Each is a mode in one plane without twist, as ElastoDyn assumes.

        Parameters
        ----------
        speed : float, optional
            Rotational speed [rad/s]; by default the speed in the deck, or 0.

        Returns
        -------
        tuple of ModePolynomial
            Polynomials, each with its coefficients, its largest difference from the mode shape, and the
            frequency.

        Raises
        ------
        ValueError
            If the speed is not finite.
        """
        stated = self.blade.speed * math.pi / 30
        return fit_mode_polynomials(
            self.scene, stated if speed is None else moderate("speed", speed, "rad/s")
        )

    def scene_text(self) -> str:
        """Return the scene as TOML text, with a table of stations, and ignored properties as comments."""
        names = ", ".join(Path(source).name for source in self.sources)
        head = [f"{self.title or 'A blade'}", f"Read from {names} ({self.kind})."]
        if self.ignored:
            head += ["", "Not in this scene:", *(f"  {entry.sentence()}" for entry in self.ignored)]
        comments = {"": head, "beam": ["linear between stations; bending_stiffness is flapwise"]}
        if "second_bending_stiffness" in self.blade.columns:
            comments["beam"][0] += ", second_bending_stiffness edgewise"
            comments["beam"] += ["twist is added to the bending angle: minus the twist towards feather"]
        comments["mount"] = ["outward; flap is out of the plane of rotation where twist and pitch are 0"]
        if self.blade.pitch:
            comments["mount"] += [f"pitched by {self.blade.pitch:g} deg towards feather"]
        if self.blade.matrices is not None:
            comments["beam"] = [
                "rows and columns of the matrices: 1 along the axis, 2 upwind (flap), 3 across (edge)"
            ]
            comments["beam"] += ["K11 to K66 are stiffnesses, M11 to M66 masses, about the axis of the blade"]
        elif self.scene.physics.torsion:
            comments["beam"] += ["offsets are from the shear centre, on the axis of the beam"]
        elif "rotary_inertia" in self.blade.columns:
            comments["physics"] = ["rotary_inertia = true adds the rotary inertia of the sections"]
        return text_of(self.tables, comments)

    def write_scene(self, path: str | PathLike[str], force: bool = False) -> None:
        """Write the scene as a TOML file, which `beamdyn.load_scene` and the commands can read.

        Parameters
        ----------
        path : str or path-like
            File to write.
        force : bool
            Overwrite a file that exists.

        Raises
        ------
        FileExistsError
            If the file exists and `force` is not set.
        OSError
            If the file cannot be written.
        """
        write_text(check_writable(Path(path), force=force), self.scene_text())


def read_deck(
    path: str | PathLike[str], length: float | None = None, hub_radius: float | None = None
) -> Deck:
    """Read a blade of ElastoDyn, FAST 7, BeamDyn or BModes, or from a CSV table with units in its headings.

    Parameters
    ----------
    path : str or path-like
        The file; its kind is recognized by its content.  Files that it names are read, too.
    length : float, optional
        Length of the blade [m], if the file lacks it: a blade file without main file, section properties
        only, or a table with positions as fractions.
    hub_radius : float, optional
        Distance of the root from the axis of rotation [m], if the file lacks it.

    Returns
    -------
    Deck

    Raises
    ------
    ConfigError
        If a file cannot be read; the message names the file, the line, and what was expected.
    ValueError
        If `length` or `hub_radius` is invalid, or given although the files contain it.

    Examples
    --------
    >>> deck = bd.read_deck("examples/blade_stations.csv", length=40.0, hub_radius=1.25)
    >>> deck.scene.mount.radius  # m
    1.25
    """
    return read_deck_text(read_data(path), length, hub_radius)


def read_deck_text(text: DataText, length: float | None = None, hub_radius: float | None = None) -> Deck:
    """Read a blade from the text of a file; length and hub radius [m] are as for `read_deck`."""
    given = {
        "length": None if length is None else size("length", length, "m"),
        "hub_radius": None if hub_radius is None else not_negative("hub_radius", hub_radius, "m"),
    }
    blade = _read(text, given)
    tables = tables_of(blade)
    sources = tuple(str(source) for source in blade.sources)
    scene = scene_from_dict(tables, sources[0])
    return Deck(blade.kind, blade.title, sources, scene, blade.ignored, tables, blade)


def is_deck(text: DataText) -> bool:
    """Return whether a text is a blade file of a known kind."""
    known = any(len(named_values(text, names)) == len(names) for _, names, _, _ in _READERS)
    return known or is_csv(text)


def _read(text: DataText, given: dict[str, float | None]) -> Blade:
    """Read the blade from a file of any known program."""
    for read, names, remedy, wanted in _READERS:
        if len(named_values(text, names)) == len(names):
            needed = _needed(text, given, remedy, **{name: name in wanted for name in given})
            return read(text, *(needed[name] for name in wanted))
    if is_csv(text):
        table = read_station_file(text, _MORE)
        heads = table.named()
        remedy = "a column r [m], measured from the axis of rotation, gives length and hub radius"
        needed = _needed(text, given, remedy, length="x/L" in heads, hub_radius=RADIUS not in heads)
        return read_csv_blade(text, table, **needed)
    raise ConfigError(str(text.path), [f"it is none of the files that are read: expected {_KINDS}"])


_BOTH = ("length", "hub_radius")
# For each kind of file: the function that reads it, names that identify it, where to find the data that it
# lacks, and which of length and hub radius it lacks.
_READERS: tuple[tuple[Callable[..., Blade], set[str], str, tuple[str, ...]], ...] = (
    (elastodyn.read_blade_file, {"nblinpst"}, "the main file has TipRad and HubRad", _BOTH),
    (elastodyn.read_main_file, {"tiprad", "bldfile1"}, "", ()),
    (read_openfast_file, {"edfile"}, "", ()),
    (
        beamdyn_blade.read_main_file,
        {"kptotal", "bldfile"},
        "the OpenFAST file (.fst) says it",
        ("hub_radius",),
    ),
    (beamdyn_blade.read_blade_file, {"stationtotal"}, "the OpenFAST file (.fst) says both", _BOTH),
    (bmodes.read_main_file, {"secpropsfile"}, "", ()),
    (bmodes.read_section_file, {"nsecs"}, "the main file (.bmi) has both", _BOTH),
)


def _needed(
    text: DataText, given: dict[str, float | None], remedy: str, length: bool, hub_radius: bool
) -> dict[str, float]:
    """Return length and hub radius if the file lacks them; raise an error if one is missing or not needed."""
    needed = {"length": length, "hub_radius": hub_radius}
    for name, value in given.items():
        if value is not None and not needed[name]:
            raise InvalidValue(name, value, f"{text.path.name} already gives it", "leave it out", "m")
    if missing := [name for name in needed if needed[name] and given[name] is None]:
        words = {"length": "the length of the blade", "hub_radius": "the radius of the hub"}
        names, unsaid = " and ".join(missing), " nor ".join(words[name] for name in missing)
        options = " and ".join(f"--{name.replace('_', '-')}" for name in missing)
        said = f"{names}: missing; the file does not say {unsaid}: give {names} ({options}); {remedy}"
        raise ConfigError(str(text.path), [said])
    values = {name: given[name] if needed[name] else math.nan for name in needed}
    return {name: value for name, value in values.items() if value is not None}
