"""Kinds of modes (bending, torsion, camber), by the kinetic energy of each."""

from __future__ import annotations

from typing import Any

import numpy as np

from beamdyn.common.results.result import Result
from beamdyn.equations.equations_of_motion import Equations

BENDING, TORSION, CAMBER = "bending", "torsion", "camber"
_TIE = 1e-9  # relative difference of kinetic energies below which the first kind is chosen


def kinds_of_modes(equations: Equations, vectors: np.ndarray) -> np.ndarray | None:
    """Name the kind (S, k) of each mode, of vectors (S, n, k), by the largest part of its kinetic energy.

    Bending in both directions, torsion and camber are compared, and ties within 1e-9 go to the first; the
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
    """Base class of results of modes that tells the kind of each mode; see `Result`.

    A subclass has the field `kinds`, which is None where all modes are bending modes.
    """

    frequency: np.ndarray
    kinds: np.ndarray | None

    @property
    def kind(self) -> np.ndarray:
        """Kind of each mode by its largest part of kinetic energy: "bending", "torsion" or "camber"."""
        return np.full(self.frequency.shape, BENDING) if self.kinds is None else self.kinds

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to numbers, lists and strings, with the kinds of modes where they differ."""
        return super().to_dict() | ({} if self.kinds is None else {"kind": self.kinds.tolist()})
