"""Functions across the width of a strip, and integrals of their products with functions along the strip.

In shapes of arrays, n counts coordinates, k positions along the strip, and l across it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.numerics import gauss_rule
from beamdyn.equations.discretization import RootConditions, Space, Spaces
from beamdyn.equations.fields.field import Field
from beamdyn.scene.profile import ONE, Profile, combine
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene

# Orders of the derivatives of the deflection along and across the strip.
_ORDERS = (0, 0), (0, 1), (0, 2), (1, 0), (2, 0), (1, 1)
_ZERO = 1e-12  # averages over the width below this fraction of the largest count as 0: they are 0 by symmetry
# Step of the width, or of its slope over x/L, relative to the largest width, above which it counts as a jump
# or a kink.  Beside this limit the functions of either kind serve as well.
_SMOOTH = 1e-8


class Derivative(NamedTuple):
    """Summand of a derivative of the deflection: factor(x) times derivative of u_k(x) times functions of eta.

    The deflection is the sum over k of functions u_k along times functions p_k across the strip.

    Parameters
    ----------
    factor : Profile
        Factor along the beam.
    order : int
        Order of the derivative of u_k with respect to x.
    across : ndarray, shape (functions, points)
        Functions of eta = 2 y/b, for each k, at the Gauss points across the width b.
    """

    factor: Profile
    order: int
    across: np.ndarray


class WidthFunctions:
    """Functions across a strip's width, and derivatives of the deflection as sums of `Derivative`.

    Parameters
    ----------
    section : Rectangle
        The section.
    length : float
        Length of the beam [m].
    field : str
        Name of the field.
    numbers : sequence of int
        Numbers k of the field's functions across the width.
    conditions : RootConditions
        Boundary conditions at the root of the field's functions along the beam.
    points : int
        Number of Gauss points across the width.
    """

    def __init__(
        self,
        section: Rectangle,
        length: float,
        field: str,
        numbers: Sequence[int],
        conditions: RootConditions,
        points: int,
    ) -> None:
        self.field, self.conditions = field, conditions
        eta, _ = gauss_rule(points)
        self.tip, (p, dp, ddp) = _polynomials(tuple(numbers), points)
        half = _inverse(section.width).scaled(2.0)  # derivative of eta = 2 y/width with respect to y
        self.parts = {  # summands of the deflection and of its derivatives
            "w": [Derivative(ONE, 0, p)],
            "w_y": [Derivative(half, 0, dp)],
            "w_yy": [Derivative(half * half, 0, ddp)],
            "w_x": [Derivative(ONE, 1, p)],
            "w_xx": [Derivative(ONE, 2, p)],
            "w_xy": [Derivative(half, 1, dp)],
        }
        if (ratio := argument_ratio(section.width, min(numbers))) is not ONE:
            self.parts = _parts_argument_ratio_width(section.width, ratio, tuple(numbers), eta)
        elif section.width.degree:  # the width varies: d/dx at constant y is not d/dx at constant eta
            slope, change = _relative_slopes(section.width, length)
            stretched, turned = eta * dp, dp + eta * ddp
            self.parts["w_x"].append(Derivative(slope.scaled(-1.0), 0, stretched))
            self.parts["w_xx"] += [
                Derivative(slope.scaled(-2.0), 1, stretched),
                Derivative(change.scaled(-1.0), 0, stretched),
                Derivative(slope * slope, 0, eta * turned),
            ]
            self.parts["w_xy"].append(Derivative((half * slope).scaled(-1.0), 0, turned))


@lru_cache(maxsize=64)
def _polynomials(numbers: tuple[int, ...], points: int) -> tuple[np.ndarray, list[np.ndarray]]:
    """Evaluate functions across the width at its edge, and derivatives 0 to 2 at Gauss points across it."""
    edge, series = np.sqrt(2 * np.array(numbers) + 1), np.eye(max(numbers) + 1)[:, [*numbers]]
    eta, _ = gauss_rule(points)
    return edge, [edge[:, None] * legendre.legval(eta, legendre.legder(series, order)) for order in range(3)]


def argument_ratio(width: Profile, number: int) -> Profile:
    """Compute the ratio of the local width to the width b in the argument 2 y/b of functions across.

    The functions have odd or even numbers, such as `number`.  If they are odd and the width has kinks or
    jumps, b is the width at the tip; else b is the local width, and the ratio is the object `ONE`.
    """
    left, right = width.end_values()
    slopes = width.derivative().end_values()
    steps = np.abs(np.concatenate([left[1:] - right[:-1], slopes[0][1:] - slopes[1][:-1]]))
    is_fixed = number % 2 and steps.max(initial=0.0) > _SMOOTH * np.abs(right).max()
    return width.scaled(1 / float(width.end_values()[1][-1])) if is_fixed else ONE


def _parts_argument_ratio_width(
    width: Profile, ratio: Profile, numbers: tuple[int, ...], eta: np.ndarray
) -> dict[str, list[Derivative]]:
    """Split derivatives of p_k(2 y/tip width) u_k(x) into powers of 2 y/width and of width/tip width."""
    dy = 2 / float(width.end_values()[1][-1])
    series = (np.sqrt(2 * k + 1) * legendre.leg2poly(np.eye(k + 1)[k]) for k in numbers)
    coefficients = np.array([np.pad(c, (0, max(numbers) + 1 - len(c))) for c in series])
    powers = [ONE]
    while len(powers) <= max(numbers):
        powers.append(powers[-1] * ratio)

    def of(along: int, across: int) -> list[Derivative]:
        """List the summands of the deflection's derivative of order `along` in x and order `across` in y."""
        return [
            Derivative(
                powers[m - across].scaled(math.perm(m, across) * dy**across),
                along,
                coefficients[:, [m]] * eta ** (m - across),
            )
            for m in range(across, max(numbers) + 1)
            if coefficients[:, m].any()
        ]

    return {"w" + ("_" + "x" * i + "y" * j if i + j else ""): of(i, j) for i, j in _ORDERS}


