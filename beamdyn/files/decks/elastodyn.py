"""Blade files of the programs ElastoDyn and FAST, and the main files that name them.

The blade's axes are x downwind, y to the trailing edge, z from root to tip; the rotor turns about +x.
Positive structural twist and pitch turn the cross-section about -z, towards feather: the flap direction is
cos(twist) x - sin(twist) y.  In the axes of this package (docs/conventions.md) b1 = z, b2 = y, b3 = -x, and
the rotor turns about -n3.  The flap direction is the line cos(psi) b2 + sin(psi) b3, where
psi = 90 deg - twist - pitch.  The angle psi is the sum of bending angle and twist in this package; therefore
this twist is minus the twist in the file.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from beamdyn.common.edge import data_text
from beamdyn.files.decks.audit import SHAPE_NAMES
from beamdyn.files.decks.blade import (
    Blade,
    DeckColumn,
    IgnoredProperty,
    Stations,
    ignore,
    ignore_columns,
    read_stations,
)

COLUMNS = (
    DeckColumn("BlFract", "-", required=True),
    DeckColumn("StrcTwst", "deg", required=True),
    DeckColumn("BMassDen", "kg/m", required=True, positive=True),
    DeckColumn("FlpStff", "Nm^2", required=True, positive=True),
    DeckColumn("EdgStff", "Nm^2", required=True, positive=True),
    DeckColumn("PitchAxis", "-"),
    DeckColumn("AeroCent", "-"),
    DeckColumn("GJStff", "Nm^2"),
    DeckColumn("EAStff", "N"),
    DeckColumn("Alpha", "-"),
    DeckColumn("FlpIner", "kg m"),
    DeckColumn("EdgIner", "kg m"),
    *(
        DeckColumn(name, "m")
        for name in ("PrecrvRef", "PreswpRef", "FlpcgOf", "EdgcgOf", "FlpEAOf", "EdgEAOf")
    ),
)
_USED = ("BlFract", "StrcTwst", "BMassDen", "FlpStff", "EdgStff")
_UNUSED_SECOND = "PitchAxis", "AeroCent"
_UNREAD = "ElastoDyn does not use it either"
_REASONS = {
    "PitchAxis": "of aerodynamics",
    "AeroCent": "of aerodynamics",
    "GJStff": f"to include it, give torsion_stiffness in [beam], and both rotary inertias; {_UNREAD}",
    "EAStff": f"the blade is rigid along its axis; {_UNREAD}",
    "Alpha": f"no coupling of flap and torsion is modelled; {_UNREAD}",
    "PrecrvRef": f"the axis of the blade is straight; {_UNREAD}",
    "PreswpRef": f"the axis of the blade is straight; {_UNREAD}",
    **{name: f"to include it, give rotary_inertia in [beam]; {_UNREAD}" for name in ("FlpIner", "EdgIner")},
    **{
        name: f"[beam] has mass_offset and tension_offset, from the shear centre, instead; {_UNREAD}"
        for name in ("FlpcgOf", "EdgcgOf", "FlpEAOf", "EdgEAOf")
    },
}
_FACTORS = {"AdjBlMs": "BMassDen", "AdjFlSt": "FlpStff", "AdjEdSt": "EdgStff"}
_DAMPING = ("BldFlDmp(1)", "BldFlDmp(2)", "BldEdDmp(1)")
_TUNERS = ("FlStTunr(1)", "FlStTunr(2)")
_SHAPES = {mode: [f"{name}({power})" for power in range(2, 7)] for mode, name in SHAPE_NAMES.items()}
_BLADE_NAMES = {
    data_text.plain_name(name): name
    for name in (
        "NBlInpSt",
        *_DAMPING,
        *_TUNERS,
        *_FACTORS,
        *(n for names in _SHAPES.values() for n in names),
    )
}
_MAIN_NAMES = {
    data_text.plain_name(name): name
    for name in ("TipRad", "HubRad", "PreCone(1)", "TipMass(1)", "BldFile(1)")
}
_MAIN_MORE = {data_text.plain_name(name): name for name in ("BlPitch(1)", "RotSpeed")}


def read_main_file(text: data_text.DataText) -> Blade:
    """Read the first blade of a rotor from the main file, and from the blade file named there."""
    found = data_text.named_values(text, _MAIN_NAMES.keys() | _MAIN_MORE.keys())
    data_text.check_all_there(text, found, _MAIN_NAMES)
    values = {key: data_text.named_number(text, named) for key, named in found.items() if key != "bldfile1"}
    hub_radius, tip_radius = values["hubrad"], values["tiprad"]
    wanted = f"of 0 or more and below TipRad = {tip_radius:g}"
    data_text.check_named(text, found["hubrad"], 0 <= hub_radius < tip_radius, wanted)
    data_text.check_named(text, found["tipmass1"], values["tipmass1"] >= 0, "of 0 or more")
    data_text.check_named(text, found["precone1"], abs(values["precone1"]) < 90, "below 90 deg either way")
    blade = read_blade_file(
        data_text.read_data(named_file(text, found["bldfile1"])), tip_radius - hub_radius, hub_radius
    )
    return replace(
        blade,
        kind=f"main file and {blade.kind}",
        sources=(text.path, *blade.sources),
        tip={"mass": values["tipmass1"]} if values["tipmass1"] else {},
        pitch=values.get("blpitch1", 0.0),
        precone=values["precone1"],
        speed=values.get("rotspeed", 0.0),
    )


def named_file(text: data_text.DataText, named: data_text.NamedValue) -> Path:
    """Return the path of a file named in another file, relative to that file's folder; it must exist."""
    path = text.path.parent / named.word.replace("\\", "/")
    if not path.is_file():
        raise text.refusal(named.line, f"expected the file {named.name}, but there is none at {path}")
    return path


