"""
A beam that points at the axis: it loses stiffness, and buckles
================================================================

The published harvester (Lee and Yoo 2019) over speed, with the values of ANSYS that the paper prints.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

beam = bd.Beam.rectangular(length=0.05, width=0.01, thickness=0.0002, youngs_modulus=200e9, density=7850.0)
scene = bd.Scene(beam, bd.Mount(radius=0.215, setting_angle=0.0))
critical = bd.critical_speed(scene)
locus = bd.frequency_locus(scene, np.linspace(0, critical, 101)[:-1], modes=1)

fig, ax = plt.subplots()
locus.plot(ax)
ax.plot([0, 50, 100], [65.230, 61.963, 50.907], "o", color="C1", label="ANSYS, printed")
ax.axvline(critical, ls=":", color="black", label=f"buckles at {critical:.2f} rad/s")
ax.legend(loc="lower left")
