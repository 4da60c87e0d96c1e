"""
A blade that stands on the axis is a shaft
==========================================

Raise an outward beam by a precone of nearly 90 deg on a hub of radius 0: it stands along the axis and
whirls. In axes that turn with it, its frequencies are those at rest less and plus the speed.
"""

import matplotlib.pyplot as plt
import numpy as np

import beamdyn as bd

shaft = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=1.0)
mount = bd.Mount(radius=0.0, setting_angle=np.pi, precone=np.radians(89.99))
scene = bd.Scene(shaft, mount, physics=bd.Physics(planes=2))
speeds = np.linspace(0, 3.4, 35)
locus = bd.frequency_locus(scene, speeds, modes=2)
rest = bd.natural_modes(scene, modes=1).frequency[0]

fig, ax = plt.subplots()
ax.plot(speeds, locus.frequency, "o", ms=4)
ax.plot(speeds, rest + speeds / (2 * np.pi), "k--", lw=1, label="at rest plus the speed")
ax.plot(speeds, rest - speeds / (2 * np.pi), "k:", lw=1, label="at rest less the speed")
ax.set(xlabel="speed [rad/s]", ylabel="frequency in turning axes [Hz]")
ax.legend()