@lru_cache(maxsize=64)
def _inverse(b: Profile) -> Profile:
    """Compute the reciprocal of the width [1/m]."""
    return combine(lambda width: 1 / width[None], b)[0]


@lru_cache(maxsize=64)
def _relative_slopes(b: Profile, length: float) -> tuple[Profile, Profile]:
    """Compute the relative slope b'/b of the width b [1/m] and its derivative [1/m2], over x/L."""
    beta = combine(lambda b, d: (d / b)[None], b, b.derivative())[0].scaled(1 / length)
    return beta, beta.derivative().scaled(1 / length)


@dataclass(frozen=True)
class Strip:
    """Rectangular strip, with integrals over its area.

    Parameters
    ----------
    scene : Scene
        The scene, whose beam has a rectangular section.
    spaces : Spaces
        Function spaces along the beam.
    """

    scene: Scene
    spaces: Spaces

    @property
    def section(self) -> Rectangle:
        """Cross-section of the strip."""
        assert self.scene.beam.strip is not None, "a scene of a plate has a section"
        return self.scene.beam.strip

    @property
    def points(self) -> int:
        """Number of Gauss points across the width; exact for products of two functions and a parabola."""
        return self.spaces.across + 3

    @property
    def rotary_inertia(self) -> Profile:
        """Rotary inertia of the thickness, per length of the beam [kg m], which acts when sections twist."""
        t = self.section.thickness
        return (self.scene.beam.mass_per_length * t * t).scaled(1 / 12)

    def functions(self, field: Field, numbers: Sequence[int], conditions: RootConditions) -> WidthFunctions:
        """Build a field's functions across the width for the given numbers k."""
        return WidthFunctions(
            self.section, self.scene.beam.length, field.name, numbers, conditions, self.points
        )

    def integrate(
        self,
        weight: Profile,
        rows: tuple[WidthFunctions, str],
        columns: tuple[WidthFunctions, str],
        across: np.ndarray | float = 1.0,
    ) -> np.ndarray:
        """Integrate over x a weight times the mean of a product over the width: a matrix.

        The product is that of two derivatives and `across`.  Each derivative is named by the functions and a
        label such as "w_xx".
        """
        (first, a), (second, b) = rows, columns
        _, of_points = gauss_rule(self.points)
        L, total = self.scene.beam.length, 0.0
        for p in first.parts[a]:
            for q in second.parts[b]:
                averages = (p.across * (of_points / 2 * across)) @ q.across.T
                scale = np.abs(p.across).max(initial=0.0) * np.abs(q.across).max(initial=0.0)
                averages[np.abs(averages) <= _ZERO * scale] = 0.0
                if averages.any():
                    of_x = weight * (p.factor * q.factor), first.conditions, second.conditions
                    along = self.spaces.product(*of_x, (p.order, q.order)) * L ** (1 - p.order - q.order)
                    of_both = averages[:, None, :, None] * along[:, None, :]
                    total = total + of_both.reshape(averages.shape[0] * along.shape[0], -1)
        return np.atleast_2d(total)

    def load(
        self,
        weight: Profile,
        rows: tuple[WidthFunctions, str],
        along: Space,
        across: np.ndarray | float = 1.0,
    ) -> np.ndarray:
        """Integrate over x a weight times the mean over the width of one derivative times `across`: a vector.

        The derivative is named as for `integrate`; it may be one across the width, but not `along` the beam.
        """
        _, of_points = gauss_rule(self.points)
        functions, name = rows
        L, total = self.scene.beam.length, 0.0
        for p in functions.parts[name]:
            means = p.across @ (of_points / 2 * across)
            total = total + np.kron(means, along.load((weight * p.factor).scaled(L)))
        return np.atleast_1d(total)

    def stiffness(self, rows: WidthFunctions, columns: WidthFunctions, warping: Profile = ONE) -> np.ndarray:
        """Compute the plate's stiffness matrix [N/m]; `warping` multiplies the stiffness along the beam."""
        section, EI = self.section, self.scene.beam.bending_stiffness
        D, bend = EI * section.camber_stiffening, self.integrate
        cross = D * _root(warping) * section.camber_ratio
        GJ = EI * section.twist_factor
        return (
            bend(D * warping, (rows, "w_xx"), (columns, "w_xx"))
            + bend(D, (rows, "w_yy"), (columns, "w_yy"))
            + bend(cross, (rows, "w_xx"), (columns, "w_yy"))
            + bend(cross, (rows, "w_yy"), (columns, "w_xx"))
            + bend(GJ, (rows, "w_xy"), (columns, "w_xy"))
        )


