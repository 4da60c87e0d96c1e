"""Kinds of modes: what deforms in them."""

from __future__ import annotations

from typing import Any

import numpy as np

from beamdyn.common.results.result import Result
from beamdyn.equations.equations_of_motion import Equations

BENDING, TORSION, CAMBER = "bending", "torsion", "camber"
_TIE = 1e-9  # relative difference of kinetic energies below which the first kind has it


def kinds_of_modes(equations: Equations, vectors: np.ndarray) -> np.ndarray | None:
    """Kind of modes (S, n, k): what has most of their kinetic energy, in a word each (S, k).

    Of bending in both directions, torsion and camber it is the first that is within 1e-9 of the largest; the
    energy of stretch is not compared.  None where a model has neither torsion nor camber.
    """
    own = [name for name in (TORSION, CAMBER) if name in equations.blocks]
    if not own:
        return None
    energy = np.real(vectors.conj() * equations.momentum(vectors))
    fields = [equations.deflecting, *([name] for name in own)]
    of_each = np.stack([energy[:, equations.places(names)].sum(axis=1) for names in fields])
    return np.array([BENDING, *own])[(of_each >= (1 - _TIE) * of_each.max(axis=0)).argmax(axis=0)]


class TellsKinds(Result):
    """Base of results of modes of which it says what deforms in them; see `Result`.

    A subclass has the field `kinds`: None where its modes are all of bending.
    """

    frequency: np.ndarray
    kinds: np.ndarray | None

    @property
    def kind(self) -> np.ndarray:
        """What has most of the kinetic energy of each mode: "bending", "torsion" or "camber"."""
        return np.full(self.frequency.shape, BENDING) if self.kinds is None else self.kinds

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings, with the kinds of its modes where they differ."""
        return super().to_dict() | ({} if self.kinds is None else {"kind": self.kinds.tolist()})
