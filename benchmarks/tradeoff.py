"""Computing time against accuracy, and the choices of `tolerance=`.  Run: python -m benchmarks.tradeoff

Takes some six minutes; writes docs/tradeoff.md and docs/tradeoff.png.
"""

from __future__ import annotations

import math
import os
import platform
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import date
from functools import partial
from pathlib import Path
from time import perf_counter, process_time

import numpy as np
import scipy
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.pictures import Axes
from beamdyn.modes.modal.error_estimate import solve_with_error
from beamdyn.modes.modal.model import Model
from beamdyn.studies.tradeoffs.frequencies import frequency_diagram
from beamdyn.studies.tradeoffs.measurements import Diagram
from beamdyn.studies.tradeoffs.responses import (
    OURS,
    harmonics_diagram,
    integrators_diagram,
    steady_modes_diagram,
    transient_modes_diagram,
)
from benchmarks import digits, rows
from benchmarks.cases.scenes import BLADE_SPIN_UP, HARVESTER, ROLLING, rolling_harvester
from benchmarks.cases.table_3 import handwritten, modal_system
from benchmarks.rows import markdown_table, time_text

DOCS = Path(__file__).parents[1] / "docs"
MODES, LOCUS = 3, 101
TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10)
LEGENDRE, SIZES = "Ritz, legendre", range(4, 15)  # numbers of functions whose times are compared
FAMILIES = {
    LEGENDRE: "Legendre functions",
    "Ritz, eigenfunctions": "eigenfunctions",
    "elements, graded": "graded elements",
    "elements, graded, extrapolated": "graded, extrapolated",
    "elements, uniform": "uniform elements",
    "elements, uniform, extrapolated": "uniform, extrapolated",
    "tolerance=": "the call with tolerance=",
}


# Scenes -------------------------------------------------------------------------------------------


def make_scenes() -> dict[str, tuple[bd.Scene, float]]:
    """Make five scenes of different character, with a speed [rad/s] for each."""
    beam_mass = 7850 * 0.05 * 0.01 * 0.0002
    body = bd.TipMass(20 * beam_mass, offset=0.003, inertia=2e-8)
    heavy = replace(HARVESTER, beam=replace(HARVESTER.beam, tip=body))
    width, thickness = Polynomial([1, -0.9]), Polynomial([1, -0.8])
    tapered = bd.Beam.from_stiffness(1.0, width * thickness, width * thickness**3)
    return {
        "published": (ROLLING, 55.0),
        "outward blade": (replace(BLADE_SPIN_UP, gravity=9.81), 6.0),
        "near the critical speed": (HARVESTER, 0.999 * bd.critical_speed(HARVESTER)),
        "heavy tip mass": (heavy, 0.5 * bd.critical_speed(heavy)),
        "strong taper": (bd.Scene(tapered, bd.Mount(0.2, math.pi, math.pi / 2)), 10.0),
    }


# The published scene with a spin-up of 1 s instead of 10 s, so that scipy's integrators can be run often.
HURRIED = rolling_harvester(bd.SpinUp(55.0, duration=1.0))


DESCRIBED = """- published: the rolling harvester of Lee and Yoo, inward, at 55 rad/s;
- outward blade: a uniform blade of 10 m on the axis, in the plane of rotation, at 6 rad/s; where it
  moves, with gravity and a damping ratio of 0.01;
- near the critical speed: the harvester at 0.999 of it;
- heavy tip mass: the harvester with a body of 20 beam masses, off its tip, at half its critical speed;
- strong taper: an outward blade, flapwise, whose width falls to 0.1 and whose thickness falls to 0.2 of the
  root's, at a nondimensional speed of 10."""


# Processor time of one thread, which other programs do not affect.
best_time = partial(rows.best_time, clock=process_time)


# What tolerance= chooses --------------------------------------------------------------------------


