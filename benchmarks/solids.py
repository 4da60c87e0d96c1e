"""Reference frequencies of random rectangular cantilevers as solid bodies (CalculiX), kept in a file.

Run: python -m benchmarks.solids [--make N] [--first K] [--workers 1].  With --make it computes the references
of N numbered cases, and adds those that are missing in the file.  It prints the accuracy of the references
from the first number on, and their differences from strips as plates in two planes with shear and rotary
inertia.  Comparisons with the references need only the file.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from time import perf_counter

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.modes.model_error.left_out_effects import UnlistedMode
from benchmarks.peers.solids import (
    BENDING,
    OTHER,
    STRETCH,
    TORSION,
    SolidMode,
    Strip,
    random_strip,
    reference,
)
from benchmarks.resumable import Cases
from benchmarks.rows import Row, show, time_text

SEED = 31
FILE = Path(__file__).parent / "cases" / "data" / "solids.jsonl"
LISTED = 3  # number of compared bending modes; the solid's modes are kept up to the last of these
_LEAST = 4  # least number of kept modes
RICHEST = bd.Physics(planes=2, shear=True, rotary_inertia=True, camber=True, torsion=True)
_MORE = 2  # number of further modes of the beam, because the solid's modes may have another order


# References ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Reference:
    """The modes of one strip as a solid body, in ascending order of frequency, as columns.

    `strip` are the fields of `Strip`; `frequency` [Hz] is extrapolated, with the relative `error`; `coarse`,
    `medium` and `fine` are the frequencies of the three meshes; `share` is that of the kind in the shape.
    """

    number: int
    strip: dict[str, float]
    time: float
    kind: tuple[str, ...] = ()
    frequency: tuple[float, ...] = ()
    error: tuple[float, ...] = ()
    coarse: tuple[float, ...] = ()
    medium: tuple[float, ...] = ()
    fine: tuple[float, ...] = ()
    share: tuple[float, ...] = ()
    refusal: str = ""

    def body(self) -> Strip:
        """The strip, built from the stored fields."""
        return Strip(**self.strip)

    def modes(self) -> list[SolidMode]:
        """The columns as modes, numbered within their kinds."""
        known = zip(self.kind, self.frequency, self.error, self.share, strict=True)
        meshes = zip(self.coarse, self.medium, self.fine, strict=True)
        return [
            SolidMode(kind, 1 + self.kind[:k].count(kind), frequency, error, by_mesh, share)
            for k, ((kind, frequency, error, share), by_mesh) in enumerate(zip(known, meshes, strict=True))
        ]

    @property
    def complete(self) -> bool:
        """Whether the stored modes include the last bending mode that is compared."""
        return self.kind.count(BENDING) >= LISTED


def measure(number: int, seed: int) -> list[Reference]:
    """Compute the reference solution of the random strip with a number."""
    strip, start = random_strip(np.random.default_rng([seed, number])), perf_counter()
    try:
        modes = reference(strip)
    except (ValueError, OSError, subprocess.SubprocessError) as error:
        return [Reference(number, asdict(strip), _digits(perf_counter() - start, 3), refusal=str(error))]
    last = next((k for k, m in enumerate(modes) if (m.kind, m.number) == (BENDING, LISTED)), len(modes))
    modes = modes[: max(_LEAST, last + 1)]
    coarse, medium, fine = zip(*(mode.by_mesh for mode in modes), strict=True)
    return [
        Reference(
            number,
            asdict(strip),
            _digits(perf_counter() - start, 3),
            tuple(mode.kind for mode in modes),
            tuple(_digits(mode.frequency, 8) for mode in modes),
            tuple(_digits(mode.error, 2) for mode in modes),
            *(coarse, medium, fine),
            tuple(_digits(mode.share, 4) for mode in modes),
        )
    ]


def _digits(value: float, digits: int) -> float:
    """Round to a number of digits."""
    return float(f"{value:.{digits}g}")


def cases(seed: int = SEED) -> Cases[Reference]:
    """Return the random strips of a seed, as resumable cases."""
    return Cases(partial(measure, seed=seed), Reference)


def known(path: Path = FILE) -> list[Reference]:
    """Load the references from the file, by number."""
    return sorted(cases().load(path), key=lambda each: each.number)


def summarize_references(references: Sequence[Reference]) -> Iterator[Row]:
    """Yield the number of references, and their accuracies."""
    solved = [each for each in references if not each.refusal]
    yield "references", f"{len(solved)}", "200"
    for each in references:
        if each.refusal:
            yield f"... refused: case {each.number}", each.refusal, ""
    yield "... whose modes reach the third of bending", str(sum(each.complete for each in solved)), "all"
    kinds = np.array([kind for each in solved for kind in each.kind])
    errors = np.array([error for each in solved for error in each.error])
    for kind in sorted(set(kinds)):
        own = errors[kinds == kind]
        found = ", ".join(f"{error:.1e}" for error in (*np.quantile(own, [0.5, 0.95]), own.max()))
        yield f"{kind}: own error of {len(own)} modes: median, 95 %, worst", found, ""
    if solved:
        times = np.array([each.time for each in solved])
        yield "median and longest time", f"{time_text(np.median(times))}, {time_text(times.max())}", ""


# Comparison of strips as plates with solids --------------------------------------------------------


_NARROW = 5.0  # width over thickness below which a section does not behave as a plate


def compare_plate(reference: Reference) -> Iterator[tuple[str, float]]:
    """Yield each mode's kind and the relative difference in frequency of plate and solid.

    The modes are paired by their kind and their number within it.
    """
    strip, modes = reference.body(), reference.modes()
    with warnings.catch_warnings(action="ignore"):  # warnings about speeds at which deflections are large
        found = bd.natural_modes(strip.scene(RICHEST), strip.speed, len(modes) + _MORE, tolerance=1e-3)
    own = kinds_of(found)
    for mode in modes:
        of_kind = found.frequency[own == mode.kind]
        if len(of_kind) >= mode.number:
            yield mode.kind, float(of_kind[mode.number - 1] / mode.frequency - 1)


def kinds_of(modes: bd.Modes) -> np.ndarray:
    """Return the kind of each beam mode, in the terms used for solids."""
    across = (modes.kind == BENDING) & (modes.plane_share[:, 1] > 0.5)
    return np.where(across, OTHER, modes.kind)


def summarize_plates(references: Sequence[Reference]) -> Iterator[Row]:
    """Yield the differences of strips as plates from the solids, by kind of mode."""
    solved = [each for each in references if not each.refusal]
    found = [(_is_narrow(each.body()), *pair) for each in solved for pair in compare_plate(each)]
    pairs = [(kind, difference) for _, kind, difference in found]
    for words, wanted in ("from", False), ("below", True):
        own = np.abs([difference for narrow, _, difference in found if narrow == wanted])
        counted = f"richest model beside solids: width {words} {_NARROW:g} thicknesses, {len(own)} modes"
        largest = ", ".join(f"{size:.1e}" for size in (np.quantile(own, 0.95), own.max())) if len(own) else ""
        yield f"{counted}: 95 %, largest", largest, ""
    for kind in (BENDING, TORSION, OTHER):
        own = np.abs([difference for name, difference in pairs if name == kind])
        found = f"{np.sqrt(np.mean(own**2)):.1e}, {own.max():.1e}" if len(own) else "none"
        yield f"richest model beside solids: {kind}, {len(own)} modes: rms, largest", found, ""


def _is_narrow(strip: Strip) -> bool:
    return strip.width < _NARROW * strip.thickness


_FITTED = 63  # number of the first case that was not used to fit the warping constant


def summarize_torsion(references: Sequence[Reference]) -> Iterator[Row]:
    """Yield differences of first torsional modes from solids that were not used to fit constants."""
    found = []
    for solid in references:
        strip = solid.body()
        slender, flat = strip.length / strip.width, strip.width / strip.thickness
        if solid.number >= _FITTED and flat <= 10 and 3 <= slender <= 10:
            torsion = [difference for kind, difference in compare_plate(solid) if kind == TORSION]
            found += [abs(torsion[0])] if torsion else []
    yield "torsion of sections to which nothing was fitted, width/thickness to 10", f"{len(found)}", "6"
    yield "... first mode beside solids: largest", f"{max(found, default=np.nan):.1e}", "1e-2"


# Model errors of the plain beam -------------------------------------------------------------------

# Factor within which the stated difference should lie, and least ratio to the true difference.
_FACTOR, _FEWEST = 2.0, 0.2
_TRUE = 1e-3  # smallest true difference that is compared; it must also exceed twice the reference's error
_PAIRED = 0.1  # largest relative distance of a named mode's frequency from that of the solid's mode


@dataclass(frozen=True)
class StatedError:
    """A model error of one mode of a beam, and the true difference from the solid, both relative.

    `counts` is true if the difference is larger than the uncertainty of the reference.
    """

    number: int
    mode: int
    stated: float
    true: float
    counts: bool


def stated_errors(reference: Reference) -> list[StatedError]:
    """Return stated and true model errors of the modes of a strip as a plain beam."""
    strip, found = reference.body(), _plain_modes(reference)
    bending = [mode for mode in reference.modes() if mode.kind == BENDING]
    made = []
    for mode, frequency, stated in zip(bending, found.frequency, found.model_error, strict=False):
        true = mode.frequency / frequency - 1
        counts = abs(true) > max(_TRUE, 2 * mode.error)
        made.append(StatedError(reference.number, mode.number, float(stated), float(abs(true)), counts))
    assert len(made) == LISTED, strip
    return made


def _plain_modes(reference: Reference) -> bd.Modes:
    strip = reference.body()
    with warnings.catch_warnings(action="ignore"):  # warnings about model errors, which are measured here
        return bd.natural_modes(strip.scene(bd.Physics()), strip.speed, LISTED)


def unnamed(reference: Reference) -> list[str]:
    """Return solid modes below the third bending mode that the plain beam's result does not mention."""
    named = _plain_modes(reference).left_out_effects.unlisted
    modes, missing = reference.modes(), []
    last = next(m.frequency for m in modes if (m.kind, m.number) == (BENDING, LISTED))
    for mode in modes:
        if mode.kind == BENDING or mode.frequency >= last:
            continue
        of_kind = [m for m in named if _kind_of(m) == mode.kind and m.number == mode.number]
        if not any(abs(m.frequency / mode.frequency - 1) < _PAIRED for m in of_kind):
            missing.append(f"case {reference.number}: {mode.kind} {mode.number}, {mode.frequency:.4g} Hz")
    return missing


