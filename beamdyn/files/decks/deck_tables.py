"""Tables of a blade read from another program's file (deck), and of the audit of its data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType

from beamdyn.common.edge.console import table
from beamdyn.common.edge.views import View

if TYPE_CHECKING:
    from beamdyn.files.decks.audit import DeckAudit
    from beamdyn.files.decks.deck import Deck


def deck_tables(deck: Deck) -> list[RenderableType]:
    """Make the tables of a deck: title, size and audit of the blade, and ignored properties."""
    scene = deck.scene
    size = f"{scene.beam.length:.6g} m on a hub of {scene.mount.radius:.6g} m"
    parts = audit_tables(deck.audit, f"{deck.title or 'Blade'} ({deck.kind}), {size}")
    ignored = [(entry.name, entry.values, entry.reason) for entry in deck.ignored]
    if ignored:
        parts.append(table("Ignored", ("in the deck", "values", "because"), ignored, (0, 1, 2)))
    return parts


def audit_tables(audit: DeckAudit, title: str = "Audit of a blade") -> list[RenderableType]:
    """Make tables of mass and moments, of steep steps, and of mode shapes compared with computed ones."""
    parts: list[RenderableType] = [table(title, ("", "", ""), audit_rows(audit), (0, 2))]
    if audit.steps:
        heads = ("steep steps between stations", "x/L", "to x/L", "factor")
        steps = [(s.name, f"{s.start:g}", f"{s.end:g}", f"{s.factor:.4g}") for s in audit.steps]
        parts.append(table("", heads, steps))
    if audit.shapes:
        parts.append(_shape_table(audit))
    return parts


def audit_rows(audit: DeckAudit) -> Iterator[tuple[str, str, str]]:
    """Yield name, value and unit of a blade's number of stations, mass, moments and stiffness ratios."""
    yield "stations", f"{audit.stations}", "ascending from 0 to 1"
    yield "mass", f"{audit.mass:.8g}", "kg, linear between stations, without tip body"
    yield "centre of mass", f"{audit.centre:.8g}", "m from the root"
    yield "first moment", f"{audit.first_moment:.8g}", "kg m about the root"
    yield "second moment", f"{audit.second_moment:.8g}", "kg m2 about the root"
    yield "", f"{audit.hub_second_moment:.8g}", "kg m2 about the axis of rotation"
    for plane, ratio in zip(("flap", "edge"), audit.stiffness_ratios, strict=False):
        yield f"{plane} stiffness", f"{ratio:.3g}", "smallest over largest"


def _shape_table(audit: DeckAudit) -> RenderableType:
    rpm = audit.shape_speed * 9.549296585513721
    speed = f"at {rpm:.4g} rpm" if audit.shape_speed else "at rest"
    heads = ("mode", "sum of coefficients", "largest difference", "at x/L", "computed frequency [Hz]")
    rows = [
        (s.mode, f"{s.coefficient_sum:.6f}", f"{s.difference:.4f}", f"{s.place:.3f}", f"{s.frequency:.5g}")
        for s in audit.shapes
    ]
    title = f"Mode shapes of the deck and those computed without twist, {speed}; tip deflection 1"
    return table(title, heads, rows)


VIEWS = {
    "Deck": View(lambda deck: Group(*deck_tables(deck))),
    "DeckAudit": View(lambda audit: Group(*audit_tables(audit))),
}
