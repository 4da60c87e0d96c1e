"""Blades of the program BModes: its main file (.bmi) with the section properties, or only the properties.

As in ElastoDyn, z points from root to tip, x downwind and y to the trailing edge; positive twist and pitch
turn the cross-section about -z.  BModes itself changes the signs of angles and of offsets along y, because it
computes in the axes of a helicopter blade (y to the leading edge, nose-up positive).  An offset along y is
therefore minus the offset in the edgewise direction of this package.

Offsets in BModes files are measured from the reference axis; moments of inertia are about the centre of mass,
as the programs that make such files write them.  In this package the axis of a blade is the line of shear
centres, and offsets are converted accordingly.  BModes uses bending stiffnesses about the shear centre; they
exceed the stiffnesses about the tension centre by E A e^2, where e is the distance of the two centres.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from beamdyn.common.edge import data_text
from beamdyn.files.decks.blade import (
    Blade,
    DeckColumn,
    IgnoredProperty,
    Stations,
    ignore,
    ignore_columns,
    read_stations,
)
from beamdyn.files.decks.elastodyn import named_file

COLUMNS = (
    DeckColumn("sec_loc", "-", required=True),
    DeckColumn("str_tw", "deg", required=True),
    DeckColumn("tw_iner", "deg", required=True),
    DeckColumn("mass_den", "kg/m", required=True, positive=True),
    DeckColumn("flp_iner", "kg-m", required=True),
    DeckColumn("edge_iner", "kg-m", required=True),
    DeckColumn("flp_stff", "Nm^2", required=True, positive=True),
    DeckColumn("edge_stff", "Nm^2", required=True, positive=True),
    DeckColumn("tor_stff", "Nm^2", required=True),
    DeckColumn("axial_stff", "N", required=True),
    DeckColumn("cg_offst", "m", required=True),
    DeckColumn("sc_offst", "m", required=True),
    DeckColumn("tc_offst", "m", required=True),
)
_OFFSETS = ("cg_offst", "sc_offst", "tc_offst")
_NO_TORSION = "offsets act in torsion, which needs tor_stff, flp_iner and edge_iner above 0"
_REASONS: dict[str, str] = dict.fromkeys(_OFFSETS, _NO_TORSION)
_USED = ("sec_loc", "str_tw", "tw_iner", "mass_den", "flp_iner", "edge_iner", "flp_stff", "edge_stff")
_USED = (*_USED, "tor_stff", "axial_stff", "span_loc")
# Column and multiplier in the file for each argument of Beam.from_stiffness.
_PROPERTIES = {
    "mass_per_length": ("mass_den", "sec_mass_mult"),
    "bending_stiffness": ("flp_stff", "flp_stff_mult"),
    "second_bending_stiffness": ("edge_stff", "edge_stff_mult"),
    "torsion_stiffness": ("tor_stff", "tor_stff_mult"),
    "axial_stiffness": ("axial_stff", "axial_stff_mult"),
    "rotary_inertia": ("flp_iner", "flp_iner_mult"),
    "second_rotary_inertia": ("edge_iner", "lag_iner_mult"),
}
_TIP = ("tip_mass", "cm_loc", "ixx_tip", "iyy_tip", "izz_tip", "ixy_tip", "izx_tip", "iyz_tip")
_NEEDED = ("beam_type", "radius", "hub_rad", "precone", "bl_thp", "hub_conn", *_TIP, "sec_props_file")
_NEEDED = (*_NEEDED, *(multiplier for _, multiplier in _PROPERTIES.values()))
_MAIN_NAMES = {data_text.plain_name(name): name for name in _NEEDED}
_OF_OFFSETS = tuple(data_text.plain_name(f"{name}_mult") for name in _OFFSETS)
# Names that only some versions of BModes have: version 3 has an axial offset, and another name for the speed.
_MAIN_MORE = ("cmaxial", "rotrpm", "rpmmult", "romg", "romgmult", *_OF_OFFSETS)


def read_main_file(text: data_text.DataText) -> Blade:
    """Read the main file and the file of section properties named there."""
    found = data_text.named_values(text, {*_MAIN_NAMES, *_MAIN_MORE})
    data_text.check_all_there(text, found, _MAIN_NAMES)
    values = {
        name: data_text.named_number(text, named) for name, named in found.items() if name != "secpropsfile"
    }

    # Raise an error about the value of `key` unless it is good: only cantilevered blades are read.
    def check(key: str, good: bool, wanted: str) -> None:
        data_text.check_named(text, found[key], good, wanted)

    check("beamtype", values["beamtype"] == 1, "= 1, a blade (towers are not read)")
    check("hubconn", values["hubconn"] == 1, "= 1, a cantilever (other roots are not read)")
    check("hubrad", values["hubrad"] >= 0, "of 0 or more")
    check("radius", values["radius"] > values["hubrad"], f"above hub_rad = {values['hubrad']:g}")
    check("tipmass", values["tipmass"] >= 0, "of 0 or more")
    check("precone", abs(values["precone"]) < 90, "below 90 deg either way")
    for _, multiplier in _PROPERTIES.values():
        key = data_text.plain_name(multiplier)
        check(key, values[key] > 0, "above 0")
    multipliers = {name: values[data_text.plain_name(name)] for _, name in _PROPERTIES.values()}
    multipliers |= {
        f"{name}_mult": values.get(key, 1.0) for name, key in zip(_OFFSETS, _OF_OFFSETS, strict=True)
    }
    sections = data_text.read_data(named_file(text, found["secpropsfile"]))
    hub_radius = values["hubrad"]
    blade, axis = _read_sections(sections, values["radius"] - hub_radius, hub_radius, multipliers)
    tip, left_out = _tip_body(values, axis)
    # Rotational speed [rpm].
    speed = values.get("rotrpm", values.get("romg", 0.0))
    return replace(
        blade,
        kind="BModes main file with section properties",
        title=text.lines[1].strip() if len(text.lines) > 1 else "",
        sources=(text.path, *blade.sources),
        tip=tip,
        pitch=values["blthp"],
        speed=speed * values.get("rpmmult", values.get("romgmult", 1.0)),
        precone=values["precone"],
        ignored=(*left_out, *blade.ignored),
    )


def _tip_body(
    values: dict[str, float], axis: float | None
) -> tuple[dict[str, float], tuple[IgnoredProperty, ...]]:
    """Return arguments of `TipMass`, and a record of the data that they cannot hold.

    In BModes, moments of inertia are about the centre of gravity: x for lag, y for flap, z for torsion.
    """
    flap, lag, torsion = (values[f"i{2 * axis}tip"] for axis in "yxz")
    tip = {"mass": values["tipmass"], "offset": values.get("cmaxial", 0.0)}
    left_out: tuple[IgnoredProperty, ...] = ()
    if axis is not None:  # offset along y from the shear centre at the tip, if torsion is modelled
        tip["offset_across"] = axis - values["cmloc"] if tip["mass"] else 0.0
    else:
        left_out += ignore("cm_loc", values["cmloc"], "m", _NO_TORSION)
    reason = "the axes of the tip body are those of its section"
    left_out += ignore(
        "ixy_tip, izx_tip, iyz_tip", [values[f"{i}tip"] for i in ("ixy", "izx", "iyz")], "kg-m^2", reason
    )
    if 2 * max(flap, lag, torsion) > (flap + lag + torsion) * (1 + 1e-12) or min(flap, lag, torsion) < 0:
        reason = "no rigid body has such moments: each is at most the sum of the other two"
        left_out += ignore("ixx_tip, iyy_tip, izz_tip", [lag, flap, torsion], "kg-m^2", reason)
    else:
        tip |= {"inertia": flap, "transverse_inertia": lag, "axial_inertia": torsion}
    return (tip if any(tip.values()) else {}), left_out


def read_section_file(
    text: data_text.DataText, length: float, hub_radius: float, multipliers: dict[str, float] | None = None
) -> Blade:
    """Read a file of section properties.

    Parameters
    ----------
    text : DataText
        Text of the file.
    length, hub_radius : float
        Length of the blade and radius of the hub [m].
    multipliers : dict of float, optional
        Multipliers in the main file, by name; 1 if not given.

    Raises
    ------
    ConfigError
        If data are missing or invalid.
    """
    return _read_sections(text, length, hub_radius, multipliers or {})[0]


def _read_sections(
    text: data_text.DataText, length: float, hub_radius: float, multipliers: dict[str, float]
) -> tuple[Blade, float | None]:
    """Read the blade, and the position of the shear centre at the tip along y [m]; None without torsion."""
    found = data_text.named_values(text, {"nsecs"})
    data_text.check_all_there(text, found, {"nsecs": "n_secs"})
    table = read_stations(text, _columns(text), found["nsecs"])
    columns, left_out = _properties(table, multipliers)
    has_torsion = {"torsion_stiffness", "rotary_inertia"} <= columns.keys()
    offsets = {name: multipliers.get(f"{name}_mult", 1.0) * table.columns[name] for name in _OFFSETS}
    if has_torsion:
        columns |= _from_shear_centre(text, table, columns, *offsets.values())
    blade = Blade(
        kind="BModes section properties",
        title=text.lines[0].strip(),
        sources=(text.path,),
        length=length,
        hub_radius=hub_radius,
        stations=table.columns[_columns(text)[0].name],
        columns=columns,
        ignored=(*left_out, *ignore_columns(table, (*_USED, *_OFFSETS * has_torsion), _REASONS)),
    )
    return blade, float(offsets["sc_offst"][-1]) if has_torsion else None


def _from_shear_centre(
    text: data_text.DataText, table: Stations, columns: dict[str, np.ndarray], *offsets: np.ndarray
) -> dict[str, np.ndarray]:
    """Return the columns that `convert_offsets` computes; raise an error if a stiffness becomes 0 or less."""
    edge = columns["second_bending_stiffness"]
    axial = columns.get("axial_stiffness", np.zeros_like(edge))
    converted = convert_offsets(edge, axial, *offsets)
    if (bad := np.flatnonzero(converted["second_bending_stiffness"] <= 0)).size:
        k, more = bad[0], axial * converted["tension_offset"] ** 2
        least = f"axial_stff (tc_offst - sc_offst)^2 = {more[k]:g} Nm^2 at this station"
        raise text.refusal(table.lines[k], f"expected edge_stff above {least}, found {edge[k]:g} Nm^2")
    return converted


def convert_offsets(
    edge: np.ndarray, axial: np.ndarray, mass: np.ndarray, shear: np.ndarray, tension: np.ndarray
) -> dict[str, np.ndarray]:
    """Convert positions of cross-section centres to offsets from the shear centre, by name in `Beam`.

    The edgewise bending stiffness is converted from the shear centre to the tension centre.

    Parameters
    ----------
    edge, axial : ndarray, shape (n,)
        Edgewise bending stiffness about the shear centre [N m2], and axial stiffness [N].
    mass, shear, tension : ndarray, shape (n,)
        Positions of the mass, shear and tension centre along y, from the reference axis [m].
    """
    return {
        "second_bending_stiffness": edge - axial * (tension - shear) ** 2,
        "mass_offset": shear - mass,
        "tension_offset": shear - tension,
    }


def _columns(text: data_text.DataText) -> tuple[DeckColumn, ...]:
    """Return the columns of BModes files; the first one is sec_loc, or span_loc in older files."""
    firsts = {
        data_text.plain_name(word) for line in range(1, len(text.lines) + 1) for word in text.words(line)[:1]
    }
    return (replace(COLUMNS[0], name="span_loc"), *COLUMNS[1:]) if "spanloc" in firsts else COLUMNS


def _properties(
    table: Stations, multipliers: dict[str, float]
) -> tuple[dict[str, np.ndarray], tuple[IgnoredProperty, ...]]:
    """Return the properties of the beam, and a record of the data that they cannot hold."""
    given = {
        name: multipliers.get(multiplier, 1.0) * table.columns[column]
        for name, (column, multiplier) in _PROPERTIES.items()
    }
    left_out: tuple[IgnoredProperty, ...] = ()
    alone = ("torsion_stiffness",), ("axial_stiffness",), ("rotary_inertia", "second_rotary_inertia")
    for names in alone:
        if min(given[name].min() for name in names) <= 0:
            for name in names:
                column = _PROPERTIES[name][0]
                left_out += ignore(
                    column, given.pop(name), table.units[column], "not above 0 at every station"
                )
    apart = table.columns["tw_iner"] - table.columns["str_tw"]
    left_out += ignore("tw_iner - str_tw", apart, "deg", "inertia has the axes of stiffness")
    return {"twist": -table.columns["str_tw"], **given}, left_out