def _kind_of(mode: UnlistedMode) -> str:
    """Return the kind of a mode named in a warning, in the terms used for solids."""
    return mode.kind if mode.kind in (TORSION, STRETCH) else OTHER


def summarize_stated(references: Sequence[Reference]) -> Iterator[Row]:
    """Yield ratios of stated to true model errors of plain beams, and modes that are not mentioned."""
    each = [stated for reference in references for stated in stated_errors(reference)]
    counted = [stated for stated in each if stated.counts]
    ratio = np.array([stated.stated / stated.true for stated in counted])
    unknown = np.isnan(ratio)
    within = (ratio <= _FACTOR) & (ratio >= 1 / _FACTOR)
    yield "plain beams: modes with a true difference above 0.1 %", f"{len(counted)} of {len(each)}", ""
    yield "... stated within a factor of 2", f"{within.mean():.1%}, {unknown.sum()} not known", "95 %"
    yield "... least and largest ratio", f"{np.nanmin(ratio):.2f}, {np.nanmax(ratio):.2f}", "0.2 at least"
    missing = [words for reference in references for words in unnamed(reference)]
    yield "solids' modes below the third listed, neither listed nor named", f"{len(missing)}", "0"
    for words in missing:
        yield f"... {words}", "", ""


# Errors with automatically chosen physics ------------------------------------------------------------

