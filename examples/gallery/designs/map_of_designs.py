"""
A map of designs
================

The speed at which an inward strip buckles over its thickness and the radius on which it stands: 1600
designs in one call.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
thickness, radius = np.linspace(0.1e-3, 0.4e-3, 40), np.linspace(0.1, 0.4, 40)
vary = {"beam.thickness": thickness, "mount.radius": radius}
study = bd.study(bd.Scene(beam, bd.Mount(radius=0.2)), vary, "critical_speed")
value = study.value.reshape(40, 40)

fig, ax = plt.subplots()
lines = ax.contourf(1e3 * radius, 1e3 * thickness, value, levels=12)
ax.plot(215, 0.2, "wo", label="published harvester")
ax.set(xlabel="radius [mm]", ylabel="thickness [mm]")
ax.legend()
fig.colorbar(lines, label="speed at which it buckles [rad/s]")
