"""Options of `beamdyn loads` on the cycles of a transient, and what they show and write."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beamdyn.analyses.analysis import WRITTEN
from beamdyn.analyses.options import LoadQuantity, Text
from beamdyn.analyses.values import naming_option
from beamdyn.common.edge.outputs import write_table
from beamdyn.common.results.files import write_text

if TYPE_CHECKING:
    from rich.console import RenderableType

    from beamdyn.loads.cycles import LoadCycles
    from beamdyn.loads.transient_loads import EquivalentRange

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)


@Parameter(name="*")
@dataclass(frozen=True)
class CycleOptions:
    """Which cycles of a transient are counted, and what is made of them.

    Parameters
    ----------
    cycles : str, optional
        In a transient: also count the cycles of this quantity, where it is largest (rainflow counting, ASTM
        E1049; needs the extra fatigue).
    woehler : str, optional
        Of these cycles: the range of equal cycles that do the same damage (Miner), for exponents m of the
        Woehler (S-N) curve, e.g. "3, 5, 10".
    equivalent_cycles : float, optional
        Number of these equal cycles; default: 1.
    cycles_file : Path, optional
        Write range, mean and count of each cycle into this file: .csv, .tsv, .txt or .json.
    """

    cycles: LoadQuantity | None = None
    woehler: Text | None = None
    equivalent_cycles: float | None = None
    cycles_file: Annotated[Path | None, WRITTEN] = None

    def check(self, in_transient: bool) -> None:
        """Refuse options that nothing would use."""
        if self.cycles is not None and not in_transient:
            raise ValueError("--cycles belongs to a transient: give --t-end, too")
        text = "" if self.woehler is None else f'"{self.woehler}"'
        for name, value in (("woehler", text), ("cycles-file", self.cycles_file)):
            if value and self.cycles is None:
                raise ValueError(f"--{name} = {value}: it is of counted cycles; give --cycles, too")
        if self.equivalent_cycles is not None and not text:
            number = f"{self.equivalent_cycles:g}"
            raise ValueError(f"--equivalent-cycles = {number}: give --woehler, too, or leave it out")
        self._check_equivalents()

    def _check_equivalents(self) -> None:
        from beamdyn.common.inputs.checks import positive

        with naming_option("exponent", "--woehler", self.woehler or ""):
            for exponent in self.exponents:
                positive("exponent", exponent)
        positive("equivalent_cycles", self.number)

    @property
    def exponents(self) -> list[float]:
        """The exponents of the Woehler curve; none if they are not given."""
        if self.woehler is None:
            return []
        parts = [part.strip() for part in self.woehler.split(",")]
        if not all(map(_NUMBER.fullmatch, parts)):
            words = f'--woehler = "{self.woehler}"'
            raise ValueError(f'{words}: give numbers, such as "3, 5, 10"')
        return [float(part) for part in parts]

    @property
    def number(self) -> float:
        """Number of equal cycles that do the same damage."""
        return 1.0 if self.equivalent_cycles is None else self.equivalent_cycles

    def tables(self, cycles: LoadCycles, equivalents: Sequence[EquivalentRange]) -> list[RenderableType]:
        """Counted cycles, and the equal cycles that do the same damage."""
        from beamdyn.results.of_loads import cycles_table, equivalents_table

        made: list[RenderableType] = [cycles_table(cycles)]
        return [*made, equivalents_table(equivalents)] if equivalents else made

    def write(self, cycles: LoadCycles) -> None:
        """Write the file that was asked for, if any."""
        from beamdyn.results.of_loads import cycles_csv

        if self.cycles_file is None:
            return
        if self.cycles_file.suffix.lower() == ".json":
            write_text(self.cycles_file, cycles.to_json())
        else:
            write_table(self.cycles_file, cycles_csv(cycles))


NOT_COUNTED = CycleOptions()