_TOLERANCES = 1e-2, 3e-3


def chosen_errors(reference: Reference, tolerance: float) -> tuple[float, bool]:
    """Return the largest difference of bending frequencies with chosen physics, and if a warning says so.

    Differences below the reference's error count as 0.
    """
    strip = reference.body()
    with warnings.catch_warnings(action="ignore"):
        scene = replace(strip.scene(), physics="auto")
        found = bd.natural_modes(scene, strip.speed, LISTED, tolerance=tolerance)
    own = kinds_of(found)
    by_kind = {kind: found.frequency[own == kind] for kind in set(own)}
    differences = [0.0]
    for mode in reference.modes():
        of_kind = by_kind.get(mode.kind, ())
        if len(of_kind) >= mode.number:
            differences.append(abs(of_kind[mode.number - 1] / mode.frequency - 1) - mode.error)
    said = not found.physics_choice.is_met or bool(found.physics_choice.not_known)
    return max(differences), said


def summarize_chosen(references: Sequence[Reference]) -> Iterator[Row]:
    """Yield how often chosen physics agrees with solids within the tolerance, or warns that it may not."""
    for tolerance in _TOLERANCES:
        each = [(reference, *chosen_errors(reference, tolerance)) for reference in references]
        met = np.array([error <= tolerance for _, error, _ in each])
        said = np.array([said for *_, said in each])
        yield f"physics auto, {tolerance:g}: met", f"{met.mean():.1%}", "90 %" if tolerance == 1e-2 else ""
        yield "... met, or said not to be", f"{(met | said).mean():.1%}", "100 %"
        for (case, error, _), fine in zip(each, met | said, strict=True):
            if not fine:
                yield f"... case {case.number}", f"{error:.1e}", ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--make", type=int, default=0, help="so many references; those in the file are kept")
    parser.add_argument("--first", type=int, default=0, help="number of the first case, to go on in parts")
    parser.add_argument("--workers", type=int, default=1)
    given = parser.parse_args()
    if given.make:
        cases().resume(FILE, range(given.first, given.first + given.make), given.workers)
    asked = known()[given.first :]
    show(
        "references",
        lambda: summarize_references(asked),
        lambda: summarize_plates(asked),
        lambda: summarize_torsion(asked),
        lambda: summarize_stated(asked),
        lambda: summarize_chosen(asked),
    )


if __name__ == "__main__":
    main()