@dataclass(frozen=True)
class Choice:
    """The model that `tolerance=` chooses for a request, beside the smallest that meets the tolerance."""

    scene: str
    speeds: int
    tolerance: float
    needed: int  # fewest Legendre functions from which on the error meets the tolerance
    chosen: int
    error: float
    estimate: float
    floor: float  # error of the reference, below which errors cannot be measured
    cheapest: float  # time of the model with the fewest sufficient functions [s]
    own: float  # time of the chosen model [s]
    call: float  # time of the whole call [s]

    def row(self) -> tuple[str, ...]:
        return (
            self.scene,
            str(self.speeds),
            f"{self.tolerance:.0e}",
            str(self.needed),
            str(self.chosen),
            f"{self.error:.0e}",
            f"{self.estimate:.0e}",
            time_text(self.cheapest),
            f"{self.own / self.cheapest:.2f}",
            f"{self.call / self.cheapest:.1f}",
        )


CHOICE_HEAD = (
    "scene",
    "speeds",
    "tolerance",
    "functions needed",
    "chosen",
    "error",
    "estimated",
    "time of those needed",
    "chosen / needed",
    "call / needed",
)


def measure_choices(name: str, scene: bd.Scene, speed: float, count: int) -> Iterator[Choice]:
    """Yield the `Choice` at each tolerance for one scene, at one speed or over many speeds."""
    speeds = np.linspace(0, speed, count) if count > 1 else np.array([speed])

    def solve(functions: int) -> np.ndarray:
        return Model(scene, bd.Ritz(functions)).solver.eigenvalues(speeds, MODES)

    exact = solve_with_error(Model(scene, bd.Ritz(40)), speeds, MODES)
    floor = float(exact.error.max())

    def error(s: np.ndarray) -> float:
        return max(floor, float(np.abs(np.abs(s) / np.abs(exact.eigen.eigenvalue) - 1).max()))

    errors = {n: error(solve(n)) for n in range(MODES, 40)}
    for tolerance in TOLERANCES:
        needed = 1 + max((n for n, e in errors.items() if e > max(tolerance, floor)), default=MODES - 1)
        result = call_beamdyn(scene, speeds, tolerance)
        # The size of a locus' basis stands only in the sentence about its method.
        chosen = int(result.provenance.method.split(" with ")[1].split()[0])
        yield Choice(
            scene=name,
            speeds=count,
            tolerance=tolerance,
            needed=needed,
            chosen=chosen,
            error=error(result.eigenvalue.reshape(len(speeds), MODES)),
            estimate=float(result.error.max()),
            floor=floor,
            cheapest=best_time(partial(solve, needed)),
            own=best_time(partial(solve, chosen)),
            call=best_time(partial(call_beamdyn, scene, speeds, tolerance)),
        )


def call_beamdyn(scene: bd.Scene, speeds: np.ndarray, tolerance: float | None) -> bd.Modes | bd.Locus:
    """Compute frequencies by the public function, at one speed or over many speeds."""
    if len(speeds) == 1:
        return bd.natural_modes(scene, speeds[0], MODES, tolerance=tolerance)
    return bd.frequency_locus(scene, speeds, MODES, tolerance=tolerance)


# Times at loose and tight tolerances ---------------------------------------------------------------


def measure_locus() -> Iterator[tuple[str, ...]]:
    """Yield for the published locus of 1000 speeds: tolerance, time, and ratio to the tightest."""
    speeds = np.linspace(0, 150, 1000)
    tolerances: tuple[float | None, ...] = (1e-3, 1e-5, 1e-7, 1e-10, None)
    times = {t: best_time(partial(call_beamdyn, ROLLING, speeds, t), 5) for t in tolerances}
    for tolerance, time in times.items():
        error = call_beamdyn(ROLLING, speeds, tolerance).error.max()
        name = "not given" if tolerance is None else f"{tolerance:.0e}"
        yield name, time_text(time), f"{times[1e-10] / time:.1f}", f"{error:.0e}"


