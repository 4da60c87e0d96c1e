"""What the physics leaves out, as a table with bars."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rich.console import RenderableType

from beamdyn.common.edge.file_words import as_in_files
from beamdyn.common.edge.tables import table
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, say_change

_LEAST = 1e-6  # relative change with the shortest bar; each decade is as long
_DECADE = 3  # letters of a bar for a decade
_LONGEST = 7  # decades
_BAR = "\u2588"


def left_out_table(effects: LeftOutEffects, of: str) -> RenderableType:
    """Table of the effects that a model leaves out, the largest first, with a bar for each.

    Parameters
    ----------
    effects : LeftOutEffects
        The effects.
    of : str
        Name of the numbers that they change, such as "frequencies".
    """
    sizes = {name: _largest(change) for name, change in effects.changes.items()}
    known = sorted((n for n in sizes if np.isfinite(sizes[n])), key=lambda name: -abs(sizes[name]))
    rows = [(name, say_change(sizes[name]), bar(sizes[name]), _how(effects, name)) for name in known]
    rows += [
        (name, "not known", "", as_in_files(why))
        for name, why in effects.not_known.items()
        if name not in known
    ]
    rows += [(name, "not modelled", "", "no model here has it") for name in effects.not_modelled]
    heads = "left out", "largest change", "size, logarithmic", "how to include it"
    return table(f"What the physics leaves out, and by how much it changes the {of}", heads, rows, (0, 2, 3))


def bar(change: float) -> str:
    """A bar as long as the decades of a change above 1e-6."""
    decades = np.log10(abs(change) / _LEAST) if change else 0.0
    return _BAR * int(np.ceil(_DECADE * min(max(decades, 0.0), _LONGEST)))


def _largest(change: np.ndarray) -> float:
    """The change of the largest size among those known."""
    known = np.asarray(change)[np.isfinite(change)]
    return float(known[np.abs(known).argmax()]) if known.size else np.nan


def _how(effects: LeftOutEffects, name: str) -> str:
    said: Iterator[str] = filter(None, (effects.reasons.get(name, ""), effects.assumed.get(name, "")))
    return as_in_files("; ".join(said))
