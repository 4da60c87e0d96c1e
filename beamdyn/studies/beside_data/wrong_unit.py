"""Detection of frequencies that were measured in another unit than the one assumed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import inf, pi

import numpy as np

from beamdyn.common.results.statements import INPUT, Statement
from beamdyn.common.words import percent
from beamdyn.studies.beside_data.pairing import NO_MODE, pair

# Ratio of given to correct values, as a number and as text (the key), and the possible cause in words.
_UNITS: Mapping[str, tuple[float, str]] = {
    "2 pi": (2 * pi, "in rad/s, and read as Hz"),
    "60": (60.0, "in 1/min, and read as Hz"),
    "1000": (1e3, "in mHz, or in Hz and read as kHz"),
    "1/(2 pi)": (1 / (2 * pi), "in Hz, and read as rad/s or divided by 2 pi"),
    "1/60": (1 / 60, "in Hz, and read as 1/min"),
    "1/1000": (1e-3, "in kHz, and read as Hz"),
}
_ALIKE = 0.1  # largest relative deviation that remains with the right unit: models rarely deviate more
_LESS = 0.5  # largest scatter that remains with the right unit, over the scatter with the assumed unit
_FEWEST = 2  # smallest number of values needed to detect a common factor


def wrong_unit(
    measured: Sequence[np.ndarray], computed: Sequence[np.ndarray], likeness: Sequence[np.ndarray | None]
) -> Iterator[Statement]:
    """Yield a statement if all values deviate by one common factor that is the ratio of two units.

    The values divided by the factor are paired with modes again.  The statement is made if each then has a
    mode within 10 %, and if the scatter of the ratios of measured to computed values is less than half of
    that without the factor.

    Parameters
    ----------
    measured : sequence of ndarray, each of shape (m,)
        Measured frequencies at each speed [Hz]; nan if not measured.
    computed : sequence of ndarray, each of shape (n,)
        Frequencies of the model at each speed [Hz].
    likeness : sequence of ndarray, each of shape (m, n), or None
        Modal assurance criterion of the shapes, as for `pair`.
    """
    if sum(int(np.isfinite(each).sum()) for each in measured) < _FEWEST:
        return

    def logarithms(factor: float) -> np.ndarray:
        """Compute log(measured / factor / computed) of each value and its mode; inf if it has none."""
        found = []
        for values, modes, alike in zip(measured, computed, likeness, strict=True):
            place, known = pair(values / factor, modes, alike), np.isfinite(values)
            of_mode = np.where(place == NO_MODE, 1.0, modes[place])
            found.append(np.where(place == NO_MODE, inf, np.log(values / factor / of_mode))[known])
        return np.concatenate(found)

    def scatter(logs: np.ndarray) -> float:
        return float(np.ptp(logs)) if np.isfinite(logs).all() else inf

    as_read = scatter(logarithms(1.0))
    for name, (factor, words) in _UNITS.items():
        logs = logarithms(factor)
        if np.abs(logs).max() <= np.log1p(_ALIKE) and scatter(logs) < _LESS * as_read:
            off = percent(float(np.abs(np.expm1(logs)).max()))
            said = f"all measured frequencies are {name} times those of the scene, within {off}: they may be "
            yield Statement(f"{said}{words}; give them in Hz or rad/s, with the unit", kind=INPUT)
            return
