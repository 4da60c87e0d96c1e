"""The page of the validation manual that lists the sources of published values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from beamdyn import published
from benchmarks.rows import markdown_table
from brakes import published as published_brakes

_CITED = (  # sources that the data files name by short names
    (
        "Hodges and Rutkowski (1981)",
        "Free-vibration analysis of rotating beams by a variable-order finite-element method. "
        "AIAA Journal 19, 1459-1466",
        "rotating_beams",
    ),
    (
        "Carnegie (1959)",
        "Vibrations of pre-twisted cantilever blading. Proceedings of the Institution of Mechanical "
        "Engineers 173, 343-374",
        "twisted_beams",
    ),
    (
        "Kane, Ryan and Banerjee (1987)",
        "Dynamics of a cantilever beam attached to a moving base. Journal of Guidance, Control, "
        "and Dynamics 10, 139-151",
        "rotating_beams",
    ),
    (
        "Simo and Vu-Quoc (1986)",
        "On the dynamics of flexible beams under large overall motions, the plane case. Journal of "
        "Applied Mechanics 53, 849-863",
        "rotating_beams",
    ),
    (
        "Wright, Smith, Thresher and Wang (1982)",
        "Vibration modes of centrifugally stiffened beams. Journal of Applied Mechanics 49, 197-202",
        "rotating_beams",
    ),
    (
        "Yoo and Shin (1998)",
        "Vibration analysis of rotating cantilever beams. Journal of Sound and Vibration 212, 807-828",
        "rotating_beams",
    ),
)
_HEAD = """# Sources

Papers, manuals and decks whose numbers stand in this manual, and the file that has them, with what it took
over and from where, in `beamdyn/published` or `brakes/published`. Textbooks are named beside their examples.
Numbers that are "computed" are in no print: the file says by which methods, of which at least two agree.

"""


def page_of_sources() -> str:
    """Write the page, in Markdown."""
    return _HEAD + markdown_table(("who", "what", "file"), sorted(_rows()))


def _rows() -> Iterator[tuple[str, str, str]]:
    for module in (published, published_brakes):
        for name in module.available():
            data = module.load(name)
            if "title" in data:
                yield _who(data), _what(data), f"`{name}.toml`"
    for who, what, name in _CITED:
        yield who, what, f"`{name}.toml`"


def _who(data: dict[str, Any]) -> str:
    """Return authors and year of a source, or a text saying that it has no author."""
    authors = data.get("authors", [])
    *others, last = authors or ["without an author"]
    names = f"{', '.join(others)} and {last}" if others else last
    return f"{names} ({data['year']})" if "year" in data else names


def _what(data: dict[str, Any]) -> str:
    """Return title and publication of a source."""
    places = [str(data[key]) for key in ("journal", "source", "url") if key in data]
    places += [f"doi:{data['doi']}"] if "doi" in data else []
    return "; ".join([data["title"], *places])
