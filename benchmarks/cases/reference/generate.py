"""Write benchmarks/cases/data/rotating_beams_more.toml from the power-series reference.

Run as ``python -m benchmarks.cases.reference.generate``; the same seed gives the same file.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

from mpmath import mp, mpf

from benchmarks.cases.reference.power_series import solve_case

Case = dict[str, Any]

TARGET = Path(__file__).parents[1] / "data" / "rotating_beams_more.toml"
DIGITS = 20

HEADER = """\
# More rotating cantilevers. Written by `python -m benchmarks.cases.reference.generate`: do not edit.
#
# All values come from the power-series reference, power_series.py beside this folder,
# not from a publication and not from beamdyn. Keys as in beamdyn/published/rotating_beams.toml, and
#   lambda_squared  the three lowest, 20 digits; negative: the mode diverges
#   frequency       their roots, "nan" where the mode diverges
# (Model "coupled": the three lowest frequencies, whether mainly of bending or of stretch.)
"""

# mass and stiffness as polynomials in x/L
SECTIONS = {
    "linear": ((1, -0.5), (1, -0.3)),
    "wedge": ((1, -0.8), (1, -2.4, 1.92, -0.512)),
    "cone": ((1, -1, 0.25), (1, -2, 1.5, -0.5, 0.0625)),
    "growing": ((1, 0.5), (1, 0.75)),
    "quadratic": ((1, 0.3, -0.7), (1, -0.6, 0.4)),
    "bulge": ((1, 2, -2), (1, 3, -3)),
    "waist": ((1, -2, 2), (1, -2.4, 2.4)),
    "late": ((1, 0, 0, -0.5), (1, 0, 0, 0, -0.8)),
}


def uniform(random: Random) -> Iterator[Case]:
    """Yield uniform beams: outward, inward below the critical speed, inward at any speed, extreme ones."""
    for _ in range(4):
        yield scene("uniform outward", random.uniform(0, 12), random.uniform(0, 5), random.uniform(0, 90))
    for _ in range(4):
        delta = random.uniform(-10, -1)
        yield scene("uniform inward", subcritical(random, delta), delta, random.uniform(0, 90))
    for _ in range(3):
        yield scene(
            "uniform inward, fast", random.uniform(2, 12), random.uniform(-10, 0), random.uniform(0, 90)
        )
    for gamma, delta, angle in ((12, -10, 0), (12, -10, 90), (12, 5, 0), (12, -0.5, 90)):
        yield scene("uniform corner", gamma, delta, angle)


def tapered(random: Random) -> Iterator[Case]:
    for name, (mass, stiffness) in SECTIONS.items():
        for delta in (random.uniform(0, 5), random.uniform(-5, -1)):
            gamma = random.uniform(1, 12) if delta > 0 else subcritical(random, delta)
            yield scene(name, gamma, delta, random.uniform(0, 90)) | section(mass, stiffness)


def tipped(random: Random) -> Iterator[Case]:
    for k in range(12):
        delta = random.uniform(0, 5) if k % 2 else random.uniform(-8, -1.5)
        gamma = random.uniform(0, 12) if k % 2 else 0.6 * subcritical(random, delta)
        mass, offset = random.uniform(0.05, 1.5), random.uniform(-0.05, 0.2)
        body = {"mass": mass, "offset": offset, "inertia": mass * random.uniform(0.001, 0.05)}
        case = scene("tip body", gamma, delta, random.choice((0, 90, random.uniform(0, 90))))
        if k >= 8:
            case |= section(*SECTIONS["quadratic" if k % 2 else "wedge"])
        yield case | {"tip": {key: round(value, 4) for key, value in body.items()}}


def coupled(random: Random) -> Iterator[Case]:
    speeds = {70: (3, 8, 12, 20, 35), 20: (2, 5, 8, 10), 200: (6, 12, 50, 100)}
    for alpha, gammas in speeds.items():
        for gamma in gammas:
            delta, angle = random.uniform(0, 2), random.choice((0, random.uniform(0, 80)))
            yield scene("stretch", gamma, delta, angle) | {"model": "coupled", "alpha": float(alpha)}
    for alpha, gamma, delta in ((70, 1, -4.3), (20, 1.5, -1.5), (200, 0.7, -8)):
        yield scene("stretch inward", gamma, delta, 0) | {"model": "coupled", "alpha": float(alpha)}


def subcritical(random: Random, delta: float) -> float:
    """Draw a speed below gamma^2 |delta| = 5, where an inward uniform beam is stable from delta = -1 on."""
    return random.uniform(0.3, 1) * (5 / abs(delta)) ** 0.5


def scene(name: str, gamma: float, delta: float, angle: float) -> Case:
    values = {"gamma": gamma, "delta": delta, "bending_angle_deg": angle}
    rounded = {key: round(float(value), 3) for key, value in values.items()}
    return {"name": name, "source": "power series", "model": "bending"} | rounded | section((1,), (1,))


def section(mass: tuple[float, ...], stiffness: tuple[float, ...]) -> Case:
    return {"mass": list(map(float, mass)), "stiffness": list(map(float, stiffness))}


def solve(case: Case, number: int) -> Case:
    squares = solve_case(case, digits=DIGITS + 5)
    with mp.workdps(DIGITS + 5):
        roots = [mp.sqrt(z) if z > 0 else mp.nan for z in squares]
    name = {"name": f"{number:02d} {case['name']}"}
    return case | name | {"lambda_squared": print_digits(squares), "frequency": print_digits(roots)}


def print_digits(values: list[mpf]) -> list[str]:
    return [mp.nstr(value, DIGITS, strip_zeros=False) for value in values]


def toml(value: Any) -> str:
    match value:
        case str():
            return f'"{value}"'
        case list():
            return f"[{', '.join(map(toml, value))}]"
        case dict():
            return f"{{ {', '.join(f'{key} = {toml(item)}' for key, item in value.items())} }}"
    return repr(value)


def table(case: Case) -> str:
    return "\n".join(["[[case]]", *(f"{key} = {toml(value)}" for key, value in case.items())])


def main() -> None:
    random = Random(2019)
    cases = [case for family in (uniform, tapered, tipped, coupled) for case in family(random)]
    tables = [table(solve(case, number)) for number, case in enumerate(cases, start=1)]
    TARGET.write_text("\n\n".join([HEADER.rstrip(), *tables]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