def read_blade_file(text: data_text.DataText, length: float, hub_radius: float) -> Blade:
    """Read a blade file.

    Parameters
    ----------
    text : DataText
        Text of the file.
    length, hub_radius : float
        Length of the blade, TipRad - HubRad, and radius of the hub, HubRad [m].

    Raises
    ------
    ConfigError
        If data are missing or invalid.
    """
    found = data_text.named_values(text, _BLADE_NAMES.keys())
    data_text.check_all_there(text, found, {"nblinpst": "NBlInpSt"})
    table = read_stations(text, COLUMNS, found["nblinpst"])
    data_text.check_all_there(text, found, _BLADE_NAMES)

    def numbers(*names: str) -> np.ndarray:
        return np.array([data_text.named_number(text, found[data_text.plain_name(name)]) for name in names])

    damping = numbers(*_DAMPING) / 100
    # Description of the file: its second line; in FAST 7, the line below two lines of dashes.
    plain = (line.strip() for line in text.lines[:4] if not line.startswith("--"))
    # Factor that the file states for each column; it must be positive.
    factors = {}
    for name, column in _FACTORS.items():
        named = found[data_text.plain_name(name)]
        factors[column] = data_text.named_number(text, named)
        data_text.check_named(text, named, factors[column] > 0, "above 0")
    return Blade(
        kind="ElastoDyn blade file",
        title=next(plain, ""),
        sources=(text.path,),
        length=length,
        hub_radius=hub_radius,
        stations=table.columns["BlFract"],
        columns=_properties(table, factors),
        damping=float(damping[0]) if np.ptp(damping) == 0 else 0.0,
        polynomials={mode: numbers(*names) for mode, names in _SHAPES.items()},
        ignored=(*_ignored_settings(damping, numbers(*_TUNERS)), *ignore_columns(table, _USED, _REASONS)),
        doubts=tuple(_doubt_order([*table.columns])),
    )


def _doubt_order(heads: Sequence[str]) -> Iterator[str]:
    """Yield a warning if column headings are in another order than the columns that ElastoDyn reads.

    The second column, which ElastoDyn does not use, was first AeroCent, later PitchAxis, and does not exist
    in newer versions.
    """
    second = [name for name in heads[1:2] if name in _UNUSED_SECOND]
    wanted = [_USED[0], *second, *_USED[1:]]
    if heads[: len(wanted)] != wanted:
        here = next(i for i, name in enumerate(wanted) if heads[i : i + 1] != [name])
        said = f"ElastoDyn ignores headings: it takes the values under {heads[here]} as {wanted[here]}"
        yield f"the headings are {', '.join(heads)}: {said}; expected {', '.join(wanted)}, then any others"


def _properties(table: Stations, factors: Mapping[str, float]) -> dict[str, np.ndarray]:
    adjusted = {name: factor * table.columns[name] for name, factor in factors.items()}
    return {
        "twist": -table.columns["StrcTwst"],
        "mass_per_length": adjusted["BMassDen"],
        "bending_stiffness": adjusted["FlpStff"],
        "second_bending_stiffness": adjusted["EdgStff"],
    }


def _ignored_settings(damping: np.ndarray, tuners: np.ndarray) -> tuple[IgnoredProperty, ...]:
    """Record damping, and stiffness tuners that are not 1, as ignored properties."""
    if np.ptp(damping) == 0:
        reason = f"natural frequencies are undamped; damping_ratio = {damping[0]:.9g} in [model] includes it"
    else:
        reason = "natural frequencies are undamped; a scene has one damping ratio for all modes"
    ignored = ignore(", ".join(_DAMPING), 100 * damping, "%", reason)
    if (tuners != 1).any():
        ignored += ignore(", ".join(_TUNERS), tuners, "", "they change the stiffness of single modes")
    return ignored
