"""Options of commands that vary inputs: which, how they are combined, and how the designs are computed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter, Token

from beamdyn.common.edge.outputs import Flag

if TYPE_CHECKING:
    from beamdyn.common.parallel.tasks import TaskRunner

OPTION = "--vary"
_MOST_WORKERS = 128


def folder(_: object, tokens: Sequence[Token]) -> Path:
    """Convert the name of a folder, and refuse an empty one, which would be the current folder."""
    if not tokens[0].value.strip():
        raise ValueError("the name is empty; give a folder, or leave the option out.")
    return Path(tokens[0].value)


Folder = Annotated[Path | None, Parameter(converter=folder)]
SomeFolder = Annotated[Path, Parameter(converter=folder)]  # folder of an option that has one by default


def _check_workers(_: object, value: object) -> None:
    if isinstance(value, int) and value > _MOST_WORKERS:
        raise ValueError(f"Give at most {_MOST_WORKERS}.")


@Parameter(name="*")
@dataclass(frozen=True)
class VaryOptions:
    """Inputs that are varied, and how the designs are computed.

    Parameters
    ----------
    vary : tuple of str
        An input and its values: NAME=start:stop:count and a unit, such as "NAME=0.1:0.4:31 mm"; at equal
        ratios "NAME=1e-4:1e-1:13:log"; or a list, "NAME=0.2,0.25,0.3 mm". Give the option once for each
        input. Names are those of the file.
    together : bool
        Take the first values of all inputs, then the second, in place of all combinations.
    workers : int
        Number of processes; the answer is the same for any.
    store : Path, optional
        Folder in which finished designs are kept; the same command resumes from it.
    """

    vary: Annotated[tuple[str, ...], Parameter(negative="", consume_multiple=False, show_default=False)] = ()
    together: Flag = False
    workers: Annotated[int, Parameter(validator=_check_workers)] = 1
    store: Folder = None

    @property
    def combine(self) -> Literal["product", "zip"]:
        """How the inputs are combined."""
        return "zip" if self.together else "product"

    @property
    def options(self) -> dict[str, object]:
        """The options that are not at their defaults, for the head of a report."""
        given: dict[str, object] = {"vary": self.vary or None, "store": self.store}
        given["workers"] = self.workers if self.workers > 1 else None
        return given | {"together": True if self.together else None}

    def check(self) -> None:
        """Refuse options that say nothing without an input that is varied."""
        for name in ("together", "workers", "store"):
            if not self.vary and getattr(self, name) != getattr(NOTHING_VARIED, name):
                raise ValueError(f"--{name} goes with {OPTION}: there is one design only")

    def runner(self, kind: str, versions: tuple[str, ...], progress: Callable[[int, int], Any]) -> TaskRunner:
        """The runner of the designs' tasks; `kind` and `versions` are as for `TaskRunner`."""
        from beamdyn.common.parallel.tasks import TaskRunner

        return TaskRunner(self.workers, None, self.store, kind, versions, progress)


NOTHING_VARIED = VaryOptions()
