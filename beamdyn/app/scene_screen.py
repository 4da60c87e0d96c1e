"""Parts shared by the screens of a scene: making screens, the choice of physics, neglected effects."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import RenderableType

from beamdyn.analyses.results.cautions import describe_choice, notes_of, warnings_of
from beamdyn.app.drawings import sketch
from beamdyn.app.scene_form import DRAGS, EFFORT, PRESETS, SCENE_TABLES
from beamdyn.common.edge.console import table
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.views import rows_of, tables_of
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.results.columns import ShownUnit
from beamdyn.common.results.one_line import number
from beamdyn.common.results.pictures import new_figure
from beamdyn.common.results.result import Result
from beamdyn.common.results.statements import joined
from beamdyn.common.screens.screens import Screen
from beamdyn.modes.model_error import left_out_effects

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Relative change below which no bar is drawn; bar lengths grow with the logarithm of the change.
_LEAST = 1e-6
_DECADE = 3  # characters of a bar for each decade of the change above `_LEAST`
_LONGEST = 7  # longest bar, in decades of the change
_BAR = "\u2588"
_HEADLINES = 3  # largest number of parts of a result's one-line summary that a screen shows


def scene_screen(
    name: str,
    purpose: str,
    solve: Callable[[Mapping[str, Any]], Any],
    beside: Sequence[str] = ("options",),
    result: Callable[[Any], Result] = lambda answer: answer,
    left_out_of: str = "",
    **special: Any,
) -> Screen:
    """Make a screen for a scene, which shows a result in the same way as its command.

    Parameters
    ----------
    name, purpose, solve
        As for `Screen`.
    beside : sequence of str
        Further tables of the form, after the first two tables of the scene.
    result : callable
        ``result(answer)`` returns the part of the computed answer that is shown; by default the answer
        itself.
    left_out_of : str
        Quantities that neglected effects would change, such as "frequencies"; empty if the screen does not
        list the effects.
    **special
        Further arguments of `Screen`.
    """
    tables = (*SCENE_TABLES[:2], *beside, *SCENE_TABLES[2:])

    def shown(answer: Any) -> Sequence[RenderableType]:
        found = result(answer)
        tables = tables_with_choice(found)
        if left_out_of and isinstance(found, left_out_effects.StatesModelError):
            tables.append(left_out_table(found.left_out_effects, left_out_of))
        return tables

    usual: dict[str, Any] = {
        "tables": shown,
        "draw": lambda answer, _=0.0: drawn(result(answer)),
        "notes": lambda answer: warnings_of(result(answer)),
        "rows": lambda answer: rows_of(result(answer)),
        "drags": DRAGS,
        "presets": PRESETS,
        "effort": EFFORT,
        "sketch": sketch,
    }
    return Screen(name, purpose, tables, tables, solve, **usual | special)


def tables_with_choice(result: Result) -> list[RenderableType]:
    """Return the tables of a result, with the sentence on how its physical effects were chosen."""
    return [tables_of(result), *describe_choice(result)]


def drawn(result: Result) -> Figure:
    """Draw the picture of a result, with its notes below."""
    figure = new_figure(9.0, 5.4)
    result.plot(figure.subplots())  # pyright: ignore[reportAttributeAccessIssue]  (results with a picture)
    return note_below(figure, notes_of(result))


def brief(value: float, unit: ShownUnit) -> str:
    """Format a value in SI units with few digits, in its display unit."""
    return number(unit.of(value), unit.name)


# Neglected effects ------------------------------------------------------------------------------------


def left_out_table(effects: left_out_effects.LeftOutEffects, of: str) -> RenderableType:
    """Make a table of the effects that a model neglects, the largest first, with a bar for each.

    Parameters
    ----------
    effects : LeftOutEffects
        Sizes of the neglected effects.
    of : str
        Quantities that the neglected effects would change, such as "frequencies".
    """
    sizes: dict[str, float] = {}
    for name, change in effects.changes.items():
        known = np.asarray(change)[np.isfinite(change)]
        if known.size:
            sizes[name] = float(known[np.abs(known).argmax()])  # the change of largest magnitude
    rows = []
    for name in sorted(sizes, key=lambda name: -abs(sizes[name])):
        how = joined("; ", filter(None, (effects.reasons.get(name, ""), effects.assumed.get(name, ""))))
        rows.append((name, left_out_effects.say_change(sizes[name]), bar(sizes[name]), in_files(how)))
    unknown = ((name, why) for name, why in effects.not_known.items() if name not in sizes)
    rows += [(name, "not known", "", in_files(why)) for name, why in unknown]
    of_kind = {mode.kind: mode.effect for mode in effects.unlisted}
    rows += [
        (f"modes: {kind}", span, "", in_files(effects.reasons.get(of_kind[kind], "")))
        for kind, span in left_out_effects.spans_by_kind(effects.unlisted).items()
    ]
    rows += [
        (name, "not modelled", "", in_files(effects.reasons.get(name, ""))) for name in effects.not_modelled
    ]
    heads = "left out", "largest change", "size, logarithmic", "how to include it"
    return table(f"Effects left out, and by how much each would change the {of}", heads, rows, (0, 2, 3))


def bar(change: float) -> str:
    """Return a bar of block characters, three for each decade of a change above 1e-6."""
    decades = np.log10(abs(change) / _LEAST) if change else 0.0
    return _BAR * int(np.ceil(_DECADE * min(max(decades, 0.0), _LONGEST)))
