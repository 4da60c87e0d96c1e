"""Which errors each analysis states, in place of ``<!-- errors of analyses -->``: read from the code."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from typing import Any

import beamdyn as bd
from beamdyn.modes.model_error.left_out_effects import StatesModelError
from beamdyn.modes.repeated import JudgedByRepeating

MARK = "<!-- errors of analyses -->"
ANALYSES = (
    *("natural_modes", "frequency_locus", "critical_point", "setting_angle_limits", "resonance_speeds"),
    *("campbell", "equilibrium", "backbone", "simulate", "sweep", "steady_response", "static_loads"),
    *("harvest", "best_resistance", "transient_harvest"),
    *("transient_loads", "steady_loads", "random_loads", "count_cycles", "frequency_response"),
    *("random_response", "matrices", "state_space", "frequency_sensitivities"),
    *("critical_speed_sensitivities", "crossing_sensitivities", "spread", "study"),
)
# Errors of a result that stand in its parts.
IN_PARTS = {
    "campbell": "`error` of each crossing and locus",
    "resonance_speeds": "`error` of each crossing",
}
# Cells that have no meaning of their own, and why.
ELSEWHERE = {
    ("transient_loads", "tolerance"): "that of its transient",
    ("steady_loads", "tolerance"): "that of its response",
    ("count_cycles", "tolerance"): "that of its transient",
    ("transient_harvest", "tolerance"): "that of its transient",
}
_OF_MODEL = {"model_error", "error_of", "growth_rate_error"}


def result_of(name: str) -> type:
    """Class of the result of an analysis."""
    function: Callable[..., Any] = inspect.unwrap(getattr(bd, name))
    return function.__globals__[str(function.__annotations__["return"])]


def numerical_error(name: str) -> str:
    """Names of the numerical errors of a result; empty if it has none."""
    kind = result_of(name)
    if name in IN_PARTS:
        return IN_PARTS[name]
    named = (*getattr(kind, "__dataclass_fields__", kind.__annotations__), *vars(kind))
    own = (each for each in named if each.endswith("error") and each not in _OF_MODEL)
    return ", ".join(f"`{each}`" for each in dict.fromkeys(own))


def model_error(name: str) -> str:
    """Of which values the model error is stated; empty if of none."""
    kind = result_of(name)
    if issubclass(kind, JudgedByRepeating):
        return _first(kind.judged).partition(", of which")[0].partition(": shape")[0]
    if issubclass(kind, StatesModelError) or hasattr(kind, "left_out_effects"):
        said = _first(kind.left_out_effects.func)
        return said.removeprefix("changes of ").partition(" by effects")[0].partition(" by the effects")[0]
    return ""


def tolerance(name: str) -> str:
    """The default tolerance of an analysis, or that it is none; empty if it takes none."""
    given = inspect.signature(getattr(bd, name)).parameters.get("tolerance")
    if given is None:
        return ELSEWHERE.get((name, "tolerance"), "")
    return "optional" if given.default is None else f"{given.default:g} by default"


def table() -> Iterator[str]:
    """Rows of the table in Markdown."""
    yield "| analysis | numerical error | model error of | `tolerance=` |"
    yield "|---|---|---|---|"
    for name in ANALYSES:
        yield f"| `{name}` | {numerical_error(name)} | {model_error(name)} | {tolerance(name)} |"


def _first(function: Any) -> str:
    text = (inspect.getdoc(function) or "").partition("\n")[0].rstrip(".")
    return text[:1].lower() + text[1:]


def write(app, docname: str, source: list[str]) -> None:
    if MARK in source[0]:
        source[0] = source[0].replace(MARK, "\n".join(table()))


def setup(app) -> dict[str, bool]:
    app.connect("source-read", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    print(*table(), sep="\n")