@lru_cache(maxsize=64)
def _root(factor: Profile) -> Profile:
    """Compute the square root of a property along the beam."""
    return combine(lambda values: np.sqrt(values)[None], factor)[0]


@dataclass(frozen=True)
class StackedSpace:
    """Coordinates of a plate field: one for each product of a function across and a function along the strip.

    Parameters
    ----------
    along : Space
        Functions along the beam.
    numbers : tuple of int
        Numbers k of the functions across the width.
    fewer : int
        Number of functions across in the coarser discretization.
    stretch : Profile
        Ratio of the local width to the width b in the argument 2 y/b of the functions across.
    """

    of_strip: ClassVar[bool] = True
    along: Space
    numbers: tuple[int, ...]
    fewer: int
    stretch: Profile = ONE

    @property
    def size(self) -> int:
        """Number of coordinates; the coordinates of the first function across the width come first."""
        return self.along.size * len(self.numbers)

    @property
    def of_each(self) -> int:
        """Number of coordinates of each function across the width; they are consecutive."""
        return self.along.size

    @property
    def corner(self) -> np.ndarray:
        """Deflection of the tip's corner at eta = 2 y/width = 1 per unit of each coordinate."""
        return np.kron(np.sqrt(2 * np.array(self.numbers) + 1), self.along.end(0))

    def evaluate(self, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Evaluate the deflections at positions x/L and 2 y/width: shape (coordinates, along, across)."""
        numbers = np.array(self.numbers)
        places = np.multiply.outer(self.stretch(xi), eta)
        across = legendre.legvander(places, numbers.max())[:, :, numbers] * np.sqrt(2 * numbers + 1)
        values = self.along.evaluate(xi)[:, :, None] * np.moveaxis(across, 2, 0)[:, None]
        return values.reshape(self.size, len(xi), len(eta))

    def curvature_across(self, xi: np.ndarray) -> np.ndarray:
        """Evaluate second derivatives with respect to eta = 2 y/width, averaged over the width, at x/L.

        An even Legendre polynomial's second derivative has the mean k(k + 1)/2, its slope at an edge.
        """
        numbers = np.array(self.numbers)
        means = np.where(numbers % 2, 0, numbers * (numbers + 1) / 2) * np.sqrt(2 * numbers + 1)
        return np.kron(means[:, None], self.along.evaluate(xi))

    @property
    def coarse(self) -> np.ndarray | None:
        """Indices of coordinates that span the coarser discretization; None if no subset does."""
        kept = self.along.coarse
        if kept is None:
            return None
        return (self.along.size * np.arange(self.fewer)[:, None] + kept).ravel()
