"""A block of 20-node solid elements, C3D20R of CalculiX, as lines of its input file."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

Place = tuple[int, int, int]  # grid position of a node, in steps of half an element along x, y, z

# Grid positions of an element's nodes, in the order of CalculiX' manual: corners, then middles of edges.
CORNERS = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2))
MIDDLES = (
    *((1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2)),
    *((1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)),
)


def numbers(counts: tuple[int, int, int]) -> dict[Place, int]:
    """Return the number of each node by grid position, for given numbers of elements along x, y, z."""
    x, y, z = (range(2 * count + 1) for count in counts)
    nodes = (place for place in product(x, y, z) if sum(step % 2 for step in place) <= 1)
    return {place: number for number, place in enumerate(nodes, 1)}


def elements(counts: tuple[int, int, int], number: dict[Place, int]) -> Iterator[str]:
    """Yield the input of each element, which the format splits into two lines."""
    for index, (a, b, c) in enumerate(product(*map(range, counts)), 1):
        own = [str(number[2 * a + i, 2 * b + j, 2 * c + k]) for i, j, k in (*CORNERS, *MIDDLES)]
        yield f"{index}, {', '.join(own[:10])},\n{', '.join(own[10:])}"
