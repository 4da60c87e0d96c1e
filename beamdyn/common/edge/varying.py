"""Options of commands that vary inputs or give them tolerances, and the computation of the designs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter, Token

from beamdyn.common.edge.outputs import Flag
from beamdyn.common.spreading import DEFAULT_SAMPLES

if TYPE_CHECKING:
    from beamdyn.common.parallel.tasks import TaskRunner

OPTION, SPREAD = "--vary", "--spread"
_MOST_WORKERS = 128


def folder(_: object, tokens: Sequence[Token]) -> Path:
    """Convert the name of a folder; refuse an empty one, which would mean the current folder."""
    if not tokens[0].value.strip():
        raise ValueError("the name is empty; give a folder, or leave the option out.")
    return Path(tokens[0].value)


Folder = Annotated[Path | None, Parameter(converter=folder)]
SomeFolder = Annotated[Path, Parameter(converter=folder)]  # a folder that has a default


def _check_workers(_: object, value: object) -> None:
    if isinstance(value, int) and value > _MOST_WORKERS:
        raise ValueError(f"Give at most {_MOST_WORKERS}.")


Workers = Annotated[int, Parameter(validator=_check_workers)]


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
    workers: Workers = 1
    store: Folder = None

    @property
    def combine(self) -> Literal["product", "zip"]:
        """The way in which inputs are combined: each with each, or taken together."""
        return "zip" if self.together else "product"

    @property
    def options(self) -> dict[str, object]:
        """Options that are not at their defaults, for the head of a report."""
        given: dict[str, object] = {"vary": self.vary or None, "store": self.store}
        given["workers"] = self.workers if self.workers > 1 else None
        return given | {"together": True if self.together else None}

    def check(self) -> None:
        """Refuse options that have no effect unless an input is varied."""
        for name in ("together", "workers", "store"):
            if not self.vary and getattr(self, name) != getattr(NOTHING_VARIED, name):
                raise ValueError(f"--{name} goes with {OPTION}: there is one design only")

    def runner(self, kind: str, versions: tuple[str, ...], progress: Callable[[int, int], Any]) -> TaskRunner:
        """Make the runner of the designs' tasks; `kind` and `versions` are as for `TaskRunner`."""
        from beamdyn.common.parallel.tasks import TaskRunner

        return TaskRunner(self.workers, None, self.store, kind, versions, progress)


NOTHING_VARIED = VaryOptions()


# Tolerances ----------------------------------------------------------------------------------------


def _whole(_: object, tokens: Sequence[Token]) -> int:
    """Read a whole number; cyclopts alone would cut 2.5 down to 2."""
    text = tokens[0].value.strip()
    if not (text.isascii() and text.isdecimal()):
        raise ValueError(f'"{text}" is not a whole number of 0 or more.')
    return int(text)


@Parameter(name="*")
@dataclass(frozen=True)
class SpreadOptions:
    """Inputs that have a tolerance, and how many random designs are drawn.

    Parameters
    ----------
    spread : tuple of str
        An input and its tolerance, NAME=tolerance, such as "NAME=+-2%", "NAME=+1% -2%", "NAME=+-0.01 mm",
        "NAME=0.19 mm to 0.21 mm" (all values as likely), or "NAME=sd 1%" (normal). Give the option once for
        each input. Names are those of the file.
    samples : int
        Number n of designs in each of 2 + d random samples of d inputs: a power of two, from 128.
    seed : int
        Whole number from which the random designs follow.
    """

    spread: Annotated[
        tuple[str, ...], Parameter(negative="", consume_multiple=False, show_default=False)
    ] = ()
    samples: Annotated[int, Parameter(converter=_whole)] = DEFAULT_SAMPLES
    seed: Annotated[int, Parameter(converter=_whole)] = 0

    @property
    def options(self) -> dict[str, object]:
        """Options that are not at their defaults, for the head of a report."""
        given: dict[str, object] = {"spread": self.spread or None}
        given["samples"] = self.samples if self.samples != DEFAULT_SAMPLES else None
        return given | {"seed": self.seed or None}

    def check(self, varying: VaryOptions) -> None:
        """Refuse options that do not go with each other, or with the inputs that are varied."""
        for name in ("samples", "seed"):
            if not self.spread and getattr(self, name) != getattr(NO_SPREAD, name):
                raise ValueError(f"--{name} goes with {SPREAD}: no random designs are drawn without it")
        if not self.spread:
            return
        both = {_key(text) for text in self.spread} & {_key(text) for text in varying.vary}
        if both:
            name = min(both)
            raise ValueError(
                f"{name} is given to {OPTION} and to {SPREAD}: an input is varied, or has a spread"
            )
        if varying.vary or varying.together:
            given = OPTION if varying.vary else "--together"
            raise ValueError(f"{given} does not go with {SPREAD}: give one of them")


NO_SPREAD = SpreadOptions()


def _key(text: str) -> str:
    return text.partition("=")[0].strip()
