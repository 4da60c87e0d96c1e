"""What each analysis asks, its options and examples, in place of ``<!-- analyses -->``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import is_dataclass
from inspect import Parameter

from beamdyn.analyses import analyses
from beamdyn.analyses.analysis import Analysis

MARK = "<!-- analyses -->"


def page() -> str:
    """A section for each analysis, in Markdown."""
    return "\n\n".join("\n".join(_section(analysis)) for analysis in analyses().values())


def _section(analysis: Analysis) -> Iterator[str]:
    yield f"### `beamdyn {analysis.name}`\n\n{analysis.question} {analysis.about_scene}\n"
    if analysis.screen:
        yield f"In the browser it is the screen *{analysis.screen}*.\n"
    yield from (f"    {example}\n" for example in analysis.examples)
    yield "| option | meaning | default |\n|---|---|---|"
    for name, option in analysis.shown.items():
        if not is_dataclass(option.default):
            default = "**required**" if option.default is Parameter.empty else option.default
            said = " ".join(analysis.meaning(name).split()).replace("|", "\\|")
            yield f"| `--{name.replace('_', '-')}` | {said} | {'' if default in (None, ()) else default} |"


def write(app, docname: str, source: list[str]) -> None:
    source[0] = source[0].replace(MARK, page())


def setup(app) -> dict[str, bool]:
    app.connect("source-read", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    print(page())
