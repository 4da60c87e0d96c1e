"""Tables of Campbell diagrams: crossings, margins and bounds, for reading and for CSV files."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.tables import set_apart, table
from beamdyn.common.results.columns import Column, Columns, columns_of_rows
from beamdyn.common.results.digits import supported
from beamdyn.equations.directions import first_drawn

if TYPE_CHECKING:
    from beamdyn.studies.campbell.crossings import LineCrossing
    from beamdyn.studies.campbell.diagram import Campbell

_RPM = 30 / np.pi  # in rad/s
_DIGITS = 10  # most digits of a speed or frequency
_NEAR = 1e-3  # relative distance of a frequency from its upper bound, which is close


def campbell_tables(result: Campbell) -> list[Group]:
    """Tables of the crossings, of the margins and of the bounds, those that there are."""
    tables = [_crossings_table(result)]
    if result.margins:
        tables.append(_margins_table(result))
    if result.bounds:
        tables.append(_bounds_table(result))
    return tables


def _crossings_table(result: Campbell) -> Group:
    (unit, factor), several = result.display_units.speed_unit(), len(result.labels) > 1
    rows = []
    for c, model_error in zip(result.crossings, _model_errors(result), strict=True):
        speed = supported(factor * c.speed, c.error * factor * c.speed, _DIGITS)
        rows.append(
            (
                *([c.label] if several else []),
                set_apart(speed, model_error * factor * c.speed),
                c.line.name,
                c.name,
                supported(c.frequency, c.error * c.frequency, _DIGITS),
                *_share(result, c),
                f"{c.confidence:.2f}",
                *([] if result.operating is None else ["yes" if c.operating else "no"]),
            )
        )
    number = f"{len(rows) or 'No'} crossing{'s' * (len(rows) != 1)}"
    top = f"{factor * result.loci[0].speeds[-1]:.6g} {unit}"
    title = f"{number} up to {top}, by {result.provenance.method}"
    heads = (
        *(["scene"] if several else []),
        f"speed [{unit}]",
        "line",
        "mode",
        "frequency [Hz]",
        *(["share of flap" if _has_flap(result) else "share of bending"] if _two_planes(result) else []),
        "tracking",
        *([] if result.operating is None else ["operating"]),
    )
    words = {"scene", "line", "mode", "operating"}
    shown = table(title, heads, rows, [i for i, head in enumerate(heads) if head in words])
    return Group(shown, Text(result.left_out_effects.sentence("crossing" if len(rows) > 1 else "")))


def _model_errors(result: Campbell) -> np.ndarray:
    """Relative model errors (k,) of the speeds of the crossings."""
    return result.model_error if result.crossings else np.zeros(0)


def _two_planes(result: Campbell) -> bool:
    return any(locus.scene.physics.planes == 2 for locus in result.loci)


def _has_flap(result: Campbell) -> bool:
    return any(name.startswith("flap") for names in result.names for name in names)


def _share(result: Campbell, crossing: LineCrossing) -> list[str]:
    """Share of flap, or else of the direction of bending, in the energy of a mode; none of one plane."""
    if not _two_planes(result):
        return []
    scene = result.loci[result.labels.index(crossing.label)].scene
    return [f"{crossing.plane_share[first_drawn(scene)]:.3f}" if scene.physics.planes == 2 else "-"]


def _margins_table(result: Campbell) -> Group:
    (unit, factor), several = result.display_units.speed_unit(), len(result.labels) > 1
    rows = [
        (
            *([m.label] if several else []),
            m.name,
            m.where,
            f"{factor * m.speed:.6g}",
            f"{m.frequency:.6g}",
            m.line.name,
            f"{100 * m.margin:+.1f} %" if m.margin else "crossed",
        )
        for m in result.margins
    ]
    heads = (
        *(["scene"] if several else []),
        "mode",
        "at",
        f"speed [{unit}]",
        "frequency [Hz]",
        "nearest line",
        "margin",
    )
    words = {"scene", "mode", "at", "nearest line"}
    title = "Margins: frequency of the nearest line over the natural frequency, less one"
    return table(title, heads, rows, [i for i, head in enumerate(heads) if head in words])


def _bounds_table(result: Campbell) -> Group:
    (unit, factor), several = result.display_units.speed_unit(), len(result.labels) > 1
    rows = []
    for label, found in result.bounds:
        for low, high, width in zip(found.lower, found.upper, found.width, strict=True):
            name, least, wide = _name_below(result, label, found.speed, high), f"{low:.10g}", f"{width:.0e}"
            known = [least, f"{high:.10g}", wide] if 0 < low <= high else ["-", f"{high:.10g}", "-"]
            rows.append((*([label] if several else []), name, *known))
    heads = *(["scene"] if several else []), "mode", "at least [Hz]", "at most [Hz]", "relative width"
    at = f"{factor * result.bounds[0][1].speed:.6g} {unit}"
    return table(f"Guaranteed bounds at {at}, of the model", heads, rows, range(len(heads) - 3))


def _name_below(result: Campbell, label: str, speed: float, high: float) -> str:
    """Name of the mode whose frequency at a speed is at an upper bound; "-" where none is near."""
    i = result.labels.index(label)
    locus = result.loci[i]
    distance = np.abs(locus.frequency[np.abs(locus.speeds - speed).argmin()] / high - 1)
    near = np.flatnonzero(distance < _NEAR)
    return result.names[i][near[distance[near].argmin()]] if near.size else "-"


def campbell_csv(result: Campbell) -> Columns:
    """Natural frequencies of all scenes over speed, one row a speed."""
    names = [
        f"{label}: {name}" if label else name
        for label, modes in zip(result.labels, result.names, strict=True)
        for name in modes
    ]
    speeds = result.loci[0].speeds
    frequency = np.concatenate([locus.frequency for locus in result.loci], axis=1)
    confidence = np.concatenate([locus.confidence for locus in result.loci], axis=1)
    return Columns(
        Column("speed", speeds, "rad/s"),
        Column("speed", speeds * _RPM, "rpm"),
        *(Column(f"{name} [Hz]", each) for name, each in zip(names, frequency.T, strict=True)),
        *(Column(f"{name}, confidence", each) for name, each in zip(names, confidence.T, strict=True)),
    )


def crossings_of_lines_csv(result: Campbell) -> Columns:
    """Crossings, one row each."""
    rows = (
        (c.label, c.line.name, c.line.multiple, c.mode, c.name, c.speed, c.speed * _RPM, c.frequency,
         c.error, c.confidence, *c.plane_share, c.operating)
        for c in result.crossings
    )  # fmt: skip
    heads = (
        "scene", "line", "multiple", "mode", "name", ("speed", "rad/s"), ("speed", "rpm"),
        ("frequency", "Hz"), "relative_error", "tracking_confidence", "share_bending", "share_across",
        "operating",
    )  # fmt: skip
    return columns_of_rows(heads, rows)