def measure_transient() -> Iterator[tuple[str, ...]]:
    """Yield for Table 3's transient: tolerance, time, ratio to the tightest, error, estimate."""
    t = np.linspace(0, 30, 30_001)
    exact = bd.simulate(ROLLING, 30.0, 5, tolerance=1e-11, discretization=bd.Ritz(20))
    true, rows = exact.deflection(t), []
    for tolerance in (1e-2, 1e-3, 1e-5, 1e-7, 1e-8, 1e-9, 1e-10):
        run = partial(bd.simulate, ROLLING, 30.0, 5, tolerance=tolerance, discretization=bd.Ritz(20))
        result, time = run(), best_time(run, 3)
        error = np.abs(result.deflection(t) - true).max() / exact.largest
        rows.append((tolerance, time, error, result.time_error / exact.largest))
    for tolerance, time, error, estimate in rows:
        yield (
            f"{tolerance:.0e}",
            time_text(time),
            f"{rows[-1][1] / time:.1f}",
            f"{error:.0e}",
            f"{estimate:.0e}",
        )


# The page -----------------------------------------------------------------------------------------

PAGE = """# What accuracy costs

Written by `python -m benchmarks.tradeoff` on {day} in {time:.0f} s (Python {python}, {machine}).
Versions: beamdyn {beamdyn}, numpy {numpy}, scipy {scipy}. Times are processor times of one thread, the
shortest of several runs.
`beamdyn tradeoff SCENE` and `bd.tradeoff(scene)` measure the same on a scene of your own.
With the error of the model included: [the other page](tradeoff_physics.md).

![Error against time](tradeoff.png)

Five scenes:
{described}

## Frequencies

The worst of the first {modes} frequencies, relative to 40 Legendre functions, which lie within the guaranteed
bounds. The time of a basis is that of its matrices and eigenvalues; extrapolated elements are solved twice;
`tolerance=` is the whole call, which also looks for the basis and estimates the error.

**Pareto fronts** (what nothing beats in both error and time):

{fronts}

**The cost of each digit**: the cheapest way to an error of at most so much, its time, and in brackets its
time over that of the digit before.

At one speed:

{single}
At {locus} speeds, from rest to the same:

{many}
## Transients

First the published scene: integrators over 2 s, numbers of modes over 30 s. Then the outward blade:
integrators over 30 s, numbers of modes over 20 s.

The published scene is brought up to speed in 1 s instead of 10 s where stock integrators are measured, so
that they can be run often. All integrate the same modal equations through `simulate(method=...)`. Its
right-hand side serves any scene; one written by hand for this scene alone is {lean:.0f} times faster, and
would make them faster by nearly as much: `python -m benchmarks.transient` races ours against that.

{transients}
## Steady response

To 55 rad/s it is the published scene, to 6 rad/s the outward blade.

{steady}
## What each digit of each analysis costs

The published scene at 55 rad/s, at a setting angle of 45 deg where that is said: the time of the whole
call at the loosest tolerance, and that of tighter ones over it.

{digits}
## What `tolerance=` makes of it

{rules}

{choices}
Loose against tight, on the published locus of 1000 speeds to 150 rad/s (estimated error of the result):

{loose_locus}
and on Table 3's transient (30 s, 5 modes; time-integration error, over the largest deflection):

{loose_transient}"""

RULES = """The rules follow from the fronts:

- **Legendre functions.** They alone make {legendre:.0%} of the {points} points of the frequency fronts above.
  Elements make {elements:.0%}: their assembly takes longer than a whole Ritz solution. So `tolerance=` never
  chooses elements by itself; `discretization="fem"` is for a second opinion.
- **A function too many costs little, a model too many costs much.** {sizes}
  Each model that is tried on the way costs as much as the answer.
- **What is chosen**, beside the fewest functions whose true error keeps the tolerance: the model takes
  {own:.2f} times as long in the median, {own_most:.2f} at most. The whole call takes {call:.1f} times as long
  in the median, {call_most:.1f} at most; of these, 2 are the estimate of the error, which needs a second
  model, and the rest is search and what else the result carries.
- **Errors that are kept**: in {kept} of {cases} cases the true error is below the tolerance, in {covered}
  below the estimate.
- **The first basis is predicted** from the number of modes and the tolerance, so that mostly no second one is
  tried; small bases, whose errors the coarser one beside them may hide, state three times the distance
  from it.
- **Transients.** {transient} points of the fronts among integrators are ours; the step follows the
  tolerance, as the tables above and below show. Modes at rest, which the papers keep, converge slowly under
  rotation; modes at the slowest and at the fastest speed together need far fewer. `tolerance=` takes these,
  two at each speed first, then half as many more until a refined run adds less than half the tolerance."""


