"""Stations of a beam in CSV files: columns by the keys of the beam, or by the heads of other programs."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import Any

from beamdyn.common.edge.csv_columns import CsvTable, check_places, read_csv
from beamdyn.common.edge.data_text import DataText, named_file, plain_name, read_data
from beamdyn.common.edge.inputs import Quantity
from beamdyn.files.scene_inputs import PLACES, VARYING

RADIUS = "r"  # in CSV files: distance from the axis of rotation
# Heads of CSV files, beside the keys of the beam.
_HEADS = {
    "x/L": ("span", "blfract", "sec_loc", "span_loc"),
    "mass_per_length": ("mass", "mass per metre", "BMassDen", "mass_den"),
    "bending_stiffness": ("EI", "EI flap", "flap EI", "flap stiffness", "FlpStff", "flp_stff"),
    "second_bending_stiffness": ("EI edge", "edge EI", "edge stiffness", "EI lag", "EdgStff", "edge_stff"),
    "axial_stiffness": ("EA", "axial_stff"),
}
_STATION_NAMES = {plain_name(name): name for name in [*PLACES, *VARYING]}
_STATION_NAMES |= {plain_name(head): name for name, heads in _HEADS.items() for head in heads}


def read_station_file(text: DataText, more: Mapping[str, Quantity] | None = None) -> CsvTable:
    """Read stations from a CSV file: its columns by the keys of the beam, checked to ascend.

    Parameters
    ----------
    text : DataText
        The file.
    more : mapping, optional
        Further places or properties, by name.

    Raises
    ------
    ConfigError
        At the first mistake: names file, line, and what was expected.
    """
    known = PLACES | VARYING | dict(more or {})
    table = read_csv(text, known, _STATION_NAMES | {plain_name(name): name for name in more or ()})
    places = [name for name in table.named() if name in PLACES or name == RADIUS]
    if len(places) != 1:
        wanted = "x/L, x [m] or r [m]" if more else "x/L or x [m]"
        found = ", ".join(column.head for column in table.columns)
        said = f"expected one column of positions, {wanted}; the heads are {found}"
        raise text.refusal(table.head_line, said)
    check_places(table, places[0])
    return table


def with_station_file(data: dict[str, Any], path: str | PathLike[str]) -> dict[str, Any]:
    """The tables of a scene with the rows of the CSV file that `beam.stations` names, if it names one."""
    beam = data.get("beam")
    if not isinstance(beam, dict) or not isinstance(beam.get("stations"), str):
        return data
    table = read_station_file(read_data(named_file(path, "beam.stations", beam["stations"])))
    if unknown := next((column.head for column in table.columns if not column.name), ""):
        known = ", ".join([*PLACES, *VARYING])
        raise table.text.refusal(table.head_line, f"unknown column '{unknown}'; known are {known}")
    units = {name: (PLACES | VARYING)[name].unit for name in table.named()}
    heads = [f"{name} [{unit}]" if unit else name for name, unit in units.items()]
    rows = [list(row) for row in zip(*(column.values for column in table.columns), strict=True)]
    return data | {"beam": beam | {"stations": [heads, *rows]}}
