"""
Paths of a four-bar linkage
===========================

`planar.trace` follows a mechanism along its path, through its turning points, wherever a driver would
have to turn back. Grey: the linkage as drawn, pinned to the ground at A and D; B and C are its other pins,
P is a point of the coupler.
"""

import matplotlib.pyplot as plt

from brakes import planar

crank, coupler, rocker = "crank", "coupler", "rocker"
joints = (
    planar.Pin("A", crank, "ground", at=(0.0, 0.0)),
    planar.Pin("B", crank, coupler, at=(0.0, 0.04)),
    planar.Pin("C", coupler, rocker, at=(0.12, 0.09)),
    planar.Pin("D", rocker, "ground", at=(0.1, 0.0)),
)
linkage = planar.Mechanism((crank, coupler, rocker), joints, (planar.Moment("drive", crank),))
path = planar.trace(linkage, "drive", length=0.5, points=401)

fig, ax = plt.subplots()
for x, y in (((0, 0, 120, 100), (0, 40, 90, 0)), ((0, 40, 120), (40, 100, 90))):
    ax.plot(x, y, "o-", color="0.7")
for name, x in (("A", 0), ("D", 100)):
    ax.annotate(name, (x, 0), (4, -12), textcoords="offset points")
for name, body, point in (
    ("B", crank, (0.0, 0.04)),
    ("C", rocker, (0.12, 0.09)),
    ("P", coupler, (0.04, 0.10)),
):
    place = path.position.point(body, point)
    ax.plot(1e3 * place[..., 0], 1e3 * place[..., 1], label=name)
ax.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
ax.legend()