def write_page(
    single: dict[str, Diagram],
    many: dict[str, Diagram],
    motion: Sequence[Diagram],
    chosen: Sequence[Choice],
    start: float,
) -> str:
    """Write the page of the documentation."""
    return PAGE.format(
        day=date.today(),
        python=platform.python_version(),
        machine=f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        beamdyn=bd.__version__,
        numpy=np.__version__,
        scipy=scipy.__version__,
        described=DESCRIBED,
        modes=MODES,
        locus=LOCUS,
        fronts="\n".join(list_fronts(single, "one speed") + list_fronts(many, f"{LOCUS} speeds")),
        single=tabulate_digits(single),
        many=tabulate_digits(many),
        transients="\n".join(write_section(d) for d in motion if d.title.startswith("transient")),
        steady="\n".join(write_section(d) for d in motion if d.title.startswith("steady")),
        digits=digits.tabulate(),
        rules=write_rules([*single.values(), *many.values()], single["published"], motion, chosen),
        choices=markdown_table(CHOICE_HEAD, (c.row() for c in chosen)),
        loose_locus=markdown_table(
            ("tolerance", "time", "cheaper than 1e-10 by", "estimated error"), measure_locus()
        ),
        loose_transient=markdown_table(
            ("tolerance", "time", "cheaper than 1e-10 by", "error", "estimated"), measure_transient()
        ),
        lean=compare_handwritten(),
        time=perf_counter() - start,
    )


def compare_handwritten() -> float:
    """Measure the time of the general right-hand side over that of one written by hand."""
    equations, y = modal_system(5), np.linspace(1e-6, 2e-6, 10)
    general, own = (
        best_time(lambda f=f: [f(12.3, y) for _ in range(200)])
        for f in (equations.rhs, handwritten(equations)[0])
    )
    return general / own


def list_fronts(diagrams: dict[str, Diagram], where: str) -> list[str]:
    return [f"- {name}, {where}: {diagram.summary}." for name, diagram in diagrams.items()]


def tabulate_digits(diagrams: dict[str, Diagram]) -> str:
    """Make the table of the cost of each digit, with a column for each scene."""
    most = max(len(d.per_digit) for d in diagrams.values())
    rows = ((f"1e-{k + 1:02d}", *(write_cell(d, k) for d in diagrams.values())) for k in range(most))
    return markdown_table(("error", *diagrams), rows)


def write_cell(diagram: Diagram, k: int) -> str:
    if k >= len(diagram.per_digit):
        return ""
    digit = diagram.per_digit[k]
    number = digit.setting.split()[0]
    ratio = "" if math.isnan(digit.ratio) else f" ({digit.ratio:.2f})"
    return f"{FAMILIES[digit.family]}: {number}, {time_text(digit.time)}{ratio}"


def write_section(diagram: Diagram) -> str:
    """Write a diagram's measurements as text, with its Pareto front marked, and the cost of each digit."""
    rows = (
        (m.family, m.setting, time_text(m.time), f"{m.error:.0e}", "yes" if m in diagram.front else "")
        for m in diagram.measurements
    )
    costs = ", then ".join(
        f"{d.error:.0e} {time_text(d.time)}" + ("" if math.isnan(d.ratio) else f" ({d.ratio:.2f})")
        for d in diagram.per_digit
    )
    skipped = "".join(f"- {sentence}\n" for sentence in diagram.skipped)
    return (
        f"### {diagram.title[:1].upper()}{diagram.title[1:]}\n\nError of {diagram.error_of}.\n"
        f"Reference: {diagram.reference}; errors below {diagram.resolved:.0e} are not resolved.\n\n"
        f"{markdown_table(('method', 'setting', 'time', 'error', 'in the front'), rows)}\n"
        f"The cost of each digit (over the digit before): {costs or 'not a digit is right'}.\n"
        + (f"\nNot measured:\n{skipped}" if skipped else "")
    )


