"""
A strip that trails is straightened out by rotation
===================================================

Set tangentially, the strip is thrown outward as the speed rises. Linear theory has no word for that:
`Physics` with large deflection does.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
mount = bd.Mount(radius=0.215, setting_angle=np.pi / 2)
scene = bd.Scene(beam, mount, physics=bd.Physics(large_deflection=True))
x = np.linspace(0, beam.length, 101)

fig, ax = plt.subplots()
for speed in (0, 50, 100, 200, 400):
    place = bd.equilibrium(scene, speed).shape(x)
    along, across = place[:, 0], place[:, 1]
    ax.plot(1e3 * along, -1e3 * across, label=f"{speed} rad/s")
ax.set(xlabel="tangential, against the motion [mm]", ylabel="outward [mm]", aspect="equal")
ax.legend()