def write_rules(
    diagrams: Sequence[Diagram], published: Diagram, motion: Sequence[Diagram], chosen: Sequence[Choice]
) -> str:
    """Write advice on the choice of a setting that follows from the measurements."""
    points = [m for d in diagrams for m in d.front]
    share = {
        kind: sum(m.family.startswith(kind) for m in points) / len(points) for kind in (LEGENDRE, "elements")
    }
    raced = [m for d in motion if any(m.family == OURS for m in d.front) for m in d.front]
    own, call = ([getattr(c, name) / c.cheapest for c in chosen] for name in ("own", "call"))
    return RULES.format(
        legendre=share[LEGENDRE],
        elements=share["elements"],
        points=len(points),
        transient=f"{sum(m.family == OURS for m in raced)} of {len(raced)}",
        sizes=compare_sizes(published),
        own=np.median(own),
        own_most=max(own),
        call=np.median(call),
        call_most=max(call),
        kept=sum(c.error <= c.tolerance for c in chosen),
        covered=sum(c.error <= max(c.estimate, c.floor) for c in chosen),
        cases=len(chosen),
    )


def compare_sizes(diagram: Diagram) -> str:
    """State the measured cost of more Legendre functions at one speed, in words."""
    times = {m.size: m.time for m in diagram.measurements if m.family == LEGENDRE and m.size in SIZES}
    if len(times) < 2:
        return "How little was not measured this time: the budget was used up before."
    small, large = min(times), max(times)
    return (
        f"At one speed {large:.0f} functions take\n  {times[large] / times[small]:.2f} times as long as "
        f"{small:.0f}: the time goes into building the matrices, not into their size."
    )


# The picture --------------------------------------------------------------------------------------


def draw_picture(many: dict[str, Diagram], transient: Diagram, path: Path) -> None:
    """Draw frequencies of all scenes, with one legend, and the published transient."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 8.6), layout="constrained")
    axes = figure.subplots(2, 3).ravel()
    for ax, (name, diagram) in zip(axes, many.items(), strict=False):
        draw_frame(ax, diagram, name)
        ax.set(ylim=(3e-15, 3))
    draw_frame(axes[-1], transient, f"published: transient, {MODES} modes")
    figure.suptitle(
        f"Error against time: {MODES} frequencies at {LOCUS} speeds in five scenes, and a transient"
    )
    axes[-1].legend(fontsize=10)
    handles, labels = axes[0].get_legend_handles_labels()
    names = [FAMILIES.get(str(label), str(label)) for label in labels]
    figure.legend(handles, names, loc="outside lower center", ncols=4, fontsize=12)
    figure.savefig(path, dpi=110)


def draw_frame(ax: Axes, diagram: Diagram, title: str) -> None:
    diagram.plot(ax)
    legend = ax.get_legend()
    if legend is not None:
        legend.remove()
    ax.set_title(title, fontsize=12)


@one_blas_thread()
def main() -> None:
    start = perf_counter()
    single, many, chosen = {}, {}, []
    for name, (scene, speed) in make_scenes().items():
        single[name] = frequency_diagram(scene, np.array([speed]), MODES, 6.0)
        many[name] = frequency_diagram(scene, np.linspace(0, speed, LOCUS), MODES, 10.0)
        chosen += [c for count in (1, LOCUS) for c in measure_choices(name, scene, speed, count)]
    blade = replace(make_scenes()["outward blade"][0], damping_ratio=0.01)
    transient = integrators_diagram(HURRIED, 2.0, MODES, 50.0)
    motion = [
        transient,
        transient_modes_diagram(ROLLING, 30.0, 8.0),
        integrators_diagram(blade, 30.0, MODES, 25.0),
        transient_modes_diagram(blade, 20.0, 8.0),
    ]
    for scene, speed in ((ROLLING, 55.0), (blade, 6.0)):
        speeds = np.linspace(0, speed, 51)[1:]
        motion += [harmonics_diagram(scene, speeds, MODES, 4.0), steady_modes_diagram(scene, speeds, 4.0)]
    (DOCS / "tradeoff.md").write_text(write_page(single, many, motion, chosen, start), encoding="utf-8")
    draw_picture(many, transient, DOCS / "tradeoff.png")


if __name__ == "__main__":
    main()
